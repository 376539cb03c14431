// needs: bind/nearest.c bind/normals.c
/* How blended vertices move: affine motions, continuity, the sums of weights, slits, and normals of a bent sheet. */
#include "bind/nearest.h"
#include "bind/normals.h"
#include "mesh/lattice.h"
#include "mesh/weights.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

/* ---- a block of voxels, and points that are bound to it */

enum { MOST = 4000 };

static const lattice grid = {{-.05, .02, 0}, {.0025, .003, .002}};

typedef struct block {
    model m;
    nearest n;
    bound b;
    motion moves;
    double *u;
    int64_t nodes, elements;
    double position[3 * MOST], weight[3 * MOST];
    int32_t element[MOST];
    uint8_t blended[MOST];
} block;

/* size cells; where slit > 0 the nodes at x < slit in the plane z = size[2] / 2 are double: the cells above have the
 * further ones. taken: may be NULL, all. */
static void make(block *k, const int32_t *size, int32_t slit, const bool *taken)
{
    err e = {0};
    const int64_t nx = size[0] + 1, ny = size[1] + 1, nz = size[2] + 1, plain = nx * ny * nz;
    k->nodes = plain + (int64_t)slit * ny;
    k->elements = 0;
    for (int64_t c = 0; c < (int64_t)size[0] * size[1] * size[2]; c++)
        k->elements += !taken || taken[c];
    memset(&k->m, 0, sizeof k->m);
    lattice_save(&grid, &k->m, &e);
    model_axis_add(&k->m, "node", k->nodes, &e);
    model_axis_add(&k->m, "element", k->elements, &e);
    double *position = model_add(&k->m, "node.position", &e)->f64;
    for (int64_t n = 0; n < k->nodes; n++) {
        const int64_t wide = slit ? slit : 1, x = n < plain ? n % nx : (n - plain) % wide;
        const int64_t y = n < plain ? n / nx % ny : (n - plain) / wide;
        int32_t ijk[3] = {(int32_t)x, (int32_t)y, (int32_t)(n < plain ? n / nx / ny : size[2] / 2)};
        lattice_corner(&grid, ijk, &position[3 * n]);
    }
    int32_t *at = model_add(&k->m, "element.lattice", &e)->i32, *node = model_add(&k->m, "element.node", &e)->i32;
    for (int64_t c = 0, i = 0; c < (int64_t)size[0] * size[1] * size[2]; c++) {
        const int32_t cell[3] = {(int32_t)(c % size[0]), (int32_t)(c / size[0] % size[1]),
                                 (int32_t)(c / size[0] / size[1])};
        if (taken && !taken[c])
            continue;
        memcpy(&at[3 * i], cell, sizeof cell);
        for (int j = 0; j < 8; j++) {
            const int64_t x = cell[0] + lattice_vtk[j][0], y = cell[1] + lattice_vtk[j][1],
                          z = cell[2] + lattice_vtk[j][2];
            const bool further = x < slit && 2 * z == size[2] && 2 * cell[2] >= size[2];
            node[8 * i + j] = (int32_t)(further ? plain + x + slit * y : x + nx * (y + ny * z));
        }
        i++;
    }
    nearest_build(&k->n, &k->m, NULL, &e);
    k->u = calloc((size_t)(3 * k->nodes), sizeof *k->u);
    k->b = (bound){.element = k->element,
                   .weight = k->weight,
                   .blended = k->blended,
                   .node = node,
                   .corners = 8,
                   .rest = position};
    if (e.status)
        printf("# %s\n", e.text);
}

/* Binds one more point, in cells from the grid's origin. */
static void add(block *k, double x, double y, double z)
{
    const int64_t v = k->b.shape.vertices++;
    const double cells[3] = {x, y, z};
    for (int a = 0; a < 3; a++)
        k->position[3 * v + a] = grid.origin[a] + grid.spacing[a] * cells[a];
    k->b.shape.position = k->position;
    k->element[v] = nearest_element(&k->n, &k->position[3 * v]);
    weights_box box = weights_box_of(&k->b.node[8 * (int64_t)k->element[v]], k->b.rest);
    weights_of(&box, &k->position[3 * v], &k->weight[3 * v]);
    k->blended[v] = 1;
}

static void open(block *k)
{
    err e = {0};
    if (motion_open(&k->moves, &k->b, k->nodes, k->elements, &e))
        ok(false, "opens: %s", e.text);
}

static void done(block *k)
{
    motion_free(&k->moves);
    nearest_free(&k->n);
    model_free(&k->m);
    free(k->u);
    free(k);
}

/* ---- what it does */

/* A turn by 40 degrees, a stretch and a shift, in a block with holes, inside and up to 3 cells outside. */
static void test_affine(void)
{
    static const double f[9] = {.766, -.6428, .1, .6428, .766, 0, .05, -.1, 1.2}, by[3] = {.3, -.02, .1};
    const int32_t size[3] = {7, 6, 8};
    block *k = calloc(1, sizeof *k);
    bool taken[7 * 6 * 8];
    for (int i = 0; i < 7 * 6 * 8; i++)
        taken[i] = rand() % 3;
    make(k, size, 0, taken);
    for (int i = 0; i < 1000; i++)
        add(k, uniform(-3, 10), uniform(-3, 9), uniform(-3, 11));
    open(k);
    for (int64_t i = 0; i < 3 * k->nodes; i++) {
        const double *x = k->b.rest + 3 * (i / 3);
        k->u[i] = by[i % 3] - x[i % 3];
        for (int j = 0; j < 3; j++)
            k->u[i] += f[3 * (i % 3) + j] * x[j];
    }
    motion_set(&k->moves, k->u, NULL);
    double worst = 0, worst_f = 0;
    for (int64_t v = 0; v < 1000; v++) {
        double d[3], g[9];
        const double *x = k->position + 3 * v;
        motion_displacement(&k->moves, v, d);
        motion_gradient(&k->moves, v, g);
        for (int i = 0; i < 9; i++)
            worst_f = fmax(worst_f, fabs(g[i] - f[i]));
        for (int i = 0; i < 3; i++)
            worst =
                fmax(worst, fabs(d[i] + x[i] - by[i] - f[3 * i] * x[0] - f[3 * i + 1] * x[1] - f[3 * i + 2] * x[2]));
    }
    ok(worst <= 1e-12 && worst_f <= 1e-12, "an affine motion, inside and 3 cells outside: off by %.2g m, F by %.2g",
       worst, worst_f);
    for (int64_t i = 0; i < 3 * k->nodes; i++)
        k->u[i] = .1 / 3;
    motion_set(&k->moves, k->u, NULL);
    worst = 0;
    for (int64_t v = 0; v < 1000; v++) {
        double d[3];
        motion_displacement(&k->moves, v, d);
        worst = fmax(worst, fabs(d[0] - .1 / 3) + fabs(d[1] - .1 / 3) + fabs(d[2] - .1 / 3));
    }
    ok(worst == 0, "a constant stays, to the bit: %g", worst);
    done(k);
}

/* Threads set the same motion as one thread does, and its gradient is that of finite differences. */
static void test_field(void)
{
    const int32_t size[3] = {14, 13, 12};
    const double step = 1e-4;
    block *k = calloc(1, sizeof *k);
    err e = {0};
    make(k, size, 0, NULL);
    for (int i = 0; i < 200; i++) {
        const double x = uniform(-1, 15), y = uniform(-1, 14), z = uniform(-1, 13);
        if (fabs(x - rint(x)) < .01 || fabs(y - rint(y)) < .01 || fabs(z - rint(z)) < .01)
            continue; /* F is not continuous there */
        add(k, x, y, z);
        for (int a = 0; a < 6; a++) {
            const double d = a % 2 ? step : -step;
            add(k, x + (a / 2 == 0 ? d : 0), y + (a / 2 == 1 ? d : 0), z + (a / 2 == 2 ? d : 0));
        }
    }
    open(k);
    for (int64_t i = 0; i < 3 * k->nodes; i++)
        k->u[i] = uniform(-.001, .001);
    pool *threads = pool_create(3, &e);
    motion_set(&k->moves, k->u, NULL);
    const size_t bytes = (size_t)k->moves.places * sizeof *k->moves.at_node;
    motion_map *alone = malloc(bytes);
    memcpy(alone, k->moves.at_node, bytes);
    motion_set(&k->moves, k->u, threads);
    ok(k->moves.places > 1024 && !memcmp(alone, k->moves.at_node, bytes), "the same bytes in threads");
    double worst = 0;
    for (int64_t v = 0; v < k->b.shape.vertices; v += 7)
        for (int a = 0; a < 3; a++) {
            double low[3], high[3], f[9];
            motion_displacement(&k->moves, v + 1 + 2 * a, low);
            motion_displacement(&k->moves, v + 2 + 2 * a, high);
            motion_gradient(&k->moves, v, f);
            for (int i = 0; i < 3; i++)
                worst = fmax(worst, fabs(f[3 * i + a] - (i == a) - (high[i] - low[i]) / (2 * step * grid.spacing[a])));
        }
    ok(worst < 1e-6, "F is what differences of the displacement are: off by %.2g", worst);
    free(alone);
    pool_destroy(threads);
    done(k);
}

/* Points a hair on either side of faces between elements: with random nodes, the displacement must not jump. */
static void test_continuous(void)
{
    const int32_t size[3] = {5, 5, 6};
    block *k = calloc(1, sizeof *k);
    make(k, size, 2, NULL);
    for (int i = 0; i < 1000; i++) {
        double q[3] = {uniform(0, 5), uniform(0, 5), uniform(0, 6)};
        const int axis = i % 3;
        q[axis] = 1 + rand() % (size[axis] - 1);
        if (axis == 2 && q[2] == 3 && q[0] < 2)
            continue; /* the slit: it may jump */
        for (int s = -1; s <= 1; s += 2)
            add(k, q[0] + (axis == 0) * s * 1e-9, q[1] + (axis == 1) * s * 1e-9, q[2] + (axis == 2) * s * 1e-9);
    }
    open(k);
    for (int64_t i = 0; i < 3 * k->nodes; i++)
        k->u[i] = uniform(-1, 1);
    motion_set(&k->moves, k->u, NULL);
    double worst = 0;
    for (int64_t v = 0; v < k->b.shape.vertices; v += 2) {
        double a[3], b[3];
        motion_displacement(&k->moves, v, a);
        motion_displacement(&k->moves, v + 1, b);
        worst = fmax(worst, fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]));
    }
    ok(k->b.shape.vertices > 1500 && worst < 1e-7, "continuous across faces, at a slit's end too: %.2g", worst);
    done(k);
}

/* The largest sum of the absolute weights of nodes over points, by a unit displacement of each node. */
static double largest_sum(block *k)
{
    double *sum = calloc((size_t)k->b.shape.vertices, sizeof *sum), largest = 0;
    for (int64_t n = 0; n < k->nodes; n++) {
        k->u[3 * n] = 1;
        motion_set(&k->moves, k->u, NULL);
        k->u[3 * n] = 0;
        for (int64_t v = 0; v < k->b.shape.vertices; v++) {
            double d[3];
            motion_displacement(&k->moves, v, d);
            sum[v] += fabs(d[0]);
            largest = fmax(largest, sum[v]);
        }
    }
    free(sum);
    return largest;
}

static void test_sums(void)
{
    const int32_t size[3] = {5, 5, 5}, one[3] = {1, 1, 1};
    static const double reach[] = {-1.5, 0, 1};
    static const double limit[] = {1.25, 1.5, 4.5};
    for (int r = 0; r < 3; r++) {
        block *k = calloc(1, sizeof *k);
        make(k, size, 0, NULL);
        add(k, 5 + reach[r], 5 + reach[r], 5 + reach[r]);
        for (int i = 0; i < 300; i++)
            add(k, uniform(-reach[r], 5 + reach[r]), uniform(-reach[r], 5 + reach[r]),
                uniform(-reach[r], 5 + reach[r]));
        open(k);
        const double sum = largest_sum(k);
        ok(sum <= limit[r] + 1e-12, "sum of |w|, %g cells outside on each axis: %.3f, at most %g", reach[r], sum,
           limit[r]);
        done(k);
    }
    block *k = calloc(1, sizeof *k);
    make(k, one, 0, NULL);
    add(k, 1, 1, 1);
    open(k);
    near_(largest_sum(k), 1.5, 1e-12, "of one element at its corner");
    done(k);
}

/* No vertex on one side of a slit moves with nodes on the other. */
static void test_slit(void)
{
    const int32_t size[3] = {6, 4, 6};
    const int64_t plain = 7 * 5 * 7;
    block *k = calloc(1, sizeof *k);
    make(k, size, 3, NULL);
    for (int i = 0; i < 1000; i++)
        add(k, uniform(0, 6), uniform(0, 4), i % 2 ? uniform(3.0001, 4.5) : uniform(1.5, 2.9999));
    open(k);
    int wrong = 0, moved = 0;
    for (int above = 0; above < 2; above++) {
        for (int64_t n = 0; n < k->nodes; n++) {
            const int64_t x = n % 7, z = n / 35;
            k->u[3 * n] = above ? n >= plain || (n < plain && x < 3 && z > 3) : n < plain && x < 3 && z <= 3;
        }
        motion_set(&k->moves, k->u, NULL);
        for (int64_t v = 0; v < 1000; v++) {
            double d[3];
            motion_displacement(&k->moves, v, d);
            moved += d[0] != 0;
            wrong += d[0] != 0 && k->position[3 * v] < grid.origin[0] + 3 * grid.spacing[0] && (v % 2) != above;
        }
    }
    ok(!wrong && moved > 400, "no vertex moves with nodes across a slit: %d of %d do", wrong, moved);
    done(k);
}

/* A sheet that is bent to a cylinder of radius R about y: normals against the cylinder's. */
static void test_bent(void)
{
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\n";
    const int32_t size[3] = {24, 6, 4};
    const double radius = .06, middle = grid.origin[2] + 2 * grid.spacing[2];
    err e = {0};
    obj o;
    in *s = in_memory(text, sizeof text - 1, "n.obj", &e);
    if (!s || obj_read(&o, s, &e)) {
        ok(false, "reads: %s", e.text);
        return;
    }
    block *k = calloc(1, sizeof *k);
    make(k, size, 0, NULL);
    add(k, 4.3, 2.2, 4.2);
    add(k, 12.7, 3.1, 3.6);
    add(k, 20.9, 4.8, 4.6);
    open(k);
    for (int64_t n = 0; n < k->nodes; n++) {
        const double *x = k->b.rest + 3 * n, r = radius + x[2] - middle, angle = (x[0] - grid.origin[0]) / radius;
        k->u[3 * n] = r * sin(angle) + grid.origin[0] - x[0];
        k->u[3 * n + 2] = r * cos(angle) - radius + middle - x[2];
    }
    motion_set(&k->moves, k->u, NULL);
    bone none = {.node = (int32_t[3]){-1, -1, -1}};
    double normal[9], worst = 0, length = 0;
    normals_deform(&o, &k->moves, &none, NULL, normal);
    for (int v = 0; v < 3; v++) {
        const double angle = (k->position[3 * v] - grid.origin[0]) / radius, *n = normal + 3 * v;
        worst = fmax(worst, acos(fmin(n[0] * sin(angle) + n[2] * cos(angle), 1)));
        length = fmax(length, fabs(sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1));
    }
    ok(worst < .02 && length < 1e-15, "a sheet bent to a cylinder: normals off by %.2g rad, lengths by %.2g", worst,
       length);
    in_close(s);
    obj_free(&o);
    done(k);
}

int main(void)
{
    srand(5);
    test_affine();
    test_field();
    test_continuous();
    test_sums();
    test_slit();
    test_bent();
    return done_testing();
}
