/* A muscle's curves in double: their figures; its stress against complex steps of an energy that is written here as its
 * equation is; objectivity; slopes and sums; and that the passive curve wins where the active one falls.
 */
#include "muscle_cases.h"

#include "physics/stability.h"

#include <complex.h>

static double number(void)
{
    static uint32_t seed = 7;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

/* A muscle as its equations have it. */
typedef struct told {
    double along[3], level, optimum, passive, stiffening, straight;
} told;

static element_fibre fibre_of(const told *t)
{
    return (element_fibre){
        .along = {t->along[0], t->along[1], t->along[2]},
        .tension = t->level * peak / t->optimum,
        .curves = {1 / t->optimum - 1, t->passive * peak / t->optimum, t->stiffening, t->straight - 1}};
}

/* peak (a F(l) + passive G(l)) with F' = f, G' = fp/passive, d lambda = optimum dl. */
static double complex energy(const told *t, double complex f[3][3])
{
    double complex square = 0;
    for (int k = 0; k < 3; k++) {
        double complex m = 0;
        for (int j = 0; j < 3; j++)
            m += f[k][j] * t->along[j];
        square += m * m;
    }
    const double complex l = csqrt(square) / t->optimum;
    const double at = creal(l), end = t->straight, steep = exp(t->stiffening * (end - 1));
    double complex active = 0, passive = 0;
    if (at > .4)
        active = at < .6    ? 3 * (l - .4) * (l - .4) * (l - .4)
                 : at < 1.4 ? .024 + (l - 4. / 3 * (l - 1) * (l - 1) * (l - 1)) - (.6 + 4. / 3 * .064)
                 : at < 1.6 ? 3 * (l - 1.6) * (l - 1.6) * (l - 1.6)
                            : 0;
    if (at > 1)
        passive = at < end ? (cexp(t->stiffening * (l - 1)) - 1) / t->stiffening - (l - 1)
                           : (steep - 1) / t->stiffening - (end - 1) + (steep - 1) * (l - end) +
                                 t->stiffening * steep * (l - end) * (l - end) / 2;
    return peak * (t->level * active + t->passive * passive);
}

static told told_by_chance(void)
{
    told t = {.level = fabs(number()),
              .optimum = 1 + .3 * number(),
              .passive = .05 + .04 * number(),
              .stiffening = 6 + 3 * number(),
              .straight = 1.3 + .2 * number()};
    double square = 0;
    for (int a = 0; a < 3; a++) {
        t.along[a] = number();
        square += t.along[a] * t.along[a];
    }
    for (int a = 0; a < 3; a++)
        t.along[a] /= sqrt(square);
    return t;
}

static element_tensor gradient_by_chance(double most)
{
    double entry[9];
    element_tensor h;
    for (int i = 0; i < 9; i++)
        entry[i] = most * number();
    memcpy(&h, entry, sizeof h);
    return h;
}

static void put_complex(element_tensor h, double complex f[3][3])
{
    double entry[9];
    memcpy(entry, &h, sizeof h);
    for (int i = 0; i < 9; i++)
        f[i / 3][i % 3] = entry[i] + (i % 4 == 0);
}

static void test_stress(void)
{
    double worst = 0;
    int stretched = 0;
    for (int i = 0; i < 2000; i++) {
        const told t = told_by_chance();
        const element_tensor h = gradient_by_chance(.45), p = element_curved(h, fibre_of(&t));
        double complex f[3][3];
        double got[9], scale = 1;
        memcpy(got, &p, sizeof p);
        for (int k = 0; k < 9; k++)
            scale = fmax(scale, fabs(got[k]));
        for (int k = 0; k < 9; k++) {
            put_complex(h, f);
            f[k / 3][k % 3] += 1e-30 * I;
            worst = fmax(worst, fabs(cimag(energy(&t, f)) / 1e-30 - got[k]) / scale);
        }
        stretched += element_fibre_energy(h, fibre_of(&t)) > 0;
    }
    ok(worst < 1e-13, "P is the complex step of the energy, 2000 gradients: %.2g", worst);
    ok(stretched > 500 && stretched < 1500, "stretched and shortened muscles: %d", stretched);
}

/* The energies by which the log is balanced are those of the equations. */
static void test_energy(void)
{
    double worst = 0;
    for (int i = 0; i < 1000; i++) {
        told t = told_by_chance();
        const element_tensor h = gradient_by_chance(.45);
        double complex f[3][3];
        put_complex(h, f);
        t.level = 0;
        worst = fmax(worst, fabs(creal(energy(&t, f)) - element_fibre_energy(h, fibre_of(&t))));
    }
    ok(worst < 1e-9 * peak, "and the energy of a passive muscle: %.2g Pa", worst);
    near_(muscle_force_length_sum(1.6) - muscle_force_length_sum(.4), .048 + .8 - 8. / 3 * .064, 1e-15,
          "the whole of f");
}

/* F turned after and before: P turns with it, and fibres that turn too change nothing. */
static void test_turned(void)
{
    const double c = cos(.7), s = sin(.7);
    const element_tensor q = {c, -s, 0, s, c, 0, 0, 0, 1};
    double worst = 0, skew = 0;
    for (int i = 0; i < 500; i++) {
        const told t = told_by_chance();
        const element_tensor h = gradient_by_chance(.4), f = tangent_moved(h), moved = element_product(q, f);
        const element_tensor less = {moved.xx - 1, moved.xy, moved.xz, moved.yx,    moved.yy - 1,
                                     moved.yz,     moved.zx, moved.zy, moved.zz - 1};
        const element_tensor p = element_curved(h, fibre_of(&t)), turned = element_curved(less, fibre_of(&t));
        const element_tensor want = element_product(q, p), tau = element_product(p, tangent_transposed(f));
        element_tensor gap = turned;
        tangent_add(&gap, -1, want);
        worst = fmax(worst, sqrt(tangent_dot(gap, gap) / (1 + tangent_dot(p, p))));
        skew = fmax(skew, fabs(tau.xy - tau.yx) + fabs(tau.yz - tau.zy) + fabs(tau.zx - tau.xz));
    }
    ok(worst < 1e-12, "P(Q F) = Q P(F): %.2g", worst);
    ok(skew < 1e-9, "P F^T is symmetric: %.2g Pa", skew);
}

static void test_slopes(void)
{
    double worst = 0;
    for (int i = 0; i < 2000; i++) {
        const told t = told_by_chance();
        const element_fibre fibre = fibre_of(&t);
        const double lambda = 1 + .6 * number(), d = 1e-6;
        const element_tensor high = {.xx = lambda + d - 1}, low = {.xx = lambda - d - 1};
        element_fibre along = fibre;
        along.along = (element_vector){1, 0, 0};
        const double want = (element_curved(high, along).xx - element_curved(low, along).xx) / (2 * d);
        const double kink = fmin(fabs(lambda / t.optimum - 1), fabs(lambda / t.optimum - t.straight));
        if (kink > 2 * d) /* there the slope jumps, or its own slope does */
            worst = fmax(worst, fabs(stability_fibre_slope(along, lambda, lambda - 1) - want));
    }
    ok(worst < 1e-5 * peak, "the fibre's slope: %.2g Pa", worst);
}

/* Fully active, in tissue of mu 5e3, whose own stress along a bar rises by mu (1 + 2/lambda^3): where does the whole
 * fall as the muscle is stretched? */
static void test_descending(void)
{
    double first = 0, last = 0, first_alone = 0, last_alone = 0;
    for (int k = 0; k < 700; k++) {
        const double l = 1 + .001 * k;
        element_fibre fibre = muscle_of(1, 1), alone = fibre;
        alone.curves.passive = 0;
        if (stability_fibre_slope(fibre, l, l - 1) + 5e3 * (1 + 2 / (l * l * l)) < 0) {
            first = first > 0 ? first : l;
            last = l;
        }
        if (stability_fibre_slope(alone, l, l - 1) + 5e3 * (1 + 2 / (l * l * l)) < 0) {
            first_alone = first_alone > 0 ? first_alone : l;
            last_alone = l;
        }
    }
    printf("# stress falls from %.3f to %.3f with the passive curve, from %.3f to %.3f without\n", first, last,
           first_alone, last_alone);
    ok(last < 1.4, "at the stretch of straight fibres the passive curve has won");
    ok(first_alone > 1 && last_alone > 1.59, "without it the force falls up to the end of the active curve");
    const element_fibre at = muscle_of(1, 1);
    ok(stability_fibre_slope(at, 1.4, .4) > 0, "its slope there is %.0f Pa", stability_fibre_slope(at, 1.4, .4));
}

int main(void)
{
    test_all_muscles(5e-6);
    test_stress();
    test_energy();
    test_turned();
    test_slopes();
    test_descending();
    return done_testing();
}
