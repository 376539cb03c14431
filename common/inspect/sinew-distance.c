/* sinew-distance: how far two surfaces are apart, by region. */
#include "cli/outs.h"
#include "cli/tool.h"
#include "inspect/distance_print.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *unit, *of, *to, *points;
    opt_list regions;
    bool both, tsv;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_INPUT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, OPT_REQUIRED,
     "unit of the OBJs and of a box; required"},
    {OPT_INPUT, 0, "of", "GROUP", OPT_TEXT, TO(of), 0, 0, NULL, 0,
     "of A take the polygons of this group [default all]"},
    {OPT_INPUT, 0, "to", "GROUP", OPT_TEXT, TO(to), 0, 0, NULL, 0,
     "of B take the polygons of this group [default all]"},
    {OPT_ACTION, 0, "region", "NAME=REGION", OPT_LIST, TO(regions), 0, 0, NULL, 0,
     "a group, a box or a closed OBJ [default all, and each group]"},
    {OPT_ACTION, 0, "both", NULL, OPT_FLAG, TO(both), 0, 0, NULL, 0,
     "measure from B to A too; print the Hausdorff distance"},
    {OPT_RESULT, 0, "points", "FILE", OPT_TEXT, TO(points), 0, 0, NULL, OPT_OUTPUT | OPT_FILE | OPT_WRITES,
     "write a line for each vertex of A to FILE (TSV)"},
    {OPT_RESULT, 0, "tsv", NULL, OPT_FLAG, TO(tsv), 0, 0, NULL, OPT_OUTPUT, "print the table as TSV, with all digits"},
    {0}};

static const opt_tool table = {
    .name = "sinew-distance",
    .command = "sinew distance",
    .usage = "--unit UNIT [options] A.obj B.obj",
    .purpose = "Measures from each vertex of A to the nearest point of the surface B.",
    .note = "REGION: a group, a box X0,Y0,Z0,X1,Y1,Z1, or FILE.obj, a closed surface.\n"
            "Its lengths are in --unit, unless they have a suffix (" NUM_UNITS_LIST ").",
    .example = "sinew distance --unit mm --of skin --region lip=lip.obj predicted.obj scan.obj",
    .operands = "A.obj B.obj",
    .operands_min = 2,
    .operands_max = 2,
    .threaded = true,
    .options = option_table,
};

/* All of one run. */
typedef struct job {
    const tool *t;
    const struct options *o;
    num_unit unit;
    distance_regions regions;
    distance_surface surface[2];
    distance_field field[2];
    distance_report report;
    pool *threads;
    notes warnings;
} job;

static void job_free(job *j)
{
    for (int i = 0; i < 2; i++) {
        distance_rows_free(&j->report.rows[i]);
        distance_field_free(&j->field[i]);
        distance_surface_free(&j->surface[i]);
    }
    free(j->report.back);
    distance_regions_free(&j->regions);
    if (j->threads)
        pool_destroy(j->threads);
}

static int check_options(job *j, char *const *path, err *e)
{
    const bool first = !strcmp(path[0], "-"), second = !strcmp(path[1], "-");
    j->unit = num_unit_of(j->o->unit);
    if (!j->unit)
        return err_usage(e, "--unit '%.100s': expected " NUM_UNITS, j->o->unit);
    if (first && second)
        return err_usage(e, "both operands are standard input; expected one file at least");
    if (j->o->points && !strcmp(j->o->points, "-"))
        return err_usage(e, "--points '-': standard output has the table; expected a file");
    if (distance_regions_of(&j->regions, &j->o->regions, j->unit, e))
        return -1;
    return (first || second) && tool_need_stdin("an OBJ", e) ? -1 : 0;
}

static int read_surfaces(job *j, char *const *path, err *e)
{
    const int threads = tool_threads(j->t, e);
    j->threads = threads > 0 ? pool_create(threads, e) : NULL;
    if (!j->threads)
        return -1;
    const distance_source sources[2] = {{path[0], j->unit / 1000., j->o->of, "--of"},
                                        {path[1], j->unit / 1000., j->o->to, "--to"}};
    for (int i = 0; i < 2; i++)
        if (distance_surface_read(&j->surface[i], &sources[i], &j->warnings, e))
            return -1;
    return 0;
}

/* From A to B, or back. */
static int measure(job *j, int from, err *e)
{
    distance_surface *a = &j->surface[from], *b = &j->surface[!from];
    distance_field *f = &j->field[from];
    if (distance_surface_index(b, &j->warnings, e) || distance_measure(f, a, b, j->threads, e))
        return -1;
    return distance_rows_of(&j->report.rows[from], &j->regions, a, f, j->threads, e);
}

/* What was left out. */
static void tell(const job *j, int from)
{
    const distance_surface *a = &j->surface[from], *b = &j->surface[!from];
    const distance_field *f = &j->field[from];
    tool_detail(j->t, "%s: %" PRId64 " triangles, %" PRId64 " edges of the border", b->file.name, b->mesh.triangles,
                b->normal.border);
    if (f->border)
        tool_say(j->t,
                 "%" PRId64 " of %" PRId64 " vertices of %s have their nearest point on the border of %s and are left "
                 "out of means and largest distances",
                 f->border, a->used_count, a->file.name, b->file.name);
}

static int put_report(const job *j, err *e)
{
    out *to = out_open(j->o->common.output, false, e);
    if (!to)
        return -1;
    if (j->o->tsv)
        distance_print_tsv(&j->report, to);
    return out_end(to, !j->o->tsv && distance_print_tables(&j->report, to, e), e);
}

/* The points appear only with the report. */
static int write_all(const job *j, err *e)
{
    outs written = {0};
    int status = 0;
    if (j->o->points) {
        out *to = outs_open(&written, j->o->points, e);
        if (to)
            distance_print_points(&j->surface[0], &j->field[0], to);
        status = to ? out_close(to, e) : -1;
    }
    status = status || put_report(j, e) || outs_commit(&written, e) ? -1 : 0;
    outs_free(&written);
    return status;
}

static int run(job *j, char *const *path, err *e)
{
    if (check_options(j, path, e) || read_surfaces(j, path, e) || measure(j, 0, e) || (j->o->both && measure(j, 1, e)))
        return -1;
    for (int i = 0; i < 2; i++)
        j->report.surface[i] = &j->surface[i];
    for (int i = 0; i < (j->o->both ? 2 : 1); i++)
        tell(j, i);
    return distance_report_join(&j->report, !j->regions.count, e) || write_all(j, e) ? -1 : 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    job j = {.t = &t, .o = &o};
    if (!tool_begin(&t, &table, argc, argv, &o, &e) && !t.done)
        run(&j, argv + 1, &e);
    tool_warn(&t, &j.warnings);
    job_free(&j);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
