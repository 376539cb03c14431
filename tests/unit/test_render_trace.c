/* Pictures of what is known: a ball, planes, a grid, a corner. */
#include "base/mem.h"
#include "render/trace.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static const double up[3] = {0, 0, 1}, front[3] = {0, -1, 0};

typedef struct quad {
    float at[4][3];
} quad;

static float *copy(const void *from, size_t size)
{
    float *to = malloc(size);
    if (!to)
        abort();
    memcpy(to, from, size);
    return to;
}

/* Quads of their own corners. turned: wound the other way round. */
static void add_quads(scene *s, const quad *q, int64_t count, scene_mesh like, bool turned)
{
    err e = {0};
    like.corners = 4;
    like.vertices = 4 * count;
    like.faces = count;
    like.position = copy(q, (size_t)count * sizeof *q);
    like.corner = malloc((size_t)count * 4 * sizeof *like.corner);
    if (!like.corner)
        abort();
    for (int64_t i = 0; i < 4 * count; i++)
        like.corner[i] = (uint32_t)(turned ? i / 4 * 4 + 3 - i % 4 : i);
    if (scene_add_mesh(s, &like, &e))
        abort();
}

static void add_ball(scene *s, float x, float y, float z, float radius)
{
    err e = {0};
    scene_spheres b = {.count = 1, .colour = {.6f, .6f, .6f}};
    b.centre_radius = copy((float[4]){x, y, z, radius}, 4 * sizeof(float));
    if (scene_add_spheres(s, &b, &e))
        abort();
}

static camera fitted(const scene *s, const char *view, int width, int height, double angle)
{
    err e = {0};
    camera c = {0};
    if (camera_view(&c, view, up, front, &e) || camera_fit_scene(&c, s, width, height, angle, .05, &e)) {
        printf("# %s\n", e.text);
        abort();
    }
    return c;
}

static image drawn(const scene *s, const camera *c, int width, int height, const trace_options *o, int threads,
                   trace_report *r)
{
    err e = {0};
    image im = {0};
    pool *p = pool_create(threads, &e);
    if (!p || image_create(&im, width, height, &e) || trace(s, c, &im, p, o, r, &e)) {
        printf("# %s\n", e.text);
        abort();
    }
    pool_destroy(p);
    return im;
}

static bool same(const image *a, const image *b)
{
    return !memcmp(a->pixel, b->pixel, (size_t)a->width * (size_t)a->height * 4 * sizeof(float));
}

static const float *at(const image *im, int x, int y)
{
    return &im->pixel[4 * (y * im->width + x)];
}

/* ---- */

static void test_ball(void)
{
    scene s = {0};
    add_ball(&s, .3f, -.2f, .1f, .05f);
    trace_options o = trace_defaults();
    memset(o.background, 0, sizeof o.background);
    for (int i = 0; i < 2; i++) {
        camera c = fitted(&s, "three-quarter", 200, 120, i ? 30 : 0);
        trace_report r;
        image im = drawn(&s, &c, 200, 120, &o, 2, &r);
        double area = 0, radius = 54; /* 60 less the margin */
        for (int k = 0; k < 200 * 120; k++)
            area += (double)im.pixel[4 * k + 3];
        near_(area, 3.14159265 * radius * radius, 12, "a ball covers pi r^2 pixels (%s)",
              i ? "perspective" : "orthographic");
        near_((double)r.covered, area, 200, "and the report says about as many");
        ok(at(&im, 0, 0)[3] == 0 && at(&im, 100, 60)[3] == 1, "outside it all is transparent, inside opaque");
        ok(at(&im, 85, 42)[0] > at(&im, 115, 78)[0], "the light comes from the upper left");
        image_free(&im);
    }
    scene_free(&s);
}

/* A ball of quads, by latitude and longitude. */
static void add_globe(scene *s, double crease)
{
    enum { ROWS = 24, COLUMNS = 48 };
    err e = {0};
    scene_mesh m = {.corners = 4, .vertices = (ROWS + 1) * COLUMNS, .faces = ROWS * COLUMNS, .colour = {.6f, .6f, .6f}};
    m.position = malloc(sizeof(float) * 3 * (ROWS + 1) * COLUMNS);
    m.corner = malloc(sizeof(uint32_t) * 4 * ROWS * COLUMNS);
    if (!m.position || !m.corner)
        abort();
    for (int i = 0; i <= ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double a = 3.14159265 * i / ROWS, b = 2 * 3.14159265 * j / COLUMNS;
            float *p = m.position + 3 * (i * COLUMNS + j);
            p[0] = (float)(sin(a) * cos(b));
            p[1] = (float)(sin(a) * sin(b));
            p[2] = (float)cos(a);
        }
    for (int f = 0; f < ROWS * COLUMNS; f++) {
        int i = f / COLUMNS, j = f % COLUMNS, k = (j + 1) % COLUMNS;
        int of[4] = {i * COLUMNS + j, (i + 1) * COLUMNS + j, (i + 1) * COLUMNS + k, i * COLUMNS + k};
        for (int n = 0; n < 4; n++) /* every third face is inside out */
            m.corner[4 * f + n] = (uint32_t)of[f % 3 ? n : 3 - n];
    }
    if (scene_smooth(&m, crease, &e) || scene_add_mesh(s, &m, &e))
        abort();
}

static void test_smooth(void)
{
    scene s = {0};
    add_globe(&s, 40);
    const scene_mesh *m = &s.mesh[0];
    double least = 1;
    for (int64_t c = 4 * 48 * 3; c < 4 * 48 * 21; c++) {
        const float *n = &m->normal[3 * c], *p = &m->position[3 * (int64_t)m->corner[c]];
        least = fmin(least, fabs((double)(n[0] * p[0] + n[1] * p[1] + n[2] * p[2])));
    }
    near_(least, 1, 1e-3, "smooth normals of a globe point from its centre, inside-out faces or not");
    trace_options o = trace_defaults();
    camera c = fitted(&s, "front", 160, 160, 0);
    image globe = drawn(&s, &c, 160, 160, &o, 2, NULL);
    scene t = {0};
    add_ball(&t, 0, 0, 0, 1);
    image ball = drawn(&t, &c, 160, 160, &o, 2, NULL);
    double worst = 0;
    for (int y = 40; y < 120; y++)
        for (int x = 40; x < 120; x++)
            worst = fmax(worst, fabs((double)(at(&globe, x, y)[0] - at(&ball, x, y)[0])));
    near_(worst, 0, .03, "and it is shaded as a ball is");
    image_free(&globe);
    image_free(&ball);
    scene_free(&s);
    scene_free(&t);
}

static const quad cube[6] = {
    {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}}, {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
    {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}}, {{{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}}},
    {{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}}, {{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}},
};

static void test_crease(void)
{
    err e = {0};
    scene_mesh m = {.corners = 4, .vertices = 8, .faces = 6};
    scene_mesh own = m;
    m.position = malloc(8 * 3 * sizeof(float));
    m.corner = malloc(24 * sizeof(uint32_t));
    if (!m.position || !m.corner)
        abort();
    for (int v = 0; v < 24; v++)
        m.position[v] = (float)(v / 3 >> v % 3 & 1);
    for (int c = 0; c < 24; c++) {
        const float *p = cube[c / 4].at[c % 4];
        m.corner[c] = (uint32_t)((int)p[0] + 2 * (int)p[1] + 4 * (int)p[2]);
    }
    bool flat = !scene_smooth(&m, 40, &e);
    for (int c = 0; c < 24 && flat; c++)
        flat = fabsf(fabsf(m.normal[3 * c + 2 - c / 8]) - 1) < 1e-6f;
    ok(flat, "a cube keeps its edges");
    scene_mesh_free(&m);
    scene_mesh_free(&own);
}

static void test_same(void)
{
    scene s = {0}, turned = {0};
    uint8_t edges[6];
    memset(edges, 15, sizeof edges);
    scene_mesh like = {.colour = {.5f, .4f, .3f}};
    like.edges = (uint8_t *)copy(edges, sizeof edges);
    add_quads(&s, cube, 6, like, false);
    like.edges = NULL;
    add_quads(&turned, cube, 6, like, true);
    add_ball(&s, 1.2f, -.3f, .5f, .3f);
    add_globe(&s, 20);
    trace_options o = trace_defaults();
    o.shadows = true;
    camera c = fitted(&s, "three-quarter", 301, 203, 25);
    trace_report r1, r5;
    image one = drawn(&s, &c, 301, 203, &o, 1, &r1), five = drawn(&s, &c, 301, 203, &o, 5, &r5);
    ok(same(&one, &five), "the same bytes from one thread and from five");
    ok(r1.rays == r5.rays && r1.covered == r5.covered && r1.faces == 6 + 24 * 48 && r1.spheres == 1,
       "and the same report");
    image_free(&one);
    image_free(&five);
    scene plain = {0};
    add_quads(&plain, cube, 6, like, false);
    camera d = fitted(&plain, "three-quarter", 120, 100, 25);
    one = drawn(&plain, &d, 120, 100, &o, 2, NULL);
    five = drawn(&turned, &d, 120, 100, &o, 2, NULL);
    double worst = 0;
    for (int i = 0; i < 4 * 120 * 100; i++)
        worst = fmax(worst, fabs((double)(one.pixel[i] - five.pixel[i])));
    near_(worst, 0, .02, "faces wound the other way round look the same");
    image_free(&one);
    image_free(&five);
    scene_free(&s);
    scene_free(&turned);
    scene_free(&plain);
}

/* ---- light, lines, veils */

static void test_light(void)
{
    /* A floor and a wall, seen from above and before. */
    const quad floor_ = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
    const quad wall = {{{-1, 1, 0}, {1, 1, 0}, {1, 1, 1}, {-1, 1, 1}}};
    scene s = {0};
    scene_mesh like = {.colour = {.5f, .5f, .5f}};
    add_quads(&s, &floor_, 1, like, false);
    trace_options o = trace_defaults();
    camera c = fitted(&s, "top", 100, 100, 0);
    image im = drawn(&s, &c, 100, 100, &o, 2, NULL);
    bool even = true;
    for (int y = 10; y < 90; y++)
        for (int x = 10; x < 90; x++)
            even = even && fabsf(at(&im, x, y)[0] - at(&im, 50, 50)[0]) < 1e-5f;
    ok(even, "an open floor is lit evenly: it does not shadow itself");
    float open = at(&im, 50, 14)[0];
    image_free(&im);
    add_quads(&s, &wall, 1, like, false);
    im = drawn(&s, &c, 100, 100, &o, 2, NULL);
    int dim = 50, x = 50;
    for (int y = 0; y < 100; y++) /* the row of the floor at the wall's foot: the darkest */
        dim = at(&im, x, y)[0] < at(&im, x, dim)[0] ? y : dim;
    ok(at(&im, x, dim)[0] < .9f * open, "a floor is darker at the foot of a wall");
    image_free(&im);
    o.occlusion = 0;
    im = drawn(&s, &c, 100, 100, &o, 2, NULL);
    near_((double)at(&im, x, dim)[0], (double)at(&im, 50, 50)[0], 1e-5, "without occlusion it is not");
    image_free(&im);
    scene_free(&s);
}

/* One slanting square, as one quad and as many: of the two the later is seen, all over. */
static void test_one_plane(void)
{
    enum { N = 7 };
    quad part[N * N] = {0}, whole = {0};
    for (int i = 0; i <= N * N; i++)
        for (int k = 0; k < 4; k++) {
            float side = i < N * N ? 1.f / N : 1, x = i < N * N ? side * (float)(i % N) : 0;
            float y = i < N * N ? side * (float)(i / N) : 0;
            float *at = i < N * N ? part[i].at[k] : whole.at[k];
            x += k == 1 || k == 2 ? side : 0;
            y += k >= 2 ? side : 0;
            at[0] = .1f + .09f * x - .013f * y;
            at[1] = .07f * x + .1f * y;
            at[2] = .31f * y - .11f * x;
        }
    for (int which = 0; which < 4; which++) {
        scene s = {0};
        bool whole_last = which & 1;
        add_quads(&s, whole_last ? part : &whole, whole_last ? N * N : 1, (scene_mesh){.colour = {1, 0, 0}}, false);
        add_quads(&s, whole_last ? &whole : part, whole_last ? 1 : N * N, (scene_mesh){.colour = {0, 0, 1}}, false);
        trace_options o = trace_defaults();
        camera c = fitted(&s, "three-quarter", 160, 120, which & 2 ? 20 : 0);
        image im = drawn(&s, &c, 160, 120, &o, 2, NULL);
        int red = 0, blue = 0;
        for (int i = 0; i < 160 * 120; i++) {
            red += im.pixel[4 * i + 1] < .5f && im.pixel[4 * i] > im.pixel[4 * i + 1] + .05f;
            blue += im.pixel[4 * i + 1] < .5f && im.pixel[4 * i + 2] > im.pixel[4 * i + 1] + .05f;
        }
        ok(blue > 1000 && red == 0, "two meshes in one plane, %s, %s: %d of the later, %d of the other",
           which & 2 ? "perspective" : "parallel", whole_last ? "the whole last" : "the parts last", blue, red);
        image_free(&im);
        scene_free(&s);
    }
}

static void test_shadow(void)
{
    const quad floor_ = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
    scene s = {0};
    scene_mesh like = {.colour = {.5f, .5f, .5f}};
    add_quads(&s, &floor_, 1, like, false);
    add_ball(&s, 0, 0, .5f, .2f);
    trace_options o = trace_defaults();
    o.occlusion = 0;
    camera c = fitted(&s, "top", 200, 200, 0);
    image without = drawn(&s, &c, 200, 200, &o, 2, NULL);
    o.shadows = true;
    image with = drawn(&s, &c, 200, 200, &o, 2, NULL);
    int darker = 0, lower_right = 0;
    for (int y = 0; y < 200; y++)
        for (int x = 0; x < 200; x++)
            if (at(&with, x, y)[0] < .8f * at(&without, x, y)[0]) {
                darker++;
                lower_right += x > 100 && y > 100;
            }
    /* A ball of 18 pixels' radius and a light 45 degrees off: an ellipse of some 1400 pixels, in part behind it. */
    ok(darker > 600 && darker < 2500, "a ball casts a shadow (%d pixels)", darker);
    ok(lower_right > .9 * darker, "away from the light");
    image_free(&with);
    image_free(&without);
    scene_free(&s);
}

static void test_lines(void)
{
    const quad pair[2] = {{{{0, 0, 0}, {0, 0, 1}, {-1, 0, 1}, {-1, 0, 0}}},
                          {{{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {1, 0, 1}}}};
    const uint8_t edges[2] = {1, 1};
    scene s = {0};
    scene_mesh like = {.colour = {.5f, .5f, .5f}};
    like.edges = (uint8_t *)copy(edges, sizeof edges);
    add_quads(&s, pair, 2, like, false);
    trace_options o = trace_defaults();
    for (int i = 0; i < 2; i++) {
        o.edge_width = i ? 3 : 1.1;
        camera c = fitted(&s, "front", 230 + i, 130, 0);
        image im = drawn(&s, &c, 230 + i, 130, &o, 2, NULL);
        double plain = (double)at(&im, 60, 60)[0], dark = 0;
        for (int x = 100; x < 130; x++)
            dark += 1 - (double)at(&im, x, 60)[0] / plain;
        near_(dark, o.edge_width, .15, "the line between two faces is %g pixels wide", o.edge_width);
        near_((double)at(&im, 160, 60)[0], plain, 1e-5, "and there is none where none is asked for");
        image_free(&im);
    }
    scene_free(&s);
}

static void test_veil(void)
{
    const quad pane = {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}};
    scene s = {0};
    scene_mesh like = {.colour = {.2f, .2f, .2f}, .transparency = .75f};
    add_quads(&s, &pane, 1, like, false);
    trace_options o = trace_defaults();
    memset(o.background, 0, sizeof o.background);
    camera c = fitted(&s, "front", 100, 100, 20);
    image im = drawn(&s, &c, 100, 100, &o, 2, NULL);
    near_((double)at(&im, 50, 50)[3], .25, 1e-5, "a transparent pane lets its share through");
    image_free(&im);
    add_ball(&s, 0, 1, 0, .5f);
    im = drawn(&s, &c, 100, 100, &o, 2, NULL);
    ok(at(&im, 50, 50)[3] == 1 && at(&im, 10, 10)[3] < .3f, "and a ball behind it is seen");
    image_free(&im);
    scene_free(&s);
}

/* ---- cameras */

static void test_fit(void)
{
    static const char *const view[] = {"front", "back", "left", "right", "top", "bottom", "three-quarter"};
    const quad odd[2] = {{{{5, 2, 1}, {5.1f, 2, 1}, {5.1f, 2.3f, 1.7f}, {5, 2.3f, 1.7f}}},
                         {{{5.4f, 2, 1}, {5.5f, 2.6f, 1}, {5.1f, 2.3f, 1.1f}, {5, 2.1f, 1.2f}}}};
    scene s = {0};
    add_quads(&s, odd, 2, (scene_mesh){0}, false);
    const int sizes[2][2] = {{320, 200}, {90, 250}};
    for (int k = 0; k < 7 * 2 * 3; k++) {
        int width = sizes[k % 2][0], height = sizes[k % 2][1], angle = k / 2 % 3 * 40;
        camera c = fitted(&s, view[k / 6], width, height, angle);
        double least[2] = {1e9, 1e9}, most[2] = {-1e9, -1e9}, margin = .05 * (width < height ? width : height);
        bool before = true;
        for (int i = 0; i < 8; i++) {
            const float *f = s.mesh[0].position + 3 * i;
            const double p[3] = {(double)f[0], (double)f[1], (double)f[2]};
            double q[2];
            before = before && camera_project(&c, width, height, p, q);
            for (int j = 0; before && j < 2; j++) {
                least[j] = fmin(least[j], q[j]);
                most[j] = fmax(most[j], q[j]);
            }
        }
        bool inside = before && least[0] > margin - .01 && least[1] > margin - .01 && most[0] < width - margin + .01 &&
                      most[1] < height - margin + .01;
        double slack = fmin(least[0] - margin, least[1] - margin);
        ok(inside && slack < .01, "%s, %d x %d, %d degrees: all is seen, and as large as can be", view[k / 6], width,
           height, angle);
    }
    camera c = fitted(&s, "left", 100, 100, 0);
    ok(c.forward[0] < -.99, "the left of one that looks to -y with z up is +x");
    c = fitted(&s, "three-quarter", 100, 100, 0);
    ok(c.forward[0] < -.3 && c.forward[1] > .3 && c.forward[2] < -.1, "three-quarter: from before, its left and above");
    scene_free(&s);
}

static void test_cameras_refused(void)
{
    camera c = {0};
    double axis[3];
    err e = {0}, f = {0}, g = {0}, h = {0}, i = {0}, j = {0};
    ok(camera_view(&c, "fromt", up, front, &e) && strstr(e.text, "front") && strstr(e.text, "three-quarter"),
       "an unknown view: %s", e.text);
    ok(camera_view(&c, "front", up, up, &f) && strstr(f.text, "one line"), "up that is front: %s", f.text);
    ok(camera_look(&c, up, up, front, false, 30, &g) && strstr(g.text, "one place"), "eye at the target: %s", g.text);
    ok(camera_look(&c, up, (double[3]){0, 0, 0}, up, false, 30, &h) && strstr(h.text, "along the view"), "up: %s",
       h.text);
    ok(camera_look(&c, up, front, up, false, 180, &i) && strstr(i.text, "degrees"), "angle: %s", i.text);
    ok(camera_axis("w", axis, &j) && strstr(j.text, "x, y or z"), "axis: %s", j.text);
    ok(!camera_axis("-y", axis, &j) && axis[0] == 0 && axis[1] == -1 && axis[2] == 0, "-y is an axis");
    scene s = {0};
    err k = {0}, l = {0};
    ok(camera_fit_scene(&c, &s, 10, 10, 0, 0, &k) && strstr(k.text, "nothing to be seen"), "empty: %s", k.text);
    ok(camera_fit_scene(&c, &s, 0, 10, 0, 0, &l) && strstr(l.text, "0 x 10"), "size: %s", l.text);
}

/* ---- scenes and pictures that are none */

static int traced(const scene *s, const camera *c, err *e)
{
    image im = {0};
    pool *p = pool_create(1, e);
    trace_options o = trace_defaults();
    int status = !p || image_create(&im, 20, 10, e) ? -1 : trace(s, c, &im, p, &o, NULL, e);
    image_free(&im);
    pool_destroy(p);
    return status;
}

static void test_refused(void)
{
    scene s = {0};
    add_quads(&s, cube, 6, (scene_mesh){0}, false);
    camera c = fitted(&s, "front", 20, 10, 0);
    err e = {0}, f = {0}, g = {0}, h = {0};
    s.mesh[0].corner[5] = 24;
    ok(traced(&s, &c, &e) && strstr(e.text, "vertex 24 of 24"), "an index too large: %s", e.text);
    s.mesh[0].corner[5] = 5;
    s.mesh[0].position[7] = NAN;
    ok(traced(&s, &c, &f) && strstr(f.text, "coordinate 7"), "a coordinate that is no number: %s", f.text);
    s.mesh[0].position[7] = 0;
    c.eye[0] = NAN;
    ok(traced(&s, &c, &g) && strstr(g.text, "camera"), "a camera that is nowhere: %s", g.text);
    image im = {0};
    ok(image_create(&im, 100000, 1, &h) && strstr(h.text, "100000 x 1"), "a picture too wide: %s", h.text);
    scene_free(&s);
}

static void test_empty(void)
{
    scene s = {0};
    camera c = {.half_height = 1, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, -1}};
    trace_options o = trace_defaults();
    o.background[0] = .25f;
    trace_report r;
    image im = drawn(&s, &c, 30, 20, &o, 2, &r);
    bool all = true;
    for (int i = 0; i < 600; i++)
        all = all && !memcmp(&im.pixel[4 * i], o.background, sizeof o.background);
    ok(all && r.covered == 0, "an empty scene is the background alone, and says so");
    image_free(&im);
    /* Faces without area, and none in sight. */
    const quad line = {{{0, 0, -5}, {1, 0, -5}, {1, 0, -5}, {0, 0, -5}}};
    add_quads(&s, &line, 1, (scene_mesh){0}, false);
    add_ball(&s, 0, 0, 9, 1);
    im = drawn(&s, &c, 30, 20, &o, 2, &r);
    ok(r.covered == 0 && !memcmp(at(&im, 15, 10), o.background, sizeof o.background),
       "faces without area and a ball behind the eye are not seen");
    image_free(&im);
    scene_free(&s);
}

static void test_bytes(void)
{
    err e = {0};
    image im = {0}, small = {0};
    pool *p = pool_create(2, &e);
    uint8_t out[256 * 4], back[256 * 4];
    if (!p || image_create(&im, 256, 1, &e) || image_create(&small, 2, 2, &e))
        abort();
    for (int i = 0; i < 256; i++) {
        const uint8_t c[3] = {(uint8_t)i, (uint8_t)(255 - i), 128};
        image_linear(c, &im.pixel[4 * i]);
        im.pixel[4 * i + 3] = 1;
        memcpy(&back[3 * i], c, 3);
    }
    image_bytes(&im, 3, out, p);
    ok(!memcmp(out, back, 256 * 3), "sRGB to linear and back is the same, for every code");
    for (int i = 0; i < 4; i++)
        im.pixel[i] *= .5f;
    image_bytes(&im, 4, out, p);
    ok(out[0] == 0 && out[1] == 255 && out[2] == 128 && out[3] == 128, "alpha is taken out of the colours");
    image_fill(&small, (float[4]){.5f, 0, 0, .5f});
    image_over(&im, &small, -1, 0);
    image_over(&im, &small, 300, 0);
    near_((double)im.pixel[1], .25, 1e-6, "one picture over another: half of the red over half of what was there");
    near_((double)im.pixel[3], .75, 1e-6, "and its alpha");
    image_free(&im);
    image_free(&small);
    pool_destroy(p);
}

int main(void)
{
    test_ball();
    test_smooth();
    test_crease();
    test_same();
    test_light();
    test_one_plane();
    test_shadow();
    test_lines();
    test_veil();
    test_fit();
    test_cameras_refused();
    test_refused();
    test_empty();
    test_bytes();
    return done_testing();
}
