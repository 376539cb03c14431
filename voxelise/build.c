#include "voxelise/build.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* Two layers of lattice corners, over the rectangle that elements cover. */
typedef struct sweep {
    const voxels *x;
    int64_t low[2], size[2];       /* of corners along i and j */
    int32_t *below, *above;        /* a corner's node, -1 = none */
    int64_t first, past;           /* runs of the layer of cells above the corners last numbered */
    int64_t nodes;                 /* so far */
    model_array *position, *place; /* NULL: the nodes are only counted */
    const lattice *l;
} sweep;

static void find_rectangle(sweep *s)
{
    const voxels *x = s->x;
    int64_t high[2] = {INT32_MIN, INT32_MIN};
    s->low[0] = s->low[1] = INT32_MAX;
    for (int64_t r = 0; r < x->runs; r++) {
        const climb_run *a = &x->run[r];
        s->low[0] = a->from < s->low[0] ? a->from : s->low[0];
        s->low[1] = a->j < s->low[1] ? a->j : s->low[1];
        high[0] = a->to > high[0] ? a->to : high[0];
        high[1] = a->j + 1 > high[1] ? a->j + 1 : high[1];
    }
    for (int a = 0; a < 2; a++)
        s->size[a] = x->runs ? high[a] - s->low[a] + 1 : 0;
}

static int64_t corner_at(const sweep *s, int64_t i, int64_t j)
{
    return (j - s->low[1]) * s->size[0] + i - s->low[0];
}

/* Marks the corners that a layer's runs have, on one of its two layers of corners. */
static void mark(const sweep *s, int64_t first, int64_t past, int32_t *layer)
{
    for (int64_t r = first; r < past; r++) {
        const climb_run *a = &s->x->run[r];
        for (int j = 0; j < 2; j++)
            for (int64_t i = a->from; i <= a->to; i++)
                layer[corner_at(s, i, a->j + j)] = 0;
    }
}

static void put_node(const sweep *s, int64_t node, int64_t i, int64_t j, int64_t k)
{
    int32_t *place = &s->place->i32[3 * node];
    place[0] = (int32_t)i, place[1] = (int32_t)j, place[2] = (int32_t)k;
    lattice_corner(s->l, place, &s->position->f64[3 * node]);
}

/* Numbers the marked corners of layer k. */
static void number(sweep *s, int64_t k, int32_t *layer)
{
    for (int64_t j = 0; j < s->size[1]; j++)
        for (int64_t i = 0; i < s->size[0]; i++) {
            int32_t *node = &layer[j * s->size[0] + i];
            if (*node < 0)
                continue;
            if (s->position)
                put_node(s, s->nodes, s->low[0] + i, s->low[1] + j, k);
            *node = (int32_t)s->nodes++;
        }
}

static void clear(const sweep *s, int32_t *layer)
{
    for (int64_t c = 0; c < s->size[0] * s->size[1]; c++)
        layer[c] = -1;
}

static int64_t layer_end(const voxels *x, int64_t first)
{
    int64_t past = first;
    while (past < x->runs && x->run[past].k == x->run[first].k)
        past++;
    return past;
}

/* Goes on to the next layer of cells: afterwards `below` and `above` hold the nodes of its corners. False at the end. */
static bool next_layer(sweep *s)
{
    const voxels *x = s->x;
    int64_t before = s->first;
    bool follows = s->past > 0 && s->past < x->runs && x->run[s->past].k == x->run[before].k + 1;
    if (s->past == x->runs)
        return false;
    s->first = s->past;
    s->past = layer_end(x, s->first);
    int32_t *spare = s->below;
    s->below = s->above;
    s->above = spare;
    int64_t k = x->run[s->first].k, next = s->past < x->runs ? layer_end(x, s->past) : s->past;
    if (!follows) {
        clear(s, s->below);
        mark(s, s->first, s->past, s->below);
        number(s, k, s->below);
    }
    clear(s, s->above);
    mark(s, s->first, s->past, s->above);
    if (s->past < x->runs && x->run[s->past].k == k + 1)
        mark(s, s->past, next, s->above);
    number(s, k + 1, s->above);
    return true;
}

static void put_elements(const sweep *s, const climb_run *a, int64_t at, model_array *node, model_array *place,
                         model_array *volume)
{
    for (int64_t i = a->from; i < a->to; i++, at++) {
        const int32_t *layer[2] = {s->below, s->above};
        for (int c = 0; c < 8; c++) {
            const int32_t *offset = lattice_vtk[c];
            node->i32[8 * at + c] = layer[offset[2]][corner_at(s, i + offset[0], a->j + offset[1])];
        }
        int32_t *ijk = &place->i32[3 * at];
        ijk[0] = (int32_t)i, ijk[1] = a->j, ijk[2] = a->k;
        volume->i32[at] = a->volume;
    }
}

static int count_nodes(sweep *s, int64_t *nodes, err *e)
{
    while (next_layer(s))
        ;
    *nodes = s->nodes;
    s->first = s->past = s->nodes = 0;
    if (*nodes > INT32_MAX)
        return err_set(e, NULL, 0, "%lld nodes; at most %d can be numbered: use larger voxels, or a --box",
                       (long long)*nodes, INT32_MAX);
    return 0;
}

/* An array of the model by its name, which is there. */
static model_array *added(const model *m, const char *name)
{
    return model_find(m, name);
}

static int add_arrays(model *m, int64_t nodes, int64_t elements, err *e)
{
    static const char *const name[] = {"node.position", "node.lattice", "element.node", "element.lattice",
                                       "element.volume"};
    if (model_axis_add(m, "node", nodes, e) || model_axis_add(m, "element", elements, e))
        return -1;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (!model_add(m, name[i], e))
            return -1;
    return 0;
}

static void fill(sweep *s, model *m)
{
    model_array *node = added(m, "element.node"), *place = added(m, "element.lattice");
    model_array *volume = added(m, "element.volume");
    int64_t at = 0;
    s->position = added(m, "node.position");
    s->place = added(m, "node.lattice");
    while (next_layer(s))
        for (int64_t r = s->first; r < s->past; r++) {
            put_elements(s, &s->x->run[r], at, node, place, volume);
            at += s->x->run[r].to - s->x->run[r].from;
        }
}

static int add_fractions(model *m, const voxels *x, err *e)
{
    model_array *to = model_add(m, "element.fraction", e);
    if (to && x->elements)
        memcpy(to->f32, x->fraction, (size_t)x->elements * sizeof *x->fraction);
    return to ? 0 : -1;
}

int build_elements(model *m, const voxels *x, const lattice *l, err *e)
{
    sweep s = {.x = x, .l = l};
    int64_t nodes;
    int status = -1;
    find_rectangle(&s);
    s.below = mem_array(s.size[0] * s.size[1], sizeof *s.below, "a layer of nodes", e);
    s.above = mem_array(s.size[0] * s.size[1], sizeof *s.above, "a layer of nodes", e);
    if (!s.below || !s.above || count_nodes(&s, &nodes, e) || add_arrays(m, nodes, x->elements, e))
        goto out;
    fill(&s, m);
    status = x->fraction ? add_fractions(m, x, e) : 0;
out:
    free(s.below);
    free(s.above);
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
