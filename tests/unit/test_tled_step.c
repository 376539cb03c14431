/* The stable step: against its formulas at rest, the element's matrix against the derivative of its
 * stress, its largest eigenvalue against bounds of it, and the model's bound against the largest frequency
 * of a block, found by power iteration. */
// needs: tled/problem/state.c tled/problem/deformed.c tled/problem/conforming.c
// needs: tled/problem/conforming_step.c tled/problem/step.c tled/problem/cut.c tled/problem/films.c
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/loads.c tled/problem/followers.c tled/problem/muscle_fibre.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c tled/problem/bodies.c
#include "tled/problem/step.h"

#include "form_tried.h"
#include "tap.h"
#include "tled_block.h"

#include <string.h>

static const block soft = {{3, 3, 3}, {.0125, .0125, .0125}, 3000, .49, 1000, 30000, 0, 0, 0, {0, 0, 0}, 0, false};

static double stable_of(block b, hourglass_control control)
{
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    block_make(&b, &m);
    ok(!tled_problem_make(&p, &m, &s, control, &e), "the problem: %s", e.text);
    double stable = step_at_rest(&p, NULL);
    tled_problem_free(&p);
    model_free(&m);
    return stable;
}

static void test_rest(void)
{
    block b = soft;
    near_(stable_of(b, PHYSICAL), .0125 / sqrt(3 * 50000. / 1000), 1e-12, "12.5 mm, nu = .49: h / sqrt(3 K / rho)");
    near_(stable_of(b, PHYSICAL), 1.02e-3, .005e-3, "which is 1.02 ms");
    b.poisson = .1;
    near_(stable_of(b, PHYSICAL), .0125 / sqrt(3 * (3000 / 2.4) / 1000), 1e-12, "nu = .1");
    b.poisson = .45;
    double modulus = 11 * 3000 / 2.9;
    near_(stable_of(b, ISOTROPIC(2)), .0125 / sqrt(2 * 3 * modulus / 1000), 1e-12,
          "a stiff hourglass control limits it");
    /* Anisotropic, nu = 0: C_11 = E alone, along the shortest side, or shear in the plane of the two shortest. */
    b.poisson = 0;
    b.side[0] = .01, b.side[1] = .02, b.side[2] = .04;
    near_(stable_of(b, PHYSICAL), 2 / sqrt(4. / 1000 * 3000 / 1e-4), 1e-12,
          "10 x 20 x 40 mm, nu = 0: along the shortest side");
    /* lambda -> large: K (1/h_i)(1/h_j) has the eigenvalue K sum(1/h^2). */
    b.poisson = .4999;
    double bulk = 3000 / (3 * (1 - 2 * b.poisson)), squares = 1e4 + 2500 + 625;
    near_(stable_of(b, PHYSICAL) / (2 / sqrt(4. / 1000 * bulk * squares)), 1, 1e-3,
          "nearly incompressible: K sum(1/h^2)");
}

static const double tissue[FORM_NUMBERS] = {1000, 9700}; /* mu, K */

/* P at H, passive and active. */
static void stress(const tled_law *v, element_tensor h, element_fibre fibre, element_fibre second, double p[9])
{
    element_tensor t = element_sum(form_stress(FORM_NEO_HOOKEAN, h, v->c), element_curved(h, fibre));
    t = element_sum(t, element_curved(h, second));
    memcpy(p, &t, sizeof t);
}

/* The matrix is (4/rho) dP_kj/dF_lm / (h_j h_m). */
static void test_matrix(element_tensor h, element_fibre fibre, element_fibre second)
{
    tled_problem p = {.side = {.01, .0125, .02}};
    tled_law v = {.c = {1000, 9000}, .density = 1100};
    step_matrix a;
    double worst = 0, scale = 0, shifted[9], high[9], low[9];
    const step_fibres fibres = {.own = fibre, .other = second};
    step_matrix_of(&p, &v, h, &fibres, &a);
    for (int c = 0; c < 9; c++) {
        element_tensor moved;
        memcpy(shifted, &h, sizeof h);
        shifted[c] += 1e-6;
        memcpy(&moved, shifted, sizeof h);
        stress(&v, moved, fibre, second, high);
        shifted[c] -= 2e-6;
        memcpy(&moved, shifted, sizeof h);
        stress(&v, moved, fibre, second, low);
        for (int r = 0; r < 9; r++) {
            double want = 4 / v.density * (high[r] - low[r]) / 2e-6 / (p.side[r % 3] * p.side[c % 3]);
            worst = fmax(worst, fabs(a.at[r][c] - want));
            scale = fmax(scale, fabs(want));
        }
    }
    near_(worst / scale, 0, 1e-7, "the matrix is the stress's derivative, tension %g and %g Pa", fibre.tension,
          second.tension);
    double largest = step_largest(&a);
    ok(step_below(&a, largest * (1 + 1e-9)) && !step_below(&a, largest * (1 - 1e-9)), "its largest eigenvalue splits");
}

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

static double passive; /* of muscles by chance: Pa; above 0, their optimum differs from 1 too */

static element_fibre fibre_by_chance(double tension)
{
    element_fibre fibre = {{number(), number(), number()}, tension, {0, 0, 0, 0}, {0, 0}};
    if (passive > 0)
        fibre.curves = (muscle_curves){.2 * number(), passive, 6.6, .4};
    const double length = element_length(fibre.along);
    fibre.along.x /= length, fibre.along.y /= length, fibre.along.z /= length;
    return fibre;
}

/* Bounds of the largest eigenvalue hold at gradients up to `strain`, with muscles of up to `tension`; in the median
 * they are as near each other as `near`. */
static void test_range(double mu, double bulk, double strain, double tension, double near)
{
    const double c[FORM_NUMBERS] = {mu, bulk};
    int wrong = 0, close = 0, count = 0;
    while (count < 2000) {
        const double side[3] = {.01 + .005 * number(), .01 + .005 * number(), .01};
        double entry[9];
        element_tensor h;
        step_matrix a;
        for (int i = 0; i < 9; i++)
            entry[i] = strain * number();
        memcpy(&h, entry, sizeof h);
        const element_fibre first = fibre_by_chance(tension * number()), second = fibre_by_chance(tension);
        if (!(element_dilation(h) > -.9))
            continue;
        count++;
        stability_matrix(FORM_NEO_HOOKEAN, c, 1000, side, h, first, second, &a);
        const stability_range range = stability_range_of(FORM_NEO_HOOKEAN, c, 1000, side, h, first, second);
        const double largest = stability_largest(&a);
        wrong += !(range.low <= largest && largest <= range.high);
        close += range.high <= (1 + near) * range.low;
    }
    ok(!wrong, "bounds of %d eigenvalues, mu %g, K %g, H to %g, tension %g: %d wrong", count, mu, bulk, strain, tension,
       wrong);
    ok(close > count / 2, "half of them within %g: %d", near, close);
}

/* The internal forces of the whole block, element by element. */
static void pull(const tled_problem *p, const double *u, double *f)
{
    element_shape shape = element_box(p->side[0], p->side[1], p->side[2]);
    const element_fibre none = {0};
    memset(f, 0, (size_t)p->nodes * 3 * sizeof *f);
    for (int64_t i = 0; i < p->elements; i++) {
        const tled_law v = tled_law_of(p, i);
        const int32_t *n = p->element_node + 8 * i;
        element_law law;
        memcpy(law.c, v.c, sizeof law.c);
        memcpy(law.hourglass, v.hourglass, sizeof law.hourglass);
        element_field at, force;
        for (int c = 0; c < 8; c++) {
            at.x.at[c] = u[3 * n[c]];
            at.y.at[c] = u[3 * n[c] + 1];
            at.z.at[c] = u[3 * n[c] + 2];
        }
        force = element_force(p->form, p->control.kind, at, shape, law, none, false);
        for (int c = 0; c < 8; c++) {
            f[3 * n[c]] += force.x.at[c];
            f[3 * n[c] + 1] += force.y.at[c];
            f[3 * n[c] + 2] += force.z.at[c];
        }
    }
}

/* The largest eigenvalue of M^-1 K about the affine state (stretch - 1) x, by power
 * iteration on differences of forces. */
static double largest_frequency(const tled_problem *p, const double stretch[3])
{
    int64_t count = 3 * p->nodes;
    double *u = calloc((size_t)count * 4, sizeof *u), *rest = u + count, *f = u + 2 * count, *way = u + 3 * count,
           value = 0;
    for (int64_t i = 0; i < count; i++)
        way[i] = sin((double)(i * i % 97));
    for (int round = 0; round < 600; round++) {
        double size = 0;
        for (int64_t i = 0; i < count; i++)
            size = fmax(size, fabs(way[i]));
        for (int side = -1; side <= 1; side += 2) {
            for (int64_t i = 0; i < count; i++)
                u[i] = (stretch[i % 3] - 1) * p->position[i] + side * 1e-9 * way[i] / size;
            pull(p, u, side < 0 ? rest : f);
        }
        value = 0;
        for (int64_t i = 0; i < count; i++) {
            double next = (f[i] - rest[i]) / (2e-9 * p->mass[i / 3]);
            value = fmax(value, fabs(next));
            way[i] = next;
        }
    }
    free(u);
    return value;
}

/* A lone element's highest frequency is the bound; in a block, neighbours share nodes that they cannot both move. */
static void test_bound(form f, int32_t cells, double x, double y, double z, double least)
{
    block b = soft;
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    step_matrix a;
    const double stretch[3] = {x, y, z};
    const element_tensor h = {x - 1, 0, 0, 0, y - 1, 0, 0, 0, z - 1};
    const step_fibres none = {0};
    b.poisson = .45;
    b.side[1] = .01;
    b.cells[0] = b.cells[1] = b.cells[2] = cells;
    block_make(&b, &m);
    tled_problem_make(&p, &m, &s, PHYSICAL, &e);
    tled_law *of = &p.volume[0].law;
    ok(form_tried(f, of->mu, of->bulk, of->c), "form %d: form_tried.h has coefficients", f);
    p.form = f;
    const tled_law law = tled_law_of(&p, 0);
    step_matrix_of(&p, &law, h, &none, &a);
    double share = largest_frequency(&p, stretch) / step_largest(&a);
    ok(share <= 1 + 1e-6 && share >= least, "%d^3 elements stretched by %g %g %g: the largest w^2 is %.4f of the bound",
       cells, x, y, z, share);
    tled_problem_free(&p);
    model_free(&m);
}

/* Elements mixed of two volumes: the step at rest holds, and is not far from what is just stable; for an element of two
 * volumes with the same nu it is just that. */
static void test_mixed(int32_t cells, double poisson_of_second, double least)
{
    block b = soft;
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    const double rest[3] = {1, 1, 1};
    b.mixed = true;
    b.cells[0] = b.cells[1] = b.cells[2] = cells;
    block_make(&b, &m);
    model_find(&m, "material.nu")->f64[0] = .4;
    model_find(&m, "material.nu")->f64[1] = poisson_of_second;
    if (cells == 1) {
        model_find(&m, "element.volume")->i32[0] = 0;
        model_find(&m, "element.mix")->i32[0] = 1;
        model_find(&m, "element.mixture")->f32[0] = .3F;
    }
    ok(!tled_problem_make(&p, &m, &s, PHYSICAL, &e), "a mixed model: %s", e.text);
    double stable = step_at_rest(&p, NULL), share = largest_frequency(&p, rest) * stable * stable / 4;
    ok(share <= 1 + 1e-6 && share >= least, "%d^3 elements, some mixed: the largest w^2 is %.4f of the bound", cells,
       share);
    tled_problem_free(&p);
    model_free(&m);
}

static void test_rate(void)
{
    int64_t check;
    near_(step_rate(2.28218e-3, &check), 900, 0, "900 steps a second for a stable step of 2.28 ms");
    ok(check == 9, "looked at every 9 steps");
    near_(step_rate(5e-5, &check), 40000, 0, "40000 for 0.05 ms");
    ok(check == 200, "looked at every 200");
    double rate = step_rate(4.7e-5, &check);
    ok(rate >= 2 / 4.7e-5 && fmod(rate / 100, (double)check) == 0, "checks divide 1/100 s");
    near_(step_rate(1, &check), 100, 0, "never fewer than 100");
}

/* What is nearly flat, or a line, its volume down to 1e-16: gradients of which cofactors keep few digits. */
static void test_collapsed(void)
{
    int wrong = 0, count = 0;
    while (count < 2000) {
        static const double side[3] = {.01, .0125, .02};
        const double thin = pow(10, -8 * fabs(number())), thinner = number() > 0 ? thin : 1;
        const double of_row[3] = {1, thinner, thin};
        double f[9];
        element_tensor h;
        step_matrix a;
        for (int i = 0; i < 9; i++)
            f[i] = number() * of_row[i / 3];
        for (int i = 0; i < 3; i++) { /* rows that are nearly one row's multiples */
            f[3 + i] += thinner < 1 ? f[i] / 2 : 0;
            f[6 + i] += f[i] / 3 + f[3 + i] / 4;
        }
        f[0] -= 1, f[4] -= 1, f[8] -= 1;
        memcpy(&h, f, sizeof h);
        if (!(1 + element_dilation(h) > 0))
            continue;
        count++;
        const element_fibre first = fibre_by_chance(30000 * number()), second = fibre_by_chance(3000);
        stability_matrix(FORM_NEO_HOOKEAN, tissue, 1000, side, h, first, second, &a);
        const stability_range range = stability_range_of(FORM_NEO_HOOKEAN, tissue, 1000, side, h, first, second);
        const double largest = stability_largest(&a);
        wrong += !(range.low <= largest && largest <= range.high);
    }
    ok(!wrong, "bounds of %d eigenvalues of elements that are nearly flat: %d wrong", count, wrong);
}

/* Where there is no answer there are no bounds: whoever asks has to take the matrix, which says so. */
static void test_no_range(void)
{
    static const double side[3] = {.01, .01, .01};
    const element_fibre none = {0}, lost = {{NAN, 0, 1}, 3000, {0, 0, 0, 0}, {0, 0}},
                        wild = {{0, 0, 1}, INFINITY, {0, 0, 0, 0}, {0, 0}};
    const element_tensor rest = {0}, point = {-1, 0, 0, 0, -1, 0, 0, 0, -1}, broken = {0, 0, 0, 0, 0, NAN, 0, 0, 0};
    const stability_range range[] = {stability_range_of(FORM_NEO_HOOKEAN, tissue, 1000, side, point, none, none),
                                     stability_range_of(FORM_NEO_HOOKEAN, tissue, 1000, side, broken, none, none),
                                     stability_range_of(FORM_NEO_HOOKEAN, tissue, 1000, side, rest, lost, none),
                                     stability_range_of(FORM_NEO_HOOKEAN, tissue, 1000, side, rest, none, wild),
                                     stability_range_of(FORM_NEO_HOOKEAN, tissue, 0, side, rest, none, none)};
    for (size_t i = 0; i < sizeof range / sizeof *range; i++)
        ok(!isfinite(range[i].high), "no bounds of what is not finite: %g to %g", range[i].low, range[i].high);
}

static void test_ranges(void)
{
    test_range(1000, 9700, 0, 0, .001);   /* nu = .45, at rest */
    test_range(1000, 49700, .2, 0, .001); /* nu = .49 */
    test_range(1000, 9700, .1, 3000, .5);
    test_range(1000, 9700, .3, 30000, 10);
    test_range(1000, 2000, .5, 3000, 1);
    test_range(1000, 300, .5, 1000, 10);
    passive = .05 * 3e5;
    test_range(5e3, 2.5e5, .1, 3e5, 1);
    test_range(5e3, 2.5e5, .3, 3e5, 3);
    test_range(1e3, 9700, .3, 0, 10);
    passive = 0;
    test_collapsed();
    test_no_range();
}

int main(void)
{
    const element_tensor bent = {.2, .3, -.1, .05, -.2, .2, -.15, .1, .1}, rest = {0};
    const element_fibre none = {0}, muscle = {{2. / 7, 3. / 7, 6. / 7}, 30000, {0, 0, 0, 0}, {0, 0}};
    test_rest();
    const element_fibre other = {{.6, -.64, .48}, 12000, {0, 0, 0, 0}, {0, 0}};
    test_matrix(rest, none, none);
    test_matrix(rest, muscle, none);
    test_matrix(bent, none, none);
    test_matrix(bent, muscle, none);
    test_matrix(bent, muscle, other);
    const element_fibre stretched = {{.8, .6, 0}, 30000, {.1, 15000, 6.6, .4}, {0, 0}};
    const element_fibre straight = {{1, 0, 0}, 0, {0, 15000, 6.6, .1}, {0, 0}};
    test_matrix(bent, stretched, straight);
    test_matrix(bent, none, straight);
    for (int f = 0; f < FORM_STEPPED; f++) {
        test_bound((form)f, 1, 1, 1, 1, 1 - 1e-5);
        test_bound((form)f, 1, 1.3, .9, .9, 1 - 1e-5);
        test_bound((form)f, 1, .7, 1.1, 1.2, 1 - 1e-5);
        test_bound((form)f, 4, 1, 1, 1, .5);
        test_bound((form)f, 4, 1.3, .9, .9, .5);
        test_bound((form)f, 4, .7, 1.1, 1.2, .5);
    }
    test_mixed(1, .4, 1 - 1e-5);
    test_mixed(1, .49, .95);
    test_mixed(5, .3, .4);
    test_rate();
    test_ranges();
    return done_testing();
}
