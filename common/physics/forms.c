#include "physics/form_maths.h"

int form_numbers(form f)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history) (coefficients),
    static const int numbers[FORM_COUNT] = {FORMS(FORM_ROW)[FORM_LINEAR] = 2};
#undef FORM_ROW
    return numbers[f];
}

int form_moduli(form f)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history) (coefficients) - (exponents),
    static const int moduli[FORM_COUNT] = {FORMS(FORM_ROW)[FORM_LINEAR] = 2};
#undef FORM_ROW
    return moduli[f];
}

static int express(form from, form target, const double *c, double *to)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        return form_##name##_express(from, c, to);
    switch (target) {
        FORMS(FORM_ROW)
    default:
        return 0;
    }
#undef FORM_ROW
}

int form_express(form from, form target, const double *c, double *to)
{
    memset(to, 0, FORM_NUMBERS * sizeof *to);
    if (from != target)
        return express(from, target, c, to);
    memcpy(to, c, (size_t)form_numbers(from) * sizeof *to);
    return 1;
}

form form_of_both(form a, const double *ca, form b, const double *cb, double *to_a, double *to_b)
{
    for (int f = 0; f < FORM_COUNT; f++)
        if (form_express(a, (form)f, ca, to_a) && form_express(b, (form)f, cb, to_b))
            return (form)f;
    return FORM_COUNT;
}

void form_between(form f, double mu, double bulk, const double *a, const double *b, double share, double *to)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        form_##name##_between(mu, bulk, a, b, share, to);                                                              \
        break;
    memset(to, 0, FORM_NUMBERS * sizeof *to);
    switch (f) {
        FORMS(FORM_ROW)
    default: /* FORM_LINEAR */
        to[0] = mu, to[1] = bulk;
        break;
    }
#undef FORM_ROW
}
