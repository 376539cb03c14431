#include "voxelise/layers.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "mesh/closest.h"
#include "mesh/triangulate.h"
#include "model/materials.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- the file */

enum { KEY_THICKNESS, KEY_MATERIAL, KEYS };

enum { MOST = 100 }; /* layers: a byte a voxel tells them */

static const char *const key_name[KEYS] = {"thickness", "material"};

/* What is read on the way. */
typedef struct reader {
    keyfile k;
    layers *l;
    num_unit unit;
    const volumes *plan;
    const model *materials;
} reader;

static int check_name(const reader *r, const char *name, err *e)
{
    if (strchr(name, '='))
        return keyfile_error(
            &r->k, e, "'%s' where a layer's name should be; expected NAME thickness=LENGTH material=MATERIAL", name);
    for (int32_t v = 0; v < r->plan->volumes; v++)
        if (strcasecmp(name, r->plan->volume[v].name) == 0)
            return keyfile_error(&r->k, e, "'%s' is a volume; expected another name", name);
    for (int64_t i = 0; i < r->l->layers; i++)
        if (strcasecmp(name, r->l->layer[i].name) == 0)
            return keyfile_error(&r->k, e, "layer '%s' is given twice; expected another name", name);
    return 0;
}

static int take_thickness(const reader *r, const char *value, double *to, err *e)
{
    num_length length;
    if (num_length_of(value, &length) || !(length.value > 0))
        return keyfile_error(&r->k, e, "thickness=%s; expected a length above 0, as 2mm", value);
    *to = num_length_in(length, r->unit, r->unit);
    return 0;
}

static int take_material(const reader *r, const char *value, int32_t *to, err *e)
{
    *to = materials_find(r->materials, value);
    return *to < 0 ? materials_unknown(r->materials, value, r->k.name, r->k.line, e) : 0;
}

static int take_line(reader *r, err *e)
{
    layers *l = r->l;
    const char *name = r->k.word[0];
    layers_layer one = {.material = materials_find(r->materials, name)};
    double thickness = 0;
    uint64_t seen = 0;
    if (check_name(r, name, e))
        return -1;
    for (int i = 1; i < r->k.count; i++) {
        char *value;
        int key = keyfile_pair(&r->k, i, key_name, KEYS, &seen, &value, e);
        if (key < 0 || (key == KEY_THICKNESS ? take_thickness(r, value, &thickness, e)
                                             : take_material(r, value, &one.material, e)))
            return -1;
    }
    if (!(seen & 1u << KEY_THICKNESS))
        return keyfile_error(&r->k, e, "layer '%s' has no thickness; expected thickness=LENGTH", name);
    one.material = one.material < 0 ? 0 : one.material;
    one.depth = thickness + (l->layers ? l->layer[l->layers - 1].depth : 0);
    if (l->layers == MOST)
        return keyfile_error(&r->k, e, "too many layers; at most %d are possible", MOST);
    if (mem_grow(&l->layer, &l->capacity, l->layers + 1, sizeof *l->layer, "layers", e))
        return -1;
    one.name = mem_text(name, e);
    if (!one.name)
        return -1;
    l->layer[l->layers++] = one;
    return 0;
}

int layers_read(layers *l, in *file, num_unit unit, const volumes *plan, const model *materials, err *e)
{
    *l = (layers){0};
    reader r = {.l = l, .unit = unit, .plan = plan, .materials = materials};
    int got;
    keyfile_open(&r.k, file);
    while ((got = keyfile_next(&r.k, e)) > 0)
        if (take_line(&r, e))
            return -1;
    if (got == 0 && l->layers == 0)
        return err_set(e, in_name(file), 0, "no layers; expected lines of NAME thickness=LENGTH material=MATERIAL");
    return got;
}

void layers_free(layers *l)
{
    for (int64_t i = 0; i < l->layers; i++)
        free(l->layer[i].name);
    free(l->layer);
    *l = (layers){0};
}

/* ---- the surface */

/* Triangles in the grid's unit, from the corner of its cell 0. */
typedef struct skin {
    double *corner; /* triangles x 9 */
    int64_t triangles, capacity;
    int32_t *cut;
    int64_t cut_capacity;
} skin;

static int32_t lowest_volumes(const volumes *plan)
{
    int32_t count = 0;
    while (count < plan->volumes && plan->volume[count].level == 0)
        count++;
    return count;
}

/* Whether a group's polygons bound level 0 by a surface that is not rigid. */
static bool is_skin(const volumes *plan, int32_t group)
{
    for (int64_t m = plan->group_start[group]; m < plan->group_start[group + 1]; m++)
        if (plan->volume[plan->member[m].volume].level == 0 &&
            !volumes_is_rigid(plan->surface[plan->member[m].surface].name))
            return true;
    return false;
}

static int add_polygon(skin *s, const obj *o, const grid *g, int64_t face, err *e)
{
    const int32_t *corner = &o->corner_vertex[o->face_start[face]];
    int64_t count = o->face_start[face + 1] - o->face_start[face] - 2;
    if (mem_grow(&s->cut, &s->cut_capacity, 3 * count, sizeof *s->cut, "triangles", e) ||
        mem_grow(&s->corner, &s->capacity, 9 * (s->triangles + count), sizeof *s->corner, "triangles", e) ||
        triangulate(o->position, corner, count + 2, s->cut, e))
        return -1;
    double *to = &s->corner[9 * s->triangles];
    for (int64_t c = 0; c < 3 * count; c++)
        for (int a = 0; a < 3; a++)
            to[3 * c + a] = grid_local(g, a, o->position[3 * (int64_t)corner[s->cut[c]] + a]);
    s->triangles += count;
    return 0;
}

static int make_skin(skin *s, const volumes *plan, const obj *o, const grid *g, err *e)
{
    for (int64_t f = 0; f < o->faces; f++)
        if (o->face_start[f + 1] - o->face_start[f] >= 3 && is_skin(plan, o->face_group[f]) &&
            add_polygon(s, o, g, f, e))
            return -1;
    return 0;
}

static void free_skin(skin *s)
{
    free(s->corner);
    free(s->cut);
}

/* ---- depths, some layers of cells at a time */

typedef struct work {
    const layers *l;
    const voxels *x;
    const grid *g;
    const skin *s;
    int32_t lowest; /* volumes of level 0 */
    uint8_t *layer; /* elements: a layer + 1, 0 = none */
    int64_t *start; /* layers of cells + 1, from the lowest: the first run of each */
    int64_t *voxel; /* and the first element */
    int64_t low;    /* the lowest */
    atomic_bool failed;
} work;

/* The cells that a slab's voxels are in, and the squared distance of the centre of each from the surface. */
typedef struct depths {
    int64_t low[3], high[3];
    double *squared;
} depths;

static double *depth_at(const depths *d, int64_t i, int64_t j, int64_t k)
{
    return &d->squared[((k - d->low[2]) * (d->high[1] - d->low[1]) + j - d->low[1]) * (d->high[0] - d->low[0]) + i -
                       d->low[0]];
}

/* Cells that a triangle, made larger by the layers, may reach; false where none is in the slab. */
static bool find_reach(const work *w, const depths *d, const double *corner, int64_t *low, int64_t *high)
{
    double most = w->l->layer[w->l->layers - 1].depth;
    for (int a = 0; a < 3; a++) {
        double h = w->g->spacing[a];
        double from = fmin(corner[a], fmin(corner[3 + a], corner[6 + a])) - most;
        double to = fmax(corner[a], fmax(corner[3 + a], corner[6 + a])) + most;
        from = floor(from / h - 0.5), to = ceil(to / h - 0.5) + 1;
        low[a] = from > (double)d->low[a] ? from < (double)d->high[a] ? (int64_t)from : d->high[a] : d->low[a];
        high[a] = to < (double)d->high[a] ? to > (double)d->low[a] ? (int64_t)to : d->low[a] : d->high[a];
        if (low[a] >= high[a])
            return false;
    }
    return true;
}

/* A centre that is further from the middle of the triangle than its corners are and than what is known already is not
 * looked at; the factor is for rounding. */
static void measure(const work *w, depths *d, const double *corner)
{
    int64_t low[3], high[3];
    double middle[3], radius = 0, q[3], p[3];
    if (!find_reach(w, d, corner, low, high))
        return;
    for (int a = 0; a < 3; a++)
        middle[a] = (corner[a] + corner[3 + a] + corner[6 + a]) / 3;
    for (int i = 0; i < 3; i++)
        radius = fmax(radius, hypot(hypot(corner[3 * i] - middle[0], corner[3 * i + 1] - middle[1]),
                                    corner[3 * i + 2] - middle[2]));
    for (int64_t k = low[2]; k < high[2]; k++)
        for (int64_t j = low[1]; j < high[1]; j++)
            for (int64_t i = low[0]; i < high[0]; i++) {
                double *best = depth_at(d, i, j, k);
                q[0] = grid_centre(w->g, 0, i), q[1] = grid_centre(w->g, 1, j), q[2] = grid_centre(w->g, 2, k);
                double x = q[0] - middle[0], y = q[1] - middle[1], z = q[2] - middle[2];
                double far = (sqrt(*best) + radius) * (1 + 1e-9);
                if (x * x + y * y + z * z < far * far)
                    *best = fmin(*best, closest_triangle(corner, corner + 3, corner + 6, q, p));
            }
}

static uint8_t layer_of(const layers *l, double squared)
{
    double depth = sqrt(squared);
    for (int64_t i = 0; i < l->layers; i++)
        if (depth < l->layer[i].depth)
            return (uint8_t)(i + 1);
    return 0;
}

/* The box of the runs of level 0 between two; false where there is none. */
static bool find_box(const work *w, int64_t first, int64_t past, depths *d)
{
    for (int a = 0; a < 3; a++)
        d->low[a] = INT64_MAX, d->high[a] = INT64_MIN;
    for (int64_t r = first; r < past; r++) {
        const climb_run *a = &w->x->run[r];
        const int64_t low[3] = {a->from, a->j, a->k}, high[3] = {a->to, (int64_t)a->j + 1, (int64_t)a->k + 1};
        for (int i = 0; a->volume < w->lowest && i < 3; i++) {
            d->low[i] = low[i] < d->low[i] ? low[i] : d->low[i];
            d->high[i] = high[i] > d->high[i] ? high[i] : d->high[i];
        }
    }
    return d->low[0] < d->high[0];
}

/* One layer of cells, or some. */
static void do_layers(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    err e = {0};
    depths d;
    if (!find_box(w, w->start[from], w->start[to], &d))
        return;
    int64_t cells = (d.high[0] - d.low[0]) * (d.high[1] - d.low[1]) * (d.high[2] - d.low[2]);
    double most = w->l->layer[w->l->layers - 1].depth;
    d.squared = mem_array(cells, sizeof *d.squared, "depths", &e);
    if (!d.squared) {
        atomic_store(&w->failed, true);
        return;
    }
    for (int64_t c = 0; c < cells; c++)
        d.squared[c] = most * most;
    for (int64_t t = 0; t < w->s->triangles; t++)
        measure(w, &d, &w->s->corner[9 * t]);
    int64_t voxel = w->voxel[from];
    for (int64_t r = w->start[from]; r < w->start[to]; r++) {
        const climb_run *a = &w->x->run[r];
        for (int64_t i = a->from; i < a->to; i++, voxel++)
            if (a->volume < w->lowest)
                w->layer[voxel] = layer_of(w->l, *depth_at(&d, i, a->j, a->k));
    }
    free(d.squared);
}

/* ---- voxels and volumes */

/* Where each layer of cells begins. */
static int find_starts(work *w, int64_t *count, err *e)
{
    const voxels *x = w->x;
    w->low = x->runs ? x->run[0].k : 0;
    *count = x->runs ? x->run[x->runs - 1].k - w->low + 1 : 0;
    w->start = mem_array(*count + 1, sizeof *w->start, "layers of cells", e);
    w->voxel = mem_array(*count + 1, sizeof *w->voxel, "layers of cells", e);
    if (!w->start || !w->voxel)
        return -1;
    for (int64_t r = 0, at = 0, voxel = 0; r <= x->runs; r++) {
        for (; at <= *count && (r == x->runs || at <= x->run[r].k - w->low); at++)
            w->start[at] = r, w->voxel[at] = voxel;
        if (r < x->runs)
            voxel += x->run[r].to - x->run[r].from;
    }
    return 0;
}

/* Volumes from the first that is not of level 0 on make room for the layers. */
static int32_t moved(const work *w, int32_t volume)
{
    return volume < w->lowest ? volume : volume + (int32_t)w->l->layers;
}

/* The runs again, cut where layers change. */
static int cut_runs(const work *w, voxels *x, err *e)
{
    climb_runs to = {0};
    int64_t voxel = 0;
    for (int64_t r = 0; r < x->runs; r++) {
        climb_run a = x->run[r];
        for (int32_t from = a.from, end; from < a.to; from = end) {
            int layer = w->layer[voxel];
            for (end = from; end < a.to && w->layer[voxel] == layer; end++)
                voxel++;
            climb_run part = {from, end, a.j, a.k, layer ? w->lowest + layer - 1 : moved(w, a.volume)};
            if (climb_add_run(&to, part, e)) {
                free(to.run);
                return -1;
            }
        }
    }
    free(x->run);
    x->run = to.run;
    x->runs = to.runs;
    return 0;
}

static int move_counts(const work *w, voxels *x, int32_t all, err *e)
{
    climb_count *count = mem_array(all + w->l->layers, sizeof *count, "volumes", e);
    if (!count)
        return -1;
    for (int32_t v = 0; v < all; v++) {
        count[moved(w, v)] = x->count[v];
        count[moved(w, v)].kept = 0;
    }
    for (int64_t r = 0; r < x->runs; r++)
        count[x->run[r].volume].kept += x->run[r].to - x->run[r].from;
    for (int64_t i = w->lowest; i < w->lowest + w->l->layers; i++)
        count[i].inside = count[i].reached = count[i].kept;
    free(x->count);
    x->count = count;
    return 0;
}

static int add_volumes(const work *w, volumes *plan, err *e)
{
    int64_t capacity = plan->volumes, layers_more = w->l->layers;
    int32_t priority = plan->volume[w->lowest - 1].priority;
    if (mem_grow(&plan->volume, &capacity, plan->volumes + layers_more, sizeof *plan->volume, "volumes", e))
        return -1;
    memmove(&plan->volume[w->lowest + layers_more], &plan->volume[w->lowest],
            (size_t)(plan->volumes - w->lowest) * sizeof *plan->volume);
    memset(&plan->volume[w->lowest], 0, (size_t)layers_more * sizeof *plan->volume);
    for (int64_t m = 0; m < plan->members; m++)
        plan->member[m].volume = moved(w, plan->member[m].volume);
    plan->volumes += (int32_t)layers_more;
    for (int64_t i = 0; i < layers_more; i++) {
        volumes_volume *v = &plan->volume[w->lowest + i];
        v->priority = ++priority;
        v->material = w->l->layer[i].material;
        v->name = mem_text(w->l->layer[i].name, e);
        v->surfaces = v->name ? mem_text("(a layer)", e) : NULL;
        if (!v->surfaces)
            return -1;
    }
    return 0;
}

int layers_apply(const layers *l, voxels *x, volumes *plan, const obj *o, const grid *g, pool *threads, err *e)
{
    skin s = {0};
    work w = {.l = l, .x = x, .g = g, .s = &s, .lowest = lowest_volumes(plan)};
    int64_t count = 0;
    int status = -1;
    w.layer = mem_array(x->elements, sizeof *w.layer, "layers", e);
    if (!w.layer || make_skin(&s, plan, o, g, e) || find_starts(&w, &count, e))
        goto out;
    pool_run(threads, count, 4, do_layers, &w);
    if (atomic_load(&w.failed)) {
        err_memory(e, "depths");
        goto out;
    }
    if (cut_runs(&w, x, e) || move_counts(&w, x, plan->volumes, e) || add_volumes(&w, plan, e))
        goto out;
    status = 0;
out:
    free_skin(&s);
    free(w.layer);
    free(w.start);
    free(w.voxel);
    return status;
}
