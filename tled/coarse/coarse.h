/* A coarser problem of the same tissue, from whose rest a run to rest may begin: the lattice with twice the spacing,
 * eight cells merged into one. A merged element has the share of tissue of its cells, and is mixed of the two volumes
 * that have most of it, with mean directions of their fibres; what holds or pushes nodes goes over to its nodes. Slits
 * are closed in it. Where its rest lies is not the finer problem's: it is good for a start, and, with loads of its own
 * besides, for corrections of the finer problem's displacements.
 *
 * The creator owns it; it borrows the finer problem, its model and its script.
 */
#ifndef SINEW_COARSE_H
#define SINEW_COARSE_H

#include "tled/problem/state.h"

typedef struct coarse {
    const tled_problem *fine;
    const int32_t *lattice; /* fine nodes x 3: places in the finer lattice, borrowed */
    int32_t low[3];         /* of its cells and nodes, in its own lattice */
    int64_t size[3];        /* cells */
    int32_t *cell;          /* size[2] x size[1] x size[0], i fastest: its element there, or -1 */
    int32_t *node;          /* likewise of size + 1: its node */
    int32_t *parent;        /* fine nodes x 8: coarse_parents */
    model m;
    script script; /* the finer one's without nodes and triangles, whose numbers it borrows but for curves and keys */
    int64_t own;   /* the first of three curves that it has besides: of 1, along x, y and z */
    tled_problem problem;
} coarse;

/* Why a problem has no coarser one, in words for a message; NULL: it has one. */
const char *coarse_lacks(const tled_problem *fine, const model *m);

/* Makes the coarser problem of one that coarse_lacks nothing for. NULL with e filled. */
coarse *coarse_make(const tled_problem *fine, const model *m, err *e);
void coarse_free(coarse *c);

/* The nodes that a finer node lies between, an eighth of it for each, one as often as it counts: rows of the coarser
 * problem's nodes. */
static inline const int32_t *coarse_parents(const coarse *c, int64_t n)
{
    return c->parent + 8 * n;
}

/* The finer nodes' displacements (m, nodes x 3) of the coarser ones, trilinear, and what the script displaces as it is
 * at `time` (s). -1 with e filled on no memory; 1: some element of the finer problem would be inverted at a corner. */
int coarse_prolong(const coarse *c, const double *from, double time, double *to, err *e);

/* Whether no element of the finer problem is inverted at a corner by these displacements (m, nodes x 3). */
bool coarse_is_upright(const coarse *c, const double *displacement);

/* A correction: coarser displacements, trilinear where the finer problem's nodes are free, else 0. */
void coarse_interpolate(const coarse *c, const double *from, double *to);

/* Its transpose: forces (N, nodes x 3) on finer nodes where they are free, on the coarser nodes that they lie between;
 * 0 where those are held. */
void coarse_restrict(const coarse *c, const double *from, double *to);

#endif
