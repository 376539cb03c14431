/* The skin: a sheet that a ball dents and that comes back to its place without oscillating; a uniform push against a
 * solution in closed form; normals; the same bytes for any count of threads; what is no skin. */
// needs: msds/run/skin.c
#include "skin_sheet.h"

#include "tap.h"

/* How many vertices touch the probe, to a thousandth of its size. */
static int64_t touched(const skin *s, const probe_placed *at)
{
    int64_t count = 0;
    for (int64_t v = 0; v < s->vertices; v++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = s->position[3 * v + a] + s->u[3 * v + a];
        count += probe_at(at, x).depth > -1e-3 * at->shape.size;
    }
    return count;
}

static probe_placed press_at(const probe *p, double x, double y, double z)
{
    const pose at = {{x, y, z}, {1, 0, 0, 0}};
    return probe_place(p, &at);
}

/* Down by 3 cm, held, and gone: no vertex goes beyond its place, none comes closer
 * and then leaves, and all come back. */
static void test_recovers(const probe *p, double swell, double anchors, const char *name)
{
    model m = {0};
    skin s = {.vertices = 0};
    skin_options o = sheet_options();
    o.anchors = anchors;
    sheet_add(&m, swell);
    sheet_make(&s, &m, &o, 2);
    ok(s.vertices == SHEET_SIDE * SHEET_SIDE &&
           s.edges == 2 * SHEET_SIDE * (SHEET_SIDE - 1) + (SHEET_SIDE - 1) * (SHEET_SIDE - 1) && s.oscillates >= 1,
       "%lld vertices, %lld springs, %.3g times critical damping at least", (long long)s.vertices, (long long)s.edges,
       s.oscillates);
    for (int t = 0; t <= 90; t++) {
        probe_placed at = press_at(p, .09 + .0003 * t, .1, .002 - .03 * fmin(1, t / 60.));
        sheet_step(&s, &at, 20);
        if (t == 90)
            ok(skin_largest(&s) > .02 && touched(&s, &at) > 5, "%s: pressed %.3g mm, %lld vertices touch", name,
               1e3 * skin_largest(&s), (long long)touched(&s, &at));
    }
    double dent = skin_largest(&s), beyond = 0, rise = 0, energy = INFINITY, high = 0;
    for (int64_t v = 0; v < s.vertices; v++)
        high = fmax(high, s.u[3 * v + 2]);
    int frames = 0;
    for (; frames < 2000 && skin_largest(&s) > .2 * 1e-5; frames++) {
        double now = 0;
        sheet_step(&s, NULL, 20);
        for (int64_t v = 0; v < 3 * s.vertices; v++)
            now += s.u[v] * s.u[v];
        for (int64_t v = 0; v < s.vertices; v++)
            beyond = fmax(beyond, (s.u[3 * v + 2] - high) / dent);
        rise = fmax(rise, now / energy - 1);
        energy = now;
    }
    double left = skin_largest(&s) / .2;
    ok(left < 1e-4, "%s: back to %.2g of its size in %d frames", name, left, frames);
    ok(beyond < .01 && rise <= 0,
       "%s: nothing oscillates: at most %.2g of the dent higher than when it let go, the whole never grows (%.2g)",
       name, beyond, rise);
    sheet_done(&s);
    model_free(&m);
}

/* The same speed everywhere stretches no spring: m v' = -a u - gamma v, by the steps' own recurrence. */
static void test_anchor(void)
{
    model m = {0};
    skin s = {.vertices = 0};
    skin_options o = sheet_options();
    sheet_add(&m, 0);
    sheet_make(&s, &m, &o, 1);
    double u = .01, v = 0, worst = 0;
    int64_t middle = SHEET_SIDE * (SHEET_SIDE / 2) + SHEET_SIDE / 2;
    for (int64_t i = 0; i < s.vertices; i++)
        s.u[3 * i] = u;
    for (int step = 0; step < 100; step++) {
        /* Vertices of other valences go at other speeds: look at the middle before it hears of them. */
        v += o.dt / s.inertia[middle] * (-s.anchor[middle] * u - s.held[middle] * v);
        u += o.dt * v;
        sheet_step(&s, NULL, 1);
        if (step < SHEET_SIDE / 2)
            worst = fmax(worst, fabs(s.u[3 * middle] - u));
    }
    ok(worst < 1e-15, "an anchor pulls with -k x - gamma v: off by %.2g m", worst);
    near_(s.anchor[middle], .1 * 6 * 100, 1e-12, "an anchor is as stiff as asked");
    sheet_done(&s);
    model_free(&m);
}

static void test_normals(void)
{
    model m = {0};
    skin s = {.vertices = 0};
    skin_options o = sheet_options();
    sheet_add(&m, 0);
    sheet_make(&s, &m, &o, 1);
    double *n = calloc((size_t)s.vertices, 3 * sizeof *n), worst = 0;
    for (int64_t v = 0; v < s.vertices; v++)
        s.u[3 * v + 2] = .5 * s.position[3 * v];
    skin_normals(&s, n);
    for (int64_t v = 0; n && v < s.vertices; v++)
        worst =
            fmax(worst, fabs(n[3 * v] + .5 / sqrt(1.25)) + fabs(n[3 * v + 1]) + fabs(n[3 * v + 2] - 1 / sqrt(1.25)));
    ok(n && worst < 1e-12, "normals of a sheet that is tilted: off by %.2g", worst);
    free(n);
    sheet_done(&s);
    model_free(&m);
}

static void test_threads(void)
{
    model m = {0};
    double *kept = NULL;
    bool same = true;
    const probe p = probe_sphere(.03);
    sheet_add(&m, .005);
    for (int threads = 1; threads <= 3; threads++) {
        skin s = {.vertices = 0};
        skin_options o = sheet_options();
        sheet_make(&s, &m, &o, threads);
        for (int t = 0; t < 20; t++) {
            probe_placed at = press_at(&p, .1, .1, .001 - .001 * t);
            sheet_step(&s, &at, 20);
        }
        if (!kept) {
            kept = s.u;
            s.u = NULL;
        } else {
            same = same && !memcmp(kept, s.u, 3 * (size_t)s.vertices * sizeof *kept);
        }
        sheet_done(&s);
    }
    ok(same, "the same bytes by 1, 2 and 3 threads");
    free(kept);
    model_free(&m);
}

static void test_bad(void)
{
    static const char *const text[] = {"v 0 0 0\nv 1 0 0\nl 1 2\n", "v 0 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 3\n"};
    static const char *const want[] = {"no polygons", "at one place"};
    for (int i = 0; i < 2; i++) {
        model m = {0};
        skin s = {.vertices = 0};
        skin_options o = sheet_options();
        surface shape;
        err e = {0};
        obj file = {0};
        in *source = in_memory(text[i], strlen(text[i]), "bad.obj", &e);
        sheet_must(source && !obj_read(&file, source, &e) && !surface_add(&m, "sheet", &file, 1, &e) &&
                       !surface_of(&m, "sheet", &shape, &e),
                   &e);
        ok(skin_make(&s, &shape, &o, NULL, &e) && strstr(e.text, want[i]), "%s", e.text);
        skin_free(&s);
        in_close(source);
        obj_free(&file);
        model_free(&m);
    }
}

int main(void)
{
    const probe ball = probe_sphere(.03), linear = probe_linear(.04, .01, .0025);
    test_recovers(&ball, 0, .1, "a flat sheet and a ball");
    test_recovers(&ball, .008, .1, "a swell and a ball");
    test_recovers(&linear, .008, .01, "a swell, soft anchors and a linear array");
    test_recovers(&ball, .008, 2, "stiff anchors");
    test_anchor();
    test_normals();
    test_threads();
    test_bad();
    return done_testing();
}
