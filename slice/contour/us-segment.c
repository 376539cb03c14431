/* us-segment: marks a part of a volume, by intensity and from seeds, as a named label in a label image. */
#include "base/chars.h"
#include "base/mem.h"
#include "cli/length.h"
#include "cli/tool.h"
#include "slice/contour/segment_region.h"
#include "volume/nrrd.h"
#include "volume/samples.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    const char *name, *onto;
    int64_t value;
    opt_list seeds, voxels;
    double low, high, tolerance;
    opt_lengths filter, smooth;
    bool largest, fill, raw;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_RESULT, 'n', "name", "NAME", OPT_TEXT, TO(name), 0, 0, NULL, OPT_REQUIRED, "name of the label; required"},
    {OPT_RESULT, 0, "value", "N", OPT_INT, TO(value), 1, 1e9, NULL, 0,
     "number of the label [default the name's, or the next]"},
    {OPT_INPUT, 0, "onto", "LABELS", OPT_TEXT, TO(onto), 0, 0, NULL, OPT_FILE,
     "add the label to this label image [default a new one]"},
    {OPT_ACTION, 0, "low", "LEVEL", OPT_NUMBER, TO(low), 0, 0, NULL, 0, "voxels of this intensity or more"},
    {OPT_ACTION, 0, "high", "LEVEL", OPT_NUMBER, TO(high), 0, 0, NULL, 0, "voxels of this intensity or less"},
    {OPT_ACTION, 0, "seed", "X,Y,Z", OPT_LIST, TO(seeds), 0, 0, NULL, 0,
     "what is connected to this point in LPS, e.g. 10,-4,32mm [length]"},
    {OPT_ACTION, 0, "seed-voxel", "I,J,K", OPT_LIST, TO(voxels), 0, 0, NULL, 0, "what is connected to this voxel"},
    {OPT_ACTION, 0, "tolerance", "T", OPT_NUMBER, TO(tolerance), 0, 1e30, NULL, 0,
     "voxels within T of the intensities of the seeds"},
    {OPT_ACTION, 0, "filter", "SIGMA", OPT_LENGTHS, TO(filter), 0, 1, NULL, 0,
     "Gaussian filter of the volume [length; default none]"},
    {OPT_ACTION, 0, "smooth", "SIGMA", OPT_LENGTHS, TO(smooth), 0, 1, NULL, 0,
     "Gaussian filter of the label [length; default none]"},
    {OPT_ACTION, 0, "largest", NULL, OPT_FLAG, TO(largest), 0, 0, NULL, 0, "keep only the largest connected component"},
    {OPT_ACTION, 0, "fill", NULL, OPT_FLAG, TO(fill), 0, 0, NULL, 0, "fill holes"},
    {OPT_RESULT, 0, "raw", NULL, OPT_FLAG, TO(raw), 0, 0, NULL, OPT_OUTPUT, "do not compress"},
    {0},
};

static const opt_tool table = {
    .name = "us-segment",
    .usage = "--name NAME [options] volume > labels.nrrd\n--name NAME [options] < volume > labels.nrrd",
    .purpose = "Marks a part of a volume image as a label, by its intensity and from seeds.",
    .note = "A length needs its unit, e.g. 0.5mm or 1cm.",
    .example = "us-segment -n vein --high 40 --seed 10,-4,32mm scan.nrrd > labels.nrrd",
    .operands = "volume",
    .operands_max = 1,
    .reads_volumes = true,
    .options = option_list,
};

enum { SEEDS = 128 };

typedef struct job {
    const struct options *o;
    const tool *t;
    volume v, labels;
    region r; /* its mask is owned here */
    int64_t seed[SEEDS];
    float at_seed[SEEDS]; /* the intensity there, filtered */
    int seeds;
    double low, high;
} job;

/* ---- options */

/* A name comes back from a header's line as it was given: blanks at its ends do not,
 * and readers refuse what is not UTF-8. */
static bool is_name(const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)name[i] < ' ' || name[i] == 0x7F)
            return false;
    return length && name[0] != ' ' && name[length - 1] != ' ' && chars_utf8(name);
}

static int check_options(const struct options *o, err *e)
{
    bool seeds = o->seeds.count || o->voxels.count;
    if (!is_name(o->name))
        return err_usage(e, "-n '%s': expected a name in UTF-8, without blanks at its ends", o->name);
    if (!isnan(o->tolerance) && !seeds)
        return err_usage(e, "--tolerance is relative to the intensity of a seed; expected --seed or --seed-voxel");
    if (isnan(o->low) && isnan(o->high) && isnan(o->tolerance))
        return err_usage(e, "no intensities are given; expected --low, --high, or --tolerance with seeds");
    if (o->low > o->high)
        return err_usage(e, "--low %g is above --high %g", o->low, o->high);
    return 0;
}

static int add_seed(job *j, const char *text, int64_t at, err *e)
{
    if (at < 0)
        return err_usage(e, "seed %s: outside of the volume", text);
    if (j->seeds == SEEDS)
        return err_usage(e, "more than %d seeds", SEEDS);
    j->seed[j->seeds++] = at;
    return 0;
}

static int add_place(job *j, const volume_finder *f, const char *text, err *e)
{
    opt_lengths l = {0};
    double place[3];
    l.count = num_lengths_of(text, l.value, 3);
    if (l.count != 3)
        return err_usage(e, "--seed %s: expected X,Y,Z, LPS, as 10,-4,32mm", text);
    if (length_mm(&l, "--seed", place, e))
        return -1;
    for (int a = 0; a < 3; a++)
        place[a] /= 1e3;
    return add_seed(j, text, volume_nearest(&j->v, f, place), e);
}

static int add_voxel(job *j, const char *text, err *e)
{
    double n[3];
    const int64_t *size = j->v.size;
    if (num_list(text, n, 3) != 3 || n[0] != floor(n[0]) || n[1] != floor(n[1]) || n[2] != floor(n[2]))
        return err_usage(e, "--seed-voxel %s: expected I,J,K, whole numbers", text);
    bool inside = true;
    for (int a = 0; a < 3; a++)
        inside &= n[a] >= 0 && n[a] < (double)size[a];
    return add_seed(j, text, inside ? ((int64_t)n[2] * size[1] + (int64_t)n[1]) * size[0] + (int64_t)n[0] : -1, e);
}

static int find_seeds(job *j, err *e)
{
    volume_finder f = volume_finder_of(&j->v);
    for (int i = 0; i < j->o->seeds.count; i++)
        if (add_place(j, &f, j->o->seeds.value[i], e))
            return -1;
    for (int i = 0; i < j->o->voxels.count; i++)
        if (add_voxel(j, j->o->voxels.value[i], e))
            return -1;
    return 0;
}

static int sigma_of(const job *j, const opt_lengths *l, const char *option, double sigma[3], err *e)
{
    double mm = 0;
    if (length_mm(l, option, &mm, e))
        return -1;
    for (int a = 0; a < 3; a++) {
        sigma[a] = mm / volume_spacing(&j->v, a);
        if (!(sigma[a] >= 0 && sigma[a] <= (double)j->v.size[a]))
            return err_usage(e, "%s %gmm: expected 0 or more, and less than the volume", option, mm);
    }
    return 0;
}

/* ---- finding */

/* The intensities that count: what was asked for, and within the tolerance of the seeds'. */
static void find_range(job *j)
{
    double low = INFINITY, high = -INFINITY;
    j->low = isnan(j->o->low) ? -INFINITY : j->o->low;
    j->high = isnan(j->o->high) ? INFINITY : j->o->high;
    if (isnan(j->o->tolerance))
        return;
    for (int i = 0; i < j->seeds; i++) {
        low = fmin(low, (double)j->at_seed[i]);
        high = fmax(high, (double)j->at_seed[i]);
    }
    j->low = fmax(j->low, low - j->o->tolerance);
    j->high = fmin(j->high, high + j->o->tolerance);
}

static int64_t count_in(const job *j)
{
    int64_t sum = 0;
    for (int64_t i = 0; i < volume_count(&j->v); i++)
        sum += j->r.mask[i];
    return sum;
}

/* Keeps what is joined to a seed. */
static int grow(job *j, err *e)
{
    if (!j->seeds)
        return 0;
    for (int i = 0; i < j->seeds; i++) {
        if (!j->r.mask[j->seed[i]])
            return err_set(e, NULL, 0, "seed %d has intensity %g; expected one from %g to %g", i + 1,
                           (double)j->at_seed[i], j->low, j->high);
        if (region_flood(&j->r, j->seed[i], 1, 2, e) < 0)
            return -1;
    }
    for (int64_t i = 0; i < volume_count(&j->v); i++)
        j->r.mask[i] = j->r.mask[i] == 2;
    return 0;
}

static int64_t plane_of(const job *j)
{
    return j->v.size[0] * j->v.size[1];
}

static void take_mask(void *context, int64_t z, float *plane)
{
    const job *j = context;
    const uint8_t *mask = j->r.mask + z * plane_of(j);
    for (int64_t i = 0; i < plane_of(j); i++)
        plane[i] = mask[i];
}

static void give_mask(void *context, int64_t z, const float *plane)
{
    job *j = context;
    uint8_t *mask = j->r.mask + z * plane_of(j);
    for (int64_t i = 0; i < plane_of(j); i++)
        mask[i] = plane[i] >= .5F;
}

/* What is at least half inside after the filter. */
static int smooth(job *j, err *e)
{
    double sigma[3];
    if (sigma_of(j, &j->o->smooth, "--smooth", sigma, e))
        return -1;
    const samples_planes planes = {take_mask, give_mask, j};
    return sigma[0] > 0 ? samples_filter_planes(&planes, j->v.size, sigma, 0, j->v.size[2], e) : 0;
}

static void take_values(void *context, int64_t z, float *plane)
{
    const job *j = context;
    const samples_box box = {{0, 0, z}, {j->v.size[0], j->v.size[1], z + 1}};
    samples_take(&j->v, &box, plane);
}

static void give_seeds(void *context, int64_t z, const float *plane)
{
    job *j = context;
    for (int i = 0; i < j->seeds; i++)
        if (j->seed[i] / plane_of(j) == z)
            j->at_seed[i] = plane[j->seed[i] % plane_of(j)];
}

static void give_inside(void *context, int64_t z, const float *plane)
{
    job *j = context;
    uint8_t *mask = j->r.mask + z * plane_of(j);
    const float low = (float)j->low, high = (float)j->high;
    for (int64_t i = 0; i < plane_of(j); i++)
        mask[i] = plane[i] >= low && plane[i] <= high;
}

/* The intensities at the seeds, from the planes that these lie in. */
static int look_at_seeds(job *j, const double sigma[3], err *e)
{
    const samples_planes planes = {take_values, give_seeds, j};
    int64_t from = INT64_MAX, to = 0;
    for (int i = 0; i < j->seeds; i++) {
        const int64_t z = j->seed[i] / plane_of(j);
        from = z < from ? z : from;
        to = z + 1 > to ? z + 1 : to;
    }
    return j->seeds ? samples_filter_planes(&planes, j->v.size, sigma, from, to, e) : 0;
}

static int find(job *j, err *e)
{
    double sigma[3];
    const samples_planes planes = {take_values, give_inside, j};
    if (find_seeds(j, e) || sigma_of(j, &j->o->filter, "--filter", sigma, e) || look_at_seeds(j, sigma, e))
        return -1;
    find_range(j);
    memcpy(j->r.size, j->v.size, sizeof j->r.size);
    j->r.mask = mem_array(volume_count(&j->v), 1, "a mask", e);
    if (!j->r.mask || samples_filter_planes(&planes, j->v.size, sigma, 0, j->v.size[2], e))
        return -1;
    free(j->v.data); /* from here on its geometry is enough */
    j->v.data = NULL;
    if (grow(j, e) || smooth(j, e) || (j->o->largest && region_largest(&j->r, e)) ||
        (j->o->fill && region_fill(&j->r, e)))
        return -1;
    if (!count_in(j))
        return err_set(e, NULL, 0,
                       "nothing is left of '%s'; expected other intensities (here %g to %g) or less smoothing",
                       j->o->name, j->low, j->high);
    return 0;
}

/* ---- the map */

static int check_same_place(const volume *a, const volume *b, const char *name, err *e)
{
    bool same = true;
    for (int i = 0; i < 3; i++) {
        double least = 1e-3 * volume_spacing(a, i);
        same &= a->size[i] == b->size[i] && fabs(a->origin[i] - b->origin[i]) <= least;
        for (int k = 0; k < 3; k++)
            same &= fabs(a->axis[i][k] - b->axis[i][k]) * (double)a->size[i] <= least;
    }
    return same ? 0 : err_set(e, name, 0, "labels of another size or place than the volume");
}

/* The mask, the walk over it and the labels, which join it when the volume has gone. */
static double peak_of_labels(const volume *l, const void *context)
{
    const job *j = context;
    const double count = (double)volume_count(&j->v);
    return count + region_bytes(count) + volume_memory(l);
}

static int open_labels(job *j, err *e)
{
    volume *l = &j->labels;
    const volume_budget budget = {.most = j->o->common.memory, .peak = peak_of_labels, .context = j};
    if (j->o->onto) {
        if (volume_load(l, j->o->onto, &budget, e) || check_same_place(&j->v, l, j->o->onto, e))
            return -1;
        if (l->type == VOLUME_F32 || l->type == VOLUME_F64)
            return err_set(e, j->o->onto, 0, "voxels that are not whole numbers; expected a label image");
        return 0;
    }
    l->type = VOLUME_U8;
    memcpy(l->size, j->v.size, sizeof l->size);
    memcpy(l->origin, j->v.origin, sizeof l->origin);
    memcpy(l->axis, j->v.axis, sizeof l->axis);
    return volume_afford(&budget, l, NULL, e) || volume_make(l, e) ? -1 : 0;
}

/* A name is of one number, and a number of one name: else what is there would be called
 * by the new name, or a name be of two. */
static int check_value(const job *j, const volume_label *l, err *e)
{
    bool named = !strcmp(l->name, j->o->name), numbered = l->value == j->o->value;
    if (j->o->value < 0 || named == numbered)
        return 0;
    return err_set(e, j->o->onto, 0, "label %" PRId64 " is '%s'; expected %s", l->value, l->name,
                   named ? "that --value, or another name" : "another --value, or that name");
}

/* The number of the name; else the first that no voxel and no name has. */
static int choose_value(const job *j, int64_t *value, err *e)
{
    samples_label *list = NULL;
    const volume *l = &j->labels;
    *value = j->o->value;
    for (int i = 0; i < l->labels; i++) {
        if (check_value(j, &l->label[i], e))
            return -1;
        if (*value < 0 && !strcmp(l->label[i].name, j->o->name))
            *value = l->label[i].value;
    }
    if (*value >= 0)
        return 0;
    int64_t count = samples_labels(l, &list, e), most = 0;
    for (int64_t i = 0; i < count; i++)
        most = list[i].value > most ? list[i].value : most;
    for (int i = 0; i < l->labels; i++)
        most = l->label[i].value > most ? l->label[i].value : most;
    free(list);
    *value = most + 1;
    return count < 0 ? -1 : 0;
}

static int put_label(job *j, err *e)
{
    int64_t value, count = volume_count(&j->v), taken = 0;
    if (open_labels(j, e) || choose_value(j, &value, e))
        return -1;
    switch (j->labels.type) {
#define PUT(name, of, nrrd, meta, low_, high_)                                                                         \
    case VOLUME_##name:                                                                                                \
        if ((int64_t)(of)value != value)                                                                               \
            return err_set(e, NULL, 0, "label %" PRId64 " in voxels of type " nrrd "; expected a smaller --value",     \
                           value);                                                                                     \
        for (int64_t i = 0; i < count; i++)                                                                            \
            if (j->r.mask[i]) {                                                                                        \
                taken += ((of *)j->labels.data)[i] != 0 && ((of *)j->labels.data)[i] != (of)value;                     \
                ((of *)j->labels.data)[i] = (of)value;                                                                 \
            }                                                                                                          \
        break;
        VOLUME_TYPES(PUT)
    default:
        break;
    }
    double voxel = fabs(volume_handed(&j->v));
    int64_t found = count_in(j);
    tool_say(j->t, "%s (%" PRId64 "): %" PRId64 " voxels, %.6g mm3%s", j->o->name, value, found, voxel * (double)found,
             taken ? ", some of them from other labels" : "");
    return volume_name(&j->labels, value, j->o->name, e);
}

/* The volume with its mask, and planes that are filtered; or, with the mask, what the walk holds, and the labels of 8
 * bits. */
static double peak_of_volume(const volume *v, const void *context)
{
    const job *j = context;
    const double count = (double)volume_count(v);
    double sigma[3] = {0}, planes = 0;
    for (int i = 0; i < 2; i++) {
        const opt_lengths *l = i ? &j->o->smooth : &j->o->filter;
        err ignored = {0};
        double mm = 0;
        for (int a = 0; a < 3 && !length_mm(l, "", &mm, &ignored); a++)
            sigma[a] = fmin(fmax(mm / volume_spacing(v, a), 0), (double)v->size[a]);
        planes = fmax(planes, samples_planes_bytes(v->size, sigma));
    }
    return count + fmax(volume_memory(v) + planes, region_bytes(count) + fmax(planes, count));
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.value = -1, .low = NAN, .high = NAN, .tolerance = NAN};
    err e = {0};
    tool t = {0};
    job j = {.o = &o, .t = &t};
    volume_budget budget = {.peak = peak_of_volume, .context = &j};
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, &e))
        goto out;
    budget.most = o.common.memory;
    if ((!t.operands && tool_need_stdin("a volume", &e)) || volume_load(&j.v, t.operands ? argv[1] : NULL, &budget, &e))
        goto out;
    if (find(&j, &e) || put_label(&j, &e))
        goto out;
    out *to = out_open(o.common.output, false, &e);
    out_end(to, to && nrrd_write(&j.labels, !o.raw, to, &e), &e);
out:
    free(j.r.mask);
    region_free(&j.r);
    volume_free(&j.v);
    volume_free(&j.labels);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
