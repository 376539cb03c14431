/* us-surface: closed surfaces of what a volume shows, by marching cubes: around
 * labels, or where an intensity is reached. */
#include "base/mem.h"
#include "base/near.h"
#include "cli/length.h"
#include "cli/tool.h"
#include "slice/contour/contour.h"
#include "slice/contour/contour_level.h"
#include "slice/contour/contour_obj.h"
#include "volume/samples.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    opt_list labels;
    double iso;
    const char *name;
    opt_lengths smooth;
    int64_t taubin;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 'l', "label", "NAME,...", OPT_LIST, TO(labels), 0, 0, NULL, 0,
     "surfaces of these labels, names or numbers, or all"},
    {OPT_INPUT, 'i', "iso", "LEVEL", OPT_NUMBER, TO(iso), 0, 0, NULL, 0,
     "or around all voxels of this intensity or more"},
    {OPT_RESULT, 0, "name", "NAME", OPT_TEXT, TO(name), 0, 0, NULL, 0,
     "name of the group, with --iso [default surface]"},
    {OPT_ACTION, 0, "smooth", "SIGMA", OPT_LENGTHS, TO(smooth), 0, 1, NULL, 0,
     "Gaussian filter of the volume or labels [length; default none]"},
    {OPT_ACTION, 0, "taubin", "PASSES", OPT_INT, TO(taubin), 0, 1000, NULL, 0,
     "passes of Taubin smoothing, e.g. 10 [default 0]"},
    {0},
};

static const opt_tool table = {
    .name = "us-surface",
    .usage = "[options] volume > surface.obj\n[options] < volume > surface.obj",
    .purpose = "Writes closed surfaces of labels, or of an intensity, as OBJ (mm, LPS).",
    .note = "A length needs its unit, e.g. 0.5mm or 1cm.",
    .example = "us-surface --label vein --smooth 0.5mm labels.nrrd > vein.obj",
    .operands = "volume",
    .operands_max = 1,
    .reads_volumes = true,
    .options = option_list,
};

typedef struct job {
    const struct options *o;
    const tool *t;
    volume v;
    double sigma[3]; /* voxels */
    cubes *table;
    samples_label *label;
    int64_t labels;
    char **group; /* names of those written; owned */
    int64_t groups, group_room;
    out *to;
    int64_t vertices; /* written */
    notes warnings;
} job;

static int check_options(const struct options *o, err *e)
{
    if ((o->labels.count > 0) == !isnan(o->iso))
        return err_usage(e, "expected -l LABEL,... or -i LEVEL");
    if (o->name && isnan(o->iso))
        return err_usage(e, "--name is for -i; labels have names of their own");
    if (o->name && (!*o->name || strpbrk(o->name, " \t\r\n")))
        return err_usage(e, "--name '%s': expected one word", o->name);
    return 0;
}

/* The volume, and the samples of all of it where a level of it is sought; how large labels and surfaces are is not
 * known yet. */
static double peak_of(const volume *v, const void *context)
{
    const job *j = context;
    return volume_memory(v) + (isnan(j->o->iso) ? 0 : sizeof(float) * (double)volume_count(v));
}

static int read_volume(job *j, const char *path, err *e)
{
    const volume_budget budget = {.most = j->o->common.memory, .peak = peak_of, .context = j};
    double sigma = 0;
    if (length_mm(&j->o->smooth, "--smooth", &sigma, e))
        return -1;
    if (!(sigma >= 0)) {
        err_usage(e, "--smooth: expected 0 or more");
        return -1;
    }
    if (!path && tool_need_stdin("a volume", e))
        return -1;
    if (volume_load(&j->v, path, &budget, e))
        return -1;
    for (int a = 0; a < 3; a++) {
        j->sigma[a] = sigma / volume_spacing(&j->v, a);
        if (j->sigma[a] > (double)j->v.size[a]) {
            err_usage(e, "--smooth %gmm: wider than the volume, which is %gmm", sigma,
                      volume_spacing(&j->v, a) * (double)j->v.size[a]);
            return -1;
        }
    }
    return 0;
}

/* One surface, from samples in a box. label NULL: where j->o->iso is reached. */
static int make_surface(job *j, const samples_box *box, float *value, const samples_label *label, contour *c, err *e)
{
    bool filtered = j->sigma[0] > 0;
    int64_t size[3];
    float level = label ? .5F : (float)j->o->iso;
    for (int a = 0; a < 3; a++)
        size[a] = box->high[a] - box->low[a];
    if (filtered && samples_filter(value, size, j->sigma, e))
        return -1;
    if (filtered && label ? contour_make_of_volume(c, value, size, (double)label->count, j->table, e)
                          : contour_make(c, value, size, level, j->table, e))
        return -1;
    double inside = label ? (double)label->count : contour_volume(c);
    if (j->o->taubin && contour_smooth(c, (int)j->o->taubin, e))
        return -1;
    if (label && !filtered)
        contour_fill(c, inside, .49);
    else if ((label || j->o->taubin) && fabs(contour_volume(c) - inside) > .005 * inside)
        contour_fill(c, inside, .25); /* a vertex may be as near to a sample as that */
    return 0;
}

static void say_surface(job *j, const contour *c, const char *group, const samples_label *label)
{
    double voxel = fabs(volume_handed(&j->v)), got = contour_volume(c);
    tool_detail(j->t, "%s: %" PRId64 " triangles, %.6g mm3", group, c->triangles, got * voxel);
    if (label && fabs(got - (double)label->count) > .01 * (double)label->count)
        notes_add(&j->warnings, "%s: the surface encloses %.6g mm3, the label has %.6g", group, got * voxel,
                  (double)label->count * voxel);
}

/* Of the samples of a label, which may be in a small part of the volume. */
static int check_memory(const job *j, const char *group, const samples_box *box, err *e)
{
    char need[NUM_TEXT], most[NUM_TEXT];
    const double peak = volume_memory(&j->v) + sizeof(float) * (double)samples_count(box);
    if (!j->o->common.memory || peak <= (double)j->o->common.memory)
        return 0;
    return err_set(e, NULL, 0, "%s: the volume and the samples around this label take %s of memory; --memory allows %s",
                   group, num_size_text(peak, need), num_size_text((double)j->o->common.memory, most));
}

static int write_surface(job *j, const char *group, const samples_box *inner, const samples_label *label, err *e)
{
    contour c = {0};
    int64_t reach[3];
    for (int a = 0; a < 3; a++)
        reach[a] = samples_reach(j->sigma[a]) + 1;
    samples_box box = samples_wider(&j->v, inner, reach);
    if (check_memory(j, group, &box, e))
        return -1;
    float *value = mem_array(samples_count(&box), sizeof *value, "samples", e);
    if (!value)
        return -1;
    if (label)
        samples_mark(&j->v, &box, label->value, value);
    else
        samples_take(&j->v, &box, value);
    int result = make_surface(j, &box, value, label, &c, e);
    free(value);
    if (!result && !c.triangles)
        result = err_set(e, NULL, 0, "%s: nothing is left of it; expected less smoothing", group);
    if (!result) {
        contour_write(&c, &j->v, &box, group, j->vertices, j->to);
        j->vertices += c.vertices;
        say_surface(j, &c, group, label);
    }
    contour_free(&c);
    return result;
}

/* The label of that name; -1: none. */
static int find_name(const volume *v, const char *name)
{
    for (int i = 0; i < v->labels; i++)
        if (!strcmp(v->label[i].name, name))
            return i;
    return -1;
}

/* A label's name as an OBJ group: one word. The caller frees it. */
static char *group_of(const job *j, int64_t value, err *e)
{
    char plain[40];
    const char *name = volume_label_of(&j->v, value);
    snprintf(plain, sizeof plain, "label_%" PRId64, value);
    char *group = mem_text(name && *name ? name : plain, e);
    for (char *c = group; c && *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '#' || *c == '\\')
            *c = '_';
    return group;
}

/* Two surfaces of one group would be one. */
static int check_group(const job *j, const char *group, err *e)
{
    for (int64_t i = 0; i < j->groups; i++)
        if (!strcmp(j->group[i], group))
            return err_set(e, NULL, 0, "a second surface in group '%s'; expected labels once, and names that differ",
                           group);
    return 0;
}

/* The group becomes the job's. */
static int take_group(job *j, char *group, err *e)
{
    if (check_group(j, group, e) || MEM_ROOM(&j->group, &j->group_room, j->groups + 1, "groups", e)) {
        free(group);
        return -1;
    }
    j->group[j->groups++] = group;
    return 0;
}

static int write_label(job *j, const samples_label *label, err *e)
{
    char *group = group_of(j, label->value, e);
    return group && !take_group(j, group, e) ? write_surface(j, group, &label->box, label, e) : -1;
}

/* A label by its name or number; it has to have voxels. */
static int write_named(job *j, const char *name, err *e)
{
    int64_t value = 0;
    int at = find_name(&j->v, name);
    if (at >= 0) {
        value = j->v.label[at].value;
    } else if (num_int(name, INT64_MIN, INT64_MAX, &value)) {
        const char **known = mem_array(j->v.labels, sizeof *known, "names", e);
        for (int i = 0; known && i < j->v.labels; i++)
            known[i] = j->v.label[i].name;
        if (known)
            near_option(e, NULL, "label", name, known, j->v.labels);
        free(known);
        return -1;
    }
    for (int64_t i = 0; i < j->labels; i++)
        if (j->label[i].value == value)
            return write_label(j, &j->label[i], e);
    return err_set(e, NULL, 0, "label '%s' has no voxels", name);
}

/* Those of an -l: all, or names by commas, or one name that has a comma in it. */
static int write_list(job *j, const char *given, err *e)
{
    if (!strcmp(given, "all")) {
        int failed = 0;
        for (int64_t l = 0; !failed && l < j->labels; l++)
            failed = write_label(j, &j->label[l], e);
        return failed;
    }
    if (find_name(&j->v, given) >= 0)
        return write_named(j, given, e);
    char *list = mem_text(given, e);
    int failed = list ? 0 : -1;
    for (char *name = list, *comma; name && !failed; name = comma) {
        comma = strchr(name, ',');
        if (comma)
            *comma++ = '\0';
        if (*name)
            failed = write_named(j, name, e);
        else
            failed = err_usage(e, "-l '%s': expected names or numbers of labels between commas, or all", given);
    }
    free(list);
    return failed;
}

static int write_labels(job *j, err *e)
{
    j->labels = samples_labels(&j->v, &j->label, e);
    if (j->labels < 0)
        return -1;
    if (j->labels == 0)
        return err_set(e, NULL, 0, "no label has voxels");
    for (int i = 0; i < j->o->labels.count; i++)
        if (write_list(j, j->o->labels.value[i], e))
            return -1;
    return 0;
}

static int write_level(job *j, err *e)
{
    samples_box whole = samples_whole(&j->v);
    return write_surface(j, j->o->name ? j->o->name : "surface", &whole, NULL, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.iso = NAN};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, &e))
        goto out;
    if (read_volume(&j, t.operands ? argv[1] : NULL, &e))
        goto out;
    j.table = cubes_create(&e);
    j.to = j.table ? out_open(o.common.output, false, &e) : NULL;
    if (!j.to)
        goto out;
    out_text(j.to, "# us-surface " SINEW_VERSION ": mm, LPS\n");
    out_end(j.to, isnan(o.iso) ? write_labels(&j, &e) : write_level(&j, &e), &e);
out:
    tool_warn(&t, &j.warnings);
    free(j.table);
    free(j.label);
    while (j.groups)
        free(j.group[--j.groups]);
    free(j.group);
    volume_free(&j.v);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
