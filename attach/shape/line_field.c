#include "attach/shape/line_field.h"

#include "base/mem.h"
#include "place/principal.h"
#include "surface/triangle_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double most_samples = 20000, softest = .05; /* of a step: nearer than this is as near */

typedef struct sample {
    double place[3], along[3], length; /* m; unit; m */
} sample;

struct line_field {
    double step, low[3], side; /* m: of a bin */
    int64_t count[3];          /* bins */
    int64_t *start;            /* bins + 1 */
    sample *of;                /* bin after bin */
    triangle_tree *tree;       /* of the segments, as triangles without area */
};

static double length_of(const double *end)
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        sum += (end[3 + a] - end[a]) * (end[3 + a] - end[a]);
    return sqrt(sum);
}

/* ---- samples, sorted into bins */

static int64_t samples_of(const line_field *f, const double *end)
{
    const double length = length_of(end);
    return length > 0 ? (int64_t)ceil(length / f->step) : 0;
}

static sample sample_of(const double *end, int64_t i, int64_t count)
{
    sample s = {.length = length_of(end) / (double)count};
    const double at = ((double)i + .5) / (double)count;
    for (int a = 0; a < 3; a++) {
        s.place[a] = end[a] + at * (end[3 + a] - end[a]);
        s.along[a] = (end[3 + a] - end[a]) / length_of(end);
    }
    return s;
}

static int64_t bin_along(const line_field *f, int axis, double x)
{
    return (int64_t)fmin(fmax(floor((x - f->low[axis]) / f->side), 0), (double)(f->count[axis] - 1));
}

static int64_t bin_of(const line_field *f, const double *place)
{
    return (bin_along(f, 2, place[2]) * f->count[1] + bin_along(f, 1, place[1])) * f->count[0] +
           bin_along(f, 0, place[0]);
}

/* Their box, with about as many bins as there are samples. */
static void choose_bins(line_field *f, const double *end, int64_t segments, int64_t samples)
{
    double high[3], longest = 0;
    for (int a = 0; a < 3; a++) {
        f->low[a] = INFINITY, high[a] = -INFINITY;
        for (int64_t i = 0; i < 2 * segments; i++) {
            f->low[a] = fmin(f->low[a], end[3 * i + a]);
            high[a] = fmax(high[a], end[3 * i + a]);
        }
        longest = fmax(longest, high[a] - f->low[a]);
    }
    f->side = fmax(2 * f->step, longest / fmax(cbrt((double)samples), 1));
    for (int a = 0; a < 3; a++)
        f->count[a] = 1 + (int64_t)floor((high[a] - f->low[a]) / f->side);
}

static int sort_samples(line_field *f, const double *end, int64_t segments, int64_t samples, err *e)
{
    const int64_t bins = f->count[0] * f->count[1] * f->count[2];
    f->start = mem_array(bins + 2, sizeof *f->start, "lines", e);
    f->of = f->start ? mem_array(samples, sizeof *f->of, "lines", e) : NULL;
    if (!f->of)
        return -1;
    /* Counted two places up, so that filling leaves each bin's first in its place. */
    for (int fill = 0; fill < 2; fill++) {
        for (int64_t i = 0; i < segments; i++)
            for (int64_t k = 0, count = samples_of(f, end + 6 * i); k < count; k++) {
                const sample s = sample_of(end + 6 * i, k, count);
                if (fill)
                    f->of[f->start[bin_of(f, s.place) + 1]++] = s;
                else
                    f->start[bin_of(f, s.place) + 2]++;
            }
        for (int64_t b = 0; !fill && b < bins; b++)
            f->start[b + 2] += f->start[b + 1];
    }
    return 0;
}

static triangle_tree *grow_tree(const double *end, int64_t segments, err *e)
{
    int32_t *corner = mem_array(3 * segments, sizeof *corner, "lines", e);
    for (int64_t i = 0; corner && i < segments; i++)
        for (int c = 0; c < 3; c++)
            corner[3 * i + c] = (int32_t)(2 * i + (c > 0));
    triangle_tree *t = corner ? triangle_tree_create(end, corner, segments, e) : NULL;
    free(corner);
    return t;
}

line_field *line_field_create(const double *end, int64_t segments, double step, err *e)
{
    double length = 0;
    int64_t samples = 0;
    for (int64_t i = 0; i < segments; i++)
        length += length_of(end + 6 * i);
    if (!(length > 0)) {
        err_set(e, NULL, 0, "no line has a length");
        return NULL;
    }
    line_field *f = mem_array(1, sizeof *f, "lines", e);
    if (!f)
        return NULL;
    f->step = fmax(step, length / most_samples);
    for (int64_t i = 0; i < segments; i++)
        samples += samples_of(f, end + 6 * i);
    choose_bins(f, end, segments, samples);
    f->tree = grow_tree(end, segments, e);
    if (f->tree && !sort_samples(f, end, segments, samples, e))
        return f;
    line_field_free(f);
    return NULL;
}

void line_field_free(line_field *f)
{
    if (!f)
        return;
    triangle_tree_destroy(f->tree);
    free(f->start);
    free(f->of);
    free(f);
}

/* ---- what they say of a place */

/* Adds the dyad of what is left of a sample's direction in the plane across the normal. */
static void add_sample(const line_field *f, const sample *s, const double *place, const double *normal, double reach,
                       double dyad[3][3])
{
    double d2 = 0, up = 0, t[3];
    for (int a = 0; a < 3; a++) {
        d2 += (s->place[a] - place[a]) * (s->place[a] - place[a]);
        up += s->along[a] * normal[a];
    }
    const double d = fmax(sqrt(d2), softest * f->step);
    if (!(d < reach))
        return;
    for (int a = 0; a < 3; a++)
        t[a] = s->along[a] - up * normal[a];
    const double weight = s->length * ((reach - d) / (reach * d)) * ((reach - d) / (reach * d));
    for (int k = 0; k < 9; k++)
        dyad[k / 3][k % 3] += weight * t[k / 3] * t[k % 3];
}

static void add_near(const line_field *f, const double *place, const double *normal, double reach, double dyad[3][3])
{
    int64_t from[3], to[3];
    for (int a = 0; a < 3; a++) {
        from[a] = bin_along(f, a, place[a] - reach);
        to[a] = bin_along(f, a, place[a] + reach);
    }
    for (int64_t k = from[2]; k <= to[2]; k++)
        for (int64_t j = from[1]; j <= to[1]; j++) {
            const int64_t row = (k * f->count[1] + j) * f->count[0];
            for (int64_t i = f->start[row + from[0]]; i < f->start[row + to[0] + 1]; i++)
                add_sample(f, &f->of[i], place, normal, reach, dyad);
        }
}

void line_field_at(const line_field *f, const double place[3], const double normal[3], double along[3])
{
    double dyad[3][3] = {{0}}, v[3][3], up = 0, length = 0;
    int largest = 0;
    const triangle_hit hit = triangle_tree_nearest(f->tree, place, -1);
    add_near(f, place, normal, 2 * (sqrt(hit.distance2) + f->step), dyad);
    principal_axes(dyad, v);
    const int first = principal_largest(dyad);
    for (int a = 0; a < 3; a++)
        up += v[a][first] * normal[a];
    for (int a = 0; a < 3; a++) { /* in the plane to the last digit */
        along[a] = dyad[first][first] > 0 ? v[a][first] - up * normal[a] : 0;
        length += along[a] * along[a];
        if (fabs(along[a]) > fabs(along[largest]) + 1e-9)
            largest = a;
    }
    length = copysign(sqrt(length), along[largest]);
    for (int a = 0; a < 3; a++)
        along[a] = length != 0 ? along[a] / length : 0;
}
