/* Newton's method with conjugate gradients on stable neo-Hookean tetrahedra (msds/problem/stable.h): so many conjugate
 * gradients a frame, from the frame before, in single precision, by products with the tangent that no matrix stores
 * (tissue_mesh.h). Prescribed contact is a bound of each node near the probe: it stays outside of the plane that
 * touches the probe where the node would come out. Nodes that have to come out do so in the step, so that a line search
 * can spare elements what a long way would do.
 *
 * Of a tissue that hardly changes its volume, points have a bulk modulus k' of 20 mu at most, and the rest by a
 * pressure that is held from frame to frame (a proximal point method for the dual, Rockafellar 1976):
 * p = k' (J - 1) + (1 - k'/k) p0, where p0 is the p of the frame before. Where the two are the same, p = k (J - 1), so
 * that what comes to rest is right; and conjugate gradients and line searches never meet k. The creator owns it.
 */
#ifndef SINEW_TISSUE_H
#define SINEW_TISSUE_H

#include "msds/cpu/pressed.h"
#include "msds/cpu/tissue_mesh.h"

typedef struct tissue {
    tissue_mesh m;
    pressed pressed;
    const lanes *loops;
    pool *threads;
    lanes_field *u, *weight; /* the state's: m, N */
    lanes_field step, left, way, pulled;
    lanes_field started, first; /* u and left where a Newton step began */
    double moved;               /* J: what is left there times the way that nodes were moved */
    double *sum, *sums;         /* chunks; chunks x 3 */
    float alpha, beta;
    const lanes_field *along, *with; /* what loops work on */
    lanes_field *to;
    float *points;
    double square[3]; /* N2: of what is left, of gravity, of what the elements pull with */
    float *share;     /* nodes: of a step, for the while */
    double *pushed;   /* cavities, N2/Pa2: the square of what a unit of pressure pushes nodes with at rest */
    double residual;  /* what is left over the load or the pull, whichever is more */
} tissue;

/* -1 with e filled, and to be freed all the same. */
int tissue_make(tissue *t, const msds_problem *p, const sell *s, contacts *c, const lanes *loops, pool *threads,
                lanes_field *u, lanes_field *weight, err *e);
void tissue_free(tissue *t);
/* Holds no pressure: the tissue is at rest. */
void tissue_reset(tissue *t);
int64_t tissue_bytes(const tissue *t);

/* Begins a frame: holds the pressures of the one before, takes those of cavities, and finds what is left at u. elapsed:
 * s, that the frame takes; 0: not known, so that cavities have their pressure at once. */
void tissue_begin(tissue *t, double elapsed);

/* From there, a step of Newton's, of so many iterations at most, with the contacts listed: those near the probe, or,
 * for a penalty, those in it. Fills their forces. Returns how many iterations it took. */
int64_t tissue_step(tissue *t, int64_t most);

#endif
