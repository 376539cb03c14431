/* Nearest points by the tree, to the bit those of a look at every triangle, in soups, on lattices with many ties, from
 * any guess; the sides and borders that pseudonormals tell, on solids whose inside is known; and what lies inside, as
 * winding numbers say it. */
#include "surface/pseudonormal.h"
#include "surface/trimesh.h"
#include "surface/winding.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* A repeatable random number in [-1, 1]. */
static double random_in(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / (double)(1ull << 52) - 1;
}

static triangle_hit by_look(const double *position, const int32_t *corner, int64_t triangles, const double *q)
{
    triangle_hit best = {.triangle = -1, .distance2 = INFINITY};
    for (int64_t t = 0; t < triangles; t++) {
        triangle_hit hit = {.triangle = t};
        hit.distance2 =
            closest_triangle_on(position + 3 * (int64_t)corner[3 * t], position + 3 * (int64_t)corner[3 * t + 1],
                                position + 3 * (int64_t)corner[3 * t + 2], q, hit.point, &hit.feature);
        if (hit.distance2 < best.distance2)
            best = hit;
    }
    return best;
}

static bool same(const triangle_hit *a, const triangle_hit *b)
{
    return a->triangle == b->triangle && a->feature == b->feature && a->distance2 == b->distance2 &&
           !memcmp(a->point, b->point, sizeof a->point);
}

enum { POINTS = 300, MOST = 3000 };

/* grid: coordinates are multiples of 1 / grid, so that there are ties and triangles without area; 0: any. size: of a
 * triangle; away: how far off the whole lies. */
static void soup(const char *name, int64_t triangles, int grid, double size, double away)
{
    static double position[9 * MOST];
    static int32_t corner[3 * MOST];
    uint64_t seed = (uint64_t)(triangles * 7 + grid);
    err e = {0};
    for (int64_t i = 0; i < 9 * triangles; i++) {
        const double middle = i % 9 < 3 || size > 1 ? random_in(&seed) : position[i - i % 9 + i % 3];
        position[i] = middle + (i % 9 < 3 ? away : size * random_in(&seed));
        if (grid)
            position[i] = round(position[i] * grid) / grid;
        corner[i / 3] = (int32_t)(i / 3);
    }
    triangle_tree *tree = triangle_tree_create(position, corner, triangles, &e);
    int wrong = 0, by_guess = 0;
    for (int i = 0; tree && i < POINTS; i++) {
        double q[3];
        for (int a = 0; a < 3; a++) {
            q[a] = away + (i % 3 ? 1.2 : 30) * random_in(&seed);
            if (grid && i % 2)
                q[a] = round(q[a] * grid) / grid;
        }
        const triangle_hit want = by_look(position, corner, triangles, q), got = triangle_tree_nearest(tree, q, -1);
        const triangle_hit guessed = triangle_tree_nearest(tree, q, i % triangles);
        wrong += !same(&want, &got);
        by_guess += !same(&want, &guessed);
    }
    ok(tree && !wrong, "%s: %d of %d points have another nearest point than by a look at all", name, wrong, POINTS);
    ok(tree && !by_guess, "%s: and %d with a guess", name, by_guess);
    triangle_tree_destroy(tree);
}

/* An OBJ's triangles, and what is made of them. */
typedef struct shape {
    trimesh mesh;
    pseudonormal normal;
    triangle_tree *tree;
} shape;

static void shape_of(shape *s, const char *text)
{
    err e = {0};
    obj o = {0};
    *s = (shape){.tree = NULL};
    in *source = in_memory(text, strlen(text), "shape", &e);
    if (!source || obj_read(&o, source, &e) || trimesh_of(&s->mesh, &o, 1, &e) ||
        pseudonormal_of(&s->normal, s->mesh.position, s->mesh.vertices, s->mesh.corner, s->mesh.triangles, &e))
        ok(false, "%s", e.text);
    in_close(source);
    obj_free(&o);
    s->tree = triangle_tree_create(s->mesh.position, s->mesh.corner, s->mesh.triangles, &e);
}

static void shape_free(shape *s)
{
    triangle_tree_destroy(s->tree);
    pseudonormal_free(&s->normal);
    trimesh_free(&s->mesh);
}

/* Of random points about a closed shape: how many pseudonormals put on another side than the winding number does. */
static int on_other_side(const shape *s, double reach)
{
    const winding solid = winding_of(s->mesh.position, s->mesh.corner, s->mesh.triangles);
    uint64_t seed = 11;
    int other = 0;
    for (int i = 0; i < 4000; i++) {
        const double q[3] = {reach * random_in(&seed), reach * random_in(&seed), reach * random_in(&seed)};
        const triangle_hit hit = triangle_tree_nearest(s->tree, q, -1);
        other += pseudonormal_outside(&s->normal, &hit, q) == winding_holds(&solid, q);
    }
    return other;
}

/* A wedge with a dihedral angle of 4 degrees, on whose edges and corners one triangle's normal alone tells the wrong
 * side; a star, whose faces meet in hollows and spikes; the wedge as a soup, with a collapsed triangle. */
static const char wedge[] = "v 0 0 0\nv 1 .02 0\nv 1 -.02 0\nv 0 0 1\nv 1 .02 1\nv 1 -.02 1\n"
                            "f 1 2 3\nf 4 6 5\nf 1 4 5 2\nf 2 5 6 3\nf 3 6 4 1\n";
static const char star[] = "v .2 .2 .2\nv -.2 -.2 .2\nv -.2 .2 -.2\nv .2 -.2 -.2\n"
                           "v -.9 -.9 -.9\nv .9 .9 -.9\nv .9 -.9 .9\nv -.9 .9 .9\n"
                           "f 2 3 5\nf 3 4 5\nf 4 2 5\nf 1 4 6\nf 4 3 6\nf 3 1 6\n"
                           "f 1 2 7\nf 2 4 7\nf 4 1 7\nf 1 3 8\nf 3 2 8\nf 2 1 8\n";
static const char seam[] = "v 0 0 0\nv 1 .02 0\nv 1 -.02 0\nv 0 0 1\nv 1 .02 1\nv 1 -.02 1\nv 0 0 0\nv 0 0 1\n"
                           "f 1 4 7\nf 1 2 3\nf 4 6 5\nf 1 4 5 2\nf 2 5 6 3\nf 3 6 8 7\n";

static void sides(void)
{
    shape s;
    shape_of(&s, wedge);
    ok(!s.normal.border && !s.normal.turned && s.normal.volume > 0, "a wedge is closed and faces outward");
    near_(s.normal.volume, .02, 1e-15, "and holds what it holds");
    const int of_wedge = on_other_side(&s, 1.3);
    ok(!of_wedge, "a wedge: %d points on another side than by the winding number", of_wedge);
    shape_free(&s);
    shape_of(&s, seam);
    ok(!s.normal.border, "with a seam, and a triangle that has two corners at one place: still closed");
    const int of_seam = on_other_side(&s, 1.3);
    ok(!of_seam, "and %d points on another side", of_seam);
    shape_free(&s);
    shape_of(&s, star);
    ok(!s.normal.border && !s.normal.turned, "a star is closed");
    const bool inward = s.normal.volume < 0;
    const int of_star = on_other_side(&s, 1.1);
    ok(of_star == (inward ? 4000 : 0), "a star: %d of 4000 points on another side (it faces %s)", of_star,
       inward ? "inward" : "outward");
    shape_free(&s);
}

static void borders(void)
{
    shape s;
    shape_of(&s, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
    ok(s.normal.border == 4 && !s.normal.turned, "an open square has four edges of border");
    const struct {
        double q[3];
        bool border, outside;
        closest_feature feature;
    } points[] = {
        {{.5, .5, .2}, false, true, CLOSEST_C},     {{.5, .5, -.2}, false, false, CLOSEST_C},
        {{.25, .25, -1}, false, false, CLOSEST_CA}, {{.5, .25, 2}, false, true, CLOSEST_INSIDE},
        {{.5, -1, .5}, true, true, CLOSEST_AB},     {{-1, -1, 0}, true, true, CLOSEST_A},
        {{1.5, .5, 0}, true, true, CLOSEST_AB},
    };
    for (int i = 0; i < (int)(sizeof points / sizeof *points); i++) {
        const triangle_hit hit = triangle_tree_nearest(s.tree, points[i].q, -1);
        ok(hit.feature == points[i].feature && pseudonormal_on_border(&s.normal, &hit) == points[i].border &&
               (points[i].border || pseudonormal_outside(&s.normal, &hit, points[i].q) == points[i].outside),
           "point %d: feature %d, border %d", i, hit.feature, points[i].border);
    }
    shape_free(&s);
    shape_of(&s, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n");
    ok(s.normal.turned == 1, "two triangles that face different sides are counted");
    shape_free(&s);
}

/* Of a lattice's points: how many the tree and the winding number do not agree on, and how many are inside. */
static int differ(const shape *s, int n, double h, int *inside)
{
    const winding solid = winding_of(s->mesh.position, s->mesh.corner, s->mesh.triangles);
    int wrong = 0;
    *inside = 0;
    for (int i = 0; i < (2 * n + 1) * (2 * n + 1) * (2 * n + 1); i++) {
        const int side = 2 * n + 1;
        const double q[3] = {h * (i % side - n), h * (i / side % side - n), h * (i / side / side - n)};
        const bool holds = winding_holds(&solid, q);
        *inside += holds;
        wrong += triangle_tree_holds(s->tree, q) != holds;
    }
    return wrong;
}

static void try_inside(const char *name, const char *text, int n, double h)
{
    shape s;
    int inside;
    shape_of(&s, text);
    const int wrong = differ(&s, n, h, &inside);
    ok(!wrong && inside,
       "%s: %d of a lattice's points, of which it holds %d, are on another side than by winding numbers", name, wrong,
       inside);
    shape_free(&s);
}

/* A box that is cut into n x n x n cells: its faces, turned about z. inward: they face
 * inward. */
static void write_box(out *o, int n, double half, double turn, bool inward, int64_t *vertices)
{
    for (int face = 0; face < 6; face++)
        for (int i = 0; i < n * n; i++) {
            static const int at[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            for (int c = 0; c < 4; c++) {
                double x[3];
                x[face / 2] = face % 2 ? half : -half;
                x[(face / 2 + 1) % 3] = half * (2. * (i % n + at[c][0]) / n - 1);
                x[(face / 2 + 2) % 3] = half * (2. * (i / n + at[c][1]) / n - 1);
                out_format(o, "v %.17g %.17g %.17g\n", x[0] * cos(turn) - x[1] * sin(turn),
                           x[0] * sin(turn) + x[1] * cos(turn), x[2]);
            }
            const long long v = *vertices, back = (face % 2 == 0) != inward;
            out_format(o, "f %lld %lld %lld %lld\n", v + 1, v + (back ? 4 : 2), v + 3, v + (back ? 2 : 4));
            *vertices += 4;
        }
}

static void try_box(const char *name, double turn, bool hollow, int n, double h)
{
    err e = {0};
    int64_t vertices = 0;
    size_t length;
    out *o = out_memory(&e);
    write_box(o, 6, .6, turn, false, &vertices);
    if (hollow)
        write_box(o, 3, .3, turn, true, &vertices);
    const unsigned char *bytes = out_bytes(o, &length);
    char *text = strndup((const char *)bytes, length);
    try_inside(name, text, n, h);
    free(text);
    out_discard(o);
}

int main(void)
{
    soup("one triangle", 1, 0, .5, 0);
    soup("a few", 7, 0, .5, 0);
    soup("a soup", MOST, 0, .1, 0);
    soup("a soup of large ones", 500, 0, 2, 0);
    soup("far from the origin", MOST, 0, .1, 1e6);
    soup("on a lattice, with ties", MOST, 4, .5, 0);
    soup("all at few places", 2000, 1, .3, 0);
    sides();
    borders();
    try_inside("a wedge", wedge, 12, .05);
    try_inside("a wedge with a seam", seam, 12, .05);
    try_inside("a star", star, 10, .1);
    try_box("a box in line with the lattice", 0, false, 8, .1);
    try_box("with a hollow", 0, true, 8, .1);
    try_box("turned by 45 degrees", acos(-1) / 4, true, 8, .1 * sqrt(.5));
    try_box("turned by 30 degrees", acos(-1) / 6, true, 8, .1);
    return done_testing();
}
