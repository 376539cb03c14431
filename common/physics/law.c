#include "physics/law.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BIT(key) (1U << LAW_##key)

#define KEY_NAME(key, unit, low, high, meaning) #key,
#define KEY_UNIT(key, unit, low, high, meaning) unit,
static const char *const key_names[] = {LAW_KEYS(KEY_NAME) LAW_COMMON_KEYS(KEY_NAME)};
static const char *const key_units[] = {LAW_KEYS(KEY_UNIT) LAW_COMMON_KEYS(KEY_UNIT)};

/* K of mu and Poisson's ratio at rest. */
static double bulk_of(double mu, double nu)
{
    return 2 * mu * (1 + nu) / (3 * (1 - 2 * nu));
}

/* ---- keys E and nu: mu = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu)) */

static law_moduli moduli_of_young(const double *value)
{
    return (law_moduli){.mu = value[LAW_E] / (2 * (1 + value[LAW_nu])),
                        .bulk = value[LAW_E] / (3 * (1 - 2 * value[LAW_nu]))};
}

static void fill_moduli(const double *value, double *c)
{
    const law_moduli at = moduli_of_young(value);
    c[0] = at.mu;
    c[1] = at.bulk;
}

static void clear(double *value)
{
    for (int i = 0; i < LAW_OWN_KEYS; i++)
        value[i] = NAN;
}

static void read_back_young(const double *c, double *value)
{
    const double mu = c[0], bulk = c[1];
    clear(value);
    value[LAW_E] = 9 * bulk * mu / (3 * bulk + mu);
    value[LAW_nu] = (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu));
}

/* ---- keys c10, c01, and K or nu: mu = 2 (c10 + c01), K = 2 mu (1 + nu) / (3 (1 - 2 nu)) */

static law_moduli moduli_of_mooney_rivlin(const double *value)
{
    const double mu = 2 * (value[LAW_c10] + value[LAW_c01]), nu = value[LAW_nu];
    return (law_moduli){.mu = mu, .bulk = isnan(nu) ? value[LAW_K] : bulk_of(mu, nu)};
}

static void fill_mooney_rivlin(const double *value, double *c)
{
    c[0] = value[LAW_c10];
    c[1] = value[LAW_c01];
    c[2] = moduli_of_mooney_rivlin(value).bulk;
}

static void read_back_mooney_rivlin(const double *c, double *value)
{
    clear(value);
    value[LAW_c10] = c[0];
    value[LAW_c01] = c[1];
    value[LAW_K] = c[2];
}

/* ---- the table. Of the laws of one form, the first is the one that files are read as which say the form alone. */

static const law_row rows[] = {
    {.name = "neo-hookean",
     .form = FORM_NEO_HOOKEAN,
     .group = {BIT(E), BIT(nu)},
     .moduli = moduli_of_young,
     .fill = fill_moduli,
     .read_back = read_back_young,
     .meaning = "Rubber of two moduli, for large strains.",
     .energy = "mu/2 (I1bar - 3) + K/2 (J - 1)^2",
     .source = "Rivlin 1948"},
    {.name = "mooney-rivlin",
     .form = FORM_MOONEY_RIVLIN,
     .group = {BIT(c10), BIT(c01), BIT(K) | BIT(nu)},
     .moduli = moduli_of_mooney_rivlin,
     .fill = fill_mooney_rivlin,
     .read_back = read_back_mooney_rivlin,
     .meaning = "Rubber with a second invariant, for large strains; c01 = 0, c10 = mu/2 is the neo-Hookean law.",
     .energy = "c10 (I1bar - 3) + c01 (I2bar - 3) + K/2 (J - 1)^2",
     .source = "Mooney 1940; Rivlin and Saunders 1951"},
    {.name = "linear",
     .form = FORM_LINEAR,
     .group = {BIT(E), BIT(nu)},
     .moduli = moduli_of_young,
     .fill = fill_moduli,
     .read_back = read_back_young,
     .meaning = "Isotropic linear elasticity, for small strains.",
     .energy = "mu dev e : dev e + K/2 (tr e)^2",
     .source = "Petrinec, Savitsky and Terzopoulos, section III"},
};

enum { ROWS = sizeof rows / sizeof *rows };
_Static_assert((int)ROWS <= (int)LAW_MOST, "LAW_MOST is too low");

const law_row *law_at(int i)
{
    return i >= 0 && i < ROWS ? &rows[i] : NULL;
}

const law_row *law_find(const char *name)
{
    for (int i = 0; i < ROWS; i++)
        if (!strcmp(rows[i].name, name))
            return &rows[i];
    return NULL;
}

const law_row *law_of_form(form f)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].form == f)
            return &rows[i];
    return NULL;
}

int law_names(const char *to[LAW_MOST])
{
    for (int i = 0; i < ROWS; i++)
        to[i] = rows[i].name;
    return ROWS;
}

unsigned law_keys(const law_row *of)
{
    unsigned keys = 0;
    for (int g = 0; g < LAW_GROUPS; g++)
        keys |= of->group[g];
    return keys;
}

int law_next_key(unsigned keys, int from)
{
    for (int k = from; k < LAW_OWN_KEYS; k++)
        if (keys >> k & 1)
            return k;
    return -1;
}

bool law_keys_equal(const law_row *a, const law_row *b)
{
    return !memcmp(a->group, b->group, sizeof a->group);
}

const char *law_key_name(law_key key)
{
    return key_names[key];
}

const char *law_key_unit(law_key key)
{
    return key_units[key];
}

/* Appends the names of a group's keys, " or " between them. */
static void add_group(unsigned group, char to[LAW_WORDS])
{
    const char *between = *to ? ", " : "";
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (group >> k & 1) {
            const size_t at = strlen(to);
            snprintf(to + at, LAW_WORDS - at, "%s%s", between, key_names[k]);
            between = " or ";
        }
}

void law_words(const law_row *of, int group, char to[LAW_WORDS])
{
    to[0] = '\0';
    for (int g = 0; g < LAW_GROUPS; g++)
        if (group < 0 || group == g)
            add_group(of->group[g], to);
}
