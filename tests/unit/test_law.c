/* The table of laws: each row is whole, its coefficients come of its keys and give them back, and its moduli are
 * theirs. */
#include "physics/form_general.h"
#include "physics/law.h"

#include "tap.h"

#include <math.h>
#include <string.h>

/* A value from the key's range: 3000 and more where it is that wide, else nine tenths of the way up. No two groups have
 * the same. */
static double allowed(int key, int group)
{
#define RANGE(key, unit, low, high, meaning) {low, high},
    static const double range[][2] = {LAW_KEYS(RANGE)};
#undef RANGE
    const double low = range[key][0], high = range[key][1];
    return high > 1e4 ? fmax(low, 3000) + 100 * group : low + (.9 + .01 * group) * (high - low);
}

/* Values for the last key of each group: of K or nu it is K. */
static void fill_last(const law_row *a, double *value)
{
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        value[k] = NAN;
    for (int g = 0; g < LAW_GROUPS && a->group[g]; g++) {
        int key = law_next_key(a->group[g], 0);
        for (int next = key; next >= 0; next = law_next_key(a->group[g], next + 1))
            key = next;
        value[key] = allowed(key, g);
    }
}

static void whole(const law_row *a)
{
    double value[LAW_OWN_KEYS], c[FORM_NUMBERS] = {0};
    char words[LAW_WORDS];
    ok(law_find(a->name) == a, "%s is found", a->name);
    ok(a->meaning && a->energy && a->source && a->form < FORM_COUNT && law_of_form(a->form), "and has all columns");
    law_words(a, -1, words);
    ok(strlen(words) + sizeof ", density, peak" < sizeof words, "its keys fit a message: %s", words);
    fill_last(a, value);
    const law_moduli at = a->moduli(value);
    a->fill(value, c);
    bool finite = true;
    for (int i = 0; i < FORM_NUMBERS; i++)
        finite = finite && isfinite(c[i]);
    ok(finite, "its coefficients are numbers where no optional key is given");
    ok(at.mu > 0 && at.bulk > 0 && isfinite(at.bulk), "moduli %g and %g Pa", at.mu, at.bulk);
}

static void mooney_rivlin(void)
{
    const law_row *a = law_find("mooney-rivlin");
    const double by_bulk[] = {[LAW_nu] = NAN, [LAW_c10] = 2500, [LAW_c01] = 500, [LAW_K] = 1e5};
    const double by_poisson[] = {[LAW_nu] = .49, [LAW_c10] = 2500, [LAW_c01] = 500, [LAW_K] = NAN};
    char words[LAW_WORDS];
    double c[FORM_NUMBERS];
    a->fill(by_bulk, c);
    ok(c[0] == 2500 && c[1] == 500 && c[2] == 1e5 && a->moduli(by_bulk).mu == 6000,
       "mooney-rivlin: mu = 2 (c10 + c01)");
    a->fill(by_poisson, c);
    near_(c[2], 2 * 6000 * 1.49 / (3 * .02), 1e-6, "K from nu");
    law_words(a, -1, words);
    ok(!strcmp(words, "c10, c01, nu or K"), "%s", words);
    law_words(a, 2, words);
    ok(!strcmp(words, "nu or K"), "%s", words);
}

/* f by the five terms of I1bar, and by the powers of x. */
static void arruda_boyce(void)
{
    const law_row *a = law_find("arruda-boyce");
    const double value[LAW_OWN_KEYS] = {[LAW_nu] = NAN, [LAW_mu] = 3000, [LAW_lock] = 1.4, [LAW_K] = 1e5};
    const double series[] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
    double c[FORM_NUMBERS];
    a->fill(value, c);
    for (int i = 1; i < 4; i++) {
        const double x = .3 * i;
        double terms = 0, powers = 0;
        for (int k = 0; k < 5; k++) {
            terms += 3000 * series[k] / pow(1.4, 2 * k) * (pow(3 + x, k + 1) - pow(3, k + 1));
            powers += c[k] * pow(x, k + 1);
        }
        near_(powers / terms, 1, 1e-12, "arruda-boyce: powers of I1bar - 3 = %g", x);
    }
    ok(a->moduli(value).mu == 2 * c[0] && c[5] == 1e5, "its moduli at rest");
}

/* Its shear is that of fibres; where bf, bt and bfs are alike it is isotropic at rest, W = c b/2 e:e. */
static void fung(void)
{
    const law_row *a = law_find("fung");
    double value[LAW_OWN_KEYS] = {
        [LAW_nu] = .45, [LAW_K] = NAN, [LAW_c] = 2000, [LAW_bf] = 3, [LAW_bt] = 3, [LAW_bfs] = 3};
    fibre_numbers f = {0};
    double c[FORM_NUMBERS] = {0};
    near_(a->moduli(value).mu, 3000, 1e-9, "fung, alike all round: mu = c b/2");
    value[LAW_bf] = 8, value[LAW_bt] = 2, value[LAW_bfs] = 4;
    const law_moduli at = a->moduli(value);
    near_(at.mu, 3600, 1e-9, "fung: the mean of 6000, twice 2000 and twice 4000");
    near_(law_poisson(at), .45, 1e-12, "and K of nu");
    a->fill(value, c);
    ok(a->form == FORM_NEO_HOOKEAN && c[0] == 0 && c[1] == at.bulk, "its form has K alone");
    a->fibres(value, &f);
    ok(f.c == 2000 && f.bf == 8 && f.bt == 2 && f.bfs == 4, "and its fibres the rest");
}

/* Yeoh's stress in shear must grow: c10 + 6 c20 x + 15 c30 x^2 above 0. */
static void yeoh(void)
{
    const law_row *a = law_find("yeoh");
    double value[LAW_OWN_KEYS] = {[LAW_nu] = NAN, [LAW_c10] = 1000, [LAW_c20] = 0, [LAW_c30] = NAN, [LAW_K] = 1e5};
    char what[LAW_WORDS], expected[LAW_WORDS];
    double c[FORM_NUMBERS] = {0};
    law_words(a, -1, what);
    ok(!strcmp(what, "c10, c20, nu or K, [c30]"), "%s", what);
    ok(!law_refuses(a, value, what, expected), "yeoh: c20 of 0");
    value[LAW_c20] = -1;
    ok(law_refuses(a, value, what, expected), "yeoh: %s; expected %s", what, expected);
    for (int i = 0; i < 2; i++) {
        const double limit = sqrt(5. / 3 * 1000 * 600);
        value[LAW_c30] = 600, value[LAW_c20] = -limit * (i ? 1.0001 : .9999);
        double least = 1;
        for (int k = 0; k < 30000; k++) {
            const double x = 1e-4 * k;
            least = fmin(least, 1000 + 6 * value[LAW_c20] * x + 15 * 600 * x * x);
        }
        ok(law_refuses(a, value, what, expected) == (i == 1) && (least > 0) == (i == 0),
           "yeoh: c20 %g with c30 600, and the least slope is %g", value[LAW_c20], least);
    }
    a->fill(value, c);
    ok(c[0] == 1000 && c[1] == value[LAW_c20] && c[2] == 600 && c[3] == 0 && c[5] == 1e5, "its coefficients");
}

/* The speed of the slowest wave across the state of a bar at stretch l, incompressible: of 2 (f' + c01 l^2). */
static double slowest(double c2, double l)
{
    return c2 * exp(c2 * (l * l + 2 / l - 3)) - c2 / 2 * l * l;
}

static void veronda_westmann(void)
{
    const law_row *a = law_find("veronda-westmann");
    double value[LAW_OWN_KEYS] = {[LAW_nu] = NAN, [LAW_c1] = 1000, [LAW_c2] = 3, [LAW_K] = 1e5};
    char what[LAW_WORDS], expected[LAW_WORDS];
    double c[FORM_NUMBERS] = {0};
    a->fill(value, c);
    ok(c[FORM_GENERAL_e] == 1000 && c[FORM_GENERAL_b] == 3 && c[FORM_GENERAL_c01] == -1500 && c[FORM_GENERAL_K] == 1e5,
       "veronda-westmann: its coefficients");
    ok(a->moduli(value).mu == 3000 && form_general_shear(c) == 3000, "mu = c1 c2");
    for (int i = 0; i < 2; i++) {
        double least = 1;
        value[LAW_c2] = i ? .3575 : .3576;
        for (int k = 0; k < 30000; k++)
            least = fmin(least, slowest(value[LAW_c2], 1 + 1e-4 * k));
        ok(law_refuses(a, value, what, expected) == (i == 1) && (least > 0) == (i == 0),
           "c2 of %g, and the least of a wave is %g", value[LAW_c2], least);
    }
    ok(!strcmp(expected, "c2 above 0.35754"), "%s; expected %s", what, expected);
}

static void ogden(void)
{
    const law_row *a = law_find("ogden");
    double value[LAW_OWN_KEYS], c[FORM_NUMBERS] = {0};
    char what[LAW_WORDS], expected[LAW_WORDS];
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        value[k] = NAN;
    value[LAW_mu1] = 1000, value[LAW_a1] = 2, value[LAW_mu2] = 200, value[LAW_a2] = -4, value[LAW_nu] = .45;
    law_words(a, -1, what);
    ok(!strcmp(what, "mu1, a1, nu or K, [mu2, a2, mu3, a3]"), "%s", what);
    ok(!law_refuses(a, value, what, expected), "ogden of two terms");
    a->fill(value, c);
    ok(c[FORM_GENERAL_m] == 500 && c[FORM_GENERAL_a] == 2 && c[FORM_GENERAL_m + 1] == 25 &&
           c[FORM_GENERAL_a + 1] == -4 && c[FORM_GENERAL_m + 2] == 0,
       "its coefficients");
    ok(a->moduli(value).mu == 1200 && form_general_shear(c) == 1200, "mu = mu1 + mu2 + mu3");
    near_(c[FORM_GENERAL_K], 2 * 1200 * 1.45 / (3 * .1), 1e-6, "K from nu");
    value[LAW_a2] = .9;
    ok(law_refuses(a, value, what, expected), "%s; expected %s", what, expected);
    value[LAW_a2] = NAN;
    ok(law_refuses(a, value, what, expected) && !strcmp(what, "mu2 without a2"), "%s; expected %s", what, expected);
    value[LAW_mu2] = NAN, value[LAW_a2] = 2;
    ok(law_refuses(a, value, what, expected) && !strcmp(what, "a2 without mu2"), "%s; expected %s", what, expected);
    value[LAW_a2] = NAN, value[LAW_mu3] = 10, value[LAW_a3] = 2;
    ok(law_refuses(a, value, what, expected) && !strcmp(what, "mu3 without mu2"), "%s; expected %s", what, expected);
}

int main(void)
{
    const char *names[LAW_MOST];
    int count = law_names(names);
    ok(count > 1 && !law_at(count) && !law_at(-1), "%d laws", count);
    for (int i = 0; i < count; i++) {
        ok(!strcmp(names[i], law_at(i)->name), "names are in order");
        whole(law_at(i));
    }
    ok(!law_find("hookean"), "another name is not found");
    const law_row *a = law_at(0), *linear = law_find("linear");
    ok(!strcmp(a->name, "neo-hookean") && a->form == FORM_NEO_HOOKEAN, "the default is neo-Hookean");
    ok(law_keys_equal(a, linear) && linear->form == FORM_LINEAR, "linear has the same keys, and a form of its own");
    const double value[LAW_OWN_KEYS] = {[LAW_E] = 3000, [LAW_nu] = .45};
    double c[FORM_NUMBERS];
    a->fill(value, c);
    near_(c[0], 3000 / 2.9, 1e-9, "mu = E / (2 (1 + nu))");
    near_(c[1], 10000, 1e-8, "K = E / (3 (1 - 2 nu))");
    mooney_rivlin();
    yeoh();
    arruda_boyce();
    veronda_westmann();
    ogden();
    fung();
    ok(!strcmp(law_key_name(LAW_density), "density") && !strcmp(law_key_unit(LAW_E), "Pa"),
       "keys have names and units");
    ok(law_next_key(law_keys(a), 0) == LAW_E && law_next_key(law_keys(a), LAW_E + 1) == LAW_nu &&
           law_next_key(law_keys(a), LAW_nu + 1) < 0,
       "its keys, one after the other");
    return done_testing();
}
