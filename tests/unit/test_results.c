/* Stress, strain, stretches and energies of elements against closed forms, difference quotients of the energy, and
 * what turning the whole does to them: of boxes, other hexahedra and tetrahedra.
 */
#include "model/materials.h"
#include "results/results.h"

#include "block.h"

#include <stdlib.h>

typedef enum shape { BOX, ANY, TETRA, SHAPES } shape;
static const char *const shape_names[SHAPES] = {"box", "hexahedron", "tetrahedron"};

/* m3, at rest. */
static const double volume_of[SHAPES] = {.002 * .003 * .004, .002 * .003 * .004, .002 * .003 * .004 / 6};

static void put_nodes(model *m, shape of)
{
    err e = {0};
    const int corners = of == TETRA ? 4 : 8;
    const double side[3] = {.002, .003, .004};
    static const int32_t tetra[4] = {0, 1, 3, 4};
    model_axis_add(m, "node", corners, &e);
    double *rest = model_add(m, "node.position", &e)->f64;
    int32_t *node = model_add_as(m, "element.node", MODEL_I32, "@node", "element", corners, &e)->i32;
    for (int n = 0; n < corners; n++) {
        node[n] = n;
        for (int a = 0; a < 3; a++)
            rest[3 * n + a] = side[a] * lattice_vtk[of == TETRA ? tetra[n] : n][a];
        if (of == ANY)
            rest[3 * n] += rest[3 * n + 1] / 2; /* leans: the volume stays */
    }
    if (of == BOX)
        model_meta_set(m, "lattice.origin", "0 0 0", &e);
    if (of == BOX)
        model_meta_set(m, "lattice.spacing", "0.002 0.003 0.004", &e);
}

/* One element of two volumes, soft and muscle, with a material each; mixture of it is muscle; fibres lie along x. */
static void make(model *m, shape of, const char *const *line, float mixture)
{
    err e = {0};
    const char *const name[2] = {"soft", "muscle"};
    const material fallback = materials_fallback();
    const material both[2] = {fallback, fallback};
    *m = (model){0};
    model_axis_add(m, "element", 1, &e);
    put_nodes(m, of);
    materials_put(m, name, both, 2, &e);
    model_axis_add(m, "volume", 2, &e);
    model_add(m, "volume.material", &e)->i32[1] = 1;
    model_set_text(model_add(m, "volume.name", &e), 0, "soft", &e);
    model_set_text(model_find(m, "volume.name"), 1, "muscle", &e);
    model_add(m, "element.volume", &e);
    model_add(m, "element.mix", &e)->i32[0] = mixture > 0 ? 1 : -1;
    model_add(m, "element.mixture", &e)->f32[0] = mixture;
    model_add(m, "element.fibre", &e);
    model_add(m, "element.mixfibre", &e)->f32[0] = 1;
    int count = 0;
    while (line[count])
        count++;
    if (materials_set(m, line, count, &e))
        ok(false, "a model: %s", e.text);
}

/* A frame where grad u is h; activation of the muscle, nan: not told. */
static void move(frame *f, const model *m, const double h[9], double activation)
{
    err e = {0};
    const model_array *rest = model_find(m, "node.position");
    *f = (frame){0};
    double *u = frame_add(f, m, "node.displacement", &e)->f64;
    for (int64_t n = 0; n < rest->rows; n++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                u[3 * n + i] += h[3 * i + j] * rest->f64[3 * n + j];
    if (!isnan(activation))
        frame_add(f, m, "volume.activation", &e)->f64[1] = activation;
}

/* What an element holds. */
typedef struct look {
    float stress[6], mises, strain[6], stretch[3], fibre, density;
    double energy[2];
} look;

static look look_at(const model *m, const double h[9], double activation)
{
    err e = {0};
    frame f;
    results *r;
    look to = {0};
    move(&f, m, h, activation);
    if (results_create(&r, m, (1U << RESULTS) - 1, NULL, &e) || results_add(r, &f, NULL, &e)) {
        ok(false, "results: %s", e.text);
        return to;
    }
    memcpy(to.stress, frame_find(&f, "element.stress")->f32, sizeof to.stress);
    memcpy(to.strain, frame_find(&f, "element.strain")->f32, sizeof to.strain);
    memcpy(to.stretch, frame_find(&f, "element.stretch")->f32, sizeof to.stretch);
    memcpy(to.energy, frame_find(&f, "material.energy")->f64, sizeof to.energy);
    to.mises = frame_find(&f, "element.stress.mises")->f32[0];
    to.fibre = frame_find(&f, "element.stretch.fibre")->f32[0];
    to.density = frame_find(&f, "element.energy")->f32[0];
    results_destroy(r);
    frame_free(&f);
    return to;
}

static bool is_near(const float *got, const double *want, int count, double tolerance)
{
    for (int i = 0; i < count; i++)
        if (!(fabs((double)got[i] - want[i]) <= tolerance))
            return false;
    return true;
}

static const char *const soft[] = {"soft.E=3000", "soft.nu=.45", NULL};
static const char *const passive[] = {"soft.E=3000",     "soft.nu=.45",        "muscle.E=3000",      "muscle.nu=.45",
                                      "muscle.peak=1e5", "muscle.passive=.05", "muscle.optimum=.95", NULL};
static const char *const rubber[] = {"soft.law=mooney-rivlin", "soft.c10=2500", "soft.c01=500", "soft.K=1e5", NULL};

/* E = 3000 Pa, nu = .45: mu = 1034.4828, K = 10000; and c10 = 2500, c01 = 500, K = 1e5. */
static void test_figures(shape of)
{
    model m;
    const char *name = shape_names[of];
    const double side = .92181984, mu = 3000 / 2.9, j = 1.2 * side * side;
    const double pull[9] = {.2, 0, 0, 0, side - 1, 0, 0, 0, side - 1}, shear[9] = {0, .2, 0, 0, 0, 0, 0, 0, 0};
    make(&m, of, soft, 0);
    look a = look_at(&m, pull, NAN);
    ok(is_near(a.stress, (double[]){502.2590 / (side * side), 0, 0, 0, 0, 0}, 6, 2e-3), "%s, pulled: P over the area",
       name);
    near_((double)a.mises, 502.2590 / (side * side), 2e-3, "%s: von Mises' is that", name);
    ok(is_near(a.strain, (double[]){.22, (side * side - 1) / 2, (side * side - 1) / 2, 0, 0, 0}, 6, 1e-7),
       "%s: Green-Lagrange's strain", name);
    ok(is_near(a.stretch, (double[]){1.2, side, side}, 3, 1e-6), "%s: stretches", name);
    const double energy = mu / 2 * (pow(j, -2. / 3) * (1.44 + 2 * side * side) - 3) + 1e4 / 2 * (j - 1) * (j - 1);
    near_((double)a.density, energy, 1e-4, "%s: energy", name);
    near_(a.energy[0], energy * volume_of[of], 1e-9 * volume_of[of] * energy, "%s: in all", name);
    ok(isnan(a.fibre) && a.energy[1] == 0, "%s: no fibre, and nothing of the other material", name);
    a = look_at(&m, shear, NAN);
    ok(is_near(a.stress, (double[]){27.5862, -13.7931, -13.7931, 206.8966, 0, 0}, 6, 1e-4), "%s, sheared: stress",
       name);
    near_((double)a.mises, sqrt(3 * (206.8966 * 206.8966) + 41.3793 * 41.3793), 1e-3, "%s: von Mises'", name);
    ok(is_near(a.strain, (double[]){0, .02, 0, .1, 0, 0}, 6, 1e-8), "%s: half of the angle", name);
    model_free(&m);
    make(&m, of, rubber, 0);
    const double narrow = .918060, drawn[9] = {.2, 0, 0, 0, narrow - 1, 0, 0, 0, narrow - 1};
    a = look_at(&m, drawn, NAN);
    ok(is_near(a.stress, (double[]){2882.59 / (narrow * narrow), 0, 0, 0, 0, 0}, 6, .2), "%s: Mooney-Rivlin", name);
    model_free(&m);
}

/* The muscle's fibres resist being stretched. */
static const char *const fibred[] = {"soft.E=3000",   "soft.nu=.45",      "muscle.E=3000",
                                     "muscle.nu=.45", "muscle.fibre=hgo", "muscle.k1=20000",
                                     "muscle.k2=2",   "muscle.kappa=.1",  NULL};

/* ---- turned, and against the energy */

static uint64_t state = 7;

static double random_to(double most)
{
    state = state * 6364136223846793005U + 1442695040888963407U;
    return most * ((double)(state >> 40) / 8388608 - 1);
}

static void product(const double a[9], const double b[9], double to[9])
{
    for (int i = 0; i < 9; i++)
        to[i] = a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[3 + i % 3] + a[i / 3 * 3 + 2] * b[6 + i % 3];
}

/* (I + A) (I + H) - I. */
static void follow(const double a[9], const double h[9], double to[9])
{
    product(a, h, to);
    for (int i = 0; i < 9; i++)
        to[i] += a[i] + h[i];
}

static double whole(look of)
{
    return of.energy[0] + of.energy[1];
}

static void test_energy(shape of, const char *const *law, float mixture, const char *name)
{
    model m;
    double worst = 0;
    make(&m, of, law, mixture);
    for (int k = 0; k < 20; k++) {
        double h[9], l[9], ahead[9], behind[9], power = 0;
        static const int at[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
        for (int i = 0; i < 9; i++) {
            h[i] = random_to(.2);
            l[i] = random_to(1e-5);
        }
        follow(l, h, ahead);
        for (int i = 0; i < 9; i++)
            l[i] = -l[i];
        follow(l, h, behind);
        const look is = look_at(&m, h, NAN), after = look_at(&m, ahead, NAN), before = look_at(&m, behind, NAN);
        const double j = (1 + h[0]) * ((1 + h[4]) * (1 + h[8]) - h[5] * h[7]) -
                         h[1] * (h[3] * (1 + h[8]) - h[5] * h[6]) + h[2] * (h[3] * h[7] - (1 + h[4]) * h[6]);
        for (int i = 0; i < 9; i++)
            power -= j * (double)is.stress[at[i]] * l[i]; /* l is -L by now */
        const double gained = (whole(after) - whole(before)) / 2 / volume_of[of];
        worst = fmax(worst, fabs(gained - power) / (1e-5 * (double)is.mises));
    }
    ok(worst < 1e-5, "%s, %s: stress is the slope of the energy, to %.2g", shape_names[of], name, worst);
    model_free(&m);
}

static void test_turned(shape of)
{
    model m;
    const double c = .8, s = .6;
    const double turn[9] = {c - 1, -s, 0, s * c, c * c - 1, -s, s * s, s * c, c - 1}; /* about z, then about x */
    const double h[9] = {.2, .1, -.05, .02, -.1, .07, .03, -.04, .05};
    double turned[9], r[9], rotated[9], back[9], wanted[6];
    static const int at[6] = {0, 4, 8, 1, 5, 2};
    make(&m, of, rubber, 0);
    follow(turn, h, turned);
    const look a = look_at(&m, h, NAN), b = look_at(&m, turned, NAN);
    ok(fabs((double)(a.mises - b.mises)) < 1e-6 * (double)a.mises, "%s, turned: von Mises' stays", shape_names[of]);
    const double stretch[3] = {(double)a.stretch[0], (double)a.stretch[1], (double)a.stretch[2]};
    ok(is_near(b.stretch, stretch, 3, 3e-7) && fabs(a.energy[0] - b.energy[0]) < 1e-12 * a.energy[0],
       "%s: stretches and energy too", shape_names[of]);
    for (int i = 0; i < 9; i++)
        r[i] = turn[i] + (i % 4 == 0);
    const float *t = a.stress;
    const double full[9] = {(double)t[0], (double)t[3], (double)t[5], (double)t[3], (double)t[1],
                            (double)t[4], (double)t[5], (double)t[4], (double)t[2]};
    const double transposed[9] = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
    product(r, full, back);
    product(back, transposed, rotated);
    for (int i = 0; i < 6; i++)
        wanted[i] = rotated[at[i]];
    ok(is_near(b.stress, wanted, 6, 2e-6 * (double)a.mises), "%s: stress turns with it", shape_names[of]);
    model_free(&m);
}

/* ---- muscles, mixtures, linear tissue */

static const char *const muscles[] = {
    "soft.E=3000", "soft.nu=.45", "soft.peak=1e5", "muscle.E=3000", "muscle.nu=.45", "muscle.peak=3e5", NULL};

static void test_muscles(void)
{
    model m;
    const double none[9] = {0}, side = .92181984, pull[9] = {.2, 0, 0, 0, side - 1, 0, 0, 0, side - 1};
    make(&m, BOX, muscles, .25F);
    look a = look_at(&m, none, .5);
    ok(is_near(a.stress, (double[]){.25 * .5 * 3e5, 0, 0, 0, 0, 0}, 6, 1e-3),
       "a muscle of which a quarter of an element is: a quarter of its stress");
    near_((double)a.fibre, 1, 0, "its fibre as it was");
    a = look_at(&m, pull, .5);
    const double active = .25 * .5 * 3e5 * (1 - 4 * .04) * 1.2 / (1.2 * side * side);
    near_((double)a.stress[0], 502.2590 / (side * side) + active, 5e-3, "stretched: the force-length curve's");
    near_((double)a.fibre, 1.2, 1e-7, "and its stretch");
    near_(a.energy[1] / a.energy[0], 1. / 3, 1e-12, "each material has the energy of its share");
    near_((a.energy[0] + a.energy[1]) / volume_of[BOX], (double)a.density, 1e-5, "together it is the element's");
    const look without = look_at(&m, pull, NAN);
    near_((double)without.stress[0], 502.2590 / (side * side), 2e-3, "without activation nothing contracts");
    model_free(&m);
    make(&m, BOX, passive, .25F);
    a = look_at(&m, pull, NAN);
    ok(a.energy[0] == without.energy[0] && a.energy[1] > 2 * without.energy[1],
       "what a passive muscle holds is its material's alone");
    near_((a.energy[0] + a.energy[1]) / volume_of[BOX] / (double)a.density, 1, 1e-7, "and the element's");
    model_free(&m);
}

/* W = k1/(2 k2) (exp(k2 x^2) - 1), x = kappa (tr C - 3) + (1 - 3 kappa) (1.2^2 - 1), of the share that is muscle. */
static void test_fibres(void)
{
    model m;
    const double side = .92181984, pull[9] = {.2, 0, 0, 0, side - 1, 0, 0, 0, side - 1}, j = 1.2 * side * side;
    const double x = .1 * (1.44 + 2 * side * side - 3) + .7 * .44, grow = exp(2 * x * x);
    const double along = 4e4 * x * grow * (.1 + .7) * 1.44 / j, across = 4e4 * x * grow * .1 * side * side / j;
    make(&m, BOX, fibred, .25F);
    const look a = look_at(&m, pull, NAN);
    near_((double)a.stress[0], 502.2590 / (side * side) + along / 4, 1e-2,
          "fibres that are pulled pull, by their share");
    near_((double)a.stress[1], across / 4, 1e-2, "and those that are dispersed press the sides");
    near_((double)a.density, whole(a) / volume_of[BOX], 1e-3, "the element's energy has theirs");
    near_(a.energy[1] - a.energy[0] / 3, 1e4 / 2 * (grow - 1) / 4 * volume_of[BOX], 1e-9 * whole(a),
          "which is their material's");
    model_free(&m);
}

static void test_linear(void)
{
    static const char *const linear[] = {"soft.law=linear", "soft.E=3000", "soft.nu=.45", NULL};
    model m;
    const double mu = 3000 / 2.9, shear[9] = {0, .2, 0, 0, 0, 0, 0, 0, 0},
                 draw[9] = {.02, 0, 0, 0, -.01, 0, 0, 0, -.01};
    const double swell[9] = {.01, 0, 0, 0, .01, 0, 0, 0, .01};
    make(&m, TETRA, linear, 0);
    look a = look_at(&m, shear, NAN);
    near_((double)a.mises, sqrt(3) * .2 * mu, 1e-4, "linear elasticity, shear: sqrt(3) mu gamma");
    near_((double)a.density, mu * .04 / 2, 1e-5, "and its energy");
    near_((double)look_at(&m, draw, NAN).mises, 6 * .01 * mu, 1e-4, "stretched at constant volume");
    a = look_at(&m, swell, NAN);
    ok(is_near(a.stress, (double[]){300, 300, 300, 0, 0, 0}, 6, 1e-4), "swollen: K times what it grows by");
    near_((double)a.density, 1e4 / 2 * .03 * .03, 1e-6, "and its energy");
    model_free(&m);
}

static void test_refusals(void)
{
    model m;
    err e = {0};
    unsigned which = 0;
    const double inside_out[9] = {-3, 0, 0, 0, 0, 0, 0, 0, 0};
    make(&m, BOX, soft, 0);
    const look a = look_at(&m, inside_out, NAN);
    ok(isnan(a.mises) && isnan(a.stress[0]) && isnan(a.stress[5]) && !isnan(a.strain[0]),
       "inside out: a strain, but no stress");
    model_free(&m);
    ok(!results_read("stress,stretch.fiber", NULL, &which, &e) &&
           which == (1U << RESULTS_STRESS | 1U << RESULTS_FIBRE_STRETCH),
       "names between commas, in either spelling");
    ok(!results_read("all", NULL, &which, &e) && which == (1U << RESULTS) - 1, "all of them");
    ok(results_read("stress,stretches", "--results", &which, &e) == -1 && strstr(e.text, "did you mean 'stretch'"),
       "no such result: %s", e.text);
}

int main(void)
{
    for (shape of = BOX; of < SHAPES; of++) {
        test_figures(of);
        test_turned(of);
        test_energy(of, soft, 0, "neo-Hookean");
        test_energy(of, rubber, 0, "Mooney-Rivlin");
        test_energy(of, passive, .75F, "three quarters of passive muscle");
        test_energy(of, fibred, .25F, "fibres");
    }
    test_muscles();
    test_fibres();
    test_linear();
    test_refusals();
    return done_testing();
}
