#include "physics/law.h"

#include "physics/form_general.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BIT(key) (1U << LAW_##key)

#define KEY_NAME(key, unit, low, high, meaning) #key,
#define KEY_UNIT(key, unit, low, high, meaning) unit,
static const char *const key_names[] = {LAW_KEYS(KEY_NAME) LAW_COMMON_KEYS(KEY_NAME) LAW_FIBRE_KEYS(KEY_NAME)};
static const char *const key_units[] = {LAW_KEYS(KEY_UNIT) LAW_COMMON_KEYS(KEY_UNIT) LAW_FIBRE_KEYS(KEY_UNIT)};

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

/* ---- keys c10, c01, and K or nu: mu = 2 (c10 + c01), K = 2 mu (1 + nu) / (3 (1 - 2 nu)) */

/* With K, or K of nu. */
static law_moduli moduli_with(double mu, const double *value)
{
    const double nu = value[LAW_nu];
    return (law_moduli){.mu = mu, .bulk = isnan(nu) ? value[LAW_K] : bulk_of(mu, nu)};
}

static law_moduli moduli_of_mooney_rivlin(const double *value)
{
    return moduli_with(2 * (value[LAW_c10] + value[LAW_c01]), value);
}

static void fill_mooney_rivlin(const double *value, double *c)
{
    c[0] = value[LAW_c10];
    c[1] = value[LAW_c01];
    c[2] = moduli_of_mooney_rivlin(value).bulk;
}

/* ---- keys c10, c20, c30, and K or nu: mu = 2 c10 */

/* An optional key. */
static double or_zero(double value)
{
    return isnan(value) ? 0 : value;
}

static law_moduli moduli_of_yeoh(const double *value)
{
    return moduli_with(2 * value[LAW_c10], value);
}

static void fill_yeoh(const double *value, double *c)
{
    c[0] = value[LAW_c10];
    c[1] = value[LAW_c20];
    c[2] = or_zero(value[LAW_c30]);
    c[FORM_FIRST_POWERS] = moduli_of_yeoh(value).bulk;
}

/* In simple shear g the stress is 2 f'(g^2) g. Its slope is 2 (f' + 2 x f'') at x = g^2: it must be above 0 at each x,
 * or waves there have no speed (in an incompressible f(I1) material just then: at a given x, no wave is stretched more
 * by f'' than those across a simple shear). That is c10 + 6 c20 x + 15 c30 x^2, for which f' > 0 too. */
static bool refuses_yeoh(const double *value, char what[LAW_WORDS], char expected[LAW_WORDS])
{
    const double c10 = value[LAW_c10], c20 = value[LAW_c20], c30 = or_zero(value[LAW_c30]);
    if (c20 >= 0 || 3 * c20 * c20 < 5 * c10 * c30)
        return false;
    snprintf(what, LAW_WORDS, "c20=%g with c10=%g and c30=%g lets the stress fall where shear grows", c20, c10, c30);
    snprintf(expected, LAW_WORDS, "c20 of 0 or more, or c30 above 3 c20^2 / (5 c10) = %g", .6 * c20 * c20 / c10);
    return true;
}

/* ---- keys mu, lock, and K or nu: with I1bar = 3 + x,
 *     f = mu sum over i to 5 of s_i / lock^(2 i - 2) (I1bar^i - 3^i)
 *       = sum over k to 5 of c_k x^k,   c_k = mu sum over i from k of s_i / lock^(2 i - 2) binomial(i, k) 3^(i - k). */

static void powers_of_arruda_boyce(const double *value, double c[FORM_FIRST_POWERS])
{
    static const double series[] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
    const double inverse = 1 / (value[LAW_lock] * value[LAW_lock]);
    double by = value[LAW_mu];
    for (int i = 0; i < FORM_FIRST_POWERS; i++)
        c[i] = 0;
    for (int i = 1; i <= FORM_FIRST_POWERS; i++) {
        double part = 1; /* binomial(i, k) 3^(i - k), from k = i down */
        for (int k = i; k > 0; k--) {
            c[k - 1] += by * series[i - 1] * part;
            part *= 3. * k / (i - k + 1);
        }
        by *= inverse;
    }
}

static law_moduli moduli_of_arruda_boyce(const double *value)
{
    double c[FORM_FIRST_POWERS];
    powers_of_arruda_boyce(value, c);
    return moduli_with(2 * c[0], value);
}

static void fill_arruda_boyce(const double *value, double *c)
{
    powers_of_arruda_boyce(value, c);
    c[FORM_FIRST_POWERS] = moduli_of_arruda_boyce(value).bulk;
}

/* ---- keys c1, c2, and K or nu: f = c1 (e^(c2 x) - 1), c01 = -c1 c2 / 2, mu = c1 c2 */

static law_moduli moduli_of_veronda_westmann(const double *value)
{
    return moduli_with(value[LAW_c1] * value[LAW_c2], value);
}

static void fill_veronda_westmann(const double *value, double *c)
{
    c[FORM_GENERAL_c01] = -value[LAW_c1] * value[LAW_c2] / 2;
    c[FORM_GENERAL_K] = moduli_of_veronda_westmann(value).bulk;
    c[FORM_GENERAL_e] = value[LAW_c1];
    c[FORM_GENERAL_b] = value[LAW_c2];
}

/* A wave along n with a displacement along a, |n| = |a| = 1 and n.a = 0, B = F F^T and det F = 1, has
 *     rho c^2 = 2 f' n.Bn + 4 f'' (a.Bn)^2 + 2 c01 a.B^-1 a,   a.B^-1 a <= l^2 n.Bn,
 * l the largest stretch, and equal where a and n are the other two axes of B. So with f'' > 0 waves have a speed in any
 * state just where f' > -c01 l^2, and as no x is less at a given l than that of a bar, l^2 + 2/l - 3,
 *     2 e^(c2 (l^2 + 2/l - 3)) > l^2 for each l > 1,
 * which is so where c2 is above the largest ln(l^2 / 2) / (l^2 + 2/l - 3), .357531 at l = 1.8286. */
static bool refuses_veronda_westmann(const double *value, char what[LAW_WORDS], char expected[LAW_WORDS])
{
    const double least = .35754;
    if (value[LAW_c2] > least)
        return false;
    snprintf(what, LAW_WORDS, "c2=%g lets waves lose their speed where tissue is stretched", value[LAW_c2]);
    snprintf(expected, LAW_WORDS, "c2 above %g", least);
    return true;
}

/* ---- keys mu1, a1 to mu3, a3, and K or nu: m_i = 2 mu_i / a_i^2, mu = mu1 + mu2 + mu3 */

enum { OGDEN_TERMS = 3 };
static const law_key ogden_mu[OGDEN_TERMS] = {LAW_mu1, LAW_mu2, LAW_mu3};
static const law_key ogden_a[OGDEN_TERMS] = {LAW_a1, LAW_a2, LAW_a3};

static law_moduli moduli_of_ogden(const double *value)
{
    double mu = 0;
    for (int i = 0; i < OGDEN_TERMS; i++)
        mu += or_zero(value[ogden_mu[i]]);
    return moduli_with(mu, value);
}

static void fill_ogden(const double *value, double *c)
{
    for (int i = 0; i < OGDEN_TERMS; i++) {
        const double mu = or_zero(value[ogden_mu[i]]), a = or_zero(value[ogden_a[i]]);
        c[FORM_GENERAL_m + i] = mu != 0 ? 2 * mu / (a * a) : 0;
        c[FORM_GENERAL_a + i] = a;
    }
    c[FORM_GENERAL_K] = moduli_of_ogden(value).bulk;
}

/* l1^a + l2^a + l3^a is convex in F for a of 1 and more, and in its cofactors for a of -1 and less: so waves have a
 * speed in any state. In between the stress falls where shear is large. */
static bool refuses_ogden(const double *value, char what[LAW_WORDS], char expected[LAW_WORDS])
{
    for (int i = 0; i < OGDEN_TERMS; i++) {
        const double mu = value[ogden_mu[i]], a = value[ogden_a[i]];
        const char *mu_name = key_names[ogden_mu[i]], *a_name = key_names[ogden_a[i]];
        if (isnan(mu) != isnan(a)) {
            snprintf(what, LAW_WORDS, "%s without %s", isnan(mu) ? a_name : mu_name, isnan(mu) ? mu_name : a_name);
            snprintf(expected, LAW_WORDS, "both %s and %s, or neither", mu_name, a_name);
            return true;
        }
        if (i && !isnan(mu) && isnan(value[ogden_mu[i - 1]])) {
            snprintf(what, LAW_WORDS, "%s without %s", mu_name, key_names[ogden_mu[i - 1]]);
            snprintf(expected, LAW_WORDS, "the terms in their order");
            return true;
        }
        if (fabs(a) < 1) {
            snprintf(what, LAW_WORDS, "%s=%g lets the stress fall where shear grows", a_name, a);
            snprintf(expected, LAW_WORDS, "%s of 1 or more, or of -1 or less", a_name);
            return true;
        }
    }
    return false;
}

/* ---- keys c, bf, bt, bfs, and K or nu: at rest mu is another in each direction. What follows from one mu takes the
 * mean of W / e:e over five strains e that keep the volume, at right angles to each other: with W = c/2 Q, Q is
 * (2 bf + bt)/3 e:e along diag(2, -1, -1), bt e:e twice and bfs e:e twice. Where bf = bt = bfs that is c bf/2. */

static law_moduli moduli_of_fung(const double *value)
{
    return moduli_with(value[LAW_c] * (2 * value[LAW_bf] + 7 * value[LAW_bt] + 6 * value[LAW_bfs]) / 30, value);
}

/* The form has K alone. */
static void fill_fung(const double *value, double *c)
{
    c[0] = 0;
    c[1] = moduli_of_fung(value).bulk;
}

static void fibres_of_fung(const double *value, fibre_numbers *to)
{
    to->c = value[LAW_c];
    to->bf = value[LAW_bf];
    to->bt = value[LAW_bt];
    to->bfs = value[LAW_bfs];
}

/* ---- the table */

static const law_row rows[] = {
    {.name = "neo-hookean",
     .form = FORM_NEO_HOOKEAN,
     .group = {BIT(E), BIT(nu)},
     .moduli = moduli_of_young,
     .fill = fill_moduli,
     .meaning = "Rubber of two moduli, for large strains.",
     .energy = "mu/2 (I1bar - 3) + K/2 (J - 1)^2",
     .source = "Rivlin 1948"},
    {.name = "mooney-rivlin",
     .form = FORM_MOONEY_RIVLIN,
     .group = {BIT(c10), BIT(c01), BIT(K) | BIT(nu)},
     .moduli = moduli_of_mooney_rivlin,
     .fill = fill_mooney_rivlin,
     .meaning = "Rubber with a second invariant, for large strains; c01 = 0, c10 = mu/2 is the neo-Hookean law.",
     .energy = "c10 (I1bar - 3) + c01 (I2bar - 3) + K/2 (J - 1)^2",
     .source = "Mooney 1940; Rivlin and Saunders 1951"},
    {.name = "yeoh",
     .form = FORM_FIRST,
     .group = {BIT(c10), BIT(c20), BIT(K) | BIT(nu)},
     .optional = BIT(c30),
     .moduli = moduli_of_yeoh,
     .fill = fill_yeoh,
     .refuses = refuses_yeoh,
     .meaning = "Rubber that stiffens with the first invariant, for large strains; much used for the tissue of faces.",
     .energy = "c10 (I1bar - 3) + c20 (I1bar - 3)^2 + c30 (I1bar - 3)^3 + K/2 (J - 1)^2",
     .source = "Yeoh 1993"},
    {.name = "arruda-boyce",
     .form = FORM_FIRST,
     .group = {BIT(mu), BIT(lock), BIT(K) | BIT(nu)},
     .moduli = moduli_of_arruda_boyce,
     .fill = fill_arruda_boyce,
     .meaning =
         "Rubber of chains that lock, for large strains: five terms of the series of the inverse Langevin function.",
     .energy = "mu (1/2 (I1bar - 3) + 1/(20 lock^2) (I1bar^2 - 9) + 11/(1050 lock^4) (I1bar^3 - 27)\n"
               "  + 19/(7000 lock^6) (I1bar^4 - 81) + 519/(673750 lock^8) (I1bar^5 - 243)) + K/2 (J - 1)^2",
     .source = "Arruda and Boyce 1993"},
    {.name = "veronda-westmann",
     .form = FORM_GENERAL,
     .group = {BIT(c1), BIT(c2), BIT(K) | BIT(nu)},
     .moduli = moduli_of_veronda_westmann,
     .fill = fill_veronda_westmann,
     .refuses = refuses_veronda_westmann,
     .meaning = "Skin that stiffens exponentially with the first invariant, for large strains.",
     .energy = "c1 (e^(c2 (I1bar - 3)) - 1) - c1 c2/2 (I2bar - 3) + K/2 (J - 1)^2",
     .source = "Veronda and Westmann 1970"},
    {.name = "ogden",
     .form = FORM_GENERAL,
     .group = {BIT(mu1), BIT(a1), BIT(K) | BIT(nu)},
     .optional = BIT(mu2) | BIT(a2) | BIT(mu3) | BIT(a3),
     .moduli = moduli_of_ogden,
     .fill = fill_ogden,
     .refuses = refuses_ogden,
     .meaning = "Rubber of powers of the principal stretches l1 to l3, for large strains; up to three terms.",
     .energy = "2 mu1/a1^2 (L1^a1 + L2^a1 + L3^a1 - 3) + K/2 (J - 1)^2, L1 = J^-1/3 l1 and so on;\n"
               "  mu2, a2 and mu3, a3 likewise",
     .source = "Ogden 1972"},
    {.name = "fung",
     .form = FORM_NEO_HOOKEAN,
     .group = {BIT(c), BIT(bf), BIT(bt), BIT(bfs), BIT(K) | BIT(nu)},
     .moduli = moduli_of_fung,
     .fill = fill_fung,
     .fibres = fibres_of_fung,
     .meaning = "Tissue, such as the heart's, that is alike all round its fibres and stiffens exponentially.",
     .energy = "c/2 (exp Q - 1) + K/2 (J - 1)^2,\n"
               "  Q = bf E11^2 + bt (E22^2 + E33^2 + 2 E23^2) + 2 bfs (E12^2 + E13^2)",
     .source = "Guccione, McCulloch and Waldman 1991"},
    {.name = "linear",
     .form = FORM_LINEAR,
     .group = {BIT(E), BIT(nu)},
     .moduli = moduli_of_young,
     .fill = fill_moduli,
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
    return keys | of->optional;
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
    return !memcmp(a->group, b->group, sizeof a->group) && a->optional == b->optional;
}

bool law_refuses(const law_row *of, const double *value, char what[LAW_WORDS], char expected[LAW_WORDS])
{
    return of->refuses && of->refuses(value, what, expected);
}

const char *law_key_name(law_key key)
{
    return key_names[key];
}

const char *law_key_unit(law_key key)
{
    return key_units[key];
}

double law_key_usual(law_key key)
{
    static const double usual[LAW_ALL_KEYS] = {[LAW_optimum] = 1,    [LAW_passive] = 0, [LAW_stiffening] = 6.6,
                                               [LAW_straight] = 1.4, [LAW_vmax] = 0,    [LAW_series] = .04};
    return (int)key >= (int)LAW_OPTIONAL && (int)key < (int)LAW_ALL_KEYS ? usual[key] : NAN;
}

/* Appends the names of a group's keys, `between` between them. */
static void add_group(unsigned group, const char *between, char to[LAW_WORDS])
{
    const char *before = *to ? ", " : "";
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (group >> k & 1) {
            const size_t at = strlen(to);
            snprintf(to + at, LAW_WORDS - at, "%s%s", before, key_names[k]);
            before = between;
        }
}

static void add_optional(unsigned keys, char to[LAW_WORDS])
{
    char names[LAW_WORDS] = "";
    const size_t at = strlen(to);
    add_group(keys, ", ", names);
    snprintf(to + at, LAW_WORDS - at, ", [%.80s]", names);
}

void law_words(const law_row *of, int group, char to[LAW_WORDS])
{
    to[0] = '\0';
    for (int g = 0; g < LAW_GROUPS; g++)
        if (group < 0 || group == g)
            add_group(of->group[g], " or ", to);
    if (group < 0 && of->optional)
        add_optional(of->optional, to);
}
