/* The stable time step of explicit central differences, dt <= 2/w, w the highest frequency of the model: bounded by
 * that of any one element with the mass that it brings (Irons). Owns nothing.
 *
 * For one element: its forces V P_kj B_aj are linear in H, and sum_a B_ai B_aj = delta_ij / (2 h_i^2), so with
 * m = rho V / 8 at each corner the squares of its frequencies are those of the 9 x 9 matrix
 *     (4/rho) A_kjlm / (h_j h_m),   A = dP/dF,
 * and, apart from them, of the hourglass modes (stability.h bounds what these add). At rest A is the elasticity C: the
 * largest eigenvalue of a cube is 12 K / (rho h^2), so dt = h / sqrt(3 K / rho). Deformed, A has the geometric
 * stiffness and the active stress in it.
 *
 * Of an element that a surface cuts, cut.h changes the matrix, and hourglass modes are counted with the law.
 *
 * Of an element mixed of two volumes what is found at rest is a bound from theirs, exact where both have the same nu;
 * where fibres resist being stretched it is exact of each element, with the fibres as they are when they are pulled.
 */
#ifndef SINEW_STEP_H
#define SINEW_STEP_H

#include "mesh/fibre_sets.h"
#include "physics/stability.h"
#include "tled/problem/state.h"

/* The stable step at rest, s: the least of all elements, with their films. *volume (may be NULL) gets whose. */
double step_at_rest(const tled_problem *p, int32_t *volume);

/* 1/s2, at rest: the square of the highest frequency of all elements; no less than that of one, with its whole mass. */
double step_elements_at_rest(const tled_problem *p, int32_t *volume);
double step_element_at_rest(const tled_problem *p, int64_t element);

/* Of the fibres of an element: how it is pulled along its fibre and along that of its second volume, and what resists
 * being stretched. */
typedef struct step_fibres {
    element_fibre own, other;
    fibre_sets sets;
} step_fibres;

/* value: of all curves; NULL: levels of 0. */
step_fibres step_fibres_of(const tled_problem *p, int64_t element, const double *value);

/* The matrix above for an element of a law at H. */
void step_matrix_of(const tled_problem *p, const tled_law *law, element_tensor h, const step_fibres *fibres,
                    step_matrix *a);

/* Between which its largest eigenvalue lies, without it; not finite where anything is not. */
stability_range step_range_of(const tled_problem *p, const tled_law *law, element_tensor h, const step_fibres *fibres);

/* Whether all its eigenvalues are below the limit; false where anything is not finite. */
bool step_below(const step_matrix *a, double limit);

/* Its largest eigenvalue to 1e-13, if that is positive; else 0. */
double step_largest(const step_matrix *a);

/* Steps between two checks: at most, and where the step is given. */
enum { STEP_UNSEEN = 200, STEP_UNSEEN_GIVEN = 50 };

/* The steps a second that are taken by default: at least twice what is just stable, and so many that a whole
 * number of them makes 1/100 s and so does a whole number of checks, at most STEP_UNSEEN steps apart. *check gets
 * the steps between checks. */
double step_rate(double stable, int64_t *check);

#endif
