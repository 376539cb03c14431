/* Tetrahedra side by side, LANES to a group, as the loops of lanes.h take them for the stable neo-Hookean law
 * (msds/problem/stable.h), and how their forces go to nodes. In single precision, but for what is made once.
 *
 * In a lattice, elements of one shape follow each other as the solver's nodes do, so that both their corners and, for a
 * slice of nodes, what pulls these are loaded in a row:
 *
 *     nodes      | 40 41 42 43 44 45 46 47 | 48 ...     corner c of elements 16 to 23
 *     elements       16 17 18 19 20 21 22 | 23 ...      stands at nodes 41 to 48
 *
 * Each element pulls its corners (force), and has a volume that changes (swollen); nodes and points of pressure sum
 * these by lists of where they stand, in one order. The points of pressure are the nodes, once for each material about
 * them: the mean of J about a point has a pressure of its own, which the elements there share. The creator owns it.
 */
#ifndef SINEW_TISSUE_MESH_H
#define SINEW_TISSUE_MESH_H

#include "msds/cpu/tissue_sums.h"
#include "msds/problem/sell.h"

enum { TISSUE_CHUNK = 32 /* groups that a thread takes at a time; results do not depend on it */ };

typedef struct tissue_mesh {
    int64_t groups, points; /* points: of pressure, filled up to slices; 0: none, as no law needs them */
    int64_t lumens, walls;  /* groups from there on are elements of cavities, and triangles of their walls */
    int32_t cavity_point;   /* the point of the first cavity; those of others follow */
    int32_t *first;         /* groups x 4: where lane 0's corner stands, if the others', and all points, follow; else
                               SELL_SCATTERED */
    int32_t *node;          /* groups x 4 x LANES: corners, in the solver's order */
    int32_t *point;         /* groups x 4 x LANES */
    int32_t *first_point;   /* groups x 4: where lane 0's point stands */
    int64_t *shape;         /* groups + 1: where the gradients of each begin in: */
    float *gradient;   /* 1/m, of corners 1 to 3: 9 for a group of one shape, else 9 x LANES; walls: tissue_walls.h */
    float *volume;     /* groups x LANES, m3; of walls: areas, m2 */
    float *mu, *kappa; /* groups x LANES, Pa: the law's; of lumens kappa is how hard thin elements are; of walls mu is
                               Young's modulus times thickness, N/m */
    float *prestress;  /* groups x 6 x LANES, Pa (walls: N/m): elements 11, 22, 33, 12, 13, 23 (walls: 11, 22, 12) of
                               the second Piola-Kirchhoff stress at rest; NULL: none */
    float *bulk;       /* points: what pressure changes by, over how the volume about them does, Pa/m3 */
    float *keep;       /* points: what part of a pressure is held (tissue.h) */
    float *inverse;    /* nodes: 1 over the diagonal of the stiffness at rest, m/N; 0 where fixed; those of cavities: as
                       tissue_walls_brace leaves it */
    float *within;     /* (walls - lumens) x 4 x LANES: 1 for corners within a cavity, 0 on its wall */
    float *at_rest;    /* nodes: the same at rest; NULL where there are no cavities */
    tissue_sums corners; /* by nodes, into force */
    tissue_sums swells;  /* by points, into swollen */
    float *g;            /* groups x 9 x LANES: the displacement's derivatives */
    float *law;          /* groups x STABLE_NUMBERS x LANES: what the tangent has there (stable.h) */
    float *counted;      /* groups x LANES: how much of an element counts about points (stable.h) */
    int64_t stride;      /* (groups + 1) x LANES; the last LANES are 0: */
    float *force;        /* 12 x stride, N: components of corners, corner by corner */
    float *swollen; /* stride, m3: what the volume changed by; of tissue a quarter of it, as it counts; of walls what
                            they sweep along a way */
    float *held, *pressure; /* points, Pa */
    float *pressed;         /* points, Pa: what that changes by along a direction */
} tissue_mesh;

/* Makes m (zeroed) of the problem's tetrahedra. -1 with e filled, and to be freed all the same. */
int tissue_mesh_make(tissue_mesh *m, const msds_problem *p, const sell *s, err *e);
void tissue_mesh_free(tissue_mesh *m);
int64_t tissue_mesh_bytes(const tissue_mesh *m);

#endif
