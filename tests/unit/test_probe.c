/* Probes: their closed forms against libccd's GJK and EPA over random points and poses, and against what can be said
 * without either; what is no probe; OBJ files that are no convex body. */
#include "any_pose.h"
#include "tap.h"

#include "base/mem.h"
#include "probe/convex.h"
#include "probe/narrow.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS = 2000 };

static void any_near(const probe_placed *p, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = p->centre[a] + 1.1 * p->reach * any();
}

static probe of_text(const char *text, const char *name)
{
    err e = {0};
    probe p = {.kind = PROBE_CONVEX};
    obj o = {0};
    in *source = in_memory(text, strlen(text), name, &e);
    if (!source || obj_read(&o, source, &e) || convex_of(&p, &o, .01, &e))
        ok(false, "%s: %s", name, e.text);
    in_close(source);
    obj_free(&o);
    return p;
}

static const char cube[] = "v -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                           "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
/* Its face is cut along an L, which is not convex; and one corner stands twice. */
static const char cut_cube[] =
    "v -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 1 0\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 4 3 2 1\nf 10 11 6 5 8 9\nf 9 12 11 10\nf 1 2 6 5\n"
    "f 2 3 7 11 6\nf 3 4 8 9 12\nf 4 1 5 8\n";
static const char wedge[] = "v 0 0 0\nv 4 0 -1\nv 0 3 -1\nv -2 -2 -1.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/* A ball of many facets, as OBJ text: rings of vertices on a sphere of 2, the polygons of its hull. */
static char *facets(void)
{
    enum { RINGS = 9, AROUND = 16 };
    static char text[60000];
    int n = snprintf(text, sizeof text, "v 0 0 0\nv 0 0 -4\n");
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < AROUND; j++) {
            double a = 3.14159265358979 * (i + 1) / (RINGS + 1), b = 6.28318530717959 * j / AROUND;
            n += snprintf(text + n, sizeof text - (size_t)n, "v %.17g %.17g %.17g\n", 2 * sin(a) * cos(b),
                          2 * sin(a) * sin(b), 2 * cos(a) - 2);
        }
    for (int j = 0; j < AROUND; j++) {
        int k = (j + 1) % AROUND;
        n += snprintf(text + n, sizeof text - (size_t)n, "f 1 %d %d\nf 2 %d %d\n", 3 + j, 3 + k,
                      3 + (RINGS - 1) * AROUND + k, 3 + (RINGS - 1) * AROUND + j);
        for (int i = 0; i + 1 < RINGS; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "f %d %d %d %d\n", 3 + i * AROUND + j,
                          3 + (i + 1) * AROUND + j, 3 + (i + 1) * AROUND + k, 3 + i * AROUND + k);
    }
    return text;
}

/* Half of the points about the surface, where the thin ones have few. */
static void any_about(const probe_placed *p, double x[3])
{
    any_near(p, x);
    if (any() < 0)
        return;
    probe_touch t = probe_at(p, x);
    double to = t.depth + .3 * p->shape.size * any();
    for (int a = 0; a < 3; a++)
        x[a] += to * t.way[a];
}

/* Whether libccd's own way leaves the ball in the probe, as it says itself. */
static bool refuted(const probe_placed *p, const double x[3], double ball, const probe_touch *t)
{
    double moved[3];
    probe_touch still;
    for (int a = 0; a < 3; a++)
        moved[a] = x[a] + t->depth * t->way[a];
    return narrow_at(p, moved, .999 * ball, NARROW_STARTS, &still);
}

/* Depths equal to libccd's, and so the ways where the depth is no tie: along the way
 * given, as deep as the depth says. */
static void test_narrow(const probe *p, const char *name)
{
    double worst = 0, way = 0, coarse = 0, ball = .02 * p->reach;
    int deep = 0, edges = 0, met_wrong = 0, differ = 0, wrong = 0;
    for (int i = 0; i < POINTS; i++) {
        pose at = any_pose();
        probe_placed placed = probe_place(p, &at);
        double x[3];
        any_about(&placed, x);
        probe_touch ours = probe_at(&placed, x), theirs;
        bool near = fabs(ours.depth + ball) < 1e-4 * p->reach;
        bool met = narrow_at(&placed, x, ball, NARROW_STARTS, &theirs);
        bool exact = p->kind != PROBE_CONVEX || ours.depth > 0;
        if (near || (!exact && ours.depth < 0))
            continue;
        met_wrong += met != (ours.depth > -ball);
        if (!met || ours.depth <= -ball)
            continue;
        if (theirs.depth < ours.depth + ball - 3e-5 * p->reach && refuted(&placed, x, ball, &theirs)) {
            wrong++;
            continue;
        }
        deep += ours.depth > 0;
        edges += ours.depth <= 0;
        worst = fmax(worst, fabs(ours.depth + ball - theirs.depth) / p->reach);
        double cosine = ours.way[0] * theirs.way[0] + ours.way[1] * theirs.way[1] + ours.way[2] * theirs.way[2];
        if (cosine < .9999) { /* as good a way as any, if it is as short */
            double moved[3];
            for (int a = 0; a < 3; a++)
                moved[a] = x[a] + (ours.depth + 1e-9 * p->reach) * ours.way[a];
            differ++;
            way = fmax(way, ours.depth > 0 ? fabs(probe_at(&placed, moved).depth) / p->reach : 0);
            coarse = fmax(coarse, ours.depth > 0 ? 0 : 1 - cosine); /* EPA's on a ball this small is no better */
        }
    }
    ok(met_wrong == 0, "%s: the same points as libccd, of %d (%d inside, %d in reach of a ball)", name, POINTS, deep,
       edges);
    ok(deep > 100 && worst < 3e-5 && wrong <= POINTS / 200,
       "%s: as deep, to %.2g of the reach (libccd denies its own answer %d times)", name, worst, wrong);
    ok(way < 1e-6 && coarse < .2, "%s: the same way, or one as short (%d): %.2g; outside %.2g", name, differ, way,
       coarse);
}

/* Anywhere: the way is of length 1; as far along it as the depth says is the surface; the depth changes along it as the
 * way does; and nothing is nearer. */
static void test_distance(const probe *p, const char *name)
{
    double length = 0, surface = 0, slope = 0, nearer = 0;
    for (int i = 0; i < 20 * POINTS; i++) {
        pose at = any_pose();
        probe_placed placed = probe_place(p, &at);
        double x[3], y[3], z[3];
        any_near(&placed, x);
        probe_touch t = probe_at(&placed, x);
        for (int a = 0; a < 3; a++) {
            y[a] = x[a] + t.depth * t.way[a];
            z[a] = x[a] + 1e-7 * p->reach * t.way[a];
        }
        length = fmax(length, fabs(t.way[0] * t.way[0] + t.way[1] * t.way[1] + t.way[2] * t.way[2] - 1));
        if (p->kind != PROBE_CONVEX || t.depth > 0)
            surface = fmax(surface, fabs(probe_at(&placed, y).depth) / p->reach);
        slope = fmax(slope, fabs((t.depth - probe_at(&placed, z).depth) / (1e-7 * p->reach) - 1));
        double step[3] = {any() * .3 * p->reach, any() * .3 * p->reach, any() * .3 * p->reach}, moved = 0;
        for (int a = 0; a < 3; a++) {
            z[a] = x[a] + step[a];
            moved += step[a] * step[a];
        }
        nearer = fmax(nearer, (fabs(t.depth - probe_at(&placed, z).depth) - sqrt(moved)) / p->reach);
    }
    ok(length < 1e-12, "%s: the way is a unit vector: %.2g", name, length);
    ok(surface < 1e-12, "%s: its end is on the surface: %.2g", name, surface);
    ok(slope < 1e-6, "%s: the depth falls along it: %.2g", name, slope);
    ok(nearer < 1e-12, "%s: nothing is nearer: %.2g", name, nearer);
}

/* What holds it, and what goes in. */
static void test_bounds(const probe *p, const char *name)
{
    int out_of_ball = 0;
    double deepest = 0, rim = 0;
    const pose at = {{0, 0, 0}, {0, 0, 0, 1}};
    const probe_placed placed = probe_place(p, &at);
    const double face[3] = {0, 0, 0};
    for (int i = 0; i < 50 * POINTS; i++) {
        double x[3], away = 0;
        any_near(&placed, x);
        for (int a = 0; a < 3; a++)
            away += (x[a] - placed.centre[a]) * (x[a] - placed.centre[a]);
        double depth = probe_at(&placed, x).depth;
        out_of_ball += depth > 0 && sqrt(away) > p->reach * (1 + 1e-12);
        deepest = fmax(deepest, depth);
        rim = depth > 0 ? fmax(rim, sqrt(away)) : rim;
    }
    ok(out_of_ball == 0 && rim > .9 * p->reach, "%s: its ball holds it, and is not much more: %.3g", name,
       rim / p->reach);
    ok(deepest < p->size * 1.6 && deepest > .5 * p->size, "%s: its size is that of a ball that goes in: %.3g", name,
       deepest / p->size);
    near_(probe_at(&placed, face).depth, 0, 1e-15, "%s: the middle of the face is the origin", name);
}

/* Where the ray from `from` along d meets a triangle, in lengths of d; below 0: nowhere. */
static double meet(const double from[3], const double d[3], const double *x, const double *y, const double *z)
{
    double u[3], v[3], w[3], n[3], uv[3];
    for (int a = 0; a < 3; a++)
        u[a] = y[a] - x[a], v[a] = z[a] - x[a], w[a] = from[a] - x[a];
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        n[a] = d[b] * v[c] - d[c] * v[b];
        uv[a] = w[b] * u[c] - w[c] * u[b];
    }
    const double whole = u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
    const double s = (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]) / whole;
    const double t = (d[0] * uv[0] + d[1] * uv[1] + d[2] * uv[2]) / whole;
    return s >= -1e-9 && t >= -1e-9 && s + t <= 1 + 1e-9 ? (v[0] * uv[0] + v[1] * uv[1] + v[2] * uv[2]) / whole : -1;
}

/* The triangles are its surface: every ray out of its middle meets one, at the surface, that is turned out. */
static void test_faces(const probe *p, const char *name)
{
    int missed = 0, turned = 0;
    double off = 0;
    for (int i = 0; i < POINTS / 4; i++) {
        const double d[3] = {any(), any(), any()};
        int met = 0;
        for (int32_t f = 0; f < p->faces; f++) {
            const int32_t *c = p->face + 3 * (int64_t)f;
            const double *x = p->corner + 3 * c[0], *y = p->corner + 3 * c[1], *z = p->corner + 3 * c[2];
            const double along = meet(p->middle, d, x, y, z);
            if (along < 0)
                continue;
            double at[3], facing = 0;
            for (int a = 0; a < 3; a++) {
                const int b = (a + 1) % 3, e = (a + 2) % 3;
                at[a] = p->middle[a] + along * d[a];
                facing += d[a] * ((y[b] - x[b]) * (z[e] - x[e]) - (y[e] - x[e]) * (z[b] - x[b]));
            }
            met++;
            turned += facing < 0;
            off = fmax(off, fabs(probe_at_own(p, at).depth) / p->reach);
        }
        missed += !met;
    }
    ok(p->faces >= 4 && !missed && !turned && off < 1e-6,
       "%s: %d triangles are its surface: %d rays miss, %d from behind, %.2g off", name, p->faces, missed, turned, off);
}

static void test_shape(const probe *p, const char *name)
{
    if (p->kind == PROBE_CONVEX)
        test_faces(p, name);
    test_narrow(p, name);
    test_distance(p, name);
    test_bounds(p, name);
}

static void test_text(const char *text)
{
    err e = {0};
    probe p;
    if (ok(!probe_of(&p, text, &e), "%s %s", text, e.text))
        test_shape(&p, text);
}

static void test_lines(void)
{
    static const struct {
        const char *text;
        int status;
    } bad[] = {{"box:1", STATUS_USAGE},
               {"linear:4cm", STATUS_USAGE},
               {"linear:4cm,0", STATUS_BAD},
               {"linear:4cm,-1cm", STATUS_BAD},
               {"linear:4cm,1cm,6mm", STATUS_BAD},
               {"linear:4cm,1cm,1mm,1mm", STATUS_USAGE},
               {"linear:nan,1cm", STATUS_USAGE},
               {"curved:6cm,60", STATUS_USAGE},
               {"curved:6cm,0,1cm", STATUS_BAD},
               {"curved:6cm,181,1cm", STATUS_BAD},
               {"curved:6cm,60mm,1cm", STATUS_BAD},
               {"curved:6cm,60,1cm,2cm", STATUS_BAD},
               {"curved:0,60,1cm", STATUS_BAD},
               {"convex:", STATUS_USAGE},
               {"linear:", STATUS_USAGE},
               {"linear:4cm,,1cm", STATUS_USAGE}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        err wrong = {0};
        probe none;
        ok(probe_of(&none, bad[i].text, &wrong) && wrong.status == bad[i].status && strstr(wrong.text, "expected"),
           "%s", wrong.text);
    }
    err e = {0};
    probe p;
    ok(!probe_of(&p, "linear:4cm,1cm", &e) && p.width == .04 && p.thickness == .01 && p.edge == .0025,
       "a linear array");
    ok(!probe_of(&p, "curved:6cm,90,14mm,3mm", &e) && p.radius == .06 && p.edge == .003, "a curved array");
    near_(p.angle, 1.5707963267948966, 1e-15, "its angle in radians");
    ok(!probe_of(&p, "linear:4cm,1cm,0", &e) && p.edge == 0, "sharp edges");
}

static void refuse(const char *text, const char *pattern)
{
    err e = {0};
    probe p = {.kind = PROBE_CONVEX};
    obj o = {0};
    in *source = in_memory(text, strlen(text), "bad.obj", &e);
    bool refused = source && !obj_read(&o, source, &e) && convex_of(&p, &o, 1, &e) && strstr(e.text, pattern);
    ok(refused && !strncmp(e.text, "bad.obj: ", 9), "%s", e.text);
    in_close(source);
    obj_free(&o);
    probe_free(&p);
}

static void test_refused(void)
{
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n", "3 faces");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\n", "4 open edges");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 2 3 4\n", "more than two faces");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nl 1 2\n", "a point or a line");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 3 4\nf 1 4 2\n", "flat");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv .2 .2 .2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n",
           "not convex");
    char two[sizeof wedge + 200];
    snprintf(two, sizeof two, "%sv 10 0 0\nv 14 0 -1\nv 10 3 -1\nv 8 -2 -1.5\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n",
             wedge);
    refuse(two, "not convex");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv .3 .3 .00001\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", "flat");
}

int main(void)
{
    probe p;
    test_text("sphere:2cm");
    test_text("linear:4cm,1cm");
    test_text("linear:4cm,1cm,5mm");
    test_text("linear:1cm,4cm,0");
    test_text("curved:6cm,60,14mm");
    test_text("curved:3cm,150,2cm,4mm");
    test_text("curved:5cm,180,3cm");
    test_text("curved:5cm,20,3mm,0");
    p = of_text(cube, "cube");
    ok(p.planes == 6 && p.corners == 8, "a cube has 6 planes");
    test_shape(&p, "cube");
    probe_free(&p);
    p = of_text(cut_cube, "cut cube");
    ok(p.planes == 6 && p.corners == 11, "a corner that stands twice is one: %d", p.corners);
    test_faces(&p, "cut cube");
    probe_free(&p);
    p = of_text(wedge, "wedge");
    test_shape(&p, "wedge");
    probe_free(&p);
    p = of_text(facets(), "facets");
    test_shape(&p, "facets");
    probe_free(&p);
    test_lines();
    test_refused();
    return done_testing();
}
