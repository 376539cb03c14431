/* Elements that a surface cuts, in the CPU's executors: a block with an oblique face under constant stress is in
 * equilibrium with exact tractions on its faces, which shares alone do not give; forces are the derivative of the
 * energy that monitors find, of mixed elements with fibres too; gravity goes by exact weights; the step at rest holds;
 * any threads and vectors give the same bytes; and models that cannot be are refused. */
// needs: tled/*/*.c
#include "solve/vectors.h"
#include "tled/cpu/cpu.h"
#include "tled/problem/cut.h"
#include "tled/problem/deformed.h"
#include "tled/problem/step.h"

#include "cut_part.h"
#include "tap.h"
#include "tled_block.h"
#include "tled_choice.h"

#include <string.h>

static const block soft = {{6, 4, 3}, {.01, .012, .009}, 3000, .45, 1000, 30000, 2, 0, 0, {0, 0, 0}, 1, false};

typedef struct setting {
    model m;
    script s;
    tled_problem p;
    double *area; /* nodes x 3, m2: of the faces, by exact weights */
    double *part; /* nodes, m3: of the tissue, likewise */
} setting;

static void die(const char *why)
{
    printf("Bail out! %s\n", why);
    exit(1);
}

static double *numbers(int64_t count)
{
    double *x = calloc((size_t)count, sizeof *x);
    if (!x)
        die("no memory");
    return x;
}

/* ---- a block whose top layer an oblique plane cuts */

/* The plane z = .5 + .08 x - .05 y of the top layer, of heights in cells, in the coordinates of a cell of it. */
static part part_of(const int32_t at[3], int top)
{
    double n[3] = {-.08, .05, 1};
    part p = part_box();
    if (at[2] < top)
        return p;
    /* z + 1 = 2 (.5 + .08 (i + (x + 1)/2) - .05 (j + (y + 1)/2)) */
    const double d = 2 * (.5 + .08 * at[0] - .05 * at[1]) + .08 - .05 - 1, length = sqrt(part_dot(n, n));
    for (int a = 0; a < 3; a++)
        n[a] /= length;
    return part_clip(&p, n, d / length);
}

/* Adds an element's to the nodes. The faces between elements cancel. */
static void add_part(setting *s, int64_t element, const part *p, const block *b, const double moments[7], double share)
{
    const int32_t *node = model_find(&s->m, "element.node")->i32 + 8 * element;
    double area[8][3] = {{0}};
    int sign[8][3];
    for (int i = 0; i < 24; i++)
        sign[i / 3][i % 3] = 2 * lattice_vtk[i / 3][i % 3] - 1;
    for (int f = 0; f < p->faces; f++)
        part_add_face(&p->face[f], b->side, sign, area);
    for (int c = 0; c < 8; c++) {
        const double u[3] = {sign[c][0], sign[c][1], sign[c][2]};
        double by[8], shape = 1. / 8;
        part_products(u, by);
        for (int k = 0; k < 7; k++)
            shape += by[k + 1] * moments[k] / 8;
        s->part[node[c]] += share * shape * b->side[0] * b->side[1] * b->side[2];
        for (int a = 0; a < 3; a++)
            s->area[3 * (int64_t)node[c] + a] += area[c][a];
    }
}

static void cut_block(setting *s, const block *b, bool moments)
{
    err e = {0};
    const int32_t *size = b->cells;
    const int64_t whole = (int64_t)size[0] * size[1] * (size[2] - 1), elements = model_count(&s->m, "element");
    float *fraction = model_find(&s->m, "element.fraction")->f32;
    if (moments && model_axis_add(&s->m, "cut", elements - whole, &e))
        die(e.text);
    int32_t *element = moments ? block_array(&s->m, "cut.element")->i32 : NULL;
    float *to = moments ? block_array(&s->m, "cut.moments")->f32 : NULL;
    s->area = numbers(3 * model_count(&s->m, "node"));
    s->part = numbers(model_count(&s->m, "node"));
    for (int64_t i = 0; i < elements; i++) {
        const int32_t at[3] = {(int32_t)(i % size[0]), (int32_t)(i / size[0] % size[1]),
                               (int32_t)(i / size[0] / size[1])};
        double of[7];
        const part p = part_of(at, size[2] - 1);
        const double share = part_moments(&p, of);
        fraction[i] = (float)share;
        for (int k = 0; moments && i >= whole && k < 7; k++)
            to[7 * (i - whole) + k] = (float)of[k];
        if (moments && i >= whole)
            element[i - whole] = (int32_t)i;
        add_part(s, i, &p, b, of, share);
    }
}

static void make(setting *s, const block *b, bool moments, hourglass_control control)
{
    err e = {0};
    *s = (setting){.area = NULL};
    block_make(b, &s->m);
    cut_block(s, b, moments);
    const double gravity[3] = {1, 2, -9.81};
    if (script_add_gravity(&s->s, gravity, 0, &e) || tled_problem_make(&s->p, &s->m, &s->s, control, &e))
        die(e.text);
}

static void end(setting *s)
{
    tled_problem_free(&s->p);
    script_free(&s->s);
    model_free(&s->m);
    free(s->area);
    free(s->part);
}

/* What the elements pull with at displacements u. */
static void pull(setting *s, const tled_executor *by, int threads_wanted, const double *u, double *f)
{
    err e = {0};
    pool *threads = pool_create(threads_wanted, &e);
    memcpy(s->p.at_start.of[TLED_DISPLACEMENT], u, 3 * (size_t)s->p.nodes * sizeof *u);
    tled_state *state = threads ? by->create(&s->p, threads, &e) : NULL;
    if (!state || by->get(state, TLED_INTERNAL, f, &e))
        die(e.text);
    by->destroy(state);
    pool_destroy(threads);
}

/* ---- the patch test */

static double out_of_balance(const tled_executor *by, bool moments, hourglass_control control)
{
    static const double h[3][3] = {{.1, .05, -.02}, {0, -.05, .04}, {.03, 0, .08}};
    const element_tensor t = {.1, .05, -.02, 0, -.05, .04, .03, 0, .08};
    setting s;
    make(&s, &soft, moments, control);
    const element_tensor p = form_stress(s.p.form, t, s.p.volume[0].law.c);
    const double stress[3][3] = {{p.xx, p.xy, p.xz}, {p.yx, p.yy, p.yz}, {p.zx, p.zy, p.zz}};
    double *u = numbers(3 * s.p.nodes), *f = numbers(3 * s.p.nodes), worst = 0, scale = 0;
    for (int64_t i = 0; i < 3 * s.p.nodes; i++)
        u[i] = part_dot(h[i % 3], s.p.position + i / 3 * 3);
    pull(&s, by, 1, u, f);
    for (int64_t i = 0; i < 3 * s.p.nodes; i++) {
        const double want = part_dot(stress[i % 3], s.area + i / 3 * 3);
        worst = fmax(worst, fabs(f[i] - want));
        scale = fmax(scale, fabs(want));
    }
    free(u);
    free(f);
    end(&s);
    return worst / scale;
}

static void test_patch(void)
{
    near_(out_of_balance(&tled_cpu_double, true, PHYSICAL), 0, 1e-6, "constant stress in a block with an oblique face");
    near_(out_of_balance(&tled_cpu_double, true, ISOTROPIC(.05)), 0, 1e-6, "and with the other control");
    near_(out_of_balance(&tled_cpu_single, true, PHYSICAL), 0, 1e-4, "and in single precision");
    const double by_shares = out_of_balance(&tled_cpu_double, false, PHYSICAL);
    ok(by_shares > .05, "shares alone are out by %.3g", by_shares);
}

/* ---- energy, with all that elements may have */

static double energy_of(const tled_problem *p, const double *u)
{
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    double sum = 0;
    for (int64_t i = 0; i < p->elements; i++) {
        const deformed d = deformed_of(p, i, box, u);
        sum += tled_fraction(p, i) * (d.rest * d.energy + d.hourglass);
    }
    return sum;
}

static void shake(const setting *s, double by, double *u)
{
    for (int64_t i = 0; i < 3 * s->p.nodes; i++)
        u[i] = by * sin((double)(i * i % 97));
}

static void test_energy(const block_fibres *fibres, bool mixed, const char *name)
{
    block b = soft;
    setting s;
    b.mixed = mixed;
    b.fibre[0] = fibres ? 1 : 0;
    in_fibres = fibres;
    make(&s, &b, true, PHYSICAL);
    in_fibres = NULL;
    double *u = numbers(3 * s.p.nodes), *f = numbers(3 * s.p.nodes), worst = 0, scale = 0;
    shake(&s, 4e-4, u);
    pull(&s, &tled_cpu_double, 1, u, f);
    for (int64_t i = 7; i < 3 * s.p.nodes; i += 11) {
        const double was = u[i], step = 1e-8;
        u[i] = was + step;
        const double high = energy_of(&s.p, u);
        u[i] = was - step;
        const double slope = (high - energy_of(&s.p, u)) / (2 * step);
        u[i] = was;
        worst = fmax(worst, fabs(slope - f[i]));
        scale = fmax(scale, fabs(slope));
    }
    near_(worst / scale, 0, 1e-5, "%s: forces are the derivative of the energy", name);
    free(u);
    free(f);
    end(&s);
}

/* ---- bytes */

static void test_bytes(const tled_executor *by, const char *name)
{
    static const char *const sets[] = {"plain", "AVX2", "AVX-512"};
    block b = soft;
    setting s;
    b.mixed = true;
    make(&s, &b, true, PHYSICAL);
    double *u = numbers(3 * s.p.nodes), *want = numbers(3 * s.p.nodes), *f = numbers(3 * s.p.nodes);
    shake(&s, 4e-4, u);
    pull(&s, by, 1, u, want);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        err none = {0};
        setenv("SINEW_VECTORS", sets[i], 1);
        if (vectors_choose(&none) < 0) {
            skip(2, "this processor has no such vectors");
            continue;
        }
        for (int threads = 1; threads < 4; threads += 2) {
            pull(&s, by, threads, u, f);
            ok(!memcmp(f, want, 3 * (size_t)s.p.nodes * sizeof *f), "%s, %s, %d threads: the same bytes", name, sets[i],
               threads);
        }
    }
    unsetenv("SINEW_VECTORS");
    free(u);
    free(want);
    free(f);
    end(&s);
}

/* ---- mass and weight */

static void test_weight(void)
{
    setting s, shares;
    double worst = 0, weight = 0, mass = 0, force[3];
    make(&s, &soft, true, PHYSICAL);
    make(&shares, &soft, false, PHYSICAL);
    double *value = numbers(3 * s.s.curves), *rest = numbers(3 * s.p.nodes);
    tled_curves(&s.p, 0, value);
    for (int64_t n = 0; n < s.p.nodes; n++) {
        tled_external(&s.p, value, rest, n, force);
        worst = fmax(worst, fabs(force[2] / (1000 * -9.81 * s.part[n]) - 1));
        weight += s.p.weight[n];
        mass += s.p.mass[n];
    }
    near_(worst, 0, 2e-5, "gravity goes by exact weights");
    near_(weight, mass, 1e-6 * mass, "which are the mass, in all");
    ok(!memcmp(s.p.mass, shares.p.mass, (size_t)s.p.nodes * sizeof *s.p.mass) && !shares.p.weight,
       "mass goes by the share, with moments and without");
    free(value);
    free(rest);
    end(&s);
    end(&shares);
}

/* ---- the stable step */

/* The largest eigenvalue of M^-1 K at rest, by power iteration. */
static double largest_square(setting *s)
{
    const int64_t count = 3 * s->p.nodes;
    double *way = numbers(count), *u = numbers(count), *f = numbers(count), value = 0;
    shake(s, 1, way);
    for (int round = 0; round < 300; round++) {
        double size = 0;
        for (int64_t i = 0; i < count; i++)
            size = fmax(size, fabs(way[i]));
        for (int64_t i = 0; i < count; i++)
            u[i] = 1e-9 * way[i] / size;
        pull(s, &tled_cpu_double, 1, u, f);
        value = 0;
        for (int64_t i = 0; i < count; i++) {
            way[i] = f[i] / (1e-9 * s->p.mass[i / 3]);
            value = fmax(value, fabs(way[i]));
        }
    }
    free(way);
    free(u);
    free(f);
    return value;
}

static void test_step(void)
{
    setting s, shares;
    make(&s, &soft, true, PHYSICAL);
    make(&shares, &soft, false, PHYSICAL);
    const double step = step_at_rest(&s.p, NULL), whole = step_at_rest(&shares.p, NULL);
    const double used = largest_square(&s) * step * step / 4;
    ok(used <= 1 + 1e-6 && used > .35, "the largest w^2 is %.3f of the bound at rest", used);
    ok(step >= .6 * whole && step < whole, "the step is %.3f of that of whole elements", step / whole);
    end(&s);
    end(&shares);
}

/* ---- what cannot be */

static void test_refused(void)
{
    setting s;
    tled_problem p = {0};
    err e = {0};
    make(&s, &soft, true, PHYSICAL);
    ok(tled_need(&s.p).features & EXECUTOR_CUTS, "an executor has to have them");
    int32_t *element = model_find(&s.m, "cut.element")->i32;
    element[1] = element[0];
    ok(tled_problem_make(&p, &s.m, &s.s, PHYSICAL, &e) && strstr(e.text, "cut.element, row 1 is 48 after 48"), "%s",
       e.text);
    tled_problem_free(&p);
    end(&s);
}

static void test_choice(void)
{
    setting s;
    make(&s, &soft, true, PHYSICAL);
    test_choice_without(&s.p, EXECUTOR_CUTS, "mean strain of cut elements",
                        "cpu (cuda: no mean strain of cut elements)");
    end(&s);
}

int main(void)
{
    static const block_fibres hgo = {.name = "hgo",
                                     .kind = {"hgo", "quadratic"},
                                     .k1 = {3000, 2000},
                                     .k2 = {2, 0},
                                     .kappa = {.1, 0},
                                     .angle = {30, 0},
                                     .passive = {.05, .1},
                                     .optimum = {1.1, 1}};
    test_patch();
    test_energy(NULL, false, "plain");
    test_energy(NULL, true, "mixed");
    test_energy(&hgo, true, "mixed, with fibres and passive muscles");
    test_bytes(&tled_cpu_double, "double");
    test_bytes(&tled_cpu_single, "single");
    test_weight();
    test_step();
    test_refused();
    test_choice();
    return done_testing();
}
