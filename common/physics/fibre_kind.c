#include "physics/fibre_kind.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BIT(key) (1U << (LAW_##key - LAW_FIBRE_KEYS_FIRST))
#define AT(key)  (value[LAW_##key - LAW_FIBRE_KEYS_FIRST])

const char fibre_kind_none[] = "none";

static double or_none(double x)
{
    return isnan(x) ? 0 : x;
}

static void fill_angle(const double *value, fibre_numbers *to)
{
    to->angle = or_none(AT(angle)) * (3.14159265358979323846 / 180);
}

static void fill_quadratic(const double *value, fibre_numbers *to)
{
    to->k1 = AT(eta);
    fill_angle(value, to);
}

static void fill_hgo(const double *value, fibre_numbers *to)
{
    to->k1 = AT(k1);
    to->k2 = AT(k2);
    to->kappa = or_none(AT(kappa));
    fill_angle(value, to);
}

static const fibre_kind rows[] = {
    {.name = "quadratic",
     .needs = BIT(eta),
     .takes = BIT(eta) | BIT(angle),
     .fill = fill_quadratic,
     .meaning = "Fibres whose stress grows as their length does.",
     .energy = "eta/2 (I4 - 1)^2 where I4 > 1",
     .source = "the standard reinforcing model, as of Qiu and Pence 1997"},
    {.name = "hgo",
     .needs = BIT(k1) | BIT(k2),
     .takes = BIT(k1) | BIT(k2) | BIT(kappa) | BIT(angle),
     .fill = fill_hgo,
     .meaning = "Fibres of collagen, which are wavy at rest and stiffen as they are stretched.",
     .energy = "k1/(2 k2) (exp(k2 Ebar^2) - 1) where Ebar > 0,  Ebar = kappa (tr C - 3) + (1 - 3 kappa) (I4 - 1)",
     .source = "Holzapfel, Gasser and Ogden 2000; kappa: Gasser, Ogden and Holzapfel 2006"},
};

enum { ROWS = sizeof rows / sizeof *rows };
_Static_assert((int)ROWS < (int)FIBRE_KIND_MOST, "FIBRE_KIND_MOST is too low");

const fibre_kind *fibre_kind_at(int i)
{
    return i >= 0 && i < ROWS ? &rows[i] : NULL;
}

const fibre_kind *fibre_kind_find(const char *name)
{
    for (int i = 0; i < ROWS; i++)
        if (!strcmp(rows[i].name, name))
            return &rows[i];
    return NULL;
}

int fibre_kind_names(const char *to[FIBRE_KIND_MOST])
{
    to[0] = fibre_kind_none;
    for (int i = 0; i < ROWS; i++)
        to[i + 1] = rows[i].name;
    return ROWS + 1;
}

bool fibre_kind_takes(const fibre_kind *of, int key)
{
    return of && key >= LAW_FIBRE_KEYS_FIRST && of->takes >> (key - LAW_FIBRE_KEYS_FIRST) & 1;
}

void fibre_kind_words(unsigned keys, char to[LAW_WORDS])
{
    to[0] = '\0';
    for (int k = 0; k < LAW_FIBRE_KEYS_COUNT; k++) {
        const size_t at = strlen(to);
        if (keys >> k & 1)
            snprintf(to + at, LAW_WORDS - at, "%s%s", at ? ", " : "",
                     law_key_name((law_key)(LAW_FIBRE_KEYS_FIRST + k)));
    }
}
