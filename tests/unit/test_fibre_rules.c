/* The rules that give fibres, against shapes made from equations: a ring, its halves, a cylinder, a fan; with their
 * surfaces in the model, and without; and directions between drawn lines.
 */
// needs: attach/muscle.c attach/muscle_fibres.c attach/attachment.c attach/fibre_rule.c attach/fibre_field.c
// needs: attach/shape/laplace.c attach/shape/ring.c
// needs: attach/muscle_shape.c attach/muscle_surface.c attach/shape/line_field.c
#include "attach/muscle.h"
#include "attach/shape/line_field.h"
#include "surface/surface.h"

#include "block.h"
#include "muscles_made.h"

#include <stdlib.h>

/* A solid, in its own axes: u runs round or along it. Its surface has rings of corners, `round` of them across. */
typedef struct solid {
    double turn[3][3]; /* its axes, as rows */
    double middle[3];
    bool (*holds)(const double *x);                         /* in its axes, m */
    void (*corner)(double along, double across, double *x); /* 0 to 1 along it, and round its section */
    void (*tangent)(const double *x, double *t);
    bool closed;  /* its end is its beginning */
    double until; /* m: along its first axis, as far as fibres are compared; 0: all are */
} solid;

enum { ALONG = 48, ACROSS = 24 };

static const double pi = 3.14159265358979323846;

static bool ring_holds(const double *x)
{
    double r = sqrt(x[0] * x[0] + x[1] * x[1]) - .03;
    return r * r + x[2] * x[2] < .01 * .01;
}

static void ring_corner(double along, double across, double *x)
{
    double r = .03 + .01 * cos(2 * pi * across);
    x[0] = r * cos(2 * pi * along), x[1] = r * sin(2 * pi * along), x[2] = .01 * sin(2 * pi * across);
}

static void ring_tangent(const double *x, double *t)
{
    t[0] = -x[1], t[1] = x[0], t[2] = 0;
}

static bool half_holds(const double *x)
{
    return x[1] > 0 && ring_holds(x);
}

static void half_corner(double along, double across, double *x)
{
    ring_corner(along / 2, across, x);
}

static bool cylinder_holds(const double *x)
{
    return fabs(x[0]) < .03 && x[1] * x[1] + x[2] * x[2] < .007 * .007;
}

static void cylinder_corner(double along, double across, double *x)
{
    x[0] = -.03 + .06 * along, x[1] = .007 * cos(2 * pi * across), x[2] = .007 * sin(2 * pi * across);
}

static void cylinder_tangent(const double *x, double *t)
{
    (void)x;
    t[0] = 1, t[1] = t[2] = 0;
}

/* A sector of a ring plate, 30 degrees wide, from 15 to 55 mm: its fibres are radial. */
static bool fan_holds(const double *x)
{
    double r = sqrt(pow(x[0] + .035, 2) + x[1] * x[1]);
    return r > .015 && r < .055 && fabs(atan2(x[1], x[0] + .035)) < 15 * pi / 180 && fabs(x[2]) < .004;
}

static void fan_corner(double along, double across, double *x)
{
    static const double y[] = {-1, 1, 1, -1}, z[] = {-1, -1, 1, 1};
    double at = 4 * across, part = at - floor(at), r = .015 + .04 * along;
    int from = (int)at % 4, to = (from + 1) % 4;
    double angle = (y[from] + part * (y[to] - y[from])) * 15 * pi / 180;
    x[0] = r * cos(angle) - .035, x[1] = r * sin(angle), x[2] = .004 * (z[from] + part * (z[to] - z[from]));
}

static void fan_tangent(const double *x, double *t)
{
    t[0] = x[0] + .035, t[1] = x[1], t[2] = 0;
}

/* ---- models */

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void to_world(const solid *s, const double *x, double *world)
{
    for (int a = 0; a < 3; a++)
        world[a] = s->middle[a] + x[0] * s->turn[0][a] + x[1] * s->turn[1][a] + x[2] * s->turn[2][a];
}

static void to_own(const solid *s, const double *world, double *x)
{
    double d[3] = {world[0] - s->middle[0], world[1] - s->middle[1], world[2] - s->middle[2]};
    for (int k = 0; k < 3; k++)
        x[k] = dot(s->turn[k], d);
}

static solid turned(solid s)
{
    const double u[3][3] = {{.8, .6, 0}, {-.48, .64, .6}, {.36, -.48, .8}};
    memcpy(s.turn, u, sizeof u);
    for (int a = 0; a < 3; a++)
        s.middle[a] = .001 * (a + 1);
    return s;
}

static void put_corner(const solid *s, int i, int j, out *to)
{
    double x[3], world[3];
    s->corner((double)i / ALONG, (double)(j % ACROSS) / ACROSS, x);
    to_world(s, x, world);
    out_format(to, "v %.17g %.17g %.17g\n", world[0], world[1], world[2]);
}

/* Its surface as an OBJ in metres. */
static void put_surface(const solid *s, const char *name, out *to)
{
    const int rings = s->closed ? ALONG : ALONG + 1;
    out_format(to, "g %s\n", name);
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < ACROSS; j++)
            put_corner(s, i, j, to);
    for (int i = 0; i < ALONG; i++)
        for (int j = 0; j < ACROSS; j++)
            out_format(to, "f %d %d %d %d\n", i * ACROSS + j + 1, i * ACROSS + (j + 1) % ACROSS + 1,
                       (i + 1) % rings * ACROSS + (j + 1) % ACROSS + 1, (i + 1) % rings * ACROSS + j + 1);
    for (int end = 0; end < 2 && !s->closed; end++) {
        out_text(to, "f");
        for (int j = 0; j < ACROSS; j++)
            out_format(to, " %d", (end ? ALONG * ACROSS : 0) + (end ? j : ACROSS - 1 - j) + 1);
        out_text(to, "\n");
    }
}

static void add_surface(model *m, const solid *s, const char *name)
{
    err e = {0};
    obj o = {0};
    size_t size;
    out *to = out_memory(&e);
    put_surface(s, name, to);
    const void *text = out_bytes(to, &size);
    in *source = in_memory(text, size, "solid.obj", &e);
    if (obj_read(&o, source, &e) || surface_add(m, "solid", &o, 1, &e))
        ok(false, "a surface: %s", e.text);
    in_close(source);
    obj_free(&o);
    out_discard(to);
}

/* A block of voxels of side h about it; those in it are volume 1. */
static void make_voxels(model *m, const solid *s, double h)
{
    const int32_t n = (int32_t)(.11 / h), size[3] = {n, n, n};
    lattice grid = {{-.055, -.055, -.055}, {h, h, h}};
    err e = {0};
    block(m, &grid, size, 0);
    model_find(m, "volume.muscle")->u8[1] = 1;
    model_set_text(model_find(m, "volume.name"), 1, "muscle_x", &e);
    model_add(m, "node.rigid", &e);
    for (int64_t i = 0; i < (int64_t)n * n * n; i++) {
        const int64_t at[3] = {i % n, i / n % n, i / n / n};
        double world[3], x[3];
        for (int a = 0; a < 3; a++)
            world[a] = grid.origin[a] + h * ((double)at[a] + .5);
        to_own(s, world, x);
        model_find(m, "element.volume")->i32[i] = s->holds(x);
    }
}

typedef struct angles {
    double mean, most; /* degrees */
    int64_t count, none;
} angles;

static angles compare(const model *m, const solid *s)
{
    const model_array *position = model_find(m, "node.position"), *node = model_find(m, "element.node");
    const float *fibre = model_find(m, "element.fibre")->f32;
    angles to = {0};
    for (int64_t i = 0; i < node->rows; i++) {
        double centre[3] = {0}, x[3], t[3], f[3], own[3];
        if (!model_find(m, "element.volume")->i32[i])
            continue;
        for (int c = 0; c < 24; c++)
            centre[c % 3] += position->f64[3 * (int64_t)node->i32[8 * i + c / 3] + c % 3] / 8;
        to_own(s, centre, x);
        if (s->until != 0 && x[0] > s->until)
            continue;
        s->tangent(x, t);
        for (int a = 0; a < 3; a++)
            f[a] = (double)fibre[3 * i + a];
        for (int k = 0; k < 3; k++)
            own[k] = dot(s->turn[k], f);
        to.none += fabs(dot(f, f) - 1) > 1e-6;
        double angle = acos(fmin(fabs(dot(own, t)) / sqrt(dot(t, t)), 1)) * 180 / pi;
        to.mean += angle;
        to.most = fmax(to.most, angle);
        to.count++;
    }
    to.mean /= (double)to.count;
    return to;
}

/* Of the solid in voxels of side h, with its surface or without. */
static angles lay(const solid *s, double h, bool whole, const char *rule, const char *expected)
{
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    opt_list asked = {.count = rule != NULL, .value = {rule}};
    pool *p = pool_create(2, &e);
    make_voxels(&m, s, h);
    if (whole)
        add_surface(&m, s, "muscle_x");
    const int rc = muscles_made(&m, &asked, p, &list, &warnings, &e);
    const model_array *said = model_find(&m, "muscle.fibre");
    ok(!rc && (rule ? !said : said && !strcmp(said->str[0], expected)), "the rule is %s: %s", expected,
       said ? said->str[0] : "not stored");
    angles to = compare(&m, s);
    printf("# %s, voxels of %g mm: %lld elements, mean %.3f, most %.3f degrees\n", expected, 1e3 * h,
           (long long)to.count, to.mean, to.most);
    ok(to.none == 0 && warnings.count == 0, "every element has a unit fibre, and nothing is warned of");
    notes_free(&warnings);
    muscles_free(&list);
    model_free(&m);
    pool_destroy(p);
    return to;
}

static void rings(void)
{
    const solid ring =
        turned((solid){.holds = ring_holds, .corner = ring_corner, .tangent = ring_tangent, .closed = true});
    ok(lay(&ring, .0025, true, NULL, "round").most < 2, "a ring by its surface: circles");
    ok(lay(&ring, .005, true, NULL, "round").most < 2, "in coarse voxels too");
    ok(lay(&ring, .0025, false, NULL, "round").most < 5, "by its voxels alone");
    ok(lay(&ring, .0025, true, "axis", "axis").mean > 30, "which one axis would miss");
    const solid half = turned((solid){.holds = half_holds, .corner = half_corner, .tangent = ring_tangent});
    angles of = lay(&half, .0025, true, NULL, "shape");
    ok(of.mean < 4 && of.most < 35, "half a ring: along its arc");
}

static void straps(void)
{
    const solid cylinder =
        turned((solid){.holds = cylinder_holds, .corner = cylinder_corner, .tangent = cylinder_tangent});
    const double exact = 1e-3 * 180 / pi;
    ok(lay(&cylinder, .0025, true, NULL, "shape").most < exact, "a slanted cylinder: its axis, to 1e-3");
    ok(lay(&cylinder, .011, true, NULL, "shape").most < exact, "in a few voxels too");
    ok(lay(&cylinder, .0025, false, NULL, "field").mean < 6, "by its voxels alone, about");
    const solid fan = {.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                       .holds = fan_holds,
                       .corner = fan_corner,
                       .tangent = fan_tangent,
                       .until = .005};
    const angles of = lay(&fan, .0025, true, NULL, "shape");
    ok(of.mean < 4 && of.most < 20, "a fan: from its narrow end to its wide one, but for the corners of that");
    ok(lay(&fan, .0025, true, "axis", "axis").mean > 6, "which one axis would miss");
}

/* Which rule a name and a value of --fibre ask for. */
static void asked(void)
{
    static const struct {
        const char *values[3];
        const char *rule;
    } of[] = {{{"MUSCLE_X=axis"}, "axis"},      {{"x=axis"}, "axis"},           {{"axis", "muscle_*=field"}, "field"},
              {{"m*=axis", "X=auto"}, "shape"}, {{"x=center"}, "centre"},       {{"axis", "auto"}, "shape"},
              {{"axis", "shape"}, NULL},        {{"x,muscle_x=round"}, "round"}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        err e = {0};
        notes warnings = {0};
        muscles list;
        model m;
        const solid s = turned((solid){.holds = cylinder_holds, .corner = cylinder_corner});
        opt_list values = {.count = of[i].values[1] ? 2 : 1, .value = {of[i].values[0], of[i].values[1]}};
        pool *p = pool_create(1, &e);
        make_voxels(&m, &s, .011);
        add_surface(&m, &s, "muscle_x");
        const int rc = muscles_made(&m, &values, p, &list, &warnings, &e);
        const model_array *said = model_find(&m, "muscle.fibre");
        ok(!rc && (of[i].rule ? said && !strcmp(said->str[0], of[i].rule) : !said), "--fibre %s: %s %s",
           of[i].values[0], said ? said->str[0] : "not stored", e.text);
        notes_free(&warnings);
        muscles_free(&list);
        model_free(&m);
        pool_destroy(p);
    }
}

/* A sphincter by its name, though it is no ring, has its fibres along its arc. */
static void named(void)
{
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    const solid s = turned((solid){.holds = half_holds, .corner = half_corner, .tangent = ring_tangent});
    pool *p = pool_create(1, &e);
    make_voxels(&m, &s, .0025);
    add_surface(&m, &s, "Orbicularis_oris_upper");
    model_set_text(model_find(&m, "volume.name"), 1, "orbicularis_oris_upper", &e);
    ok(!muscles_made(&m, &(opt_list){0}, p, &list, &warnings, &e) && list.of[0].rule == MUSCLE_ROUND &&
           !list.of[0].is_ring,
       "an arc of a sphincter, by its name %s", e.text);
    ok(compare(&m, &s).mean < 4, "along its arc");
    notes_free(&warnings);
    muscles_free(&list);
    model_free(&m);
    pool_destroy(p);
}

static void lines(void)
{
    err e = {0};
    const double straight[] = {0, 0, 0, .1, 0, 0, .1, .02, 0, 0, .02, 0, 0, .04, 0, 0, .04, 0};
    const double none[3] = {0}, up[3] = {0, 0, 1}, slanted[3] = {.6, 0, .8};
    double along[3];
    line_field *f = line_field_create(straight, 3, .001, &e);
    line_field_at(f, (double[]){.05, .01, .01}, none, along);
    ok(f && along[0] == 1, "between lines drawn one way and the other: their direction");
    line_field_at(f, (double[]){.05, .01, 0}, slanted, along);
    near_(along[0], .8, 1e-12, "in the plane across a normal");
    near_(along[2], -.6, 1e-12, "and nowhere else");
    line_field_at(f, (double[]){.05, 0, 0}, (double[]){1, 0, 0}, along);
    ok(along[0] == 0 && along[1] == 0 && along[2] == 0, "none where lines are along the normal");
    line_field_free(f);
    const double across[] = {-.05, .01, 0, .05, .01, 0, -.04, -.06, 0, .03, -.13, 0};
    double most = 0, before[3];
    f = line_field_create(across, 2, .001, &e);
    line_field_at(f, (double[]){0, .01, 0}, up, along);
    near_(along[0], 1, 1e-6, "on a line: its own direction");
    for (int i = 0; i <= 1000; i++) {
        memcpy(before, along, sizeof before);
        line_field_at(f, (double[]){0, .01 - .1 * i / 1000, 0}, up, along);
        most = fmax(most, acos(fmin(dot(before, along), 1)));
    }
    near_(along[1], -sqrt(.5), 1e-2, "from one to the other");
    ok(most < .01, "without a step: %g", most);
    line_field_free(f);
    ok(!line_field_create(straight, 0, .001, &e) && strstr(e.text, "no line has a length"), "%s", e.text);
}

int main(void)
{
    rings();
    straps();
    asked();
    named();
    lines();
    return done_testing();
}
