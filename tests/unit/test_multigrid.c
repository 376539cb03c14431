/* Runs to rest that coarser models begin and correct: a bar that bends, whose slowest motion plain relaxation takes
 * long for, and a block that hangs, against plain relaxation to a hundredth of the tolerance, by where they end and
 * by how many steps they take; the same bytes whatever the threads, single precision; and ways of which the least
 * energy is known.
 */
// needs: tled/*/*.c
#include "tled/loop/multigrid.h"
#include "tled/loop/subspace.h"
#include "tled_bench.h"

static const block bar = {{48, 8, 8}, {.0025, .0025, .0025}, 30000, .45, 1000, 0, 0, 1, 0, {0, 0, 0}, 0, false};
static const block cube = {{16, 16, 16}, {.00625, .00625, .00625}, 3000, .45, 1000, 0, 2, 0, 1, {0, 0, 0}, 0, false};

enum { LEAST = 64 }; /* elements of a model that has a coarser one here */

typedef struct outcome {
    double *displacement; /* nodes x 3, m; owned */
    int64_t nodes;
    double work; /* steps of its own, with what those of coarser models are worth */
    int corrections;
} outcome;

/* Where nodes and elements are in the lattice, as voxelise says it. */
static void add_places(const block *what, model *m)
{
    int32_t *node = block_array(m, "node.lattice")->i32;
    int32_t *element = model_find(m, "element.lattice") ? NULL : block_array(m, "element.lattice")->i32;
    for (int32_t k = 0; k <= what->cells[2]; k++)
        for (int32_t j = 0; j <= what->cells[1]; j++)
            for (int32_t i = 0; i <= what->cells[0]; i++, node += 3) {
                memcpy(node, (int32_t[]){i, j, k}, 3 * sizeof *node);
                if (!element || i == what->cells[0] || j == what->cells[1] || k == what->cells[2])
                    continue;
                memcpy(element, (int32_t[]){i, j, k}, 3 * sizeof *element);
                element += 3;
            }
}

/* To rest: rest < 0: with coarser models to 1e-4, else plainly to `rest`. */
static outcome go(const block *what, double pull, double rest, int threads, const tled_executor *device)
{
    bench b;
    outcome o = {0};
    const double gravity[3] = {0, 0, -pull};
    bench_make(&b, what, gravity, 0, PHYSICAL, threads);
    b.setup.device = device;
    b.setup.single = device == &tled_cpu_single;
    b.setup.finer = b.setup.single ? &tled_cpu_double : NULL;
    b.setup.rest = rest < 0 ? 1e-4 : rest;
    if (rest < 0) {
        add_places(what, &b.m);
        b.setup.coarser = multigrid_make(&b.setup, &b.problem, &b.m, LEAST, &b.e);
        b.setup.smooth = MULTIGRID_SMOOTH;
        bench_must(!b.setup.coarser || multigrid_start(b.setup.coarser, &b.problem, &b.e), &b.e);
    }
    const bool done = !bench_go(&b);
    ok(done && b.end.rested, "at rest after %lld steps, %d corrections %s", (long long)b.end.steps, b.end.corrections,
       b.e.text);
    o.nodes = b.problem.nodes;
    o.work = (double)b.end.taken + (b.setup.coarser ? multigrid_tell(b.setup.coarser).work : 0);
    o.corrections = b.end.corrections;
    o.displacement = calloc((size_t)o.nodes * 3, sizeof *o.displacement);
    bench_must(!o.displacement, &b.e);
    memcpy(o.displacement, b.displacement, (size_t)o.nodes * 3 * sizeof *o.displacement);
    multigrid_free(b.setup.coarser);
    bench_free(&b);
    return o;
}

/* How far two rests are apart, as a share of the second, by root mean squares. */
static double apart(const outcome *a, const outcome *b)
{
    double way = 0, whole = 0;
    for (int64_t i = 0; i < 3 * a->nodes; i++) {
        way += (a->displacement[i] - b->displacement[i]) * (a->displacement[i] - b->displacement[i]);
        whole += b->displacement[i] * b->displacement[i];
    }
    return sqrt(way / whole);
}

/* fewer: times that plain relaxation takes as many steps. */
static void test_rest(const char *name, const block *what, double pull, double fewer)
{
    outcome exact = go(what, pull, 1e-6, 2, &tled_cpu_double), plain = go(what, pull, 1e-4, 2, &tled_cpu_double);
    outcome twice = go(what, pull, -1, 2, &tled_cpu_double), other = go(what, pull, -1, 1, &tled_cpu_double);
    outcome once = go(what, pull, -1, 2, &tled_cpu_single);
    ok(apart(&twice, &exact) < 1e-4, "%s: %.2g from a rest of 1e-6, plain relaxation %.2g", name, apart(&twice, &exact),
       apart(&plain, &exact));
    ok(apart(&once, &exact) < 2e-4, "%s: in single precision %.2g", name, apart(&once, &exact));
    ok(twice.corrections > 0 && fewer * twice.work < plain.work,
       "%s: %.0f steps' work for %.0f: at least %g times fewer", name, twice.work, plain.work, fewer);
    ok(once.work < 3 * twice.work, "%s: in single precision %.0f steps' work", name, once.work);
    ok(!memcmp(twice.displacement, other.displacement, (size_t)twice.nodes * 3 * sizeof *twice.displacement),
       "%s: the same bytes on one thread", name);
    free(exact.displacement);
    free(plain.displacement);
    free(twice.displacement);
    free(other.displacement);
    free(once.displacement);
}

/* What has no coarser model says why. */
static void test_none(void)
{
    bench b;
    bench_make(&b, &cube, NULL, 0, PHYSICAL, 1);
    multigrid *g = multigrid_make(&b.setup, &b.problem, &b.m, b.problem.elements + 1, &b.e);
    ok(!g && strstr(b.e.text, "few elements"), "%s", b.e.text);
    multigrid_free(g);
    bench_free(&b);
}

/* K diagonal: of ways along two axes, and one that is a sum of both, the least energy is where nothing is left along
 * these; along the third all is. */
static void test_subspace(void)
{
    static const double stiffness[3] = {2, 5, 7}, way[3][3] = {{1, 0, 0}, {1, 1, 0}, {0, -2, 0}}, r[3] = {4, 10, 21};
    double sum[3], left[3];
    subspace s;
    err e = {0};
    bench_must(subspace_make(&s, 3, &e), &e);
    subspace_least(&s, r, sum, left);
    ok(sum[0] == 0 && left[2] == 21, "no ways: nothing moves");
    for (int i = 0; i < 3; i++) {
        subspace_push(&s);
        for (int a = 0; a < 3; a++) {
            s.way[0][a] = way[i][a];
            s.force[0][a] = stiffness[a] * way[i][a];
        }
    }
    subspace_least(&s, r, sum, left);
    near_(sum[0], 2, 1e-12, "along x: %g", sum[0]);
    near_(sum[1], 2, 1e-12, "along y: %g", sum[1]);
    ok(fabs(left[0]) < 1e-12 && fabs(left[1]) < 1e-12 && left[2] == 21 && sum[2] == 0, "z is left: %g", left[2]);
    for (int i = 0; i < 2 * SUBSPACE_WAYS; i++)
        subspace_push(&s);
    ok(s.ways == SUBSPACE_WAYS, "as many as there is room for");
    subspace_free(&s);
}

int main(void)
{
    test_subspace();
    test_none();
    test_rest("a block", &cube, 9.81, 3);
    if (getenv("SINEW_SANITIZED")) {
        skip(10, "the bar takes long with sanitizers");
        return done_testing();
    }
    test_rest("a bar", &bar, 1, 10);
    return done_testing();
}
