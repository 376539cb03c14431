/* Slits in a block of voxels: between cells, which then have nodes of their own on both sides, and through cells, which
 * then are two elements. Two elements have a node in common where they hang together by faces around it. Memory that is
 * not to be had ends the test program.
 */
#ifndef SINEW_TLED_SLIT_H
#define SINEW_TLED_SLIT_H

#include "mesh/lattice.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Between cells at - 1 and at along an axis, or through cells at, for cells low to high - 1 along the next two axes. */
typedef struct slit_piece {
    int axis;
    int32_t at, low[2], high[2];
    bool through;
    bool tip_open; /* of one through cells: its elements are parted from the cells beside it, too */
} slit_piece;

typedef struct slit {
    const char *name;
    slit_piece piece[4]; /* up to the first that is of no size */
    bool thin;           /* for a block of one cell along y, whose nodes are in 8 elements at most even so */
} slit;

/* Slits of a block of 17 x 9 x 6 cells. */
enum { SLITS = 7 };
static const slit slits[SLITS] = {
    {"a half slit", {{0, 9, {0, 0}, {5, 6}, false, false}}, false},
    {"a slit at the border of bricks", {{1, 4, {0, 3}, {6, 14}, false, false}}, false},
    {"a slit all through", {{2, 3, {0, 0}, {17, 9}, false, false}}, false},
    {"crossing slits",
     {{0, 9, {0, 0}, {5, 6}, false, false},
      {1, 4, {0, 3}, {6, 14}, false, false},
      {2, 3, {5, 0}, {14, 9}, false, false}},
     false},
    {"a slit through cells", {{2, 3, {2, 0}, {9, 9}, true, true}}, false},
    {"several tips",
     {{0, 9, {2, 1}, {7, 3}, false, false},
      {0, 9, {2, 4}, {7, 5}, false, false},
      {0, 11, {0, 2}, {5, 6}, false, false},
      {2, 2, {12, 3}, {16, 7}, true, true}},
     false},
    {"a slit through cells that have nodes in common", {{2, 2, {2, 0}, {9, 1}, true, false}}, true}};

/* What new blocks have, or NULL. */
static const slit *in_slit;

typedef struct slit_mesh {
    int64_t nodes, elements;
    int32_t *cell;  /* elements: its cell, x fastest */
    int32_t *node;  /* elements x 8 */
    int32_t *place; /* nodes: its place, x fastest */
} slit_mesh;

static inline void *slit_memory(size_t count, size_t size)
{
    void *p = calloc(count ? count : 1, size);
    if (!p) {
        printf("Bail out! no memory\n");
        exit(1);
    }
    return p;
}

static inline bool slit_has(const slit_piece *s, const int32_t cell[3])
{
    for (int a = 0; a < 2; a++) {
        const int32_t at = cell[(s->axis + 1 + a) % 3];
        if (at < s->low[a] || at >= s->high[a])
            return false;
    }
    return true;
}

static inline bool slit_ends(const slit_piece *s)
{
    return s->high[0] <= s->low[0];
}

/* Whether a cell is two elements; *tip_open: parted from those beside it. */
static inline const slit_piece *slit_through(const slit *s, const int32_t cell[3])
{
    for (int i = 0; i < 4 && !slit_ends(&s->piece[i]); i++)
        if (s->piece[i].through && cell[s->piece[i].axis] == s->piece[i].at && slit_has(&s->piece[i], cell))
            return &s->piece[i];
    return NULL;
}

/* Whether half `low` of a cell, or all of it, hangs together with half `high` of the next along an axis. */
static inline bool slit_joins(const slit *s, const int32_t cell[3], int low, const int32_t next[3], int high, int axis)
{
    const slit_piece *here = slit_through(s, cell), *there = slit_through(s, next);
    for (int i = 0; i < 4 && !slit_ends(&s->piece[i]); i++)
        if (!s->piece[i].through && axis == s->piece[i].axis && next[axis] == s->piece[i].at &&
            slit_has(&s->piece[i], next))
            return false;
    if (here && here->axis == axis)
        return low == 1;
    if (there && there->axis == axis)
        return high == 0;
    if (here && there)
        return low == high;
    return !(here && here->tip_open) && !(there && there->tip_open);
}

static inline int32_t slit_root(int32_t *of, int32_t i)
{
    while (of[i] != i)
        i = of[i] = of[of[i]];
    return i;
}

/* Corner c of one element is corner d of another. */
static inline void slit_join(int32_t *of, int32_t a, int32_t b)
{
    a = slit_root(of, a), b = slit_root(of, b);
    of[a > b ? a : b] = a > b ? b : a;
}

static inline int slit_corner(const int32_t offset[3])
{
    for (int c = 0; c < 8; c++)
        if (!memcmp(lattice_vtk[c], offset, sizeof lattice_vtk[c]))
            return c;
    return -1;
}

static inline void slit_join_faces(int32_t *of, int32_t low, int32_t high, int axis)
{
    for (int c = 0; c < 8; c++) {
        int32_t offset[3] = {lattice_vtk[c][0], lattice_vtk[c][1], lattice_vtk[c][2]};
        if (!offset[axis])
            continue;
        offset[axis] = 0;
        slit_join(of, 8 * low + c, 8 * high + slit_corner(offset));
    }
}

/* Numbers the nodes by place, copies by the first of their elements. */
static inline void slit_number(slit_mesh *m, const int32_t cells[3], int32_t *of)
{
    const int32_t gx = cells[0] + 1, gy = cells[1] + 1, places = gx * gy * (cells[2] + 1);
    int32_t *start = slit_memory((size_t)places + 1, sizeof *start), *at = slit_memory(8 * (size_t)m->elements, 4);
    int32_t *which = slit_memory(8 * (size_t)m->elements, sizeof *which);
    for (int64_t i = 0; i < 8 * m->elements; i++) {
        const int32_t c = m->cell[i / 8], *o = lattice_vtk[i % 8];
        at[i] = c % cells[0] + o[0] + gx * (c / cells[0] % cells[1] + o[1] + gy * (c / cells[0] / cells[1] + o[2]));
        start[at[i] + 1] += slit_root(of, (int32_t)i) == i;
    }
    for (int32_t k = 0; k < places; k++)
        start[k + 1] += start[k];
    m->nodes = start[places];
    m->place = slit_memory((size_t)m->nodes, sizeof *m->place);
    for (int64_t i = 0; i < 8 * m->elements; i++) {
        const int32_t root = slit_root(of, (int32_t)i);
        if (root == i) {
            which[i] = start[at[i]]++;
            m->place[which[i]] = at[i];
        }
        m->node[i] = which[root];
    }
    free(start);
    free(at);
    free(which);
}

static inline void slit_make(slit_mesh *m, const slit *s, const int32_t cells[3])
{
    const int32_t all = cells[0] * cells[1] * cells[2];
    int32_t *first = slit_memory((size_t)all + 1, sizeof *first);
    for (int32_t i = 0; i < all; i++) {
        const int32_t at[3] = {i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1]};
        first[i + 1] = first[i] + 1 + (slit_through(s, at) != NULL);
    }
    m->elements = first[all];
    m->cell = slit_memory((size_t)m->elements, sizeof *m->cell);
    m->node = slit_memory(8 * (size_t)m->elements, sizeof *m->node);
    int32_t *of = slit_memory(8 * (size_t)m->elements, sizeof *of);
    for (int32_t i = 0; i < 8 * m->elements; i++)
        of[i] = i;
    for (int32_t i = 0; i < all; i++) {
        const int32_t at[3] = {i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1]};
        const int32_t step[3] = {1, cells[0], cells[0] * cells[1]};
        for (int32_t k = first[i]; k < first[i + 1]; k++)
            m->cell[k] = i;
        for (int axis = 0; axis < 3; axis++) {
            int32_t next[3] = {at[0], at[1], at[2]};
            if (++next[axis] == cells[axis])
                continue;
            const int32_t other = i + step[axis];
            for (int32_t k = first[i]; k < first[i + 1]; k++)
                for (int32_t n = first[other]; n < first[other + 1]; n++)
                    if (slit_joins(s, at, k - first[i], next, n - first[other], axis))
                        slit_join_faces(of, k, n, axis);
        }
    }
    slit_number(m, cells, of);
    free(first);
    free(of);
}

static inline void slit_free(slit_mesh *m)
{
    free(m->cell);
    free(m->node);
    free(m->place);
    memset(m, 0, sizeof *m);
}

#endif
