/* The forms of strain energy that steppers are compiled for. A form is a header, form_NAME.h, with its energy, stress
 * and tangent as functions of H = grad u and its coefficients; form_maths.h chooses among them, by a form that steppers
 * know when they are compiled. A law of tissue gives a form its coefficients. Owns nothing.
 */
#ifndef SINEW_FORMS_H
#define SINEW_FORMS_H

/* A row: X(with, NAME, name, coefficients, how many of them are exponents, numbers of history an element). The
 * exponents are the last of a form's coefficients; in the others, moduli (Pa), its energy is linear. First the forms
 * that others can express: a model runs in the first form that expresses all its laws. Nothing else lists the forms:
 * the Makefile, the steppers, the kernels and messages take them from here. */
#define FORMS_WITH(X, with)                                                                                            \
    X(with, NEO_HOOKEAN, neo_hookean, 2, 0, 0)                                                                         \
    X(with, MOONEY_RIVLIN, mooney_rivlin, 3, 0, 0)                                                                     \
    X(with, FIRST, first, 6, 0, 0)                                                                                     \
    X(with, GENERAL, general, 23, 8, 0)
#define FORMS_ALONE(X, NAME, name, coefficients, exponents, history) X(NAME, name, coefficients, exponents, history)
#define FORMS(X)                                                     FORMS_WITH(FORMS_ALONE, X)

#define FORM_ROW(NAME, name, coefficients, exponents, history) FORM_##NAME,
/* FORM_STEPPED: how many steppers are compiled for. Linear elasticity, of coefficients mu and K, is msds-run's, which
 * has a matrix of it. */
typedef enum form { FORMS(FORM_ROW) FORM_STEPPED, FORM_LINEAR = FORM_STEPPED, FORM_COUNT } form;
#undef FORM_ROW

#define FORM_ROW(NAME, name, coefficients, exponents, history) char name[coefficients];
union form_most {
    FORMS(FORM_ROW)
};
#undef FORM_ROW
enum { FORM_NUMBERS = sizeof(union form_most) }; /* the most coefficients of any form */

/* How many coefficients a form has, as constants, and how many of them are moduli: FORM_NEO_HOOKEAN_NUMBERS,
 * FORM_NEO_HOOKEAN_MODULI and so on. */
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    FORM_##NAME##_NUMBERS = (coefficients), FORM_##NAME##_MODULI = (coefficients) - (exponents),
enum { FORMS(FORM_ROW) };
#undef FORM_ROW

/* How many coefficients a form has, and how many of them, the first ones, are moduli. */
int form_numbers(form f);
int form_moduli(form f);

/* The coefficients in form `target` of what c says in form `from`; both of FORM_NUMBERS, 0 where a form has fewer.
 * False: that form does not express it. */
int form_express(form from, form target, const double *c, double *to);

/* The first form that expresses both, with the coefficients of each; FORM_COUNT: none does. */
form form_of_both(form a, const double *ca, form b, const double *cb, double *to_a, double *to_b);

/* The coefficients of what lies between a and b, both of form f, with the moduli mu and bulk at rest (Pa). share:
 * of b. */
void form_between(form f, double mu, double bulk, const double *a, const double *b, double share, double *to);

#endif
