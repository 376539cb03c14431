/* The maths of a form, chosen by its name: H = grad u and the form's coefficients give energy, stress and tangent.
 * Steppers give a form that is a constant, so that nothing is chosen while they run; others may give a variable. Owns
 * nothing.
 */
#ifndef SINEW_FORM_MATHS_H
#define SINEW_FORM_MATHS_H

#include "physics/form_first.h"
#include "physics/form_mooney_rivlin.h"
#include "physics/form_neo_hookean.h"
#include "physics/forms.h"

#ifdef ELEMENT_FORCES_ALONE /* numbers without bits have no powers: nothing is known of the form that takes them */
ELEMENT_FUNCTION element_tensor form_general_stress(element_tensor h, const real *c)
{
    const real none = R(NAN);
    const element_tensor p = {none, none, none, none, none, none, none, none, none};
    (void)h, (void)c;
    return p;
}

ELEMENT_FUNCTION real form_general_energy(element_tensor h, const real *c)
{
    (void)h, (void)c;
    return R(NAN);
}

enum { FORM_GENERAL_STIFFENS = 1 };
ELEMENT_FUNCTION form_shear form_general_sheared(real x, const real *c)
{
    const form_shear none = {R(NAN), R(NAN), R(NAN)};
    (void)x, (void)c;
    return none;
}
#else
#include "physics/form_general.h"
#endif

/* P (Pa), the first Piola-Kirchhoff stress. c: the form's coefficients. */
ELEMENT_FUNCTION element_tensor form_stress(form f, element_tensor h, const real *c)
{
    const element_tensor none = {REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO,
                                 REAL_ZERO, REAL_ZERO, REAL_ZERO, REAL_ZERO};
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_stress(h, c);
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return none;
    }
#undef FORM_CASE
}

/* W, by volume at rest (J/m3). */
ELEMENT_FUNCTION real form_energy(form f, element_tensor h, const real *c)
{
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_energy(h, c);
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return REAL_ZERO;
    }
#undef FORM_CASE
}

/* Returns whether the shear stiffness of the form depends on the state. */
ELEMENT_FUNCTION int form_stiffens(form f)
{
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return FORM_##NAME##_STIFFENS;
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return 0;
    }
#undef FORM_CASE
}

ELEMENT_FUNCTION form_shear form_sheared_alone(form f, real x, const real *c)
{
    const form_shear none = {REAL_ZERO, REAL_ZERO, REAL_ZERO};
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_sheared(x, c);
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return none;
    }
#undef FORM_CASE
}

/* Its shear stiffness at x = I1bar - 3. Of coefficients without any, those of a law whose shear is that of fibres, it
 * is a constant 1: hourglass control does not follow fibres. */
ELEMENT_FUNCTION form_shear form_sheared(form f, real x, const real *c)
{
    form_shear t = form_sheared_alone(f, x, c);
    t.now = REAL_SELECT(t.rest > 0, t.now, REAL_ZERO + 1);
    t.rest = REAL_SELECT(t.rest > 0, t.rest, REAL_ZERO + 1);
    return t;
}

#ifdef REAL_IS_DOUBLE
/* d2T/dx2 of form_shear.h, Pa. */
ELEMENT_FUNCTION double form_sheared_curve(form f, double x, const double *c)
{
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_sheared_curve(x, c);
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return 0;
    }
#undef FORM_CASE
}

/* The lower triangle of A = dP/dF as a 9 x 9 matrix. */
ELEMENT_FUNCTION void form_tangent(form f, element_tensor h, const double *c, double a[9][9])
{
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        form_##name##_tangent(h, c, a);                                                                                \
        break;
    switch (f) {
        FORMS(FORM_CASE)
    default: /* of none: nothing */
        for (int i = 0; i < 81; i++)
            a[i / 9][i % 9] = 0;
        break;
    }
#undef FORM_CASE
}

/* Adds A y to *to; square: G:y, G = cof F. Returns no less than z:(A z) of any z of length 1 with G:z = 0;
 * this bound may count on the ranges of the keys (c01 >= 0). */
ELEMENT_FUNCTION double form_along(form f, element_tensor h, const double *c, element_tensor y, double square,
                                   element_tensor *to)
{
#define FORM_CASE(NAME, name, coefficients, exponents, history)                                                        \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_along(h, c, y, square, to);
    switch (f) {
        FORMS(FORM_CASE)
    default:
        return 0;
    }
#undef FORM_CASE
}
#endif

#endif
