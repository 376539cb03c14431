#include "inspect/distance_rows.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/path.h"
#include "surface/surface.h"
#include "surface/surface_region.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Regions, as they are asked for */

static int read_box(distance_region *r, num_unit unit, err *e)
{
    num_length corner[6];
    if (num_lengths_of(r->text, corner, 6) != 6)
        return err_usage(e, "--region %.100s=%.200s: expected X0,Y0,Z0,X1,Y1,Z1: a box, in --unit or with suffixes",
                         r->name, r->text);
    for (int i = 0; i < 6; i++)
        r->box[i] = num_length_in(corner[i], unit, num_unit_of("mm"));
    for (int a = 0; a < 3; a++)
        if (r->box[a] > r->box[a + 3])
            return err_usage(e,
                             "--region %.100s=%.200s: the box is empty: %g mm > %g mm; expected the low corner first",
                             r->name, r->text, r->box[a], r->box[a + 3]);
    return 0;
}

static int read_region(distance_regions *r, const char *asked, num_unit unit, err *e)
{
    const char *equals = strchr(asked, '=');
    const size_t size = equals ? (size_t)(equals - asked) : 0;
    distance_region *new = &r->list[r->count];
    if (!size || !equals[1])
        return err_usage(e, "--region '%.200s': expected NAME=REGION", asked);
    if (!(new->name = mem_array((int64_t)(4 * size + 1), 1, "regions", e)))
        return -1;
    chars_show(asked, size, new->name);
    new->text = equals + 1;
    r->count++;
    for (int i = 0; i + 1 < r->count; i++)
        if (!strcmp(r->list[i].name, new->name))
            return err_usage(e, "--region: two regions are named '%.200s'; expected different names", new->name);
    return surface_region_is_box(new->text) ? read_box(new, unit, e) : 0;
}

int distance_regions_of(distance_regions *r, const opt_list *asked, num_unit unit, err *e)
{
    r->mm = unit / 1000.;
    r->list = mem_array(asked->count, sizeof *r->list, "regions", e);
    if (!r->list)
        return -1;
    for (int i = 0; i < asked->count; i++)
        if (read_region(r, asked->value[i], unit, e))
            return -1;
    return 0;
}

void distance_regions_free(distance_regions *r)
{
    for (int i = 0; i < r->count; i++)
        free(r->list[i].name);
    free(r->list);
    *r = (distance_regions){.count = 0};
}

/* ---- Their figures */

typedef struct sample {
    double distance;
    int32_t vertex;
} sample;

/* What it takes to make rows of one surface. */
typedef struct maker {
    const distance_surface *s;
    const distance_field *f;
    double *weight;    /* vertices: three times each one's, mm2; 0 between rows */
    uint8_t *seen;     /* vertices: whether it has a sample; 0 between rows */
    sample *sample;    /* vertices of the region */
    int32_t *triangle; /* triangles of the region; of all groups, one after the other */
    uint8_t *inside;   /* vertices: whether in the region of space */
} maker;

static double area_of(const trimesh *m, int64_t triangle)
{
    const double *a = m->position + 3 * (int64_t)m->corner[3 * triangle],
                 *b = m->position + 3 * (int64_t)m->corner[3 * triangle + 1],
                 *c = m->position + 3 * (int64_t)m->corner[3 * triangle + 2];
    double n[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
    return .5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* Weighs the vertices of these triangles, and takes a sample of each. Returns how many. */
static int64_t take_samples(maker *k, const int32_t *triangle, int64_t count)
{
    const trimesh *m = &k->s->mesh;
    int64_t samples = 0;
    for (int64_t i = 0; i < count; i++) {
        const double area = area_of(m, triangle[i]);
        for (int c = 0; c < 3; c++) {
            const int32_t v = m->corner[3 * (int64_t)triangle[i] + c];
            k->weight[v] += area;
            if (!k->seen[v])
                k->sample[samples++] = (sample){k->f->distance[v], v};
            k->seen[v] = true;
        }
    }
    return samples;
}

static int compare_samples(const void *left, const void *right)
{
    const sample *a = left, *b = right;
    if (a->distance != b->distance)
        return a->distance < b->distance ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* The first of the samples, which are sorted, at which a part of the weight is reached. */
static double quantile(const maker *k, int64_t samples, double weight)
{
    double sum = 0, reached = NAN;
    for (int64_t i = 0; i < samples; i++)
        if (k->f->side[k->sample[i].vertex] != 0) {
            sum += k->weight[k->sample[i].vertex];
            reached = k->sample[i].distance;
            if (sum >= weight)
                break;
        }
    return reached;
}

static distance_row row_of(maker *k, const char *name, const int32_t *triangle, int64_t count)
{
    distance_row row = {.name = name};
    double weight = 0, sum = 0, squares = 0, sides = 0;
    const int64_t samples = take_samples(k, triangle, count);
    qsort(k->sample, (size_t)samples, sizeof *k->sample, compare_samples);
    row.furthest = k->sample[samples - 1].distance;
    row.largest = NAN;
    for (int64_t i = 0; i < samples; i++) {
        const int32_t v = k->sample[i].vertex;
        const double side = k->f->side[v], d = k->sample[i].distance, w = k->weight[v];
        row.border += side == 0;
        if (side == 0)
            continue;
        row.vertices++;
        row.largest = d;
        weight += w;
        sum += w * d;
        squares += w * d * d;
        sides += w * d * side;
    }
    row.mean = sum / weight;
    row.rms = sqrt(squares / weight);
    row.signed_mean = sides / weight;
    row.median = weight > 0 ? quantile(k, samples, .5 * weight) : NAN;
    row.most_of = weight > 0 ? quantile(k, samples, .95 * weight) : NAN;
    for (int64_t i = 0; i < samples; i++) {
        k->weight[k->sample[i].vertex] = 0;
        k->seen[k->sample[i].vertex] = false;
    }
    return row;
}

/* ---- The whole, and each group */

static int add_groups(distance_rows *rows, maker *k, err *e)
{
    const trimesh *m = &k->s->mesh;
    const int64_t groups = k->s->file.groups;
    int64_t used = 0, first = 0;
    /* Counted one place up, so that sums are where each group's triangles begin. */
    int64_t *end = mem_array(groups + 1, sizeof *end, "groups", e);
    rows->row = end ? mem_array(groups + 1, sizeof *rows->row, "groups", e) : NULL;
    if (!rows->row) {
        free(end);
        return -1;
    }
    for (int64_t t = 0; t < m->triangles; t++)
        end[m->group[t] + 1]++;
    for (int64_t g = 0; g < groups; g++)
        used += end[g + 1] > 0;
    for (int64_t g = 0; g < groups; g++)
        end[g + 1] += end[g];
    for (int64_t t = 0; t < m->triangles; t++)
        k->triangle[end[m->group[t]]++] = (int32_t)t;
    rows->row[rows->count++] = row_of(k, "all", k->triangle, m->triangles);
    for (int64_t g = 0; g < groups && used > 1; first = end[g++])
        if (end[g] > first)
            rows->row[rows->count++] = row_of(k, k->s->file.group[g], k->triangle + first, end[g] - first);
    free(end);
    return 0;
}

/* ---- Regions that are asked for */

static bool is_picked(const maker *k, const distance_region *r, bool by_place, int64_t triangle)
{
    const trimesh *m = &k->s->mesh;
    const int32_t *corner = m->corner + 3 * triangle;
    if (by_place)
        return k->inside[corner[0]] && k->inside[corner[1]] && k->inside[corner[2]];
    return surface_in_group(k->s->file.group[m->group[triangle]], r->text);
}

static int mark(maker *k, const distance_regions *all, const distance_region *r, pool *threads, err *e)
{
    const trimesh *m = &k->s->mesh;
    if (surface_region_is_box(r->text))
        surface_region_in_box(m->position, m->vertices, r->box, k->inside);
    else if (path_is_obj(r->text))
        return surface_region_in_file(r->text, all->mm * 1e-3, m->position, m->vertices, 1e-3, threads, k->inside, e);
    return 0;
}

static int no_triangle(const maker *k, const distance_region *r, err *e)
{
    const obj *o = &k->s->file;
    if (surface_region_is_box(r->text))
        return err_option(e, "--region",
                          "no triangle of %.100s lies in the box %.200s; expected X0,Y0,Z0,X1,Y1,Z1 around some, in "
                          "--unit or with suffixes",
                          o->name, r->text);
    if (path_is_obj(r->text))
        return err_option(e, "--region",
                          "no triangle of %.100s lies inside of %.200s; expected a closed surface around some, in its "
                          "place and unit",
                          o->name, r->text);
    for (int32_t g = 0; g < o->groups; g++)
        if (surface_in_group(o->group[g], r->text))
            return err_option(e, "--region", "group '%.200s' of %.100s has no polygon; expected one with some", r->text,
                              o->name);
    return distance_unknown_group(o, "--region", r->text, e);
}

static int add_regions(distance_rows *rows, maker *k, const distance_regions *all, pool *threads, err *e)
{
    rows->row = mem_array(all->count, sizeof *rows->row, "regions", e);
    if (!rows->row)
        return -1;
    for (int i = 0; i < all->count; i++) {
        const distance_region *r = &all->list[i];
        const bool by_place = surface_region_is_box(r->text) || path_is_obj(r->text);
        int64_t count = 0;
        if (mark(k, all, r, threads, e))
            return -1;
        for (int64_t t = 0; t < k->s->mesh.triangles; t++)
            if (is_picked(k, r, by_place, t))
                k->triangle[count++] = (int32_t)t;
        if (!count)
            return no_triangle(k, r, e);
        rows->row[rows->count++] = row_of(k, r->name, k->triangle, count);
    }
    return 0;
}

int distance_rows_of(distance_rows *rows, const distance_regions *r, const distance_surface *s, const distance_field *f,
                     pool *threads, err *e)
{
    static const char what[] = "regions";
    maker k = {.s = s, .f = f};
    int status = -1;
    if ((k.weight = mem_array(s->mesh.vertices, sizeof *k.weight, what, e)) &&
        (k.seen = mem_array(s->mesh.vertices, sizeof *k.seen, what, e)) &&
        (k.sample = mem_array(s->used_count, sizeof *k.sample, what, e)) &&
        (k.triangle = mem_array(s->mesh.triangles, sizeof *k.triangle, what, e)) &&
        (k.inside = mem_array(s->mesh.vertices, sizeof *k.inside, what, e)))
        status = r->count ? add_regions(rows, &k, r, threads, e) : add_groups(rows, &k, e);
    free(k.weight);
    free(k.seen);
    free(k.sample);
    free(k.triangle);
    free(k.inside);
    return status;
}

void distance_rows_free(distance_rows *rows)
{
    free(rows->row);
    *rows = (distance_rows){.count = 0};
}
