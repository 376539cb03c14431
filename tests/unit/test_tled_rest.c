/* Runs to rest against CalculiX 2.20 (C3D8R): a cube that hangs from its top, with the sweep of the hourglass
 * coefficient, and a cantilever, both by their own weight.
 */
// needs: tled/*/*.c
#include "tled_bench.h"

static const block cube = {{8, 8, 8}, {.0125, .0125, .0125}, 3000, .45, 1000, 0, 2, 0, 1, {0, 0, 0}, 0, false};
static const block beam = {{32, 8, 8}, {.0025, .0025, .0025}, 30000, .45, 1000, 0, 0, 1, 0, {0, 0, 0}, 0, false};
static const double down[3] = {0, 0, -9.81};

/* The displacement along z of node (i, j, k) at rest. */
static double sag(const block *what, hourglass_control control, const tled_executor *device, int32_t i, int32_t j,
                  int32_t k)
{
    bench b;
    bench_make(&b, what, down, 0, control, 2);
    b.setup.device = device;
    bool done = !bench_go(&b);
    ok(done && b.end.rested, "at rest after %lld steps, %.2g of the displacement to go %s", (long long)b.end.steps,
       b.end.remaining, b.e.text);
    double z = b.displacement[3 * block_node(what, i, j, k) + 2];
    bench_free(&b);
    return z;
}

/* Too much damping, and too little: what is left is what the tolerance says, however
 * slowly or whichever way it moves. */
static void test_damping(const block *what, double want)
{
    static const double damping[] = {3, 300};
    for (int i = 0; i < 2; i++) {
        bench b;
        bench_make(&b, what, down, 0, ISOTROPIC(.0075), 2);
        b.setup.adapt = false;
        b.setup.damping = damping[i];
        bool done = !bench_go(&b);
        double z = b.displacement[3 * block_node(what, 16, 2, 2) + 2];
        ok(done && b.end.rested, "damping %g: at rest after %lld steps %s", damping[i], (long long)b.end.steps,
           b.e.text);
        near_(z, want, 2e-4 * fabs(want), "the tip is %.2g off", z / want - 1);
        bench_free(&b);
    }
}

/* Rounding keeps single precision from the last digits: that is said, and soon. */
static void test_stuck(const block *what)
{
    bench b;
    bench_make(&b, what, down, 0, PHYSICAL, 2);
    b.setup.device = &tled_cpu_single;
    b.setup.single = true;
    b.setup.rest = 1e-7;
    int gone = bench_go(&b);
    ok(gone && strstr(b.e.text, "single precision leaves"), "%s", b.e.text);
    bench_free(&b);
}

/* Where it can go on in double it ends as close to rest as double does, and where that ends. */
static void test_refined(const block *what)
{
    double z[2] = {0, 0};
    int64_t steps[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        bench b;
        bench_make(&b, what, down, 0, PHYSICAL, 2);
        b.setup.device = i ? &tled_cpu_single : &tled_cpu_double;
        b.setup.single = i;
        b.setup.finer = i ? &tled_cpu_double : NULL;
        b.setup.rest = 1e-7;
        bool done = !bench_go(&b);
        ok(done && b.end.rested && b.end.remaining <= 1e-7, "%s, to 1e-7: after %lld steps %s",
           i ? "begun in single precision" : "double", (long long)b.end.steps, b.e.text);
        z[i] = b.displacement[3 * block_node(what, 4, 4, 0) + 2];
        steps[i] = b.end.steps;
        bench_free(&b);
    }
    near_(z[1], z[0], 2e-7 * fabs(z[0]), "both end where they are to: %.2g apart", z[1] / z[0] - 1);
    ok(steps[1] < 3 * steps[0], "%lld steps, %lld in double alone", (long long)steps[1], (long long)steps[0]);
}

int main(void)
{
    const tled_executor *twice = &tled_cpu_double, *once = &tled_cpu_single;
    double z = sag(&cube, ISOTROPIC(.0075), twice, 4, 4, 0);
    near_(z, -1.8191e-2, .005 * 1.8191e-2, "the cube's bottom centre: %.5g m, C3D8R to 0.5 %%", z);
    z = sag(&cube, ISOTROPIC(.0075), once, 4, 4, 0);
    near_(z, -1.8191e-2, .005 * 1.8191e-2, "in single precision: %.5g m", z);
    z = sag(&cube, ISOTROPIC(.075), twice, 4, 4, 0);
    near_(z, -1.7828e-2, .001 * 1.7828e-2, "hourglass coefficient .075: %.5g m", z);
    z = sag(&cube, ISOTROPIC(.5), twice, 4, 4, 0);
    near_(z, -1.6435e-2, .001 * 1.6435e-2, ".5: %.5g m", z);
    block coarse = beam;
    for (int a = 0; a < 3; a++) {
        coarse.cells[a] /= 2;
        coarse.side[a] *= 2;
    }
    z = sag(&coarse, ISOTROPIC(.0075), twice, 16, 2, 2);
    near_(z, -4.3478e-2, .01 * 4.3478e-2, "the cantilever's tip, 16 x 4 x 4: %.5g m, C3D8R to 1 %%", z);
    test_stuck(&cube);
    test_refined(&cube);
    if (getenv("SINEW_SANITIZED")) {
        skip(6, "32 x 8 x 8 takes long with sanitizers");
        return done_testing();
    }
    test_damping(&coarse, z);
    z = sag(&beam, ISOTROPIC(.0075), twice, 32, 4, 4);
    near_(z, -4.2577e-2, .01 * 4.2577e-2, "32 x 8 x 8: %.5g m, C3D8R to 1 %%", z);
    return done_testing();
}
