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

/* Returns whether all moduli but one are 0: that one is K, of a law whose shear is that of fibres (law.h). */
static int only_bulk(form f, const double *c)
{
    int others = -1;
    for (int i = 0; i < form_moduli(f); i++)
        others += c[i] != 0;
    return !others;
}

/* Where one is such, energies but for that of K go by shares, as those of fibres do. */
static int between_by_shares(form f, double bulk, const double *a, const double *b, double share, double *to)
{
    const double *slack = only_bulk(f, a) ? a : b;
    if (!only_bulk(f, slack))
        return 0;
    for (int i = 0; i < form_moduli(f); i++)
        to[i] = slack[i] != 0 ? bulk : (1 - share) * a[i] + share * b[i];
    for (int i = form_moduli(f); i < form_numbers(f); i++)
        to[i] = a[i] + b[i]; /* exponents, of which the slack one has none */
    return 1;
}

void form_between(form f, double mu, double bulk, const double *a, const double *b, double share, double *to)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        form_##name##_between(mu, bulk, a, b, share, to);                                                              \
        break;
    memset(to, 0, FORM_NUMBERS * sizeof *to);
    if (between_by_shares(f, bulk, a, b, share, to))
        return;
    switch (f) {
        FORMS(FORM_ROW)
    default: /* FORM_LINEAR */
        to[0] = mu, to[1] = bulk;
        break;
    }
#undef FORM_ROW
}
