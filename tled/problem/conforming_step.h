/* The stable step of elements that are not boxes of a lattice, and their shapes for monitors and reports (in double:
 * see stability.h).
 *
 * The squares of an element's frequencies are no more than those of two matrices together: (8/rho) L^T A L, A = dP/dF
 * and L L^T = B B^T (3 x 3), with what stretches it, and (8/(rho V)) R^T D R, R R^T = gamma gamma^T (4 x 4), with what
 * twists it, D = d2W/dq dq of the hourglass energy. With l1, l2 the largest of each and c the cosine of the least angle
 * between B's rows and the gammas (0 of a box), the largest of their sum is at most that of l1 P1 + l2 P2, P1 and P2
 * projections at that angle:
 *     (l1 + l2 + sqrt((l1 - l2)^2 + 4 c^2 l1 l2)) / 2.
 * Deformed, stability.h's bounds of hourglass modes hold with R^-1 m, which is no longer than u, in place of m, and
 * with R^T D R in place of D: R acts on modes and F on components, so the two commute. As |R^-1 q| <= |q|/g, g^2 the
 * smallest eigenvalue of R R^T, and |dF| <= |L| |u|, the largest 1/(4 h) of a box becomes l = |L|/g. Owns nothing.
 */
#ifndef SINEW_CONFORMING_STEP_H
#define SINEW_CONFORMING_STEP_H

#include "physics/element_any.h"
#include "tled/problem/conforming.h"
#include "tled/problem/step.h"

/* Once the volumes have their laws: the hourglass stiffnesses and the stable step. */
void conforming_join(tled_problem *p);

/* element_any of double numbers. */
element_any conforming_shape(const tled_problem *p, int64_t element, const conforming_hold *hold);

/* The first of the two matrices above, for an element of a law at H that is pulled along its fibre. */
void conforming_matrix(const tled_problem *p, int64_t element, const tled_law *law, element_tensor h,
                       element_fibre fibre, step_matrix *a);

/* What its hourglass modes m (twisted) have, at H; s: how control follows the law there. */
stability_twists conforming_twists(const tled_problem *p, int64_t element, element_tensor h, const hourglass_modes *m,
                                   stability_stiffening s);

/* What its largest eigenvalue may be, so that the square of the element's highest frequency is at most limit; and
 * the other way round: what that is at most with an eigenvalue. */
double conforming_room(const tled_problem *p, int64_t element, stability_twists t, double limit);
double conforming_square(const tled_problem *p, int64_t element, stability_twists t, double eigenvalue);

#endif
