#include "bind/touch_skin.h"

#include "base/mem.h"
#include "base/near.h"
#include "surface/scale.h"
#include "surface/surface_region.h"
#include "surface/triangle.h"
#include "surface/triangulate.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char option[] = "--self-contact";

enum { AUTO_VOXELS = 8, NAMES_TOLD = 100, SAMPLES_MOST = INT32_MAX / 64, CUTS_MOST = 4096 };

typedef struct maker {
    touch_skin *k;
    const model *m;
    const side *sides;
    const touch_skin_options *o;
    pool *threads;
    int64_t taken[64]; /* options: the triangles that each has in its region */
    int64_t named[64]; /* and in all */
    int32_t *cut;
    int64_t cut_room;
    err *e;
} maker;

static bool is_auto(const char *text)
{
    return !strcmp(text, "auto");
}

/* Tells whether one of the names between commas is the name of the surface, or one of the names of the group. */
static bool is_named(const char *text, const char *whole, const char *group)
{
    char name[MODEL_NAME];
    while (surface_region_name(&text, name, sizeof name) > 0)
        if (!strcasecmp(whole, name) || surface_in_group(group, name))
            return true;
    return false;
}

/* ---- names that are wrong */

static int unknown_name(const maker *k, const char *name)
{
    const char *list[NAMES_TOLD];
    char told[NAMES_TOLD][MODEL_NAME], at_name[MODEL_NAME];
    int count = 0;
    surface s;
    for (int at = 0; model_surface(k->m, &at, at_name, sizeof at_name);) {
        if (surface_of(k->m, at_name, &s, k->e))
            return -1;
        for (int64_t g = -1; g < s.groups && count < NAMES_TOLD; g++) {
            snprintf(told[count], sizeof told[count], "%s", g < 0 ? at_name : s.group_name[g]);
            list[count] = told[count];
            count++;
        }
    }
    return near_option(k->e, option, "surface", name, list, count);
}

static int check_name(const maker *k, const char *name, bool *found)
{
    char at_name[MODEL_NAME];
    surface s;
    *found = false;
    for (int at = 0; !*found && model_surface(k->m, &at, at_name, sizeof at_name);) {
        if (surface_of(k->m, at_name, &s, k->e))
            return -1;
        for (int64_t f = 0; f < s.faces && !*found; f++)
            *found = surface_end(&s, f) - s.start[f] >= 3 && is_named(name, at_name, s.group_name[s.group[f]]);
    }
    return 0;
}

static bool is_rigid(const maker *k, const char *name)
{
    const model_array *anchor = model_find(k->m, "anchor.name");
    for (int64_t i = 0; anchor && i < anchor->rows; i++)
        if (surface_in_group(anchor->str[i], name))
            return true;
    return false;
}

static int check_option(const maker *k, const char *text)
{
    const char *colon = strchr(text, ':');
    char name[MODEL_NAME];
    bool found;
    int left;
    if (is_auto(text))
        return k->sides->beside ? 0
                                : err_option(k->e, option,
                                             "auto takes the skin about slits, and the model has none; expected "
                                             "SURFACE,...[:REGION], or a model of voxelise --slits");
    if (!*text || colon == text || (colon && !colon[1]))
        return err_usage(k->e, "%s '%.200s': expected SURFACE,...[:REGION], such as skin:lips.obj, or auto", option,
                         text);
    for (const char *p = text; (left = surface_region_name(&p, name, sizeof name)) > 0;) {
        if (check_name(k, name, &found))
            return -1;
        if (!found)
            return unknown_name(k, name);
        if (is_rigid(k, name))
            return err_set(k->e, NULL, 0,
                           "%s '%.200s': surface %s is rigid; expected surfaces of tissue (attach --slide is for "
                           "tissue on bone)",
                           option, text, name);
    }
    return left ? err_usage(k->e, "%s '%.200s': expected names of surfaces between commas", option, text) : 0;
}

/* ---- triangles */

static bool is_of(const maker *k, int which, const surface *s, int64_t face)
{
    const char *text = k->o->regions->value[which], *group = s->group_name[s->group[face]];
    char name[MODEL_NAME];
    if (!is_auto(text))
        return is_named(text, s->name, group);
    const char *of = model_meta_of(k->m, "slits.surface"), *groups = model_meta_of(k->m, "slits.groups");
    if (strcmp(of, s->name) != 0)
        return false;
    for (const char *p = groups; *p; p += strspn(p, " ")) {
        const size_t n = strcspn(p, " ");
        snprintf(name, sizeof name, "%.*s", (int)n, p);
        if (surface_in_group(group, name) && !is_rigid(k, name))
            return true;
        p += n;
    }
    return false;
}

/* Spreads marks of cells by AUTO_VOXELS along one axis, whose cells are `step` apart. */
static void spread(uint8_t *mark, int64_t cells, int64_t step, int64_t size)
{
    for (int64_t c = 0; c < cells; c++)
        if (mark[c] == 1) /* 2: spread to, of this axis */
            for (int64_t i = -AUTO_VOXELS; i <= AUTO_VOXELS; i++) {
                const int64_t along = c / step % size + i;
                if (along >= 0 && along < size && !mark[c + i * step])
                    mark[c + i * step] = 2;
            }
    for (int64_t c = 0; c < cells; c++)
        mark[c] = mark[c] != 0;
}

/* The vertices that are within AUTO_VOXELS voxels, along each axis, of one that a slit is beside. */
static int mark_near_slits(const maker *k, const surface *s, uint8_t *inside)
{
    const lattice_map *map = &k->sides->to->map;
    const int64_t cells = (int64_t)map->size[0] * map->size[1] * map->size[2];
    uint8_t *mark = mem_array(cells, 1, "the voxels", k->e);
    if (!mark)
        return -1;
    for (int64_t c = 0; c < cells; c++)
        for (int32_t i = map->element[c]; i >= 0; i = lattice_next(map, i))
            mark[c] |= k->sides->beside[i];
    for (int64_t a = 0, step = 1; a < 3; step *= map->size[a++])
        spread(mark, cells, step, map->size[a]);
    for (int64_t v = 0; v < s->vertices; v++) {
        double local[3];
        int64_t c = 0;
        lattice_local(&k->sides->to->grid, s->position + 3 * v, local);
        for (int a = 2; a >= 0; a--)
            c = c * map->size[a] + (int64_t)fmin(fmax(floor(local[a]) - map->low[a], 0), map->size[a] - 1);
        inside[v] = mark[c];
    }
    free(mark);
    return 0;
}

static int mark_region(const maker *k, int which, const surface *s, uint8_t *inside)
{
    const char *text = k->o->regions->value[which], *colon = strchr(text, ':');
    const num_unit unit = colon ? scale_unit(NULL, k->m, k->e) : num_unit_of("m");
    if (!unit)
        return -1;
    if (is_auto(text))
        return mark_near_slits(k, s, inside);
    return surface_region_of_option(option, colon ? colon + 1 : NULL, unit, s->position, s->vertices, k->threads,
                                    inside, k->e);
}

static int add_triangle(maker *k, const int32_t corner[3], int64_t base, bool is_sampled)
{
    touch_skin *to = k->k;
    const int64_t t = to->triangles;
    if (t >= INT32_MAX / 8)
        return err_set(k->e, NULL, 0, "%s: more than %d triangles", option, INT32_MAX / 8);
    if (mem_grow(&to->corner, &to->corner_room, 3 * (t + 1), sizeof *to->corner, "the triangles", k->e) ||
        mem_grow(&to->is_sampled, &to->sampled_room, t + 1, sizeof *to->is_sampled, "the triangles", k->e))
        return -1;
    for (int i = 0; i < 3; i++)
        to->corner[3 * t + i] = (int32_t)(base + corner[i]);
    to->is_sampled[to->triangles++] = is_sampled;
    return 0;
}

/* The triangles of a face that some option names. inside: options x vertices. */
static int add_face(maker *k, const surface *s, int64_t face, const uint8_t *inside, int64_t base)
{
    const int32_t *vertex = s->vertex + s->start[face];
    const int64_t corners = surface_end(s, face) - s->start[face], count = corners - 2;
    bool is[64], any = false;
    for (int i = 0; i < k->o->regions->count; i++)
        any |= is[i] = count > 0 && is_of(k, i, s, face);
    if (!any)
        return 0;
    if (MEM_ROOM(&k->cut, &k->cut_room, 3 * count, "the triangles", k->e) ||
        triangulate(s->position, vertex, corners, k->cut, k->e))
        return -1;
    for (int64_t t = 0; t < count; t++) {
        const int32_t corner[3] = {vertex[k->cut[3 * t]], vertex[k->cut[3 * t + 1]], vertex[k->cut[3 * t + 2]]};
        bool is_sampled = false;
        for (int i = 0; i < k->o->regions->count; i++) {
            const uint8_t *region = inside + i * s->vertices;
            const bool mine = is[i] && region[corner[0]] && region[corner[1]] && region[corner[2]];
            k->named[i] += is[i];
            k->taken[i] += mine;
            is_sampled |= mine;
        }
        if (add_triangle(k, corner, base, is_sampled))
            return -1;
    }
    return 0;
}

static int add_vertices(maker *k, const surface *s)
{
    touch_skin *to = k->k;
    const int64_t base = to->vertices, count = 3 * (base + s->vertices);
    if (count > INT32_MAX)
        return err_set(k->e, NULL, 0, "%s: more than %d vertices", option, INT32_MAX / 3);
    double *normal = k->sides->beside ? side_normals(k->sides, s, k->m, k->e) : NULL;
    if ((k->sides->beside && !normal) ||
        mem_grow(&to->position, &to->position_room, count, sizeof *to->position, "the vertices", k->e) ||
        mem_grow(&to->inward, &to->inward_room, count, sizeof *to->inward, "the vertices", k->e)) {
        free(normal);
        return -1;
    }
    memcpy(to->position + 3 * base, s->position, 3 * (size_t)s->vertices * sizeof *s->position);
    for (int64_t i = 0; i < 3 * s->vertices; i++)
        to->inward[3 * base + i] = normal ? normal[i] : 0;
    to->vertices += s->vertices;
    free(normal);
    return 0;
}

static int add_surface(maker *k, const char *name)
{
    surface s;
    if (surface_of(k->m, name, &s, k->e))
        return -1;
    const int64_t base = k->k->vertices;
    uint8_t *inside = mem_array(s.vertices, (size_t)k->o->regions->count, "the vertices", k->e);
    int failed = !inside;
    for (int i = 0; i < k->o->regions->count && !failed; i++)
        failed = mark_region(k, i, &s, inside + i * s.vertices);
    for (int64_t f = 0; f < s.faces && !failed; f++)
        failed = add_face(k, &s, f, inside, base);
    failed = failed || add_vertices(k, &s);
    free(inside);
    return failed ? -1 : 0;
}

static int check_regions(const maker *k)
{
    for (int i = 0; i < k->o->regions->count; i++)
        if (!k->taken[i])
            return err_set(k->e, NULL, 0,
                           "%s '%.200s': the region has none of the %" PRId64
                           " triangles; expected one around some, in the model's place and unit",
                           option, k->o->regions->value[i], k->named[i]);
    return 0;
}

/* ---- samples */

/* A point of so many corners with these weights. */
static int add_sample(maker *k, const int32_t *corner, const double *weight, int corners)
{
    touch_skin *to = k->k;
    const int64_t n = to->samples;
    if (n >= SAMPLES_MOST)
        return err_set(k->e, NULL, 0,
                       "%s: more than %d samples; expected a smaller region or a larger --contact-spacing", option,
                       SAMPLES_MOST);
    if (mem_grow(&to->sample, &to->sample_room, 3 * (n + 1), sizeof *to->sample, "the samples", k->e) ||
        mem_grow(&to->behind, &to->behind_room, 3 * (n + 1), sizeof *to->behind, "the samples", k->e))
        return -1;
    for (int a = 0; a < 3; a++) {
        to->sample[3 * n + a] = to->behind[3 * n + a] = 0;
        for (int i = 0; i < corners; i++) {
            to->sample[3 * n + a] += weight[i] * to->position[3 * (int64_t)corner[i] + a];
            to->behind[3 * n + a] += to->inward[3 * (int64_t)corner[i] + a];
        }
    }
    to->samples++;
    return 0;
}

static int64_t cuts_of(const maker *k, double length)
{
    return (int64_t)fmin(ceil(length / k->o->apart * (1 - 1e-9)), CUTS_MOST);
}

static const double *at(const maker *k, int32_t vertex)
{
    return k->k->position + 3 * (int64_t)vertex;
}

static int sample_edge(maker *k, const int32_t *edge)
{
    const int64_t n = cuts_of(k, triangle_distance(at(k, edge[0]), at(k, edge[1])));
    for (int64_t i = 1; i < n; i++) {
        const double t = (double)i / (double)n, weight[2] = {1 - t, t};
        if (add_sample(k, edge, weight, 2))
            return -1;
    }
    return 0;
}

static int sample_triangle(maker *k, const int32_t *c)
{
    double longest = 0;
    for (int i = 0; i < 3; i++)
        longest = fmax(longest, triangle_distance(at(k, c[i]), at(k, c[(i + 1) % 3])));
    const int64_t n = cuts_of(k, longest);
    for (int64_t i = 1; i < n; i++)
        for (int64_t j = 1; i + j < n; j++) {
            const double weight[3] = {(double)i / (double)n, (double)j / (double)n, (double)(n - i - j) / (double)n};
            if (add_sample(k, c, weight, 3))
                return -1;
        }
    return 0;
}

static int by_edge(const void *a, const void *b)
{
    const int32_t *p = a, *q = b;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Each edge of the sampled triangles once. Returns how many; -1 with e filled. */
static int64_t find_edges(maker *k, int32_t **edges)
{
    const touch_skin *of = k->k;
    int64_t count = 0, kept = 0;
    int32_t *edge = *edges = mem_array(of->triangles, 6 * sizeof *edge, "the edges", k->e);
    if (!edge)
        return -1;
    for (int64_t t = 0; t < of->triangles; t++)
        for (int i = 0; i < 3 && of->is_sampled[t]; i++) {
            const int32_t p = of->corner[3 * t + i], q = of->corner[3 * t + (i + 1) % 3];
            edge[2 * count] = p < q ? p : q;
            edge[2 * count++ + 1] = p < q ? q : p;
        }
    qsort(edge, (size_t)count, 2 * sizeof *edge, by_edge);
    for (int64_t i = 0; i < count; i++)
        if (!i || by_edge(edge + 2 * i, edge + 2 * (kept - 1)) != 0) {
            edge[2 * kept] = edge[2 * i];
            edge[2 * kept++ + 1] = edge[2 * i + 1];
        }
    return kept;
}

static int sample_vertices(maker *k)
{
    const touch_skin *of = k->k;
    bool *is = mem_array(of->vertices, sizeof *is, "the vertices", k->e);
    int failed = !is;
    for (int64_t t = 0; t < of->triangles && !failed; t++)
        for (int i = 0; i < 3 && of->is_sampled[t]; i++)
            is[of->corner[3 * t + i]] = true;
    for (int32_t v = 0; v < of->vertices && !failed; v++)
        if (is[v])
            failed = add_sample(k, &v, (double[1]){1}, 1);
    free(is);
    return failed ? -1 : 0;
}

static int sample(maker *k)
{
    int32_t *edge = NULL;
    const int64_t edges = sample_vertices(k) ? -1 : find_edges(k, &edge);
    int failed = edges < 0;
    for (int64_t i = 0; i < edges && !failed; i++)
        failed = sample_edge(k, edge + 2 * i);
    for (int64_t t = 0; t < k->k->triangles && !failed; t++)
        if (k->k->is_sampled[t])
            failed = sample_triangle(k, k->k->corner + 3 * t);
    free(edge);
    return failed ? -1 : 0;
}

/* ---- all */

int touch_skin_make(touch_skin *to, const model *m, const side *sides, const touch_skin_options *o, pool *threads,
                    err *e)
{
    maker k = {.k = to, .m = m, .sides = sides, .o = o, .threads = threads, .e = e};
    char name[MODEL_NAME];
    int failed = 0;
    for (int i = 0; i < o->regions->count && !failed; i++)
        failed = check_option(&k, o->regions->value[i]);
    for (int i = 0; !failed && model_surface(m, &i, name, sizeof name);)
        failed = add_surface(&k, name);
    failed = failed || check_regions(&k) || sample(&k);
    free(k.cut);
    return failed ? -1 : 0;
}

void touch_skin_free(touch_skin *k)
{
    free(k->position);
    free(k->inward);
    free(k->corner);
    free(k->is_sampled);
    free(k->sample);
    free(k->behind);
    *k = (touch_skin){.vertices = 0};
}
