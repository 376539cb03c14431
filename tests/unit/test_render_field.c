/* What pictures are made of, but for the tracing: the outside of elements, strain and stress at their middles, the
 * scale of colours, round numbers, the layout of sheets. */
#include "mesh/boundary.h"
#include "mesh/gradient.h"
#include "picture/colourmap.h"
#include "picture/legend.h"
#include "picture/sheet.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A block of n x n x n unit hexahedra, without the array element.lattice or with it. */
static void make_block(model *m, int n, bool lattice)
{
    static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    err e = {0};
    int k = n + 1;
    *m = (model){0};
    model_axis_add(m, "node", k * k * k, &e);
    model_axis_add(m, "element", n * n * n, &e);
    model_add(m, "node.position", &e);
    model_add(m, "element.node", &e);
    if (lattice)
        model_add(m, "element.lattice", &e);
    double *p = model_find(m, "node.position")->f64;
    int32_t *node = model_find(m, "element.node")->i32;
    for (int i = 0; i < k * k * k; i++)
        p[3 * i] = i % k, p[3 * i + 1] = i / k % k, p[3 * i + 2] = i / k / k;
    for (int i = 0; i < n * n * n; i++)
        for (int c = 0; c < 8; c++)
            node[8 * i + c] =
                (i % n + corner[c][0]) + k * ((i / n % n + corner[c][1]) + k * (i / n / n + corner[c][2]));
    for (int i = 0; lattice && i < n * n * n; i++) {
        int32_t *at = &model_find(m, "element.lattice")->i32[3 * i];
        at[0] = i % n, at[1] = i / n % n, at[2] = i / n / n;
    }
    ok(!e.status, "a block: %s", e.text);
}

/* Six times the volume that faces of 4 enclose: right only where each is seen from outside against the clock. */
static double enclosed(const boundary *b, const double *p)
{
    double sum = 0;
    for (int64_t f = 0; f < b->faces; f++)
        for (int t = 0; t < 2; t++) {
            const double *x = &p[3 * (int64_t)b->node[4 * f]], *y = &p[3 * (int64_t)b->node[4 * f + 1 + t]];
            const double *z = &p[3 * (int64_t)b->node[4 * f + 2 + t]];
            sum += x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
                   x[2] * (y[0] * z[1] - y[1] * z[0]);
        }
    return sum;
}

static void test_boundary(bool lattice)
{
    model m;
    boundary b;
    err e = {0};
    bool keep[27], beside[27];
    make_block(&m, 3, lattice);
    const double *p = model_find(&m, "node.position")->f64;
    const char *how = lattice ? "by the lattice" : "by nodes";
    ok(!boundary_of(&b, &m, NULL, NULL, &e) && b.faces == 54, "%s: 54 faces of 27 cubes, not %d", how, (int)b.faces);
    near_(enclosed(&b, p), 6 * 27, 1e-12, "%s: they enclose 27", how);
    boundary_free(&b);
    for (int i = 0; i < 27; i++) {
        keep[i] = i != 13;
        beside[i] = i == 13;
    }
    ok(!boundary_of(&b, &m, keep, NULL, &e) && b.faces == 60, "%s: 60 with a hole in the middle", how);
    near_(enclosed(&b, p), 6 * 26, 1e-12, "%s: they enclose 26", how);
    boundary_free(&b);
    ok(!boundary_of(&b, &m, keep, beside, &e) && b.faces == 54, "%s: 54 where the hole is filled", how);
    boundary_free(&b);
    ok(!boundary_of(&b, &m, beside, keep, &e) && !b.faces, "%s: none of what fills it", how);
    boundary_free(&b);
    model_free(&m);
}

static void test_tetrahedra(void)
{
    model m = {0};
    boundary b;
    err e = {0};
    model_axis_add(&m, "node", 5, &e);
    model_axis_add(&m, "element", 2, &e);
    model_array *node = model_add_as(&m, "element.node", MODEL_I32, "@node", "element", 4, &e);
    const int32_t two[8] = {0, 1, 2, 3, 2, 1, 3, 4};
    if (node)
        memcpy(node->i32, two, sizeof two);
    ok(!boundary_of(&b, &m, NULL, NULL, &e) && b.faces == 6 && b.corners == 3, "two tetrahedra have six faces");
    boundary_free(&b);
    model_free(&m);
}

static void test_gradient(void)
{
    double strain[9], shear[9] = {0, .2, 0, 0, 0, 0, 0, 0, 0};
    gradient_strain(shear, strain);
    near_(gradient_largest(strain), .01 + sqrt(.01 * .01 + .1 * .1), 1e-12, "simple shear: the largest strain");
    const double sizes[9] = {2, 0, 0, 0, -1, 0, 0, 0, 2}, ball[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3};
    near_(gradient_largest(sizes), 2, 1e-12, "two alike");
    near_(gradient_largest(ball), 3, 1e-12, "all alike");
    near_(gradient_mises(sizes), 3, 1e-12, "von Mises of 2, -1, 2");
}

/* A linear field has its gradient in any hexahedron and tetrahedron. */
static void test_linear(int corners)
{
    static const double unit[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const int pick[4] = {0, 1, 3, 4};
    const double wanted[9] = {.1, -.2, .3, .05, .4, -.1, .2, 0, -.3};
    double rest[24], u[24] = {0}, h[9], worst = 0;
    int32_t node[8];
    for (int n = 0; n < corners; n++)
        for (int a = 0; a < 3; a++) {
            node[n] = n;
            rest[3 * n + a] = unit[corners == 8 ? n : pick[n]][a] * (a + 1) + .2 * rand() / (double)RAND_MAX;
        }
    for (int n = 0; n < corners; n++)
        for (int i = 0; i < 9; i++)
            u[3 * n + i / 3] += wanted[i] * rest[3 * n + i % 3];
    ok(gradient_of(node, corners, rest, u, h), "%d corners have a volume", corners);
    for (int i = 0; i < 9; i++)
        worst = fmax(worst, fabs(h[i] - wanted[i]));
    ok(worst < 1e-12, "%d corners: the gradient of a linear field, to %.1e", corners, worst);
    memset(rest, 0, sizeof rest);
    ok(!gradient_of(node, corners, rest, u, h) && isnan(h[0]), "%d corners at one place: none", corners);
}

/* Of a linear RGB colour: the way back of colourmap.c's. */
static void oklab_of(const float colour[3], double lab[3])
{
    double r = colour[0], g = colour[1], b = colour[2];
    double l = cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    double m = cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    double s = cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

static void test_colours(void)
{
    colourmap c;
    double last[3], lab[3], least = INFINITY, most = 0;
    bool lighter = true;
    colourmap_make(&c);
    oklab_of(c.colour[0], last);
    for (int i = 1; i < COLOURMAP_STEPS; i++) {
        oklab_of(c.colour[i], lab);
        double step = sqrt(pow(lab[0] - last[0], 2) + pow(lab[1] - last[1], 2) + pow(lab[2] - last[2], 2));
        least = fmin(least, step);
        most = fmax(most, step);
        lighter &= lab[0] > last[0];
        memcpy(last, lab, sizeof last);
    }
    ok(lighter, "lightness grows throughout");
    ok(most < 1.02 * least, "steps are equal: %.5f to %.5f", least, most);
    float grey[3], end[3];
    colourmap_at(&c, NAN, grey);
    colourmap_at(&c, 7, end);
    ok(grey[0] == grey[1] && grey[1] == grey[2], "nan is grey");
    ok(!memcmp(end, c.colour[COLOURMAP_STEPS - 1], sizeof end), "beyond the end is the end");
}

/* Chroma gives way until a screen can show the colour; lightness and hue do not. */
static void test_names_colours(void)
{
    const double lightness[3] = {.74, .60, .86};
    double lab[3], off = 0, turned = 0;
    for (int i = 0; i < 64; i++) {
        float colour[3];
        colourmap_name(i, colour);
        oklab_of(colour, lab);
        double hue = (i * .6180339887498949 * 360 + 40) * acos(-1) / 180;
        off = fmax(off, fabs(lab[0] - lightness[(i + i / 8) % 3]));
        turned = fmax(turned, fabs(lab[1] * sin(hue) - lab[2] * cos(hue)));
    }
    ok(off < 1e-5 && turned < 1e-5, "64 names have the lightness and hue of each, to %.1e and %.1e", off, turned);
}

static void ticks(double low, double high, int most, int count, double first, double last, int places)
{
    double t[LEGEND_TICKS];
    int decimals, n = legend_ticks(low, high, most, t, &decimals);
    ok(n == count && fabs(t[0] - first) < 1e-9 && fabs(t[n - 1] - last) < 1e-9 && decimals == places,
       "%g to %g: %d numbers, %g to %g, %d places", low, high, n, t[0], t[n - 1], decimals);
}

static void test_sheet(void)
{
    sheet s;
    sheet_make(&s, 1500, 600, 3, 20, 60);
    ok(s.columns == 3 && s.rows == 1, "three side by side on a wide sheet");
    sheet_make(&s, 600, 1500, 3, 20, 60);
    ok(s.columns == 1 && s.rows == 3, "one above the other on a high one");
    sheet_make(&s, 1000, 900, 5, 20, 60);
    for (int i = 0; i < 5; i++) {
        sheet_cell p = sheet_panel(&s, i), c = sheet_picture(&s, i);
        ok(p.x >= 0 && p.y >= 0 && p.x + p.width <= 1000 && p.y + p.height <= 900 && c.y == p.y + 20 &&
               c.y + c.height + 60 == p.y + p.height,
           "panel %d is on the sheet, its picture in it", i);
    }
}

int main(void)
{
    test_boundary(false);
    test_boundary(true);
    test_tetrahedra();
    test_gradient();
    test_linear(8);
    test_linear(4);
    test_colours();
    test_names_colours();
    ticks(0, 5.7, 6, 6, 0, 5, 0);
    ticks(0, .0057, 6, 6, 0, .005, 3);
    ticks(-1.5, 1.5, 4, 3, -1, 1, 0);
    ticks(2, 2, 4, 1, 2, 2, 0);
    test_sheet();
    return done_testing();
}
