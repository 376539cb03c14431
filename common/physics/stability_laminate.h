/* The stable step of a box that a border parts into two materials (element_laminate.h). Its energy is the least by a,
 * so its stiffness, K_uu - K_ua K_aa^-1 K_au, is no more than with a kept, where the parts lie side by side:
 *     K_uu = the first part's + the second's + what is found at the mean F.
 * The largest eigenvalue of a sum is at most the sum of the largest: of a part those of L^T A L, with its own moments
 * (stability_cut.h), and with its own F and its share of the law. Fibres, and what hourglass control that follows the
 * law adds to it, are at the mean F; so are twists. Where the box is cut, forces go by its share and mass by its
 * inertia, as there. In double. Owns nothing. */
#ifndef SINEW_STABILITY_LAMINATE_H
#define SINEW_STABILITY_LAMINATE_H

#include "physics/element_laminate.h"
#include "physics/stability_cut.h"

/* The matrices of the parts and of what is at the mean F. */
typedef struct stability_laminate {
    step_matrix part[2], rest;
} stability_laminate;

/* first, second: the parts' coefficients, by their shares; rest: those at the mean F, of no moduli but what stability_
 * stiffen adds. density: of the whole, kg/m3. by: share over inertia. */
ELEMENT_FUNCTION void stability_laminate_matrices(form f, const laminate_state *is, const element_laminate *l,
                                                  const double *first, const double *second, const double *rest,
                                                  double density, const double side[3], element_fibre fibre,
                                                  element_fibre other, const fibre_set *sets, int count, double by,
                                                  stability_laminate *to)
{
    const element_fibre none = {.tension = 0};
    stability_matrix(f, first, density, side, is->h1, none, none, &to->part[0]);
    stability_matrix(f, second, density, side, is->h2, none, none, &to->part[1]);
    stability_cut_matrix(laminate_first(l), by, &to->part[0]);
    stability_cut_matrix(l->second, by, &to->part[1]);
    stability_matrix_fibred(f, rest, density, side, is->h, fibre, other, sets, count, &to->rest);
    stability_cut_matrix(l->whole, by, &to->rest);
}

/* No less than the square of the highest frequency; twists: of the box, cut as it is, at the mean F. */
ELEMENT_FUNCTION double stability_laminate_square(const stability_laminate *m, stability_twists t)
{
    return stability_largest(&m->part[0]) + stability_largest(&m->part[1]) + stability_largest(&m->rest) + t.own +
           t.more;
}

/* The same at less cost, and less near. */
ELEMENT_FUNCTION double stability_laminate_bound(const stability_laminate *m, stability_twists t)
{
    return stability_bound(&m->part[0]) + stability_bound(&m->part[1]) + stability_bound(&m->rest) + t.own + t.more;
}

#endif
