#include "tled/cuda/tile_split.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* What is found of a tile that is being filled. Numbers differ from one to the next, so that arrays of those that have
 * been seen need no clearing. */
typedef struct piece {
    int32_t number;
    int32_t nodes, around, cells; /* owned, of all its cells, and these */
    int32_t own_cells;            /* whose low corner it owns */
} piece;

typedef struct splitter {
    const tled_problem *p;
    const int32_t *first;
    int32_t most_nodes, most_halos, most_cells; /* of a tile */
    int32_t pieces;                             /* numbers taken */
    int32_t *node_seen, *element_seen;          /* by which piece */
    int64_t *at_place, *at_cell; /* by first node at a place: the piece in the high half, and who is there */
} splitter;

void tile_split_free(tile_split *s)
{
    free(s->tile);
    memset(s, 0, sizeof *s);
}

/* Entry i of a node's elements, or -1 after its last. */
static int32_t corner_of(const tled_problem *p, int32_t node, int i)
{
    const int32_t corner = i < 8 ? p->corner[8 * (int64_t)node + i] : -1;
    return corner < 8 * p->elements ? corner : -1;
}

/* Notes that `who` is at a place. False: another one is. */
static bool take_place(int64_t *at, int32_t place, int32_t number, int32_t who)
{
    const int64_t mine = (int64_t)number << 32 | who;
    if (at[place] >> 32 == number && at[place] != mine)
        return false;
    at[place] = mine;
    return true;
}

/* Whether all that has to do with a node has a place of its own, among what the piece has seen. */
static bool is_alone(const splitter *s, int32_t number, int32_t node)
{
    for (int i = 0; corner_of(s->p, node, i) >= 0; i++) {
        const int32_t element = corner_of(s->p, node, i) / 8, *corner = s->p->element_node + 8 * (int64_t)element;
        if (s->element_seen[element] == number)
            continue;
        s->element_seen[element] = number;
        if (!take_place(s->at_cell, s->first[corner[0]], number, element))
            return false;
        for (int c = 0; c < 8; c++)
            if (!take_place(s->at_place, s->first[corner[c]], number, corner[c]))
                return false;
    }
    return true;
}

static bool is_plain(splitter *s, const tiles *t, const tile *brick)
{
    const int32_t number = s->pieces++;
    if (brick->nodes > s->most_nodes)
        return false;
    for (int32_t k = 0; k < brick->nodes; k++)
        if (!is_alone(s, number, t->node[brick->node + k]))
            return false;
    return true;
}

/* Adds a node. False: that is more than a tile may have. */
static bool add_node(const splitter *s, piece *to, int32_t node)
{
    to->nodes++;
    for (int i = 0; corner_of(s->p, node, i) >= 0; i++) {
        const int32_t element = corner_of(s->p, node, i) / 8, *corner = s->p->element_node + 8 * (int64_t)element;
        to->own_cells += corner[0] == node;
        if (s->element_seen[element] == to->number)
            continue;
        s->element_seen[element] = to->number;
        to->cells++;
        for (int c = 0; c < 8; c++) {
            to->around += s->node_seen[corner[c]] != to->number;
            s->node_seen[corner[c]] = to->number;
        }
    }
    return to->nodes <= s->most_nodes && to->around - to->nodes <= s->most_halos && to->cells <= s->most_cells &&
           to->own_cells <= s->most_nodes;
}

static int add_tile(tile_split *s, int32_t brick, bool listed, err *e)
{
    if (MEM_ROOM(&s->tile, &s->capacity, s->count + 1, "the tiles", e))
        return -1;
    s->tile[s->count++] = (tile_piece){brick, listed};
    return 0;
}

/* Gives the nodes of a brick to tiles, in their order: each gets as many as it has room for. */
static int split_brick(splitter *s, tile_split *to, const tiles *t, int32_t brick, int32_t *tile_of, err *e)
{
    const tile *from = &t->tile[brick];
    piece now = {.number = s->pieces++};
    int32_t which = brick;
    to->tile[brick].listed = true;
    for (int32_t k = 0; k < from->nodes; k++) {
        const int32_t node = t->node[from->node + k];
        if (!add_node(s, &now, node)) {
            const bool alone = now.nodes == 1;
            now = (piece){.number = s->pieces++};
            if (alone || !add_node(s, &now, node))
                return err_set(e, NULL, 0,
                               "node %d: its elements are more than a device's brick has room for; expected at most "
                               "one for each place around it, or -d cpu",
                               node);
            which = (int32_t)to->count;
            if (add_tile(to, brick, true, e))
                return -1;
        }
        tile_of[node] = which;
    }
    return 0;
}

static int allocate(splitter *s, err *e)
{
    const int64_t nodes = s->p->nodes, elements = s->p->elements;
    s->node_seen = mem_array(nodes, sizeof *s->node_seen, "the tiles", e);
    s->element_seen = mem_array(elements, sizeof *s->element_seen, "the tiles", e);
    s->at_place = mem_array(nodes, sizeof *s->at_place, "the tiles", e);
    s->at_cell = mem_array(nodes, sizeof *s->at_cell, "the tiles", e);
    return s->node_seen && s->element_seen && s->at_place && s->at_cell ? 0 : -1;
}

int tile_split_make(tile_split *s, const tled_problem *p, const tiles *t, const int32_t *first, int32_t *tile_of,
                    err *e)
{
    const int *b = t->brick, *g = t->grid, nodes = b[0] * b[1] * b[2];
    splitter with = {.p = p,
                     .first = first,
                     .most_nodes = nodes,
                     .most_halos = g[0] * g[1] * g[2] - nodes,
                     .most_cells = (b[0] + 1) * (b[1] + 1) * (b[2] + 1),
                     .pieces = 1};
    int result = -1;
    memset(s, 0, sizeof *s);
    if (allocate(&with, e))
        goto out;
    for (int32_t i = 0; i < t->count; i++)
        if (add_tile(s, i, false, e))
            goto out;
    for (int32_t i = 0; i < t->count; i++)
        if (!is_plain(&with, t, &t->tile[i]) && split_brick(&with, s, t, i, tile_of, e))
            goto out;
    result = 0;
out:
    free(with.node_seen);
    free(with.element_seen);
    free(with.at_place);
    free(with.at_cell);
    return result;
}
