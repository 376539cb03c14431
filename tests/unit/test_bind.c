// needs: bind/nearest.c bind/normals.c
/* Binding: the nearest element against a search through all, ties, equation (1), linear fields inside and outside. */
#include "bind/nearest.h"
#include "bind/normals.h"
#include "cli/numbered.h"
#include "mesh/motion.h"
#include "mesh/weights.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

/* A model of the cells (i, j, k) of a grid that `taken` says, elements in shuffled order; the grid's own nodes, all of
 * them. */
static model make(const lattice *l, const int32_t *low, const int32_t *size, const bool *taken)
{
    model m = {0};
    err e = {0};
    int64_t cells = (int64_t)size[0] * size[1] * size[2], elements = 0;
    int64_t nx = size[0] + 1, ny = size[1] + 1, nodes = nx * ny * (size[2] + 1);
    int32_t *cell = malloc((size_t)cells * sizeof *cell);
    for (int32_t c = 0; c < cells; c++)
        if (taken[c])
            cell[elements++] = c;
    for (int64_t i = elements - 1; i > 0; i--) {
        int64_t j = rand() % (i + 1);
        int32_t keep = cell[i];
        cell[i] = cell[j], cell[j] = keep;
    }
    lattice_save(l, &m, &e);
    model_axis_add(&m, "node", nodes, &e);
    model_axis_add(&m, "element", elements, &e);
    double *position = model_add(&m, "node.position", &e)->f64;
    for (int64_t n = 0; n < nodes; n++) {
        int32_t ijk[3] = {(int32_t)(low[0] + n % nx), (int32_t)(low[1] + n / nx % ny), (int32_t)(low[2] + n / nx / ny)};
        lattice_corner(l, ijk, &position[3 * n]);
    }
    int32_t *at = model_add(&m, "element.lattice", &e)->i32;
    for (int64_t i = 0; i < elements; i++) {
        at[3 * i] = low[0] + cell[i] % size[0];
        at[3 * i + 1] = low[1] + cell[i] / size[0] % size[1];
        at[3 * i + 2] = low[2] + cell[i] / size[0] / size[1];
    }
    int32_t *node = model_add(&m, "element.node", &e)->i32;
    for (int64_t i = 0; i < elements; i++)
        for (int c = 0; c < 8; c++) {
            int64_t x = cell[i] % size[0] + lattice_vtk[c][0], y = cell[i] / size[0] % size[1] + lattice_vtk[c][1];
            node[8 * i + c] = (int32_t)(x + nx * (y + ny * (cell[i] / size[0] / size[1] + lattice_vtk[c][2])));
        }
    free(cell);
    if (e.status)
        printf("# %s\n", e.text);
    return m;
}

/* By the rule, from all elements: of those within a tie of the least distance, the lowest. */
static int32_t brute(const model *m, const lattice *l, const double *point)
{
    const model_array *at = model_find(m, "element.lattice");
    double least = INFINITY, tie = 1e-9 * fmin(fmin(l->spacing[0], l->spacing[1]), l->spacing[2]);
    for (int pass = 0; pass < 2; pass++)
        for (int32_t i = 0; i < at->rows; i++) {
            double d = 0, q[3];
            lattice_local(l, point, q);
            for (int a = 0; a < 3; a++)
                d += pow((q[a] - at->i32[3 * i + a] - .5) * l->spacing[a], 2);
            d = sqrt(d);
            if (pass && d <= least + tie)
                return i;
            least = !pass && d < least ? d : least;
        }
    return -1;
}

static void test_nearest(const double *spacing, double share, const char *name)
{
    lattice l = {{.1, -.2, 3}, {spacing[0], spacing[1], spacing[2]}};
    int32_t low[3] = {-4, 2, 0}, size[3] = {13, 9, 6};
    bool taken[13 * 9 * 6];
    for (int i = 0; i < 13 * 9 * 6; i++)
        taken[i] = uniform(0, 1) < share || i == 77;
    model m = make(&l, low, size, taken);
    nearest n;
    err e = {0};
    int wrong = 0;
    if (nearest_build(&n, &m, NULL, &e))
        ok(false, "builds: %s", e.text);
    for (int i = 0; i < 6000; i++) {
        static const double reaches[4] = {1, 1, 12, 1000};
        double p[3], reach = reaches[i % 4];
        for (int a = 0; a < 3; a++) {
            double q = low[a] + uniform(-reach, size[a] + reach);
            if (i % 3 == 0) /* a corner, or the middle of a side: a tie */
                q = floor(2 * q) / 2;
            p[a] = l.origin[a] + l.spacing[a] * q;
        }
        int32_t got = nearest_element(&n, p), want = brute(&m, &l, p);
        wrong += got != want;
        if (got != want && wrong < 4)
            printf("# %g %g %g: got %d, wanted %d\n", p[0], p[1], p[2], got, want);
    }
    ok(!wrong, "nearest of %s: as a search through all, ties too (%d wrong)", name, wrong);
    double far[3] = {1e300, -1e300, 3};
    ok(nearest_element(&n, far) >= 0, "a point at the end of the world");
    nearest_free(&n);
    model_free(&m);
}

static void test_bad_models(void)
{
    lattice l = {{0, 0, 0}, {1, 1, 1}};
    int32_t low[3] = {0}, size[3] = {2, 1, 1};
    bool taken[2] = {true, true};
    nearest n;
    err e = {0};
    model m = make(&l, low, size, taken);
    model_find(&m, "node.position")->f64[0] += 1e-3;
    ok(nearest_build(&n, &m, NULL, &e) && strstr(e.text, "is not the box of its lattice cell"), "refused: %s", e.text);
    model_remove(&m, "element.lattice");
    e = (err){0};
    ok(nearest_build(&n, &m, NULL, &e) && strstr(e.text, "element.lattice"), "refused: %s", e.text);
    model_free(&m);
}

static void test_weights(void)
{
    weights_box box = {{1, 2, 3}, {.5, 1, 2}};
    double p[3] = {1.125, 2.5, 4.5}, w[3], share[8], sum = 0;
    weights_of(&box, p, w);
    ok(w[0] == .75 && w[1] == .5 && w[2] == .25, "equation (1)");
    weights_shares(w, share);
    for (int n = 0; n < 8; n++)
        sum += share[n];
    near_(sum, 1, 1e-15, "shares sum to 1");
    ok(share[0] == .75 * .5 * .25 && share[6] == .25 * .5 * .75 && share[1] == .25 * .5 * .25,
       "the first node's share is w0 w1 w2");
    ok(weights_outside(&box, w) == 0, "inside");
    double q[3] = {.5, 6, 4};
    weights_of(&box, q, w);
    near_(weights_outside(&box, w), sqrt(.25 + 9), 1e-15, "outside, by how much");
}

enum { VERTICES = 500 };

/* A field u = A x + b is what every vertex gets, wherever it is: tolerance relative to the size of the surface. */
static void test_linear(double reach, double tolerance)
{
    static const double a[9] = {.1, -.3, .2, .05, .4, -.1, .7, 0, -.2}, b[3] = {.01, -2, .3};
    lattice l = {{-.05, .02, 0}, {.0025, .003, .0017}};
    int32_t low[3] = {0}, size[3] = {8, 8, 8};
    bool taken[512];
    for (int i = 0; i < 512; i++)
        taken[i] = rand() % 3;
    model m = make(&l, low, size, taken);
    const model_array *rest = model_find(&m, "node.position");
    double *u = calloc((size_t)(3 * rest->rows), sizeof *u), weight[3 * VERTICES], worst = 0, worst_f = 0;
    int32_t element[VERTICES];
    for (int64_t i = 0; i < 3 * rest->rows; i++) {
        u[i] = b[i % 3];
        for (int k = 0; k < 3; k++)
            u[i] += a[3 * (i % 3) + k] * rest->f64[i - i % 3 + k];
    }
    nearest n;
    err e = {0};
    nearest_build(&n, &m, NULL, &e);
    bound view = {.element = element,
                  .weight = weight,
                  .corners = 8,
                  .node = model_find(&m, "element.node")->i32,
                  .rest = rest->f64};
    for (int v = 0; v < VERTICES; v++) {
        double p[3], d[3], f[9];
        for (int k = 0; k < 3; k++)
            p[k] = l.origin[k] + l.spacing[k] * uniform(-reach, 8 + reach);
        element[v] = nearest_element(&n, p);
        weights_box box = weights_box_of(&view.node[8 * element[v]], rest->f64);
        weights_of(&box, p, &weight[3 * v]);
        bound_displacement(&view, v, u, d);
        bound_gradient(&view, v, u, f);
        for (int i = 0; i < 9; i++) {
            worst_f = fmax(worst_f, fabs(f[i] - (i % 4 == 0) - a[i]));
            if (i < 3)
                worst = fmax(worst, fabs(d[i] - b[i] - a[3 * i] * p[0] - a[3 * i + 1] * p[1] - a[3 * i + 2] * p[2]));
        }
    }
    worst /= (8 + 2 * reach) * l.spacing[0];
    ok(worst <= tolerance && worst_f <= 10 * tolerance,
       "linear field, up to %g cells outside: %.2g of the surface's size, gradient %.2g", reach, worst, worst_f);
    free(u);
    nearest_free(&n);
    model_free(&m);
}

/* In a tetrahedron the weights are the shares. */
static void test_tetrahedron(void)
{
    static const int32_t node[] = {3, 1, 0, 2};
    static const double weight[] = {.5, .25, .125, .125}, u[] = {8, 0, 0, 0, 8, 0, 0, 0, 8, 8, 8, 16};
    double d[3];
    weights_displacement(node, 4, weight, u, d);
    ok(d[0] == 5 && d[1] == 6 && d[2] == 9, "a place in a tetrahedron: %g %g %g", d[0], d[1], d[2]);
}

/* One cube that a rotation, a stretch and a shift move: normals follow. */
static void test_normals(void)
{
    static const char text[] = "v .2 .2 .2\nv .8 .2 .2\nv .2 .8 .2\nvn 0 0 2\nvn 1 1 0\nvn 0 3 0\nvn 0 0 0\n"
                               "f 1//1 2//2 3//1\nf 1//4 2//4 3//4\n";
    lattice l = {{0, 0, 0}, {1, 1, 1}};
    int32_t low[3] = {0}, size[3] = {1, 1, 1};
    bool taken[1] = {true}, held[3] = {true, true, true};
    model m = make(&l, low, size, taken);
    err e = {0};
    obj o;
    in *s = in_memory(text, sizeof text - 1, "n.obj", &e);
    if (!s || obj_read(&o, s, &e)) {
        ok(false, "reads: %s", e.text);
        return;
    }
    const double *rest = model_find(&m, "node.position")->f64;
    int32_t element[3] = {0};
    double weight[9], u[24], normal[12];
    bound b = {
        .element = element, .weight = weight, .corners = 8, .node = model_find(&m, "element.node")->i32, .rest = rest};
    for (int i = 0; i < 9; i++)
        weight[i] = 1 - o.position[i];
    for (int i = 0; i < 8; i++) { /* x' = 2 x + 5, then a quarter turn about x: y' = -z, z' = y */
        u[3 * i] = rest[3 * i] + 5;
        u[3 * i + 1] = -rest[3 * i + 2] - rest[3 * i + 1];
        u[3 * i + 2] = rest[3 * i + 1] - rest[3 * i + 2];
    }
    bone none = {.node = (int32_t[3]){-1, -1, -1}};
    motion moves;
    motion_open(&moves, &b, 8, 1, &e);
    motion_set(&moves, u, NULL);
    normals_deform(&o, &moves, &none, NULL, normal);
    near_(hypot(normal[0], normal[2]) + fabs(normal[1] + 1), 0, 1e-12, "turned: z to -y, made a unit vector");
    double k = sqrt(1 / 4. + 1); /* F^-T (1, 1, 0) = (1/2, 0, 1) */
    near_(fabs(normal[3] - .5 / k) + fabs(normal[4]) + fabs(normal[5] - 1 / k), 0, 1e-12, "stretched: by F^-T");
    ok(normal[6] == 0 && normal[7] == 3 && normal[8] == 0, "used by no corner: as it was");
    ok(normal[9] == 0 && normal[10] == 0 && normal[11] == 0, "no direction: as it was");
    normals_deform(&o, &moves, &none, held, normal);
    ok(!memcmp(normal, o.normal, sizeof normal), "vertices held: as they were");
    for (int i = 0; i < 24; i++)
        u[i] = .1 / 3;
    normals_deform(&o, &moves, &none, NULL, normal);
    ok(!memcmp(normal, o.normal, sizeof normal), "a shift: as they were, to the bit");
    motion_free(&moves);
    in_close(s);
    obj_free(&o);
    model_free(&m);
}

static bool names_are(const char *pattern, int64_t index, const char *want)
{
    numbered n;
    err e = {0};
    if (numbered_of(&n, pattern, "", &e))
        return !want && e.status == STATUS_USAGE;
    char *got = numbered_name(&n, index, &e);
    bool same = want && !strcmp(got, want);
    free(got);
    return same;
}

static void test_numbered(void)
{
    ok(names_are("f_%04d.obj", 7, "f_0007.obj") && names_are("%d", -3, "-3") && names_are("a%3db", 7, "a  7b") &&
           names_are("d/f%02d", 1234, "d/f1234"),
       "names from patterns");
    static const char *const bad[] = {NULL, "f.obj",   "%s.obj", "%d%d", "%d%%",  "%04x",
                                      "%",  "%99999d", "%-4d",   "%n",   "50%.%d"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        ok(names_are(bad[i], 1, NULL), "refused pattern %s", bad[i] ? bad[i] : "(none)");
}

int main(void)
{
    srand(3);
    test_nearest((const double[3]){.1, .1, .1}, .5, "half the cells");
    test_nearest((const double[3]){.1, .02, .3}, .5, "half the cells, anisotropic");
    test_nearest((const double[3]){.1, .02, .3}, .01, "a few cells, anisotropic");
    test_nearest((const double[3]){.0025, .0025, .0025}, 1, "a block");
    test_bad_models();
    test_weights();
    test_linear(0, 1e-12);
    test_linear(3, 1e-11);
    test_linear(1000, 1e-6);
    test_tetrahedron();
    test_normals();
    test_numbered();
    return done_testing();
}
