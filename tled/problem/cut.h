/* Elements that a surface cuts, of a model that has their moments (mesh/cut_moments.h): their forces are by the mean
 * strain of what is enclosed (physics/element_cut.h) and by its share; so is the body force, by exact weights, the
 * means of the corners' shape functions over it,
 *     N_a = (1 + x_a x + ... + x_a y_a xy + ... + x_a y_a z_a xyz)/8,
 * x_a, y_a and z_a the signs of corner a. Each corner has an eighth of the mass, by the share: mass by these weights
 * would leave some nodes with next to none, and no step would be stable. What fills less than CUT_LEAST of its box has
 * the mass of so much, for the stable step (stability_cut.h), and as a probe and pressures push nodes.
 *
 * And elements that a border parts, as laminates of their two volumes, of a model that has their borders
 * (element_laminate.h, stability_laminate.h). Owns nothing but what the problem does.
 */
#ifndef SINEW_CUT_H
#define SINEW_CUT_H

#include "physics/stability_laminate.h"
#include "tled/problem/state.h"
#include "tled/problem/step.h"

/* By what part of a whole box's mass an element moves: its share; if it is cut, at least CUT_LEAST. */
double cut_inertia(const tled_problem *p, int64_t element);

/* Its mass, kg; and what its forces go by over what its mass does, at most 1; of a share that no films take from. */
double cut_mass(const tled_problem *p, int64_t element);
double cut_lighter_of(const tled_problem *p, int64_t element);
ELEMENT_FUNCTION double cut_lighter(double share)
{
    return share < CUT_LEAST ? share / CUT_LEAST : 1;
}

/* Makes p->cut and, where any element is cut or has films, p->weight; the latter needs the laws. -1 with e filled. */
int cut_borrow(tled_problem *p, const model *m, err *e);
int cut_weigh(tled_problem *p, err *e);

/* How many have more mass than their share. */
int64_t cut_least(const tled_problem *p);

/* From what is known of the whole box: its matrix, and what hourglass modes add. moments: of the element. */
void cut_matrix(const tled_problem *p, int64_t element, const float *moments, step_matrix *a);
stability_twists cut_twists(const tled_problem *p, int64_t element, const float *moments, stability_twists whole);

/* No less than the largest factor by which the part's strain raises the square of a frequency. */
double cut_raises(const tled_problem *p, int64_t element, const float *moments);

/* ---- laminates */

/* A laminate's parts: the coefficients of each by its share of the element, and what is between (tled_law_of). */
typedef struct border_parts {
    element_laminate l;
    double c[2][FORM_NUMBERS];
    element_law law;
} border_parts;

/* Makes p->borders and p->border, of elements whose cuts are known. -1 with e filled. */
int border_borrow(tled_problem *p, const model *m, err *e);

/* numbers: tled_border's. */
border_parts border_parts_of(const tled_problem *p, int64_t element, const double *numbers);

/* Scales the parts by a share of the element, as its forces are. */
border_parts border_parts_by(border_parts parts, const tled_problem *p, double share);

/* At given modes; parts' law becomes what is at the mean F, as of laminate_held. */
laminate_state border_state(const tled_problem *p, border_parts *parts, element_modes x, element_modes y,
                            element_modes z, element_shape box);

/* Whether the parts' F can be, and a was found to a tenth. */
bool border_is_found(const laminate_state *is);

/* No less than the square of the highest frequency; where that is below `highest`, perhaps much more. rest: the
 * coefficients at the mean F (parts' law and what it stiffens by); t: as of a whole element at the mean F. */
double border_square(const tled_problem *p, int64_t element, const border_parts *parts, const laminate_state *is,
                     const double *rest, double density, const step_fibres *fibres, stability_twists t, double highest);

/* Likewise at rest, without muscles. */
double border_square_at_rest(const tled_problem *p, int64_t element, const double *numbers, const step_fibres *fibres,
                             double highest);

#endif
