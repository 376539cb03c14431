/* Modified proportioning with reduced gradient projections (MPRGP; Dostal & Schoberl 2005, Computational Optimization
 * and Applications 30:23; Gamma = 1), for forces of contact: the minimum of x.S x / 2 - w.x over x >= 0, by products
 * with S alone, which is symmetric and positive definite. Conjugate gradients go over the components above 0. Where one
 * comes to 0, that and the others which the step would lead below 0 are held there (the projected step of Kruzik,
 * Horak, Cermak, Pospisil & Pecha 2020, Active set expansion strategies in MPRGP algorithm); where what is left pulls
 * more on components that are held than on the others, those are let go. tissue.c does the same with planes as bounds
 * of displacements, in the order of its fields, and where S changes and need not be positive. The creator owns it; it
 * takes no memory after it is made.
 */
#ifndef SINEW_MPRGP_H
#define SINEW_MPRGP_H

#include "base/err.h"

typedef struct mprgp {
    int64_t count;
    double *x;       /* count: from where it begins, to the minimum */
    double *g;       /* S x - w, at first of the x to begin from */
    double *inverse; /* what stands for the inverse of S's diagonal, above 0 */
    double *way, *product, *move;
    /* product = S way. */
    void (*multiply)(void *context, const double *way, double *product);
    void (*tell)(void *context, double share); /* how far it has come, 0 to 1, before each product */
    void *context;
} mprgp;

/* Of at most so many components. m is zeroed. -1 with e filled, and to be freed all the same. */
int mprgp_make(mprgp *m, int64_t most, err *e);
void mprgp_free(mprgp *m);

/* The most that a component is off: |g| where x is above 0, -g where it is 0 and g is below. */
double mprgp_off(const mprgp *m);

/* Makes x longer or shorter, and g with it, to the least on the way through 0 and x: a good guess where what presses
 * goes deeper and touches what it touched. Takes a product. */
void mprgp_scale(mprgp *m);

/* Fills x and g, until mprgp_off is no more than `least`, or after so many products. Returns how many it took. */
int64_t mprgp_solve(mprgp *m, double least, int64_t most);

#endif
