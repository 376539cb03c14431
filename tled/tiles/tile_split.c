#include "tled/tiles/tile_split.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/tiles/lattice_sheet.h"

#include <stdlib.h>
#include <string.h>

/* ---- cells put into a grid */

void tile_pack_begin(tile_pack *k, const int grid[3])
{
    memcpy(k->grid, grid, sizeof k->grid);
    memset(k->node, 0xff, sizeof k->node);
    memset(k->cell, 0, sizeof k->cell);
    k->places = 0;
}

/* Where corner c of a cell is, from its low corner. */
static int32_t step_to(const tile_pack *k, int c)
{
    const int32_t *way = lattice_vtk[c];
    return way[0] + k->grid[0] * (way[1] + k->grid[1] * way[2]);
}

/* How many corners of a cell are where a place wants them; -1: others are there. */
static int count_alike(const tile_pack *k, int32_t place, const int32_t node[8])
{
    int count = 0;
    if (k->cell[place])
        return -1;
    for (int c = 0; c < 8; c++) {
        const int32_t there = k->node[place + step_to(k, c)];
        if (there >= 0 && there != node[c])
            return -1;
        count += there >= 0;
    }
    return count;
}

int32_t tile_pack_add(tile_pack *k, const int32_t node[8])
{
    const int *g = k->grid;
    int32_t best = -1;
    int most = -1;
    for (int32_t z = 0; z + 1 < g[2]; z++)
        for (int32_t y = 0; y + 1 < g[1]; y++)
            for (int32_t x = 0; x + 1 < g[0]; x++) {
                const int32_t place = x + g[0] * (y + g[1] * z);
                const int count = count_alike(k, place, node);
                if (count > most) {
                    most = count;
                    best = place;
                }
            }
    if (best < 0)
        return -1;
    for (int c = 0; c < 8; c++)
        k->node[best + step_to(k, c)] = node[c];
    k->cell[best] = true;
    k->places += 8 - most;
    return best;
}

/* ---- bricks split */

/* A listed tile that is being filled. */
typedef struct piece {
    int32_t number;    /* from 1 on */
    int32_t nodes;     /* that it owns */
    int32_t own_cells; /* whose low corner it owns */
    tile_pack pack;
} piece;

typedef struct splitter {
    const tled_problem *p;
    int32_t most_nodes, most_halos; /* of a tile */
    lattice_sheet sheet;
    piece now;
    int32_t *seen; /* elements: by which piece */
} splitter;

void tile_split_free(tile_split *s)
{
    free(s->tile);
    memset(s, 0, sizeof *s);
}

static int add_tile(tile_split *s, int32_t brick, bool listed, err *e)
{
    if (MEM_ROOM(&s->tile, &s->capacity, s->count + 1, "the tiles", e))
        return -1;
    s->tile[s->count++] = (tile_piece){brick, listed};
    return 0;
}

/* The tile for what is left of a brick: the brick's own, or one more. -1 with e filled. */
static int64_t tile_for(tile_split *to, int32_t brick, bool own, bool listed, err *e)
{
    if (own)
        to->tile[brick].listed = listed;
    else if (add_tile(to, brick, listed, e))
        return -1;
    return own ? brick : to->count - 1;
}

/* Gives a brick's nodes to a tile for each sheet that they take. Leaves in the list of the brick, at its beginning,
 * those that none takes: *left. *own: no tile has the brick's number yet. */
static int split_sheets(splitter *s, tile_split *to, int32_t brick, int32_t *node, int32_t *left, int32_t *tile_of,
                        bool *own, err *e)
{
    for (int32_t before = -1; *left && before != *left; *own = *own && before == *left) {
        int64_t which = -1;
        lattice_sheet_begin(&s->sheet);
        before = *left;
        *left = 0;
        for (int32_t k = 0; k < before; k++) {
            if (!lattice_sheet_take(&s->sheet, node[k])) {
                node[(*left)++] = node[k];
                continue;
            }
            if (which < 0 && (which = tile_for(to, brick, *own, false, e)) < 0)
                return -1;
            tile_of[node[k]] = (int32_t)which;
        }
    }
    return 0;
}

static void begin_piece(splitter *s, const tiles *t)
{
    s->now.number++;
    s->now.nodes = s->now.own_cells = 0;
    tile_pack_begin(&s->now.pack, t->grid);
}

/* Adds a node to a listed tile. False: that is more than it has room for. */
static bool add_node(const splitter *s, piece *to, int32_t node)
{
    int32_t corner;
    to->nodes++;
    for (int i = 0; (corner = lattice_sheet_corner(s->p, node, i)) >= 0; i++) {
        const int32_t element = corner / 8;
        to->own_cells += corner % 8 == 0;
        if (s->seen[element] == to->number)
            continue;
        s->seen[element] = to->number;
        if (tile_pack_add(&to->pack, s->p->element_node + 8 * (int64_t)element) < 0)
            return false;
    }
    return to->nodes <= s->most_nodes && to->own_cells <= s->most_nodes && to->pack.places - to->nodes <= s->most_halos;
}

/* Gives tips to listed tiles, in their order: each gets as many as it has room for. */
static int split_tips(splitter *s, tile_split *to, const tiles *t, int32_t brick, const int32_t *node, int32_t count,
                      int32_t *tile_of, bool own, err *e)
{
    int64_t which = -1;
    for (int32_t k = 0; k < count; k++) {
        if (which < 0 || !add_node(s, &s->now, node[k])) {
            begin_piece(s, t);
            if ((which = tile_for(to, brick, own, true, e)) < 0)
                return -1;
            own = false;
            if (!add_node(s, &s->now, node[k]))
                return err_set(e, NULL, 0,
                               "node %d: its elements are more than a device's brick has room for; expected at most "
                               "one for each place around it, or -d cpu",
                               node[k]);
        }
        tile_of[node[k]] = (int32_t)which;
    }
    return 0;
}

static int split_brick(splitter *s, tile_split *to, const tiles *t, int32_t brick, int32_t *tile_of, err *e)
{
    int32_t *node = t->node + t->tile[brick].node, left = t->tile[brick].nodes;
    bool own = true;
    return split_sheets(s, to, brick, node, &left, tile_of, &own, e) ||
                   split_tips(s, to, t, brick, node, left, tile_of, own, e)
               ? -1
               : 0;
}

int tile_split_make(tile_split *s, const tled_problem *p, const tiles *t, const int32_t *first, int32_t *tile_of,
                    err *e)
{
    const int *b = t->brick, *g = t->grid, nodes = b[0] * b[1] * b[2];
    splitter with = {.p = p, .most_nodes = nodes, .most_halos = g[0] * g[1] * g[2] - nodes};
    int result = -1;
    memset(s, 0, sizeof *s);
    with.seen = mem_array(p->elements, sizeof *with.seen, "the tiles", e);
    if (!with.seen || lattice_sheet_make(&with.sheet, p, first, e))
        goto out;
    for (int32_t i = 0; i < t->count; i++)
        if (add_tile(s, i, false, e))
            goto out;
    for (int32_t i = 0; i < t->count; i++)
        if (split_brick(&with, s, t, i, tile_of, e))
            goto out;
    result = 0;
out:
    free(with.seen);
    lattice_sheet_free(&with.sheet);
    return result;
}
