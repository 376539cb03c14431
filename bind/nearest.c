#include "bind/nearest.h"

#include "base/mem.h"
#include "mesh/weights.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

static double shortest(const lattice *l)
{
    return fmin(fmin(l->spacing[0], l->spacing[1]), l->spacing[2]);
}

static double longest(const lattice *l)
{
    return fmax(fmax(l->spacing[0], l->spacing[1]), l->spacing[2]);
}

/* What takes longer than to wake a thread. */
enum { CHUNK = 1 << 14, BLOCKS = 1 << 16 }; /* elements, blocks */

typedef struct boxes {
    const nearest *n;
    const int32_t *node, *ijk;
    const double *position;
    atomic_llong off; /* the first element that is not the box of its cell */
} boxes;

static bool is_box(const boxes *b, int64_t element)
{
    const weights_box box = weights_box_of(&b->node[8 * element], b->position);
    const double *side = b->n->grid.spacing;
    double corner[3];
    lattice_corner(&b->n->grid, &b->ijk[3 * element], corner);
    for (int a = 0; a < 3; a++) {
        double off = fmax(fabs(box.first[a] - corner[a]), fabs(box.side[a] - side[a]));
        if (!(off <= 1e-6 * side[a]))
            return false;
    }
    return true;
}

static void check_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    boxes *b = context;
    (void)chunk;
    while (from < to && is_box(b, from))
        from++;
    long long before = atomic_load(&b->off);
    while (from < to && from < before && !atomic_compare_exchange_weak(&b->off, &before, from))
        ;
}

/* Each element must be where its cell is: the lookup goes by cells, the weights by nodes. */
static int check_boxes(const nearest *n, const model *m, pool *threads, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *ijk = model_need(m, "element.lattice", e);
    const model_array *position = model_need(m, "node.position", e);
    if (!node || !ijk || !position)
        return -1;
    boxes b = {.n = n, .node = node->i32, .ijk = ijk->i32, .position = position->f64};
    atomic_init(&b.off, INT64_MAX);
    pool_run(threads, node->rows, CHUNK, check_some, &b);
    const int64_t off = atomic_load(&b.off);
    if (off == INT64_MAX)
        return 0;
    return err_set(e, NULL, 0,
                   "element %lld is not the box of its lattice cell %d %d %d; expected a model from voxelise",
                   (long long)off, ijk->i32[3 * off], ijk->i32[3 * off + 1], ijk->i32[3 * off + 2]);
}

static bool occupied(const nearest *n, int level, int32_t i, int32_t j, int32_t k)
{
    const nearest_level *l = &n->level[level];
    int64_t at = ((int64_t)k * l->size[1] + j) * l->size[0] + i;
    return level ? l->occupied[at] : n->map.element[at] >= 0;
}

/* Layers of the last level. */
static void gather_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const nearest *n = context;
    const nearest_level *below = &n->level[n->levels - 1], *l = below + 1;
    const int64_t last = 2 * to < below->size[2] ? 2 * to : below->size[2];
    (void)chunk;
    for (int64_t k = 2 * from; k < last; k++)
        for (int32_t j = 0; j < below->size[1]; j++) {
            uint8_t *row = &l->occupied[(k / 2 * l->size[1] + j / 2) * l->size[0]];
            for (int32_t i = 0; i < below->size[0]; i++)
                row[i / 2] |= occupied(n, n->levels - 1, i, j, (int32_t)k);
        }
}

/* Adds the level above the last one. */
static int add_level(nearest *n, pool *threads, err *e)
{
    const nearest_level *below = &n->level[n->levels - 1];
    nearest_level *l = &n->level[n->levels];
    int64_t blocks = 1;
    for (int a = 0; a < 3; a++)
        blocks *= l->size[a] = below->size[a] / 2 + below->size[a] % 2;
    l->occupied = mem_array(blocks, 1, "the lattice's blocks", e);
    if (!l->occupied)
        return -1;
    pool_run(threads, l->size[2], blocks > BLOCKS ? 1 : l->size[2], gather_some, n);
    n->levels++;
    return 0;
}

static bool is_one(const nearest_level *l)
{
    return l->size[0] == 1 && l->size[1] == 1 && l->size[2] == 1;
}

int nearest_build(nearest *n, const model *m, pool *threads, err *e)
{
    *n = (nearest){0};
    if (lattice_of(m, &n->grid, e) || lattice_map_build(&n->map, m, threads, e) || check_boxes(n, m, threads, e))
        goto bad;
    for (int a = 0; a < 3; a++)
        n->level[0].size[a] = n->map.size[a];
    n->levels = 1;
    while (!is_one(&n->level[n->levels - 1]))
        if (add_level(n, threads, e))
            goto bad;
    n->tie = 1e-9 * shortest(&n->grid);
    n->margin = 1e-9 * longest(&n->grid) / shortest(&n->grid);
    return 0;
bad:
    nearest_free(n);
    return -1;
}

void nearest_free(nearest *n)
{
    for (int l = 1; l < n->levels; l++)
        free(n->level[l].occupied);
    lattice_map_free(&n->map);
    *n = (nearest){0};
}

/* A search: for the least squared distance, then for the lowest index within it and a tie's width. */
typedef struct search {
    const nearest *n;
    double q[3];     /* the point, in cells from the map's low corner */
    double limit;    /* m2: what is further is not looked at */
    int32_t element; /* -1: the distance is searched for */
} search;

/* The squared distance from the point to the nearest place where a block of cells low to high - 1 has a centre, m2. */
static double distance2(const search *s, const int64_t *low, const int64_t *high)
{
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        double d = fmax(fmax((double)low[a] + .5 - s->q[a], s->q[a] - ((double)high[a] - .5)), 0);
        d *= s->n->grid.spacing[a];
        sum += d * d;
    }
    return sum;
}

/* A block of cells; level 0: one cell. */
typedef struct block {
    int level;
    int32_t at[3];
} block;

enum { WAITING = 8 * NEAREST_LEVELS }; /* blocks: a search goes down one level at a time, 7 wait at each */

/* The squared distance to a block's centres; bit a of *side is set where the point is on its high side along axis a. */
static double block_distance2(const search *s, const block *b, int *side)
{
    int64_t low[3], high[3];
    *side = 0;
    for (int a = 0; a < 3; a++) {
        int64_t size = s->n->map.size[a];
        low[a] = (int64_t)b->at[a] << b->level;
        high[a] = low[a] + (INT64_C(1) << b->level);
        *side |= s->q[a] > (double)(low[a] + high[a]) / 2 ? 1 << a : 0;
        high[a] = high[a] < size ? high[a] : size;
    }
    return distance2(s, low, high);
}

/* Adds the occupied blocks that b is made of, the one on the point's side last: it is looked at first. Returns how many
 * blocks wait then. */
static int add_children(const search *s, const block *b, int side, block *waiting, int count)
{
    const int32_t *size = s->n->level[b->level - 1].size;
    for (int c = 7; c >= 0; c--) {
        block child = {.level = b->level - 1};
        bool there = true;
        for (int a = 0; a < 3; a++) {
            child.at[a] = 2 * b->at[a] + (((c ^ side) >> a) & 1);
            there &= child.at[a] < size[a];
        }
        if (there && occupied(s->n, child.level, child.at[0], child.at[1], child.at[2]))
            waiting[count++] = child;
    }
    return count;
}

static void look_at(search *s, const int32_t *cell, double d2, bool by_index)
{
    const lattice_map *map = &s->n->map;
    if (!by_index) {
        s->limit = d2;
        return;
    }
    int32_t element = map->element[((int64_t)cell[2] * map->size[1] + cell[1]) * map->size[0] + cell[0]];
    if (s->element < 0 || element < s->element)
        s->element = element;
}

/* by_index: of the elements within the limit, the lowest; else the limit comes down to the nearest one's distance. */
static void look_through(search *s, bool by_index)
{
    block waiting[WAITING] = {{.level = s->n->levels - 1}};
    for (int count = 1, side; count;) {
        block b = waiting[--count];
        double d2 = block_distance2(s, &b, &side);
        if (d2 > s->limit)
            continue;
        if (b.level)
            count = add_children(s, &b, side, waiting, count);
        else
            look_at(s, b.at, d2, by_index);
    }
}

/* The element of the cell that the point is well inside of, or -1. */
static int32_t element_around(const search *s)
{
    int64_t cell[3];
    for (int a = 0; a < 3; a++) {
        double low = floor(s->q[a]), within = s->q[a] - low;
        if (!(within > s->n->margin && 1 - within > s->n->margin))
            return -1;
        cell[a] = (int64_t)low + s->n->map.low[a];
    }
    return lattice_element(&s->n->map, cell[0], cell[1], cell[2]);
}

int32_t nearest_element(const nearest *n, const double *point)
{
    const double far = 1e12; /* cells: beyond it no double tells neighbours apart */
    search s = {.n = n, .limit = INFINITY, .element = -1};
    lattice_local(&n->grid, point, s.q);
    for (int a = 0; a < 3; a++)
        s.q[a] = fmin(fmax(s.q[a] - n->map.low[a], -far), far);
    int32_t around = element_around(&s);
    if (around >= 0)
        return around;
    look_through(&s, false);
    double d = sqrt(s.limit);
    d += n->tie + 4e-15 * d; /* the second: what rounding does to d far outside */
    s.limit = d * d;
    look_through(&s, true);
    return s.element;
}
