/* Binding to tetrahedra: the element against a search through all, inside, on faces and outside;
 * weights and linear fields; what has no volume.
 */
// needs: bind/tetra.c
#include "bind/tetra.h"
#include "mesh/weights.h"
#include "surface/closest.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 7, CELLS = SIDE * SIDE * SIDE, ELEMENTS = 5 * CELLS };

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

/* A grid's cells in five tetrahedra each, of alternating parity, its nodes moved about; elements in shuffled order,
 * some inside out. Cells may be left out. */
static model make(double size, double shift, bool holes)
{
    static const int split[2][5][4] = {{{0, 1, 3, 4}, {1, 2, 3, 6}, {4, 5, 6, 1}, {4, 6, 7, 3}, {1, 3, 4, 6}},
                                       {{0, 1, 2, 5}, {0, 2, 3, 7}, {5, 6, 7, 2}, {4, 5, 7, 0}, {0, 2, 7, 5}}};
    static const int at[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static int32_t list[ELEMENTS][4];
    const int row = SIDE + 1;
    int32_t elements = 0;
    err e = {0};
    model m = {0};
    for (int c = 0; c < CELLS; c++) {
        int x = c % SIDE, y = c / SIDE % SIDE, z = c / SIDE / SIDE;
        for (int t = 0; t < 5 && !(holes && c % 11 == 3); t++) {
            for (int k = 0; k < 4; k++) {
                const int *d = at[split[(x + y + z) % 2][t][k]];
                list[elements][k] = ((z + d[2]) * row + y + d[1]) * row + x + d[0];
            }
            if (c % 3 == 0) {
                int32_t keep = list[elements][0];
                list[elements][0] = list[elements][1];
                list[elements][1] = keep;
            }
            elements++;
        }
    }
    model_axis_add(&m, "node", row * row * row, &e);
    model_axis_add(&m, "element", elements, &e);
    double *position = model_add(&m, "node.position", &e)->f64;
    for (int n = 0; n < row * row * row; n++)
        for (int a = 0; a < 3; a++) {
            const int cell[3] = {n % row, n / row % row, n / row / row};
            position[3 * n + a] = size * (cell[a] + uniform(-shift, shift));
        }
    int32_t *node = model_add_as(&m, "element.node", MODEL_I32, "@node", "element", 4, &e)->i32;
    for (int32_t i = elements - 1; i >= 0; i--) {
        int32_t j = rand() % (i + 1);
        memcpy(&node[4 * i], list[j], sizeof list[j]);
        memcpy(list[j], list[i], sizeof list[j]);
    }
    if (e.status)
        ok(false, "%s", e.text);
    return m;
}

/* The distance from a tetrahedron, by signed volumes and all its faces. */
static double distance(const tetra *t, int32_t element, const double *p)
{
    const double *x[4];
    double least = INFINITY, near[3];
    int same = 0;
    for (int c = 0; c < 4; c++)
        x[c] = &t->position[3 * t->node[4 * element + c]];
    for (int c = 0; c < 4; c++) {
        const double *y[4] = {x[0], x[1], x[2], x[3]};
        double d[3][3], whole[2];
        for (int k = 0; k < 2; k++) {
            y[c] = k ? p : x[c];
            for (int i = 0; i < 9; i++)
                d[i / 3][i % 3] = y[i / 3 + 1][i % 3] - y[0][i % 3];
            whole[k] = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                       d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                       d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
        }
        same += whole[1] / whole[0] >= 0;
        least = fmin(least, closest_triangle(x[(c + 1) % 4], x[(c + 2) % 4], x[(c + 3) % 4], p, near));
    }
    return same == 4 ? 0 : sqrt(least);
}

static int32_t brute(const tetra *t, int64_t elements, const double *p)
{
    double least = INFINITY;
    for (int32_t i = 0; i < elements; i++)
        least = fmin(least, distance(t, i, p));
    for (int32_t i = 0; i < elements; i++)
        if (distance(t, i, p) <= least + t->tie + 4e-15 * least)
            return i;
    return -1;
}

/* Points anywhere, at nodes, on edges and faces, and far away. */
static void take_point(const model *m, double size, int kind, double *p)
{
    const double *x = model_find(m, "node.position")->f64;
    const model_array *node = model_find(m, "element.node");
    const int32_t *n = &node->i32[4 * (rand() % node->rows)];
    for (int a = 0; a < 3; a++) {
        double reach = kind == 1 ? 100 : 1;
        p[a] = size * uniform(-reach, SIDE + reach);
        if (kind == 2)
            p[a] = x[3 * n[0] + a];
        if (kind == 3)
            p[a] = (x[3 * n[0] + a] + x[3 * n[1] + a]) / 2;
        if (kind == 4)
            p[a] = .25 * x[3 * n[0] + a] + .25 * x[3 * n[1] + a] + .5 * x[3 * n[2] + a];
    }
}

static void against_all(double size, double shift, bool holes)
{
    err e = {0};
    model m = make(size, shift, holes);
    tetra t;
    int64_t elements = model_count(&m, "element");
    int wrong = 0;
    double off = 0;
    ok(!tetra_build(&t, &m, &e) && t.flat == 0, "%d elements %s", (int)elements, e.text);
    for (int i = 0; i < 1500; i++) {
        double p[3], weight[4], sum = 0, want = 0, got = 0;
        take_point(&m, size, i % 5, p);
        int32_t element = tetra_element(&t, p);
        wrong += element != brute(&t, elements, p);
        int32_t n[4];
        memcpy(n, t.node + 4 * (size_t)element, sizeof n);
        weights_tetrahedron(n, t.position, p, weight);
        for (int a = 0; a < 3; a++)
            want += (a + 2) * p[a] / size;
        for (int c = 0; c < 4; c++) {
            sum += weight[c];
            for (int a = 0; a < 3; a++)
                got += weight[c] * (a + 2) * t.position[3 * n[c] + a] / size;
        }
        off = fmax(off, fmax(fabs(sum - 1), fabs(got - want) / (1 + fabs(want))));
    }
    ok(!wrong, "each the one that a search through all finds: %d differ", wrong);
    ok(off < 1e-10, "and its weights give linear fields, outside too: off by %.1e", off);
    tetra_free(&t);
    model_free(&m);
}

/* A sliver has a volume until it is flatter than a billionth. */
static void flat(void)
{
    static const int32_t node[] = {0, 1, 2, 3};
    double x[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, .3, .3, 1};
    near_(weights_tetrahedron_volume(node, x), 1. / 6, 1e-15, "a corner of a cube");
    x[11] = -1e-6;
    near_(weights_tetrahedron_volume(node, x), 1e-6 / 6, 1e-18, "a sliver, inside out");
    x[11] = 1e-9;
    ok(weights_tetrahedron_volume(node, x) == 0, "a flat one");
    double p[] = {.25, .25, .5};
    x[11] = 1;
    near_(weights_tetrahedron_outside(node, x, p), 0, 0, "inside");
    p[2] = -2;
    near_(weights_tetrahedron_outside(node, x, p), 2, 1e-15, "below a face");
    p[2] = 3;
    near_(weights_tetrahedron_outside(node, x, p), sqrt(.005 + 4), 1e-14, "above a corner");
}

/* The gradients of the shares are those of the weights. */
static void gradients(void)
{
    static const int32_t node[] = {3, 1, 0, 2};
    const double x[] = {.1, .2, .3, 1.4, -.2, .1, .3, 1.2, .2, -.1, .4, 1.1}, step = 1e-3;
    double gradient[12], worst = 0;
    weights_tetrahedron_gradients(node, x, gradient);
    for (int a = 0; a < 3; a++) {
        double p[] = {.2, .3, .4}, low[4], high[4];
        weights_tetrahedron(node, x, p, low);
        p[a] += step;
        weights_tetrahedron(node, x, p, high);
        for (int c = 0; c < 4; c++)
            worst = fmax(worst, fabs((high[c] - low[c]) / step - gradient[3 * c + a]));
    }
    near_(worst, 0, 1e-11, "gradients of the shares");
}

int main(void)
{
    srand(3);
    against_all(1, 0, false);
    against_all(1, .2, false);
    against_all(.004, .2, true);
    flat();
    gradients();
    return done_testing();
}
