/* sinew-register: the rigid motion that takes points that were picked in one frame to the same points in another. */
#include "base/mem.h"
#include "base/space.h"
#include "cli/text_table.h"
#include "cli/tool.h"
#include "place/itk.h"
#include "place/points.h"
#include "place/registration.h"
#include "place/tum.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* For what: how .fcsv is taken, first and second, and what .tfm has. */
enum { FOR_BODY, FOR_TRACKER, FOR_MARKER };
enum { FORMAT_TUM, FORMAT_MATRIX, FORMAT_TFM };
enum { ROWS_MOST = 40 };

struct options {
    opt_common common;
    const char *unit, *residuals;
    opt_lengths target;
    bool by_order;
    int use, format;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_INPUT, 0, "unit", "UNIT[,UNIT]", OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "unit of points that are text, of both files or of each"},
    {OPT_INPUT, 0, "by-order", NULL, OPT_FLAG, TO(by_order), 0, 0, NULL, 0,
     "pair points by their order, not by their names"},
    {OPT_INPUT, 0, "for", "body|tracker|marker", OPT_CHOICE, TO(use), 0, 0, "body|tracker|marker", 0,
     "what it is for: which axes .fcsv is taken in [default body]"},
    {OPT_ACTION, 0, "target", "X,Y,Z", OPT_LENGTHS, TO(target), 0, 3, NULL, OPT_OUTPUT,
     "a place of the first frame whose expected error is told [length; default the middle]"},
    {OPT_RESULT, 0, "format", "tum|4x4|tfm", OPT_CHOICE, TO(format), 0, 0, "tum|4x4|tfm", OPT_OUTPUT,
     "a line of a pose, a matrix, or Slicer's transform [default tum]"},
    {OPT_RESULT, 0, "residuals", "FILE", OPT_TEXT, TO(residuals), 0, 0, NULL, OPT_OUTPUT | OPT_FILE | OPT_WRITES,
     "write what each pair is apart (TSV)"},
    {0}};

static const opt_tool table = {
    .name = "sinew-register",
    .command = "sinew register",
    .usage = "[options] from to > motion",
    .purpose = "Finds the rigid motion that takes points to the same points as they were picked\nin another frame, for "
               "--body and --marker, and tells what is left between them.",
    .note = "FROM and TO: .fcsv of 3D Slicer, or lines of text, x y z or NAME x y z.",
    .example = "sinew register --unit mm scan.fcsv touched.txt > body.tum",
    .operands = "FROM TO",
    .operands_min = 2,
    .operands_max = 2,
    .options = option_table,
};

/* All of one run. */
typedef struct job {
    const tool *t;
    const struct options *o;
    points from, to;
    int64_t *pair;
    double *x, *y, *left; /* pairs x 3, m */
    registration found;
} job;

/* ---- reading */

static int read_units(const char *text, num_unit unit[2], err *e)
{
    char first[16];
    const char *second = text ? strchr(text, ',') : NULL;
    const size_t n = second ? (size_t)(second - text) : 0;
    unit[0] = unit[1] = 0;
    if (!text)
        return 0;
    if (n < sizeof first) {
        memcpy(first, text, n);
        first[n] = '\0';
        unit[0] = num_unit_of(second ? first : text);
        unit[1] = num_unit_of(second ? second + 1 : text);
    }
    return unit[0] && unit[1] ? 0 : err_usage(e, "--unit '%.100s': expected " NUM_UNITS ", or two of them", text);
}

static int read_points(points *p, const char *path, num_unit unit, bool shown, err *e)
{
    const points_wish wish = {unit, shown};
    in *s = in_open(path, e);
    const int failed = s ? points_read(p, s, &wish, e) : -1;
    in_close(s);
    return failed;
}

static int read_all(job *j, err *e)
{
    num_unit unit[2];
    char *const *path = j->t->operand;
    if (read_units(j->o->unit, unit, e))
        return -1;
    if (j->o->target.count != 0 && j->o->target.count != 3)
        return err_usage(e, "--target with %d lengths; expected X,Y,Z", j->o->target.count);
    if (!strcmp(path[0], "-") && !strcmp(path[1], "-"))
        return err_usage(e, "both files are standard input; expected one of them");
    return read_points(&j->from, path[0], unit[0], j->o->use == FOR_MARKER, e) ||
                   read_points(&j->to, path[1], unit[1], j->o->use != FOR_BODY, e)
               ? -1
               : 0;
}

/* ---- the work */

static int make_pairs(job *j, err *e)
{
    const int64_t count = j->from.count;
    char *const *path = j->t->operand;
    j->pair = mem_array(count, sizeof *j->pair, "pairs", e);
    j->x = mem_array(3 * count, sizeof *j->x, "pairs", e);
    j->y = mem_array(3 * count, sizeof *j->y, "pairs", e);
    j->left = mem_array(3 * count, sizeof *j->left, "pairs", e);
    if (!j->pair || !j->x || !j->y || !j->left ||
        points_pair(&j->from, &j->to, path[0], path[1], j->o->by_order, j->pair, e))
        return -1;
    for (int64_t i = 0; i < count; i++) {
        memcpy(j->x + 3 * i, j->from.one[i].at, 3 * sizeof *j->x);
        memcpy(j->y + 3 * i, j->to.one[j->pair[i]].at, 3 * sizeof *j->y);
    }
    return 0;
}

static int find(job *j, err *e)
{
    return make_pairs(j, e) ? -1 : registration_fit(j->x, j->y, j->from.count, j->t->operand[0], &j->found, j->left, e);
}

/* ---- what is told */

static void name_of(const job *j, int64_t i, char name[120])
{
    const char *own = *j->from.one[i].name ? j->from.one[i].name : j->to.one[j->pair[i]].name;
    if (*own)
        snprintf(name, 120, "%.100s", own);
    else
        snprintf(name, 120, "%" PRId64, i + 1);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static int say_each(const job *j, err *e)
{
    static const char *const heads[] = {"<point", ">apart\nmm", ">x", ">y", ">z", NULL};
    text_table *rows = text_table_create(heads, e);
    if (!rows)
        return -1;
    for (int64_t i = 0; i < j->found.count; i++) {
        char name[120];
        name_of(j, i, name);
        text_table_cell(rows, "%s", name);
        text_table_number(rows, 1e3 * length_of(j->left + 3 * i), 3);
        for (int a = 0; a < 3; a++)
            text_table_number(rows, 1e3 * j->left[3 * i + a], 3);
    }
    const int failed = tool_table(j->t, rows, e, "what is left of %" PRId64 " pairs", j->found.count);
    text_table_free(rows);
    return failed;
}

static int say(const job *j, err *e)
{
    const registration *r = &j->found;
    char name[120];
    double at[3];
    memcpy(at, r->middle, sizeof at);
    if (r->count <= ROWS_MOST && say_each(j, e))
        return -1;
    name_of(j, r->worst, name);
    tool_say(j->t, "%" PRId64 " pairs: FRE %.3g mm (rms), largest %.3g mm, of %s; FLE %.3g mm by it", r->count,
             1e3 * r->fre, 1e3 * r->largest, name, 1e3 * r->fle);
    for (int a = 0; a < j->o->target.count; a++)
        at[a] = num_length_in(j->o->target.value[a], num_unit_of("m"), num_unit_of("m"));
    tool_say(j->t, "expected TRE %.3g mm (rms) at %s (%.6g, %.6g, %.6g) mm", 1e3 * registration_tre(r, at),
             j->o->target.count ? "the target" : "the middle of the points", 1e3 * at[0], 1e3 * at[1], 1e3 * at[2]);
    return 0;
}

/* ---- writing */

static void put_number(out *to, const char *before, double v)
{
    char text[NUM_TEXT];
    num_text(v, false, text);
    out_text(to, before);
    out_text(to, text);
}

static void put_motion(const job *j, out *to)
{
    const pose *p = &j->found.at;
    double m[16];
    if (j->o->format == FORMAT_TFM) {
        itk_write(p, j->o->use == FOR_MARKER ? TRANSFORM_MARKER : TRANSFORM_BODY, to);
        return;
    }
    out_format(to, "# sinew register: %" PRId64 " pairs, FRE %.3g mm\n", j->found.count, 1e3 * j->found.fre);
    if (j->o->format == FORMAT_TUM) {
        out_text(to, "0");
        for (int i = 0; i < 7; i++)
            put_number(to, " ", i < 3 ? p->position[i] : p->quaternion[i - 3]);
        out_text(to, "\n");
        return;
    }
    space_matrix_of_pose(p, SPACE_LPS, m);
    for (int i = 0; i < 16; i++) {
        put_number(to, i % 4 ? " " : "", m[i]);
        out_text(to, i % 4 == 3 ? "\n" : "");
    }
}

static void put_residuals(const job *j, out *to)
{
    out_text(to, "point\tx [mm]\ty [mm]\tz [mm]\tapart [mm]\n");
    for (int64_t i = 0; i < j->found.count; i++) {
        char name[120];
        name_of(j, i, name);
        out_text(to, name);
        for (int a = 0; a < 3; a++)
            put_number(to, "\t", 1e3 * j->left[3 * i + a]);
        put_number(to, "\t", 1e3 * length_of(j->left + 3 * i));
        out_text(to, "\n");
    }
}

static int write_one(const job *j, const char *path, void (*put)(const job *, out *), err *e)
{
    out *to = out_open(path, false, e);
    if (to)
        put(j, to);
    return to ? out_close(to, e) : -1;
}

static int write_all(const job *j, err *e)
{
    if (j->o->residuals && write_one(j, j->o->residuals, put_residuals, e))
        return -1;
    return write_one(j, j->o->common.output, put_motion, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.use = FOR_BODY, .format = FORMAT_TUM};
    err e = {0};
    tool t = {0};
    job j = {.t = &t, .o = &o};
    if (!tool_begin(&t, &table, argc, argv, &o, &e) && !t.done && !read_all(&j, &e) && !find(&j, &e) && !say(&j, &e))
        write_all(&j, &e);
    points_free(&j.from);
    points_free(&j.to);
    free(j.pair);
    free(j.x);
    free(j.y);
    free(j.left);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
