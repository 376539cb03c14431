#include "msds/mesh/mesh_cells.h"

#include "base/mem.h"
#include "msds/mesh/mesh_keys.h"

#include <stdlib.h>

/* Cells that are halved, by how often they were before. */
typedef struct tree {
    mesh_cells *c;
    mesh_wish wish;
    mesh_keys halved[MESH_LEVELS];
} tree;

static mesh_cell child(const mesh_cell *of, int i)
{
    mesh_cell to = {.side = of->side / 2};
    for (int a = 0; a < 3; a++)
        to.at[a] = of->at[a] + (i >> a & 1) * to.side;
    return to;
}

static int ask(tree *t, const mesh_cell *of, int level, err *e)
{
    if (level == t->c->levels || !t->wish.halve(t->wish.context, t->c, of, level))
        return 0;
    return mesh_keys_put(&t->halved[level], mesh_key(of->at), e) < 0 ? -1 : 0;
}

/* The cell before the last halving that lies `step` (-1 to 1) from a cell along each axis. False: outside the box. */
static bool parent(const mesh_cells *c, const int32_t at[3], int32_t side, int number, int32_t to[3])
{
    const int32_t step[3] = {number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1};
    for (int a = 0; a < 3; a++) {
        to[a] = at[a] + step[a] * side;
        if (to[a] < 0 || to[a] >= c->size[a])
            return false;
        to[a] = to[a] / (2 * side) * (2 * side);
    }
    return true;
}

/* A cell is halved once more than its neighbours at most: all cells around one that is halved are there, as large.
 * From the finest up, so that each level has all that finer ones ask for. */
static int grade(tree *t, err *e)
{
    for (int level = t->c->levels - 1; level > 0; level--) {
        const int32_t side = MESH_UNITS(t->c->levels - level);
        for (int64_t i = 0; i < t->halved[level].count; i++) {
            int32_t at[3], up[3];
            mesh_key_place(t->halved[level].key[i], at);
            for (int n = 0; n < 27; n++)
                if (parent(t->c, at, side, n, up) && mesh_keys_put(&t->halved[level - 1], mesh_key(up), e) < 0)
                    return -1;
        }
    }
    return 0;
}

/* A cell that is not halved stays. */
static int stay(tree *t, const mesh_cell *of, int level, err *e)
{
    mesh_cells *c = t->c;
    if (level < c->levels && mesh_keys_find(&t->halved[level], mesh_key(of->at)) >= 0)
        return 0;
    if (MEM_ROOM(&c->cell, &c->capacity, c->count + 1, "cells", e))
        return -1;
    c->cell[c->count++] = *of;
    return 0;
}

typedef int visit(tree *t, const mesh_cell *of, int level, err *e);

static int each_of_lattice(tree *t, visit *each, err *e)
{
    const int32_t side = MESH_UNITS(t->c->levels), *size = t->c->size;
    mesh_cell of = {.side = side};
    for (of.at[2] = 0; of.at[2] < size[2]; of.at[2] += side)
        for (of.at[1] = 0; of.at[1] < size[1]; of.at[1] += side)
            for (of.at[0] = 0; of.at[0] < size[0]; of.at[0] += side)
                if (each(t, &of, 0, e))
                    return -1;
    return 0;
}

/* The lattice's cells, and those that the halved ones are halved into, level by level: a visit may halve more. */
static int each_cell(tree *t, visit *each, err *e)
{
    if (each_of_lattice(t, each, e))
        return -1;
    for (int level = 0; level < t->c->levels; level++)
        for (int64_t i = 0; i < 8 * t->halved[level].count; i++) {
            mesh_cell of = {.side = MESH_UNITS(t->c->levels - level)};
            mesh_key_place(t->halved[level].key[i / 8], of.at);
            const mesh_cell next = child(&of, (int)(i % 8));
            if (each(t, &next, level + 1, e))
                return -1;
        }
    return 0;
}

static int by_place(const void *a, const void *b)
{
    const int64_t x = mesh_key(((const mesh_cell *)a)->at), y = mesh_key(((const mesh_cell *)b)->at);
    return (x > y) - (x < y);
}

static int check_size(const mesh_cells *c, const int32_t nodes[3], err *e)
{
    double count = 1;
    for (int a = 0; a < 3; a++) {
        if (nodes[a] < 2)
            return err_set(e, NULL, 0, "%d nodes along a side; expected 2 or more", nodes[a]);
        if ((int64_t)(nodes[a] - 1) * MESH_UNITS(c->levels) > MESH_KEY_MOST)
            return err_set(e, NULL, 0, "%d nodes along a side, whose cells are halved %d times; expected at most %d",
                           nodes[a], c->levels, MESH_KEY_MOST / MESH_UNITS(c->levels) + 1);
        count *= nodes[a] - 1;
    }
    if (count < INT32_MAX / 5.)
        return 0;
    return err_set(e, NULL, 0, "%dx%dx%d nodes are more than can be numbered; expected at most %d tetrahedra", nodes[0],
                   nodes[1], nodes[2], INT32_MAX);
}

int mesh_cells_make(mesh_cells *c, const int32_t nodes[3], int levels, mesh_wish wish, err *e)
{
    tree t = {.c = c, .wish = wish};
    c->levels = levels;
    if (check_size(c, nodes, e))
        return -1;
    for (int a = 0; a < 3; a++)
        c->size[a] = (nodes[a] - 1) * MESH_UNITS(levels);
    const int status = each_cell(&t, ask, e) || grade(&t, e) || each_cell(&t, stay, e) ? -1 : 0;
    if (!status)
        qsort(c->cell, (size_t)c->count, sizeof *c->cell, by_place);
    for (int i = 0; i < MESH_LEVELS; i++)
        mesh_keys_free(&t.halved[i]);
    return status;
}

void mesh_cells_free(mesh_cells *c)
{
    free(c->cell);
    *c = (mesh_cells){0};
}

void mesh_cells_keep(mesh_cells *c, const uint8_t *marked)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < c->count; i++)
        if (marked[i])
            c->cell[kept++] = c->cell[i];
    c->count = kept;
}
