/* Fibres that resist being stretched, against their energies written here once more in complex numbers: the derivative
 * of these along i. Then what every law must do, the bounds of the stable step, and figures.
 */
// needs: tests/unit/fibre_single.c
#include "physics/stability.h"

#include "fibre_single.h"
#include "tap.h"

#include <complex.h>

enum { TRIALS = 200 };

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 11;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

static element_tensor tensor_of(const double h[9])
{
    element_tensor t;
    memcpy(&t, h, sizeof t);
    return t;
}

/* H with entries up to `most`, and J from .5 to 2. */
static void gradient_by_chance(double most, double h[9])
{
    do
        for (int i = 0; i < 9; i++)
            h[i] = most * number();
    while (!(fabs(log(1 + element_dilation(tensor_of(h)))) < log(2)));
}

static void direction_by_chance(double a[3])
{
    double length = 0;
    for (int i = 0; i < 3; i++) {
        a[i] = number();
        length += a[i] * a[i];
    }
    for (int i = 0; i < 3; i++)
        a[i] /= sqrt(length);
}

static fibre_local local_of(fibre_numbers of)
{
    fibre_local l = {.of = of, .share = 1};
    direction_by_chance(l.along);
    direction_by_chance(l.family[0]);
    direction_by_chance(l.family[1]);
    return l;
}

static double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

/* ---- the energies once more */

static double complex capped(double complex y)
{
    return creal(y) < 30 ? cexp(y) - 1 : exp(30.) - 1 + exp(30.) * (y - 30);
}

/* E along two vectors. */
static double complex between(double complex e[3][3], const double a[3], const double b[3])
{
    double complex sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += a[i] * e[i][j] * b[j];
    return sum;
}

/* Two vectors across a, and across each other. */
static void axes_of(const double a[3], double b[3], double c[3])
{
    const int i = fabs(a[0]) < .7 ? 0 : 1;
    double unit[3] = {0}, along = a[i], length = sqrt(1 - along * along);
    unit[i] = 1;
    for (int k = 0; k < 3; k++)
        b[k] = (unit[k] - along * a[k]) / length;
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double complex fung_once_more(const fibre_numbers *n, double complex e[3][3], const double a[3])
{
    double b[3], c[3];
    axes_of(a, b, c);
    const double complex e11 = between(e, a, a), e22 = between(e, b, b), e33 = between(e, c, c);
    const double complex e12 = between(e, a, b), e13 = between(e, a, c), e23 = between(e, b, c);
    return n->c / 2 *
           capped(n->bf * e11 * e11 + n->bt * (e22 * e22 + e33 * e33 + 2 * e23 * e23) +
                  2 * n->bfs * (e12 * e12 + e13 * e13));
}

static double complex once_more(const fibre_local *l, double complex f[3][3])
{
    const fibre_numbers *n = &l->of;
    double complex e[3][3], w = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            e[i][j] = i == j ? -.5 : 0;
            for (int k = 0; k < 3; k++)
                e[i][j] += f[k][i] * f[k][j] / 2;
        }
    for (int k = 0; k < fibre_numbers_families(n); k++) {
        const double complex i1 = 2 * (e[0][0] + e[1][1] + e[2][2]), i4 = 2 * between(e, l->family[k], l->family[k]);
        const double complex strain = n->kappa * i1 + (1 - 3 * n->kappa) * i4;
        if (creal(strain) > 0)
            w += n->k2 > 0 ? n->k1 / (2 * n->k2) * capped(n->k2 * strain * strain) : n->k1 / 2 * strain * strain;
    }
    return n->c > 0 ? w + fung_once_more(n, e, l->along) : w;
}

/* P by the complex step; *w: the energy. */
static void stress_once_more(const fibre_local *l, const double h[9], double p[9], double *w)
{
    for (int s = 0; s < 9; s++) {
        double complex f[3][3];
        for (int i = 0; i < 9; i++)
            f[i / 3][i % 3] = h[i] + (i % 4 ? 0 : 1) + (i == s ? 1e-30 * I : 0);
        const double complex at = once_more(l, f);
        *w = creal(at);
        p[s] = cimag(at) / 1e-30;
    }
}

/* ---- stress and energy */

static void test_stress(const char *name, fibre_numbers of, double strain)
{
    double off = 0, energy = 0, single = 0;
    for (int i = 0; i < TRIALS; i++) {
        const fibre_local l = local_of(of);
        const fibre_set set = fibre_set_of(&l, 1);
        double h[9], want[9], w, got[9], most = 0, worst = 0, worst_single = 0;
        float small[9];
        gradient_by_chance(strain, h);
        for (int k = 0; k < 9; k++)
            h[k] = (double)(float)h[k];
        stress_once_more(&l, h, want, &w);
        const element_tensor p = fibre_stress(tensor_of(h), &set, 1);
        memcpy(got, &p, sizeof got);
        fibre_single(&l, h, small);
        for (int k = 0; k < 9; k++) {
            most = larger(most, fabs(want[k]));
            worst = larger(worst, fabs(got[k] - want[k]));
            worst_single = larger(worst_single, fabs((double)small[k] - want[k]));
        }
        off = larger(off, most > 0 ? worst / most : worst);
        single = larger(single, most > 0 ? worst_single / most : worst_single);
        energy = larger(energy, w > 0 ? fabs(fibre_energy(tensor_of(h), &set) / w - 1) : 0);
    }
    ok(off < 1e-11, "%s, H to %g: stress is the derivative of energy, to %.1e", name, strain, off);
    ok(energy < 1e-8, "%s, H to %g: the energy, to %.1e", name, strain, energy);
    ok(single < 1e-4, "%s, H to %g: float's stress, to %.1e", name, strain, single);
}

static void test_small(const char *name, fibre_numbers of)
{
    double worst = 0;
    for (int power = -6; power <= 0; power++)
        for (int i = 0; i < TRIALS; i++) {
            const fibre_local l = local_of(of);
            const fibre_set set = fibre_set_of(&l, 1);
            double h[9], wide[9], most = 0, off = 0;
            float narrow[9];
            gradient_by_chance(.5 * pow(10, power), h);
            for (int k = 0; k < 9; k++)
                h[k] = (double)(float)h[k];
            const element_tensor p = fibre_stress(tensor_of(h), &set, 1);
            memcpy(wide, &p, sizeof wide);
            fibre_single(&l, h, narrow);
            for (int k = 0; k < 9; k++) {
                most = larger(most, fabs(wide[k]));
                off = larger(off, fabs((double)narrow[k] - wide[k]));
            }
            /* beside what the family has at this strain where it is slack, or nearly */
            const double scale = .05 * pow(10, power) * (of.k1 + of.c * (of.bf + of.bt));
            worst = larger(worst, off / fmax(most, scale));
        }
    ok(worst < 1e-5, "%s: float keeps strains from 1e-6 to 1: %.1e off", name, worst);
}

static element_tensor turn_by_chance(void)
{
    const double q[4] = {number(), number(), number(), number()};
    const double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const element_tensor r = {
        1 - s * (q[1] * q[1] + q[2] * q[2]), s * (q[0] * q[1] - q[2] * q[3]),     s * (q[0] * q[2] + q[1] * q[3]),
        s * (q[0] * q[1] + q[2] * q[3]),     1 - s * (q[0] * q[0] + q[2] * q[2]), s * (q[1] * q[2] - q[0] * q[3]),
        s * (q[0] * q[2] - q[1] * q[3]),     s * (q[1] * q[2] + q[0] * q[3]),     1 - s * (q[0] * q[0] + q[1] * q[1])};
    return r;
}

static double largest_of(element_tensor t)
{
    double x[9], most = 0;
    memcpy(x, &t, sizeof x);
    for (int i = 0; i < 9; i++)
        most = larger(most, fabs(x[i]));
    return most;
}

static void test_objective(const char *name, fibre_numbers of)
{
    double skew = 0, turned = 0;
    for (int i = 0; i < TRIALS; i++) {
        const fibre_local l = local_of(of);
        const fibre_set set = fibre_set_of(&l, 1);
        double h[9];
        gradient_by_chance(.4, h);
        const element_tensor f = tangent_moved(tensor_of(h));
        element_tensor other = element_product(turn_by_chance(), f);
        other.xx -= 1, other.yy -= 1, other.zz -= 1;
        element_tensor cauchy = element_product(fibre_stress(tensor_of(h), &set, 1), tangent_transposed(f));
        const double w = fibre_energy(tensor_of(h), &set), most = largest_of(cauchy);
        tangent_add(&cauchy, -1, tangent_transposed(cauchy));
        skew = larger(skew, most > 0 ? largest_of(cauchy) / most : 0);
        turned = larger(turned, w > 0 ? fabs(fibre_energy(other, &set) - w) / (w + 1e-6 * (of.k1 + of.c)) : 0);
    }
    const fibre_local l = local_of(of);
    const fibre_set set = fibre_set_of(&l, 1);
    const element_tensor rest = {0};
    ok(skew < 1e-12, "%s: P F^T is symmetric, to %.1e", name, skew);
    ok(turned < 1e-9, "%s: turning changes no energy, to %.1e", name, turned);
    ok(largest_of(fibre_stress(rest, &set, 1)) == 0 && fibre_energy(rest, &set) == 0, "%s: none at rest", name);
}

/* ---- the tangent */

static void test_tangent(const char *name, fibre_numbers of)
{
    double off = 0, along = 0;
    for (int i = 0; i < TRIALS; i++) {
        const fibre_local l[2] = {local_of(of), local_of(of)};
        const fibre_set sets[2] = {fibre_set_of(&l[0], .7), fibre_set_of(&l[1], .3)};
        double h[9], a[9][9] = {{0}}, y[9], to[9], scale = 0, worst = 0;
        element_tensor product = {0};
        gradient_by_chance(.3, h);
        fibre_add_tangent(tensor_of(h), sets, 2, a);
        for (int s = 0; s < 9; s++) {
            double high[9], low[9];
            h[s] += 1e-6;
            element_tensor p = fibre_stress(tensor_of(h), sets, 2);
            memcpy(high, &p, sizeof high);
            h[s] -= 2e-6;
            p = fibre_stress(tensor_of(h), sets, 2);
            memcpy(low, &p, sizeof low);
            h[s] += 1e-6;
            for (int r = s; r < 9; r++) {
                a[s][r] = a[r][s];
                scale = larger(scale, fabs(a[r][s]));
                worst = larger(worst, fabs(a[r][s] - (high[r] - low[r]) / 2e-6));
            }
        }
        off = larger(off, scale > 0 ? worst / scale : 0);
        for (int s = 0; s < 9; s++)
            y[s] = number();
        fibre_along(tensor_of(h), sets, 2, tensor_of(y), &product);
        memcpy(to, &product, sizeof to);
        for (int r = 0; r < 9; r++)
            for (int s = 0; s < 9; s++)
                to[r] -= a[r][s] * y[s];
        for (int r = 0; r < 9; r++)
            along = larger(along, scale > 0 ? fabs(to[r]) / scale : 0);
    }
    ok(off < 1e-6, "%s: the tangent is the slope of stress, to %.1e", name, off);
    ok(along < 1e-12, "%s: the tangent along a direction, to %.1e", name, along);
}

/* The bounds of the largest eigenvalue, beside a law of mu 1000 Pa and K. */
static void test_range(const char *name, fibre_numbers of, double bulk, double strain)
{
    const double c[FORM_NUMBERS] = {of.c > 0 ? 0 : 1000, bulk};
    const element_fibre none = {0};
    int wrong = 0, wide = 0;
    for (int i = 0; i < 5 * TRIALS; i++) {
        const double side[3] = {.01 + .005 * number(), .01 + .005 * number(), .01};
        const fibre_local l[2] = {local_of(of), local_of(of)};
        const fibre_set sets[2] = {fibre_set_of(&l[0], .7), fibre_set_of(&l[1], .3)};
        double h[9];
        step_matrix a;
        gradient_by_chance(strain, h);
        stability_matrix_fibred(FORM_NEO_HOOKEAN, c, 1000, side, tensor_of(h), none, none, sets, 2, &a);
        const stability_range range = stability_range_fibred(FORM_NEO_HOOKEAN, c, stability_diagonal(1000, side),
                                                             tensor_of(h), none, none, sets, 2);
        const double largest = stability_largest(&a);
        wrong += !(range.low <= largest && largest <= range.high);
        wide += !(range.high <= 1.1 * range.low);
    }
    ok(!wrong, "%s, K %g, H to %g: bounds of eigenvalues hold: %d do not", name, bulk, strain, wrong);
    if (strain < .1) /* else the matrix tells */
        ok(wide == 0, "%s: within 10 %% of each other: %d are not", name, wide);
}

/* ---- figures: P11 of a bar along its fibres whose sides are free */

static double pulled(double mu, double bulk, const fibre_set *set, double stretch, double *side)
{
    const double c[FORM_NUMBERS] = {mu, bulk};
    double low = .5, high = 1.5;
    element_tensor p = {0};
    for (int i = 0; i < 200; i++) {
        *side = (low + high) / 2;
        const element_tensor h = {stretch - 1, 0, 0, 0, *side - 1, 0, 0, 0, *side - 1};
        p = element_sum(form_stress(FORM_NEO_HOOKEAN, h, c), fibre_stress(h, set, 1));
        if (p.yy > 0)
            high = *side;
        else
            low = *side;
    }
    return p.xx;
}

static void test_figures(void)
{
    fibre_local l = {.of = {.k1 = 2e4, .k2 = 2}, .share = 1, .along = {1, 0, 0}, .family = {{1, 0, 0}}};
    fibre_set set = fibre_set_of(&l, 1);
    double side;
    near_(pulled(1e4, 5e5, &set, 1.2, &side) / 36121.1, 1, 1e-5, "hgo along x: stretched by 1.2");
    near_(side, .914693, 1e-6, "and its sides");
    near_(pulled(1e4, 5e5, &set, .8, &side) / -7582.10, 1, 1e-5, "pressed to .8");
    l.of.kappa = .1;
    set = fibre_set_of(&l, 1);
    near_(pulled(1e4, 5e5, &set, 1.2, &side) / 18961.8, 1, 1e-5, "kappa .1: stretched by 1.2");
    near_(side, .913519, 1e-6, "and its sides");
    near_(pulled(1e4, 5e5, &set, .8, &side) / -7582.10, 1, 1e-5, "pressed to .8");
    l.of = (fibre_numbers){.k1 = 2e4, .k2 = 2, .kappa = .3};
    l.family[0][0] = 0;
    set = fibre_set_of(&l, 1);
    const element_tensor h = {.2, .1, 0, 0, .1, 0, 0, 0, .3};
    ok(largest_of(fibre_stress(h, &set, 1)) == 0, "where there is no direction there are no fibres, kappa or not");
}

int main(void)
{
    static const struct {
        const char *name;
        fibre_numbers of;
    } tried[] = {{"quadratic", {.k1 = 2e4}},
                 {"hgo", {.k1 = 2e4, .k2 = 2}},
                 {"hgo, kappa .1", {.k1 = 2e4, .k2 = 2, .kappa = .1}},
                 {"hgo, kappa 1/3", {.k1 = 2e4, .k2 = 2, .kappa = 1. / 3}},
                 {"two families", {.k1 = 2e4, .k2 = 20, .kappa = .05, .angle = .5}},
                 {"fung", {.c = 2e3, .bf = 8, .bt = 2, .bfs = 4}},
                 {"fung, families", {.k1 = 1e4, .k2 = 1, .angle = .3, .c = 500, .bf = 1, .bt = 20, .bfs = 3}}};
    for (size_t i = 0; i < sizeof tried / sizeof *tried; i++) {
        test_stress(tried[i].name, tried[i].of, .3);
        test_stress(tried[i].name, tried[i].of, .9);
        test_small(tried[i].name, tried[i].of);
        test_objective(tried[i].name, tried[i].of);
        test_tangent(tried[i].name, tried[i].of);
        test_range(tried[i].name, tried[i].of, 1e6, .02);
        test_range(tried[i].name, tried[i].of, 1e4, .3);
    }
    test_figures();
    return done_testing();
}
