/* J in the middle and at the corners: against closed forms, against gradients that come by inverting the map, of boxes,
 * other hexahedra and tetrahedra; what is folded; sums by parts. (VTK's Jacobian: tests/cli/quality.t.) */
#include "mesh/quality.h"

#include "mesh/gradient.h"
#include "mesh/hexahedron.h"
#include "mesh/lattice.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum { TRIES = 300 };

static const int32_t own[8] = {0, 1, 2, 3, 4, 5, 6, 7};
static const double side[3] = {.002, .003, .0015};

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

/* A box of `side`, its corners moved by up to `off` of it. */
static void make_rest(double off, double rest[24])
{
    for (int i = 0; i < 24; i++)
        rest[i] = .07 + side[i % 3] * (lattice_vtk[i / 3][i % 3] + uniform(-off, off));
}

static double determinant(const double f[9])
{
    return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) + f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/* A corner goes d of each side outward: the three edges there are those of I + d times ones, of which det is 1 + 3 d.
 * The neighbours have one edge that ends there: 1 + d. The middle has a quarter of it all: 1 + 3 d / 4. */
static void test_pushed(int corner, double d, bool box)
{
    double rest[24], u[24] = {0};
    const quality_mesh m = {own, 8, 1, rest, box ? side : NULL};
    make_rest(0, rest);
    for (int a = 0; a < 3; a++)
        u[3 * corner + a] = d * side[a] * (lattice_vtk[corner][a] ? 1 : -1);
    const quality_j j = quality_of(&m, 0, u);
    ok(fabs(j.centre - (1 + .75 * d)) < 1e-12 && fabs(j.corner - fmin(1, 1 + 3 * d)) < 1e-12 &&
           quality_is_folded(j) == (1 + 3 * d <= 0),
       "corner %d pushed by %g%s: J %.17g in the middle, %.17g there", corner, d, box ? ", a box" : "", j.centre,
       j.corner);
}

static void test_rest(void)
{
    static const int32_t tet[4] = {0, 1, 3, 4};
    double rest[24], none[24] = {0}, worst = 0;
    for (int i = 0; i < TRIES; i++) {
        make_rest(.2, rest);
        const quality_mesh all[3] = {{own, 8, 1, rest, NULL}, {own, 8, 1, rest, side}, {tet, 4, 1, rest, NULL}};
        for (int k = 0; k < 6; k++) {
            const quality_j j = quality_of(&all[k / 2], 0, k % 2 ? NULL : none);
            worst = fmax(worst, fmax(fabs(j.centre - 1), fabs(j.corner - 1)));
        }
    }
    ok(worst == 0, "at rest J is 1, to the last bit, with no displacement and with one of nothing");
}

/* det(I + u grad), the gradients of the nodes' shares at a corner by the inverse of the map there. */
static double inverted(const double *rest, const double *u, const double weight[3])
{
    double gradient[24], f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    hexahedron_gradients(own, rest, weight, gradient);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 9; i++)
            f[i] += u[3 * c + i / 3] * gradient[3 * c + i % 3];
    return determinant(f);
}

static void test_any(double off)
{
    double rest[24], u[24], weight[3], worst = 0;
    int folded = 0;
    for (int i = 0; i < TRIES; i++) {
        const quality_mesh m = {own, 8, 1, rest, off == 0 ? side : NULL};
        const double half[3] = {.5, .5, .5};
        double least = INFINITY;
        make_rest(off, rest);
        for (int k = 0; k < 24; k++)
            u[k] = side[k % 3] * uniform(-.4, .4);
        for (int c = 0; c < 8; c++) {
            for (int a = 0; a < 3; a++)
                weight[a] = lattice_vtk[c][a] ? 0 : 1;
            least = fmin(least, inverted(rest, u, weight));
        }
        const quality_j j = quality_of(&m, 0, u);
        worst = fmax(worst, fmax(fabs(j.corner - least), fabs(j.centre - inverted(rest, u, half))));
        folded += quality_is_folded(j);
    }
    ok(worst < 1e-11 && folded > TRIES / 10 && folded < TRIES,
       "%s: as by gradients, to %.1e, where %d of %d are folded", off == 0 ? "boxes" : "any hexahedra", worst, folded,
       TRIES);
}

static void test_tetrahedra(void)
{
    static const int32_t node[4] = {0, 1, 3, 4};
    double rest[24], u[24], h[9], worst = 0;
    for (int i = 0; i < TRIES; i++) {
        const quality_mesh m = {node, 4, 1, rest, NULL};
        make_rest(.2, rest);
        for (int k = 0; k < 24; k++)
            u[k] = side[k % 3] * uniform(-.6, .6);
        gradient_of(node, 4, rest, u, h);
        for (int k = 0; k < 9; k += 4)
            h[k] += 1;
        const quality_j j = quality_of(&m, 0, u);
        worst = fmax(worst, fmax(fabs(j.centre - determinant(h)), fabs(j.corner - determinant(h))));
    }
    ok(worst < 1e-11, "tetrahedra: one J, as by gradients, to %.1e", worst);
}

/* What has no J is folded. */
static void test_none(void)
{
    double rest[24], u[24] = {0};
    const quality_mesh any = {own, 8, 1, rest, NULL}, box = {own, 8, 1, rest, side};
    make_rest(0, rest);
    u[20] = NAN;
    for (int k = 0; k < 2; k++) {
        const quality_j j = quality_of(k ? &box : &any, 0, u);
        ok(isnan(j.centre) && isnan(j.corner) && quality_is_folded(j), "a displacement that is no number");
    }
    u[20] = 0;
    for (int a = 0; a < 3; a++)
        rest[a] = rest[3 + a];
    quality_j j = quality_of(&any, 0, u);
    ok(j.centre == 1 && isnan(j.corner) && quality_is_folded(j), "two corners in one place at rest");
    memset(rest, 0, sizeof rest);
    j = quality_of(&any, 0, NULL);
    ok(isnan(j.centre) && isnan(j.corner) && quality_is_folded(j), "all of them");
    ok(quality_is_folded((quality_j){-.1, .2}) && quality_is_folded((quality_j){.2, 0}) &&
           !quality_is_folded((quality_j){1e-9, 1e-9}),
       "J of 0 or less is folded, in the middle or at a corner");
}

static bool same(const quality *a, const quality *b)
{
    return !memcmp(&a->centre, &b->centre, sizeof a->centre) && !memcmp(&a->corner, &b->corner, sizeof a->corner) &&
           a->folded == b->folded && a->element == b->element;
}

/* A row of boxes, each moved in its own way, one by what is no number, two in the same way. */
static void test_parts(void)
{
    enum { ROW = 12 };
    static double rest[24 * ROW], u[24 * ROW];
    int32_t node[8 * ROW];
    const quality_mesh m = {node, 8, ROW, rest, side};
    int bad = 0;
    for (int i = 0; i < 8 * ROW; i++)
        node[i] = i;
    for (int k = 0; k < ROW; k++)
        make_rest(0, rest + 24 * k);
    for (int with_nan = 0; with_nan < 2; with_nan++) {
        for (int i = 0; i < 24 * ROW; i++)
            u[i] = side[i % 3] * uniform(-.3, .3);
        for (int i = 0; i < 24; i++)
            u[24 * 7 + i] = u[24 * 4 + i] = side[i % 3] * (i == 18 ? -2 : 0);
        u[24 * 9] = with_nan ? (double)NAN : 0;
        const quality whole = quality_look(&m, u, 0, ROW);
        ok(whole.element == (with_nan ? 9 : 4) && fabs(whole.corner + 1) < 1e-12 && whole.folded >= 2,
           "the worst is element %d: J %g at a corner; %d are folded", (int)whole.element, whole.worst,
           (int)whole.folded);
        for (int a = 0; a <= ROW; a++)
            for (int b = a; b <= ROW; b++) {
                quality first = quality_look(&m, u, 0, a);
                const quality second = quality_look(&m, u, a, b), third = quality_look(&m, u, b, ROW);
                quality_join(&first, &second);
                quality_join(&first, &third);
                bad += !same(&first, &whole);
            }
    }
    ok(!bad, "however the row is cut into parts, their sum is the same");
    const quality none = quality_look(&m, u, 3, 3);
    ok(isnan(none.centre) && isnan(none.corner) && !none.folded && none.element < 0, "of nothing there is none");
}

int main(void)
{
    static const double ways[] = {.5, -.3, -1. / 3 - 1e-9, -.5, -1};
    for (int c = 0; c < 8; c++)
        for (int k = 0; k < 5; k++)
            test_pushed(c, ways[k], (c + k) % 2);
    test_rest();
    test_any(0);
    test_any(.2);
    test_tetrahedra();
    test_none();
    test_parts();
    return done_testing();
}
