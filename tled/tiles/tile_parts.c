#include "tled/tiles/tile_parts.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* A tile, where it stood, and what it is ordered by. */
typedef struct place {
    tile of;
    int64_t at;
    bool is_late;
} place;

static bool has_late(const tiles *t, const tile *of, const uint8_t *late)
{
    for (int32_t k = of->node; k < of->node + of->nodes; k++)
        if (late[t->node[k]])
            return true;
    for (int32_t k = of->halo; k < of->halo + of->halos; k++)
        if (late[t->node[t->halo_node[k]]])
            return true;
    return false;
}

static int by_turn(const void *a, const void *b)
{
    const place *one = a, *other = b;
    if (one->is_late != other->is_late)
        return one->is_late ? 1 : -1;
    if (one->of.cells != other->of.cells)
        return one->of.cells > other->of.cells ? -1 : 1;
    return (one->at > other->at) - (one->at < other->at);
}

static int64_t order(tiles *t, const uint8_t *late, place *turn, int32_t *list)
{
    int64_t count = 0;
    for (int64_t i = 0; i < t->count; i++) {
        turn[i] = (place){t->tile[i], i, has_late(t, &t->tile[i], late)};
        count += turn[i].is_late;
    }
    qsort(turn, (size_t)t->count, sizeof *turn, by_turn);
    for (int64_t i = 0; i < t->count; i++) {
        t->tile[i] = turn[i].of;
        list[i] = t->list ? t->list[turn[i].at] : -1;
    }
    if (t->list)
        memcpy(t->list, list, (size_t)t->count * sizeof *list);
    return count;
}

int64_t tiles_part(tiles *t, const uint8_t *late, err *e)
{
    place *turn = mem_array(t->count, sizeof *turn, "the solver", e);
    int32_t *list = turn ? mem_array(t->count, sizeof *list, "the solver", e) : NULL;
    const int64_t count = list ? order(t, late, turn, list) : -1;
    free(list);
    free(turn);
    return count;
}

enum { NODES = 4096 };

static int by_node(const void *a, const void *b)
{
    const int32_t x = ((const tile_extra *)a)->node, y = ((const tile_extra *)b)->node;
    return (x > y) - (x < y);
}

typedef struct reordering {
    tiles *t;
    const int32_t *order; /* of the model's nodes */
    int32_t *node;        /* as the tiles', in the new order */
    uint32_t *info;
} reordering;

static void reorder_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const reordering *r = context;
    tiles *t = r->t;
    (void)chunk;
    for (int64_t k = from; k < to; k++) {
        const int32_t at = t->order[k] = r->order[t->node[k]];
        r->node[at] = t->node[k];
        r->info[at] = t->node_info[k];
    }
}

static void reorder_halos_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tiles *t = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        t->halo_node[i] = t->order[t->halo_node[i]];
}

int tiles_reorder(tiles *t, const int32_t *order, pool *threads, err *e)
{
    int32_t *node = mem_array(t->nodes, sizeof *node, "the tiles", e);
    uint32_t *info = mem_array(t->nodes, sizeof *info, "the tiles", e);
    t->order = mem_array(t->nodes, sizeof *t->order, "the tiles", e);
    if (!node || !info || !t->order) {
        free(node);
        free(info);
        return -1;
    }
    pool_run(threads, t->nodes, NODES, reorder_work, &(reordering){t, order, node, info});
    pool_run(threads, t->halos, NODES, reorder_halos_work, t);
    for (int64_t i = 0; i < t->extras; i++)
        t->extra[i].node = t->order[t->extra[i].node];
    qsort(t->extra, (size_t)t->extras, sizeof *t->extra, by_node);
    free(t->node);
    free(t->node_info);
    t->node = node;
    t->node_info = info;
    return 0;
}
