/* Finds the cuts of slits: pairs of neighbouring samples along an axis between which the surfaces of level 0 leave it
 * and enter it again. Both of such a pair may be inside, and still nothing joins them. Samples are the centres of
 * voxels, or the N^3 parts of each. Crossings are exact (crossing.h), so that a slit without any width is one too; of
 * several volumes of level 0, those that are closer than a twentieth of a voxel touch. The caller owns a cuts.
 */
#ifndef SINEW_CUTS_H
#define SINEW_CUTS_H

#include "base/pool.h"
#include "voxelise/inside.h"

/* A cut from a sample of a voxel to the next along an axis, which may be in the next voxel. */
typedef struct cuts_cut {
    int32_t cell[3]; /* the voxel of the first sample */
    uint16_t sample; /* in it: (z N + y) N + x */
    uint8_t axis;
} cuts_cut;

typedef struct cuts {
    cuts_cut *cut; /* by cell (k, j, i), then axis, then sample; each once */
    int64_t count, capacity;
} cuts;

/* t: the triangles of level 0. g: the lattice of samples, `samples` of them along each side of a voxel. The same for
 * any number of threads. -1 with e filled on no memory. */
int cuts_find(cuts *c, const inside_triangles *t, const grid *g, int samples, pool *threads, err *e);
void cuts_free(cuts *c);

/* The cuts from the first whose cell is not before this one (k, j, i) on: its index. */
int64_t cuts_from(const cuts *c, const int32_t *cell);

/* -1, 0 or 1: cell a comes before b, is it, or comes after it. */
static inline int cuts_order(const int32_t *a, const int32_t *b)
{
    for (int i = 2; i >= 0; i--)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

/* Of volumes, in voxels: what lies nearer touches. */
#define CUTS_TOUCHING .05

#endif
