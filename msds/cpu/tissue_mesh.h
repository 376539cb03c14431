/* Tetrahedra in groups of LANES, side by side, as the loops of lanes.h take them for the stable neo-Hookean law
 * (msds/problem/stable.h), and how their forces go to nodes. In single precision, but for what is made once.
 *
 * In a lattice, the corners of a group's elements mostly follow each other in the solver's order of nodes, so that they
 * are loaded in a row:
 *
 *     group i:  | corner 0: first ... first + 7 | corner 1: ... | corner 2 | corner 3 |
 *
 * Each element pulls its corners (force), and has a volume that changes (swollen); nodes and points of pressure sum
 * these by lists of where they stand, in one order. The points of pressure are the nodes, once for each material about
 * them: the mean of J about a point has a pressure of its own, which the elements there share. The creator owns it.
 */
#ifndef SINEW_TISSUE_MESH_H
#define SINEW_TISSUE_MESH_H

#include "msds/problem/sell.h"

enum { TISSUE_CHUNK = 32 /* groups that a thread takes at a time; results do not depend on it */ };

/* Sums of what stands in an array, eight to a slice: place `slot` of lane l is list[slot * LANES + l]. */
typedef struct tissue_sums {
    int64_t slices, slots;
    int64_t *start; /* slices + 1 */
    int32_t *list;  /* slots x LANES */
} tissue_sums;

typedef struct tissue_mesh {
    int64_t groups, points; /* points: of pressure, filled up to slices; 0: none, as no law needs them */
    int32_t *first;         /* groups x 4: where lane 0's corner stands, if the others' follow; else SELL_SCATTERED */
    int32_t *node;          /* groups x 4 x LANES: corners, in the solver's order */
    int32_t *point;         /* groups x 4 x LANES */
    float *gradient;        /* groups x 9 x LANES, 1/m: of corners 1 to 3; 0 where a lane has no element */
    float *volume;          /* groups x LANES, m3 */
    float *mu, *kappa;      /* groups x LANES, Pa: the law's */
    float *bulk;            /* points: what pressure changes by, over how the volume about them does, Pa/m3 */
    float *keep;            /* points: what part of a pressure is held (tissue.h) */
    float *inverse;         /* nodes: 1 over the diagonal of the stiffness at rest, m/N; 0 where fixed */
    tissue_sums corners;    /* by nodes, into force */
    tissue_sums swells;     /* by points, into swollen */
    float *g;               /* groups x 9 x LANES: the displacement's derivatives */
    float *force;           /* (groups + 1) x 12 x LANES, N: corner by corner; the last are 0 */
    float *counted;         /* groups x LANES: how much of an element counts about points (stable.h) */
    float *swollen;         /* (groups + 1) x LANES, m3: a quarter of what the volume changed by, as it counts; the last
                               are 0 */
    float *held, *pressure; /* points, Pa */
    float *pressed;         /* points, Pa: what that changes by along a direction */
} tissue_mesh;

/* Makes m (zeroed) of the problem's tetrahedra. -1 with e filled, and to be freed all the same. */
int tissue_mesh_make(tissue_mesh *m, const msds_problem *p, const sell *s, err *e);
void tissue_mesh_free(tissue_mesh *m);
int64_t tissue_mesh_bytes(const tissue_mesh *m);

#endif
