#include "voxelise/build.h"

#include "base/mem.h"
#include "mesh/cut_moments.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 64, CHUNK = 4 /* layers */ };

/* The rectangle of corners that elements have in any layer. */
typedef struct rectangle {
    int64_t low[2], size[2]; /* along i and j */
    int64_t words;           /* of a row along i */
} rectangle;

typedef struct work {
    const voxels *x;
    const slits *slit;
    const voxels_layers *layer;
    const lattice *l;
    rectangle of;
    int64_t *first;   /* layers of corners + 1: the first node of each */
    double *position; /* the model's arrays */
    int32_t *place, *node, *element_place, *volume;
    atomic_bool failed;
} work;

/* One layer of corners: which of them elements have, and for each word of a row the nodes before it in the layer. So
 * the nodes of a run, whose corners follow one another, are known from its first. */
typedef struct corners {
    uint64_t *bits;
    int32_t *before;
    int64_t count;
} corners;

static rectangle find_rectangle(const voxels *x)
{
    rectangle r = {{INT32_MAX, INT32_MAX}, {0, 0}, 0};
    int64_t high[2] = {INT32_MIN, INT32_MIN};
    for (int64_t n = 0; n < x->runs; n++) {
        const climb_run *a = &x->run[n];
        r.low[0] = a->from < r.low[0] ? a->from : r.low[0];
        r.low[1] = a->j < r.low[1] ? a->j : r.low[1];
        high[0] = a->to > high[0] ? a->to : high[0];
        high[1] = a->j + 1 > high[1] ? a->j + 1 : high[1];
    }
    for (int a = 0; x->runs && a < 2; a++)
        r.size[a] = high[a] - r.low[a] + 1;
    r.words = pool_chunks(r.size[0], WORD);
    return r;
}

/* Sets bits from <= i <= to of a row. */
static void set_bits(uint64_t *row, int64_t from, int64_t to)
{
    int64_t first = from / WORD, last = to / WORD;
    uint64_t begin = ~(uint64_t)0 << (from % WORD), end = ~(uint64_t)0 >> (WORD - 1 - to % WORD);
    if (first == last) {
        row[first] |= begin & end;
        return;
    }
    row[first] |= begin;
    for (int64_t w = first + 1; w < last; w++)
        row[w] = ~(uint64_t)0;
    row[last] |= end;
}

static void mark_cells(const work *w, corners *c, int64_t layer)
{
    if (layer < 0 || layer >= w->layer->count)
        return;
    for (int64_t n = w->layer->run[layer]; n < w->layer->run[layer + 1]; n++) {
        const climb_run *a = &w->x->run[n];
        for (int j = 0; j < 2; j++)
            set_bits(c->bits + (a->j + j - w->of.low[1]) * w->of.words, a->from - w->of.low[0], a->to - w->of.low[0]);
    }
}

/* The corners below a layer of cells: its own, and those of the layer under it. */
static void find_corners(const work *w, corners *c, int64_t layer)
{
    int64_t words = w->of.words * w->of.size[1];
    memset(c->bits, 0, (size_t)words * sizeof *c->bits);
    mark_cells(w, c, layer - 1);
    mark_cells(w, c, layer);
    c->count = 0;
    for (int64_t i = 0; i < words; i++) {
        c->before[i] = (int32_t)c->count;
        c->count += __builtin_popcountll(c->bits[i]);
    }
}

static bool make_corners(corners *c, const work *w)
{
    err ignored = {0};
    int64_t words = w->of.words * w->of.size[1];
    c->bits = mem_array(words, sizeof *c->bits, "a layer of nodes", &ignored);
    c->before = mem_array(words, sizeof *c->before, "a layer of nodes", &ignored);
    return c->bits && c->before;
}

static void free_corners(corners *c)
{
    free(c->bits);
    free(c->before);
}

/* ---- nodes are counted layer by layer */

static void count_layers(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    corners c = {0};
    if (!make_corners(&c, w))
        atomic_store(&w->failed, true);
    for (int64_t layer = from; layer < to && !atomic_load(&w->failed); layer++) {
        find_corners(w, &c, layer);
        w->first[layer + 1] = c.count;
    }
    free_corners(&c);
}

static int count_nodes(work *w, pool *threads, err *e)
{
    int64_t layers = w->layer->count + 1;
    pool_run(threads, layers, CHUNK, count_layers, w);
    if (atomic_load(&w->failed))
        return err_memory(e, "a layer of nodes");
    for (int64_t i = 0; i < w->slit->points; i++)
        w->first[w->slit->point[i].place[2] - w->layer->low + 1] += w->slit->point[i].nodes - 1;
    for (int64_t i = 0; i < layers; i++)
        w->first[i + 1] += w->first[i];
    if (w->first[layers] <= INT32_MAX)
        return 0;
    return err_set(e, NULL, 0, "%lld nodes; at most %d can be numbered: use larger voxels, or a --box",
                   (long long)w->first[layers], INT32_MAX);
}

/* ---- then nodes and elements are written, some layers at a time */

static void put_nodes(const work *w, const corners *c, int64_t layer)
{
    int64_t node = w->first[layer];
    for (int64_t j = 0; j < w->of.size[1]; j++)
        for (int64_t i = 0; i < w->of.words; i++)
            for (uint64_t bits = c->bits[j * w->of.words + i]; bits; bits &= bits - 1, node++) {
                int32_t *place = &w->place[3 * node];
                place[0] = (int32_t)(w->of.low[0] + i * WORD + __builtin_ctzll(bits));
                place[1] = (int32_t)(w->of.low[1] + j);
                place[2] = (int32_t)(w->layer->low + layer);
                lattice_corner(w->l, place, &w->position[3 * node]);
            }
}

/* The node at a corner that has one. */
static int32_t node_at(const work *w, const corners *c, int64_t layer, int64_t i, int64_t j)
{
    i -= w->of.low[0];
    int64_t word = (j - w->of.low[1]) * w->of.words + i / WORD;
    uint64_t earlier = c->bits[word] & (((uint64_t)1 << (i % WORD)) - 1);
    return (int32_t)(w->first[layer] + c->before[word] + __builtin_popcountll(earlier));
}

/* corner: the layers of corners below and above. at: the run's first element. */
static void put_elements(const work *w, const corners *const *corner, int64_t layer, const climb_run *a, int64_t at)
{
    int32_t first[8];
    for (int c = 0; c < 8; c++) {
        const int32_t *offset = lattice_vtk[c];
        first[c] = node_at(w, corner[offset[2]], layer + offset[2], a->from, a->j + offset[1]) + offset[0];
    }
    for (int32_t i = 0; i < a->to - a->from; i++, at++) {
        int32_t *ijk = &w->element_place[3 * at];
        for (int c = 0; c < 8; c++)
            w->node[8 * at + c] = first[c] + i;
        ijk[0] = a->from + i, ijk[1] = a->j, ijk[2] = a->k;
        w->volume[at] = a->volume;
    }
}

/* Layers of cells with the nodes below them; the last layer's with those above it too. */
static void fill_layers(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    corners c[2] = {{0}, {0}};
    if (!make_corners(&c[0], w) || !make_corners(&c[1], w)) {
        atomic_store(&w->failed, true);
        to = from;
    } else
        find_corners(w, &c[0], from);
    for (int64_t layer = from; layer < to; layer++) {
        const corners *pair[2] = {&c[(layer - from) % 2], &c[(layer - from + 1) % 2]};
        find_corners(w, &c[(layer - from + 1) % 2], layer + 1);
        put_nodes(w, pair[0], layer);
        if (layer + 1 == w->layer->count)
            put_nodes(w, pair[1], layer + 1);
        int64_t at = w->layer->voxel[layer];
        for (int64_t n = w->layer->run[layer]; n < w->layer->run[layer + 1]; n++) {
            put_elements(w, pair, layer, &w->x->run[n], at);
            at += w->x->run[n].to - w->x->run[n].from;
        }
    }
    free_corners(&c[0]);
    free_corners(&c[1]);
}

/* The further nodes of points that slits part: the last of their layer. */
static void put_parted(const work *w)
{
    const slits *s = w->slit;
    for (int64_t i = s->points - 1, next = 0, layer = -1; i >= 0; i--) {
        const slits_point *p = &s->point[i];
        if (p->place[2] - w->layer->low != layer) {
            layer = p->place[2] - w->layer->low;
            next = w->first[layer + 1];
        }
        next -= p->nodes - 1;
        for (int64_t n = next; n < next + p->nodes - 1; n++) {
            memcpy(&w->place[3 * n], p->place, sizeof p->place);
            lattice_corner(w->l, p->place, &w->position[3 * n]);
        }
        for (int64_t c = p->from; c < p->to; c++) {
            const slits_corner *at = &s->corner[c];
            if (at->node)
                w->node[8 * at->element + at->corner] = (int32_t)(next + at->node - 1);
        }
    }
}

/* An array of the model by its name, which is there. */
static model_array *added(const model *m, const char *name)
{
    return model_find(m, name);
}

static int add_arrays(work *w, model *m, int64_t nodes, int64_t elements, err *e)
{
    static const char *const name[] = {"node.position", "node.lattice", "element.node", "element.lattice",
                                       "element.volume"};
    if (model_axis_add(m, "node", nodes, e) || model_axis_add(m, "element", elements, e))
        return -1;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (!model_add(m, name[i], e))
            return -1;
    w->position = added(m, "node.position")->f64;
    w->place = added(m, "node.lattice")->i32;
    w->node = added(m, "element.node")->i32;
    w->element_place = added(m, "element.lattice")->i32;
    w->volume = added(m, "element.volume")->i32;
    return 0;
}

/* Whether some element has a second volume. */
static bool is_mixed(const voxels *x)
{
    for (int64_t i = 0; x->mix && i < x->elements; i++)
        if (x->mix[i] >= 0)
            return true;
    return false;
}

static int add_shares(model *m, const voxels *x, err *e)
{
    bool mixed = is_mixed(x);
    model_array *fraction = model_add(m, "element.fraction", e);
    model_array *mix = fraction && mixed ? model_add(m, "element.mix", e) : NULL;
    model_array *mixture = mix ? model_add(m, "element.mixture", e) : NULL;
    if (!fraction || (mixed && !mixture))
        return -1;
    memcpy(fraction->f32, x->fraction, (size_t)x->elements * sizeof *x->fraction);
    if (mixed) {
        memcpy(mix->i32, x->mix, (size_t)x->elements * sizeof *x->mix);
        memcpy(mixture->f32, x->mixture, (size_t)x->elements * sizeof *x->mixture);
    }
    return 0;
}

static int add_moments(model *m, const moments_list *list, err *e)
{
    if (!list->count)
        return 0;
    if (model_axis_add(m, "cut", list->count, e))
        return -1;
    model_array *element = model_add(m, "cut.element", e), *of = element ? model_add(m, "cut.moments", e) : NULL;
    for (int64_t i = 0; of && i < list->count; i++) {
        element->i32[i] = (int32_t)list->voxel[i].element;
        memcpy(of->f32 + CUT_MOMENTS * i, list->voxel[i].of, sizeof list->voxel[i].of);
    }
    return of ? 0 : -1;
}

/* The normal in space: n dA is as large as a face across an axis is, which is by 1 / side. */
static int add_borders(model *m, const moments_list *list, const lattice *l, err *e)
{
    if (!list->count)
        return 0;
    if (model_axis_add(m, "border", list->count, e))
        return -1;
    model_array *element = model_add(m, "border.element", e), *n = element ? model_add(m, "border.normal", e) : NULL,
                *of = n ? model_add(m, "border.moments", e) : NULL;
    for (int64_t i = 0; of && i < list->count; i++) {
        const moments_voxel *v = &list->voxel[i];
        double length = 0;
        for (int a = 0; a < 3; a++)
            length += pow((double)v->faces[a] / l->spacing[a], 2);
        for (int a = 0; a < 3; a++)
            n->f32[3 * i + a] = (float)((double)v->faces[a] / l->spacing[a] / sqrt(length));
        element->i32[i] = (int32_t)v->element;
        memcpy(of->f32 + BORDER_MOMENTS * i, v->of, BORDER_MOMENTS * sizeof *v->of);
    }
    return of ? 0 : -1;
}

static int add_inside(model *m, const slits *s, err *e)
{
    model_array *a = s->inside ? model_add(m, "element.inside", e) : NULL;
    if (a)
        memcpy(a->f32, s->inside, (size_t)(3 * a->rows) * sizeof *s->inside);
    return s->inside && !a ? -1 : 0;
}

int build_elements(model *m, const voxels *x, const slits *s, const lattice *l, pool *threads, err *e)
{
    voxels_layers layer;
    work w = {.x = x, .slit = s, .layer = &layer, .l = l, .of = find_rectangle(x)};
    int status = -1;
    if (voxels_find_layers(x, &layer, e))
        return -1;
    w.first = mem_array(layer.count + 2, sizeof *w.first, "layers of nodes", e);
    if (!w.first || count_nodes(&w, threads, e) || add_arrays(&w, m, w.first[layer.count + 1], x->elements, e))
        goto out;
    pool_run(threads, layer.count, CHUNK, fill_layers, &w);
    put_parted(&w);
    if (atomic_load(&w.failed))
        err_memory(e, "a layer of nodes");
    else
        status = (x->fraction && add_shares(m, x, e)) || add_moments(m, &x->cut, e) ||
                         add_borders(m, &x->border, l, e) || add_inside(m, s, e)
                     ? -1
                     : 0;
out:
    free(w.first);
    voxels_layers_free(&layer);
    return status;
}

int build_volumes(model *m, const volumes *plan, err *e)
{
    static const char *const name[] = {"volume.name", "volume.level", "volume.priority", "volume.material",
                                       "volume.muscle"};
    if (model_axis_add(m, "volume", plan->volumes, e))
        return -1;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (!model_add(m, name[i], e))
            return -1;
    for (int32_t v = 0; v < plan->volumes; v++) {
        const volumes_volume *a = &plan->volume[v];
        if (model_set_text(added(m, "volume.name"), v, a->name, e))
            return -1;
        added(m, "volume.level")->i32[v] = a->level;
        added(m, "volume.priority")->i32[v] = a->priority;
        added(m, "volume.material")->i32[v] = a->material;
        added(m, "volume.muscle")->u8[v] = a->muscle;
    }
    return 0;
}

int build_slits(model *m, const volumes *v, const char *name, err *e)
{
    bool *bounds = mem_array(v->surfaces, sizeof *bounds, "surfaces", e);
    size_t size = 1;
    for (int64_t i = 0; bounds && i < v->members; i++)
        bounds[v->member[i].surface] |= v->volume[v->member[i].volume].level == 0;
    for (int32_t s = 0; bounds && s < v->surfaces; s++)
        size += strlen(v->surface[s].name) + 1;
    char *names = bounds ? mem_array((int64_t)size, 1, "surfaces", e) : NULL;
    char *end = names;
    for (int32_t s = 0; names && s < v->surfaces; s++)
        if (bounds[s])
            end += snprintf(end, size - (size_t)(end - names), "%s%s", end == names ? "" : " ", v->surface[s].name);
    const int status =
        !names || model_meta_set(m, "slits.surface", name, e) || model_meta_set(m, "slits.groups", names, e) ? -1 : 0;
    free(bounds);
    free(names);
    return status;
}
