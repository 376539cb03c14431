/* What every form must do, whatever it is: stress is the slope of energy and tangent that of stress, turning changes
 * nothing, nothing is pulled at rest; and the bounds of the stable step hold. Then figures of the Mooney-Rivlin form.
 */
#include "physics/stability.h"

#include "form_tried.h"
#include "tap.h"

enum { TRIALS = 200 };

#define NAME_OF(NAME, name, coefficients, exponents, history) #name,
static const char *const names[] = {FORMS(NAME_OF)};

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 7;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

static element_tensor tensor_of(const double h[9])
{
    element_tensor t;
    memcpy(&t, h, sizeof t);
    return t;
}

/* H with entries up to `most`, and J from .7 to 1.4. */
static element_tensor gradient_by_chance(double most)
{
    for (;;) {
        double h[9];
        for (int i = 0; i < 9; i++)
            h[i] = most * number();
        const double dilation = element_dilation(tensor_of(h));
        if (dilation > -.3 && dilation < .4)
            return tensor_of(h);
    }
}

/* The larger; nan where one is, which fmax would drop. */
static double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

static element_tensor minus_one(element_tensor f)
{
    f.xx -= 1, f.yy -= 1, f.zz -= 1;
    return f;
}

/* A rotation about an axis by chance. */
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

static double apart(element_tensor a, element_tensor b)
{
    tangent_add(&a, -1, b);
    return largest_of(a);
}

/* The difference quotient of fourth order of the energy. */
static element_tensor slope_of_energy(form f, element_tensor h, const double *c)
{
    const double step = 2e-3;
    double at[9], slope[9];
    memcpy(at, &h, sizeof at);
    for (int i = 0; i < 9; i++) {
        double w[4];
        for (int k = 0; k < 4; k++) {
            const double was = at[i];
            at[i] += (k < 2 ? k - 2 : k - 1) * step;
            w[k] = form_energy(f, tensor_of(at), c);
            at[i] = was;
        }
        slope[i] = (w[0] - w[3] + 8 * (w[2] - w[1])) / (12 * step);
    }
    return tensor_of(slope);
}

static void test_stress(form f, const double *c)
{
    double off = 0, skew = 0, turned = 0;
    for (int i = 0; i < TRIALS; i++) {
        const element_tensor h = gradient_by_chance(.4), p = form_stress(f, h, c), moved = tangent_moved(h);
        const element_tensor cauchy = element_product(p, tangent_transposed(moved));
        const double energy = form_energy(f, h, c);
        const element_tensor other = minus_one(element_product(turn_by_chance(), moved));
        off = larger(off, apart(p, slope_of_energy(f, h, c)) / largest_of(p));
        skew = larger(skew, apart(cauchy, tangent_transposed(cauchy)) / largest_of(cauchy));
        turned = larger(turned, fabs(form_energy(f, other, c) - energy) / energy);
    }
    ok(off < 1e-6, "%s: stress is the slope of energy, to %.1e", names[f], off);
    ok(skew < 1e-12, "%s: P F^T is symmetric, to %.1e", names[f], skew);
    ok(turned < 1e-11, "%s: turning changes no energy, to %.1e", names[f], turned);
    const element_tensor rest = {0};
    ok(largest_of(form_stress(f, rest, c)) == 0 && form_energy(f, rest, c) == 0, "%s: none at rest", names[f]);
}

static void test_tangent(form f, const double *c)
{
    const double step = 1e-5;
    double off = 0, along = 0;
    for (int i = 0; i < TRIALS; i++) {
        const element_tensor h = gradient_by_chance(.4), y = gradient_by_chance(1);
        element_tensor product = {0};
        double a[9][9], at[9], high[9], low[9], sides[9], scale = 0, worst = 0, gone[9];
        form_tangent(f, h, c, a);
        memcpy(at, &h, sizeof at);
        memcpy(sides, &y, sizeof sides);
        for (int s = 0; s < 9; s++) {
            element_tensor p;
            at[s] += step;
            p = form_stress(f, tensor_of(at), c);
            memcpy(high, &p, sizeof high);
            at[s] -= 2 * step;
            p = form_stress(f, tensor_of(at), c);
            memcpy(low, &p, sizeof low);
            at[s] += step;
            for (int r = s; r < 9; r++) {
                a[s][r] = a[r][s];
                scale = larger(scale, fabs(a[r][s]));
                worst = larger(worst, fabs(a[r][s] - (high[r] - low[r]) / (2 * step)));
            }
        }
        off = larger(off, worst / scale);
        form_along(f, h, c, y, tangent_dot(element_cofactor(h), y), &product);
        memcpy(gone, &product, sizeof gone);
        for (int r = 0; r < 9; r++) {
            for (int s = 0; s < 9; s++)
                gone[r] -= a[r][s] * sides[s];
            along = larger(along, fabs(gone[r]) / scale);
        }
    }
    ok(off < 1e-7, "%s: the tangent is the slope of stress, to %.1e", names[f], off);
    ok(along < 1e-12, "%s: the tangent along a direction, to %.1e", names[f], along);
}

/* The bounds of the largest eigenvalue, with fibres by chance: they hold, and the matrix is seldom needed. */
static void test_range(form f, const double *c, double strain)
{
    int wrong = 0, wide = 0;
    for (int i = 0; i < 10 * TRIALS; i++) {
        const double side[3] = {.01 + .005 * number(), .01 + .005 * number(), .01};
        const element_tensor h = gradient_by_chance(strain);
        element_fibre fibre = {{number(), number(), number()}, 2000 * number(), {0, 0, 0, 0}, {0, 0}};
        const element_fibre none = {0};
        const double length = element_length(fibre.along);
        fibre.along.x /= length, fibre.along.y /= length, fibre.along.z /= length;
        step_matrix a;
        stability_matrix(f, c, 1000, side, h, fibre, none, &a);
        const stability_range range = stability_range_of(f, c, 1000, side, h, fibre, none);
        const double largest = stability_largest(&a);
        wrong += !(range.low <= largest && largest <= range.high);
        wide += !(range.high <= 1.05 * range.low);
    }
    ok(!wrong, "%s, H to %g: bounds of eigenvalues hold: %d do not", names[f], strain, wrong);
    ok(wide < 4 * TRIALS, "%s, H to %g: all but %d of %d within 5 %%", names[f], strain, wide, 10 * TRIALS);
}

/* Neo-Hookean is the same in a form that expresses it. */
static void test_express_in(form f)
{
    double own[FORM_NUMBERS], c[FORM_NUMBERS], none[FORM_NUMBERS], worst = 0, energy = 0, slope = 0;
    form_tried(FORM_NEO_HOOKEAN, 1000, 9700, own);
    ok(form_express(FORM_NEO_HOOKEAN, f, own, c) && c[0] == 500 && c[1] == 0, "neo-Hookean in the form %s", names[f]);
    ok(!form_express(f, FORM_NEO_HOOKEAN, c, none) && !form_express(FORM_LINEAR, f, own, none),
       "not the other way round, nor what is linear");
    for (int i = 0; i < TRIALS; i++) {
        const element_tensor h = gradient_by_chance(.4);
        const element_tensor p = form_stress(FORM_NEO_HOOKEAN, h, own);
        double a[9][9], b[9][9];
        form_tangent(FORM_NEO_HOOKEAN, h, own, a);
        form_tangent(f, h, c, b);
        for (int r = 0; r < 9; r++)
            for (int s = 0; s <= r; s++)
                slope = larger(slope, fabs(a[r][s] - b[r][s]) / own[1]);
        worst = larger(worst, apart(p, form_stress(f, h, c)) / largest_of(p));
        energy = larger(energy, fabs(form_energy(FORM_NEO_HOOKEAN, h, own) / form_energy(f, h, c) - 1));
    }
    ok(worst < 1e-12 && energy < 1e-11 && slope < 1e-12, "the same stress, energy and tangent: %.1e, %.1e, %.1e", worst,
       energy, slope);
}

/* What lies between two has the moduli between, by forms that both express it alike. */
static void test_between_in(form f, form wider)
{
    const double share = .3, mu = 1700, bulk = 2e4;
    double a[FORM_NUMBERS], b[FORM_NUMBERS], c[FORM_NUMBERS], wide[3][FORM_NUMBERS], worst = 0;
    form_tried(f, 1000, 9700, a);
    form_tried(f, 3000, 5e4, b);
    form_between(f, mu, bulk, a, b, share, c);
    if (!ok(form_express(f, wider, a, wide[0]) && form_express(f, wider, b, wide[1]), "%s expresses %s", names[wider],
            names[f]))
        return;
    form_between(wider, mu, bulk, wide[0], wide[1], share, wide[2]);
    for (int i = 0; i < TRIALS; i++) {
        const element_tensor h = gradient_by_chance(.4), p = form_stress(f, h, c);
        worst = larger(worst, apart(p, form_stress(wider, h, wide[2])) / largest_of(p));
    }
    ok(worst < 1e-12, "%s: what lies between two is the same in %s, to %.1e", names[f], names[wider], worst);
}

/* f by its own mu goes by shares. */
static void test_between_first(void)
{
    const double a[FORM_NUMBERS] = {500, 800, 0, 0, 100, 9700}, b[FORM_NUMBERS] = {1000, 0, 4000, 0, 0, 9700};
    double c[FORM_NUMBERS];
    form_between(FORM_FIRST, 1600, 12000, a, b, .25, c);
    near_(c[0], 800, 1e-9, "first, between two: c1 is mu/2");
    near_(c[1], 1600 * .75 * .8, 1e-9, "c2");
    near_(c[2], 1600 * .25 * 2, 1e-9, "c3");
    near_(c[4], 1600 * .75 * .1, 1e-9, "c5");
    near_(c[5], 12000, 0, "K");
}

static void test_between(void)
{
    const double a[FORM_NUMBERS] = {300, 200, 9700}, b[FORM_NUMBERS] = {2000, 0, 9700};
    double c[FORM_NUMBERS];
    form_between(FORM_MOONEY_RIVLIN, 2000, 9700, a, b, .5, c);
    near_(c[0], 800, 1e-9, "between two: c10");
    near_(c[1], 200, 1e-9, "between two: c01");
    near_(c[2], 9700, 0, "between two: K");
    const double one[FORM_NUMBERS] = {1000, 9700}, other[FORM_NUMBERS] = {4000, 9700};
    form_between(FORM_NEO_HOOKEAN, 2000, 9700, one, other, .5, c);
    ok(c[0] == 2000 && c[1] == 9700 && c[2] == 0, "neo-Hookean: the moduli between");
}

/* Of terms with equal exponents one is made, and the terms of both are there: the sum of energies is exact. */
static void test_between_general(void)
{
    const double share = .25, mu = 1600;
    double a[FORM_NUMBERS] = {0}, b[FORM_NUMBERS] = {0}, c[FORM_NUMBERS], worst = 0;
    a[FORM_GENERAL_e] = 500, a[FORM_GENERAL_b] = 2, a[FORM_GENERAL_c01] = -500; /* mu 1000 */
    b[FORM_GENERAL_e] = 100, b[FORM_GENERAL_b] = 5, b[FORM_GENERAL_c01] = -250; /* 500 + m a^2 / 2 */
    for (int i = 0; i < 3; i++) {
        a[FORM_GENERAL_m + i] = 10 + i, a[FORM_GENERAL_a + i] = 2 + i;
        b[FORM_GENERAL_m + i] = 30 - i, b[FORM_GENERAL_a + i] = -3 - i;
    }
    b[FORM_GENERAL_a + 1] = 3;
    form_between(FORM_GENERAL, mu, 0, a, b, share, c);
    int terms = 0;
    for (int i = 0; i < FORM_GENERAL_STRETCHES; i++)
        terms += c[FORM_GENERAL_m + i] != 0;
    ok(terms == 5 && c[FORM_GENERAL_e + 1] != 0, "general, between two: %d terms of stretches, two exponentials",
       terms);
    near_(form_general_shear(c), mu, 1e-9, "its modulus at rest");
    for (int i = 0; i < TRIALS; i++) {
        const element_tensor h = gradient_by_chance(.4);
        const double sum = (1 - share) * form_energy(FORM_GENERAL, h, a) / form_general_shear(a) +
                           share * form_energy(FORM_GENERAL, h, b) / form_general_shear(b);
        worst = larger(worst, fabs(form_energy(FORM_GENERAL, h, c) / (mu * sum) - 1));
    }
    ok(worst < 1e-12, "and its energy is the sum by shares, to %.1e", worst);
    form_between(FORM_GENERAL, mu, 0, a, a, share, c);
    ok(c[FORM_GENERAL_e + 1] == 0 && c[FORM_GENERAL_m + 3] == 0, "of one and the same, it has as many terms");
}

/* The exponent 2 is neo-Hookean, 2 and -2 together are Mooney-Rivlin where the volume is kept: also where stretches are
 * equal, or nearly. */
static void test_equal_stretches(void)
{
    const double mu = 1000, bulk = 9700, plain[FORM_NUMBERS] = {1000, 9700};
    double c[FORM_NUMBERS] = {0}, worst = 0, slope = 0;
    c[FORM_GENERAL_m] = mu / 2, c[FORM_GENERAL_a] = 2, c[FORM_GENERAL_K] = bulk;
    for (int i = 0; i < 3 * TRIALS; i++) {
        const double x = .4 * number(), y = i % 3 ? x : x * (1 + 1e-9 * number()), z = i % 3 == 2 ? x : .4 * number();
        const element_tensor turn = turn_by_chance(), diagonal = {1 + x, 0, 0, 0, 1 + y, 0, 0, 0, 1 + z};
        const element_tensor f = element_product(element_product(turn, diagonal), tangent_transposed(turn));
        const element_tensor h = minus_one(f), p = form_stress(FORM_NEO_HOOKEAN, h, plain);
        double a[9][9], b[9][9];
        worst = larger(worst, apart(p, form_stress(FORM_GENERAL, h, c)) / mu);
        form_tangent(FORM_NEO_HOOKEAN, h, plain, a);
        form_tangent(FORM_GENERAL, h, c, b);
        for (int r = 0; r < 9; r++)
            for (int s = 0; s <= r; s++)
                slope = larger(slope, fabs(a[r][s] - b[r][s]) / bulk);
    }
    ok(worst < 1e-13, "general of stretches squared is neo-Hookean where stretches are equal: %.1e of mu", worst);
    ok(slope < 1e-13, "and its tangent: %.1e of K", slope);
}

/* Jacobi's rotations leave nothing beside the diagonal, however small or alike the entries are. */
static void test_spectral(void)
{
    double worst = 0, square = 0;
    for (int i = 0; i < 20 * TRIALS; i++) {
        const double by = pow(10, 10 * number() - (i % 4 ? 0 : 280));
        const double off = by * pow(10, i % 3 ? 0 : 16 * number() - 8);
        const element_symmetric a = {by * number(),  by * number(),  by * number(),
                                     off * number(), off * number(), off * number()};
        const spectral s = spectral_of(a);
        const element_symmetric back = spectral_with(s.v, s.at);
        const element_tensor v = element_product(tangent_transposed(s.v), s.v);
        const element_tensor rest = {
            back.xx - a.xx, back.xy - a.xy, back.zx - a.zx, back.yy - a.yy, back.yz - a.yz, back.zz - a.zz, 0, 0, 0};
        worst = larger(worst, largest_of(rest) / fmax(by, off));
        square = larger(square, largest_of(minus_one(v)));
    }
    const spectral none = spectral_of((element_symmetric){0});
    ok(worst < 1e-14, "eigenvalues and vectors give the tensor: %.1e off", worst);
    ok(square < 1e-14, "vectors are orthonormal: %.1e off", square);
    ok(none.at.x == 0 && none.v.xx == 1 && none.v.xy == 0, "of nothing they are 0 and the axes");
}

/* P_xx where the sides that are free, y and z or z alone, are not pulled. */
static double pulled(double x, bool both, double *lateral)
{
    const double c[FORM_NUMBERS] = {2500, 500, 1e5};
    double low = .5, high = 1.5;
    element_tensor p = {0};
    for (int i = 0; i < 200; i++) {
        *lateral = (low + high) / 2;
        const element_tensor h = {x - 1, 0, 0, 0, (both ? x : *lateral) - 1, 0, 0, 0, *lateral - 1};
        p = form_stress(FORM_MOONEY_RIVLIN, h, c);
        if (p.zz > 0)
            high = *lateral;
        else
            low = *lateral;
    }
    return p.xx;
}

static void test_figures(void)
{
    const double c[FORM_NUMBERS] = {2500, 500, 1e5};
    double lateral;
    near_(pulled(1.2, false, &lateral) / 2882.59, 1, 1e-5, "c10 2500, c01 500, K 1e5: stretched by 1.2, Pa");
    near_(lateral, .918060, 1e-6, "and its sides");
    near_(pulled(.8, false, &lateral) / -4677.80, 1, 1e-5, "pressed to .8");
    near_(pulled(1.15, true, &lateral) / 3855.32, 1, 1e-5, "stretched by 1.15 along two axes");
    const element_tensor shear = {0, .4, 0, 0, 0, 0, 0, 0, 0}, p = form_stress(FORM_MOONEY_RIVLIN, shear, c);
    const element_tensor cauchy = element_product(p, tangent_transposed(tangent_moved(shear)));
    near_(cauchy.xy, 2400, 2400e-5, "sheared by .4");
    near_(cauchy.xx - cauchy.yy, 960, 960e-5, "and the difference of its normal stresses");
}

int main(void)
{
    for (int f = 0; f < FORM_STEPPED; f++) {
        double c[FORM_NUMBERS];
        if (!ok(form_tried((form)f, 1000, 9700, c), "%s: form_tried.h has coefficients", names[f]))
            continue;
        test_stress((form)f, c);
        test_tangent((form)f, c);
        test_range((form)f, c, .02);
        test_range((form)f, c, .3);
    }
    const double second[FORM_NUMBERS] = {0, 500, 9700};
    test_range(FORM_MOONEY_RIVLIN, second, .02);
    test_range(FORM_MOONEY_RIVLIN, second, .3);
    const double softens[FORM_NUMBERS] = {500, -400, 300, 0, 0, 9700}; /* f'' is below 0 at small strains */
    test_tangent(FORM_FIRST, softens);
    test_range(FORM_FIRST, softens, .02);
    test_range(FORM_FIRST, softens, .3);
    double steep[FORM_NUMBERS] = {0}; /* skin of an exponential, and brain's stretches */
    steep[FORM_GENERAL_e] = 100, steep[FORM_GENERAL_b] = 3, steep[FORM_GENERAL_c01] = -150,
    steep[FORM_GENERAL_K] = 9700;
    test_tangent(FORM_GENERAL, steep);
    test_range(FORM_GENERAL, steep, .02);
    test_range(FORM_GENERAL, steep, .1);
    steep[FORM_GENERAL_m] = 1, steep[FORM_GENERAL_a] = -19;
    test_range(FORM_GENERAL, steep, .02);
    test_express_in(FORM_MOONEY_RIVLIN);
    test_express_in(FORM_FIRST);
    test_express_in(FORM_GENERAL);
    test_between();
    test_between_first();
    test_between_general();
    test_between_in(FORM_FIRST, FORM_GENERAL);
    test_between_in(FORM_MOONEY_RIVLIN, FORM_GENERAL);
    test_equal_stretches();
    test_spectral();
    test_between_in(FORM_NEO_HOOKEAN, FORM_MOONEY_RIVLIN);
    test_between_in(FORM_NEO_HOOKEAN, FORM_FIRST);
    test_figures();
    return done_testing();
}
