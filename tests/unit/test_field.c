/* Fibres by a potential: in a straight bar exactly along it; in a bent tube made from equations, its own axis; with
 * both ends, one or none attached, whatever the number of threads.
 */
// needs: attach/muscle.c attach/muscle_fibres.c attach/attachment.c attach/fibre_rule.c attach/fibre_field.c
// needs: attach/shape/laplace.c attach/shape/ring.c attach/muscle_shape.c attach/muscle_surface.c
#include "attach/muscle.h"
#include "attach/shape/laplace.h"

#include "block.h"
#include "muscles_made.h"

#include <stdlib.h>

/* A tube whose axis is an arc about the origin in a slanted plane: u and v span it. */
typedef struct tube {
    double radius, thickness, angle; /* of the axis, of the tube, from -angle to angle */
    double u[3], v[3], w[3];
} tube;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double *v)
{
    double l = sqrt(dot(v, v));
    for (int a = 0; a < 3; a++)
        v[a] /= l;
}

static tube make_tube(double radius, double thickness, double angle)
{
    tube t = {radius, thickness, angle, {.8, .5, .3}, {-.2, .7, -.6}, {0}};
    unit(t.u);
    double along = dot(t.u, t.v);
    for (int a = 0; a < 3; a++)
        t.v[a] -= along * t.u[a];
    unit(t.v);
    for (int a = 0; a < 3; a++)
        t.w[a] = t.u[(a + 1) % 3] * t.v[(a + 2) % 3] - t.u[(a + 2) % 3] * t.v[(a + 1) % 3];
    return t;
}

/* Where along the arc x is (rad), and how far from the axis. */
static double place(const tube *t, const double *x, double *off)
{
    double p = dot(x, t->u), q = dot(x, t->v), r = sqrt(p * p + q * q) - t->radius, h = dot(x, t->w);
    *off = sqrt(r * r + h * h);
    return atan2(q, p);
}

/* A box of voxels of side h round the tube; those in it are volume 1, a muscle. Bits
 * of ends: which of its ends are rigid. */
static void make_muscle(model *m, const tube *t, double h, int ends)
{
    int32_t n = (int32_t)(2 * (t->radius + t->thickness) / h) + 2;
    lattice grid = {{-n * h / 2 + .2 * h, -n * h / 2 - .1 * h, -n * h / 2}, {h, h, h}};
    const int32_t size[3] = {n, n, n};
    err e = {0};
    double x[3], off;
    block(m, &grid, size, 0);
    model_find(m, "volume.muscle")->u8[1] = 1;
    model_set_text(model_find(m, "volume.name"), 1, "muscle_tube", &e);
    uint8_t *rigid = model_add(m, "node.rigid", &e)->u8;
    const model_array *position = model_find(m, "node.position"), *node = model_find(m, "element.node");
    int32_t *volume = model_find(m, "element.volume")->i32;
    for (int64_t i = 0; i < node->rows; i++) {
        for (int a = 0; a < 3; a++)
            x[a] = position->f64[3 * (int64_t)node->i32[8 * i] + a] + h / 2;
        double at = place(t, x, &off);
        volume[i] = off < t->thickness && fabs(at) < t->angle;
        for (int c = 0; c < 8 && volume[i]; c++) {
            double to = place(t, &position->f64[3 * (int64_t)node->i32[8 * i + c]], &off);
            if (((ends & 1) && to < -t->angle + h / t->radius) || ((ends & 2) && to > t->angle - h / t->radius))
                rigid[node->i32[8 * i + c]] = 1;
        }
    }
}

/* Degrees between fibres and the tube's axis, the mean and the largest; `away` from the ends (m). */
static void compare(const model *m, const tube *t, double h, double away, double *mean, double *most)
{
    const model_array *position = model_find(m, "node.position"), *node = model_find(m, "element.node");
    const int32_t *volume = model_find(m, "element.volume")->i32;
    const float *fibre = model_find(m, "element.fibre")->f32;
    int64_t count = 0;
    *mean = *most = 0;
    for (int64_t i = 0; i < node->rows; i++) {
        double x[3], off, axis = 0;
        for (int a = 0; a < 3; a++)
            x[a] = position->f64[3 * (int64_t)node->i32[8 * i] + a] + h / 2;
        double at = place(t, x, &off);
        if (!volume[i] || fabs(at) > t->angle - away / t->radius)
            continue;
        for (int a = 0; a < 3; a++)
            axis += fibre[3 * i + a] * (cos(at) * t->v[a] - sin(at) * t->u[a]);
        double degrees = acos(fmin(fabs(axis), 1)) * 180 / M_PI;
        *mean += degrees;
        *most = fmax(*most, degrees);
        count++;
    }
    *mean /= (double)count;
}

static void make(model *m, const char *rule, int threads)
{
    err e = {0};
    notes warnings = {0};
    muscles list;
    pool *p = pool_create(threads, &e);
    ok(!muscles_made(m, &(opt_list){1, {rule}}, p, &list, &warnings, &e), "fibres %s", e.text);
    notes_free(&warnings);
    muscles_free(&list);
    pool_destroy(p);
}

/* Against the tube's own tangent. The voxels' steps leave 18 degrees at single elements of its sides whatever the size;
 * the mean comes down with it. */
static void bent(void)
{
    tube t = make_tube(.04, .008, 1.2);
    const char *const held[] = {"no end", "one end", "the other", "both ends"};
    for (int fine = 0; fine < 2; fine++)
        for (int ends = 3; ends >= 0; ends--) {
            double h = fine ? .001 : .002, mean, most, far_mean, far_most, line_mean, line_most;
            model m;
            make_muscle(&m, &t, h, ends);
            make(&m, "axis", 1);
            compare(&m, &t, h, 0, &line_mean, &line_most);
            make(&m, "field", 2);
            compare(&m, &t, h, 0, &mean, &most);
            compare(&m, &t, h, .008, &far_mean, &far_most);
            printf("# %s held, voxels of %g mm: mean %.2f, most %.2f degrees; a radius from the ends %.2f and %.2f; "
                   "--fibre axis %.2f and %.2f\n",
                   held[ends], 1e3 * h, mean, most, far_mean, far_most, line_mean, line_most);
            ok(mean < (fine ? 1.7 : 2.5) && most < 40, "%s held: mean and largest angle to the axis", held[ends]);
            ok(far_mean < (fine ? 1.0 : 1.8) && far_most < 19, "a radius from the ends");
            ok(line_mean > 30, "which a straight line would miss");
            model_free(&m);
        }
}

/* The same bytes for any number of threads. */
static void any_threads(void)
{
    tube t = make_tube(.04, .008, 1.2);
    float *one = NULL;
    size_t size = 0;
    for (int threads = 1; threads < 5; threads++) {
        model m;
        make_muscle(&m, &t, .001, 1);
        make(&m, "field", threads);
        const model_array *fibre = model_find(&m, "element.fibre");
        size = 3 * (size_t)fibre->rows * sizeof *one;
        if (!one && (one = malloc(size)))
            memcpy(one, fibre->f32, size);
        ok(one && !memcmp(one, fibre->f32, size), "%d threads", threads);
        model_free(&m);
    }
    free(one);
}

/* A bar along an axis of the lattice, of flat voxels: u is linear, and fibres are exact; toward the larger attachment.
 * A second piece, apart from it, runs across, with nothing held; a third is one voxel. */
static void straight(void)
{
    static const lattice grid = {{0, 0, 0}, {.004, .002, .001}};
    static const int32_t size[] = {12, 9, 6};
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    block(&m, &grid, size, 0);
    model_find(&m, "volume.muscle")->u8[1] = 1;
    int32_t *volume = model_find(&m, "element.volume")->i32;
    uint8_t *rigid = model_add(&m, "node.rigid", &e)->u8;
    for (int32_t i = 0; i < 12 * 9 * 6; i++) {
        int32_t x = i % 12, y = i / 12 % 9, z = i / 108;
        volume[i] = (x < 9 && y < 2 && z < 2) || (x == 11 && z > 3) || (x == 2 && y == 5 && z == 2);
    }
    for (int32_t k = 0; k <= 2; k++)
        for (int32_t j = 0; j <= 2; j++) {
            rigid[node_at(size, 9, j, k)] = 1;
            rigid[node_at(size, 0, j, k)] = k < 2;
        }
    pool *p = pool_create(1, &e);
    ok(!muscles_made(&m, &(opt_list){1, {"field"}}, p, &list, &warnings, &e), "three pieces %s", e.text);
    const float *f = model_find(&m, "element.fibre")->f32;
    double off[3] = {0};
    for (int32_t i = 0; i < 12 * 9 * 6; i++) {
        int32_t x = i % 12, y = i / 12 % 9;
        if (volume[i] && x == 11)
            off[1] += fabs(1 - fabs((double)f[3 * i + 1]));
        else if (volume[i])
            off[y == 5 ? 2 : 0] += fabs(1 - (double)f[3 * i]);
    }
    ok(off[0] < 1 && f[0] > .8, "the bar: along it, toward its larger end (off by %g in 36 elements)", off[0]);
    ok(off[1] < .2, "the other: along it (off by %g in 18)", off[1]);
    ok(warnings.count == 0, "%s", warnings.count ? warnings.line[0] : "no warning");
    ok(list.attached.count == 2 && list.attached.of[0].nodes == 9 && list.attached.of[1].nodes == 6,
       "two attachments, the larger first");
    const model_array *centre = model_find(&m, "attachment.centre"), *of = model_find(&m, "attachment.muscle");
    ok(centre && centre->rows == 2 && of->i32[0] == 0 && of->i32[1] == 0 &&
           model_find(&m, "attachment.nodes")->i32[0] == 9,
       "in the model too");
    near_(centre->f64[0], .036, 1e-15, "the centre of one");
    near_(centre->f64[3], 0, 1e-15, "and of the other");
    near_(centre->f64[5], .0005, 1e-15, "whose nodes are the lower ones");
    near_(model_find(&m, "muscle.centre")->f64[0], .036 * 9 / 15, 1e-15, "the contraction centre is that of all");
    notes_free(&warnings);
    muscles_free(&list);
    pool_destroy(p);
    model_free(&m);
}

/* A rod held at one end with a source: u = source (L s - s^2 / 2); held at both: linear. */
static void a_rod(void)
{
    enum { CELLS = 10, NODES = 4 * (CELLS + 1) };
    static const double spacing[] = {.01, .02, .03};
    int32_t node[8 * CELLS];
    bool held[NODES] = {0};
    double u[NODES] = {0}, worst = 0, gradient[3];
    err e = {0};
    pool *p = pool_create(1, &e);
    for (int i = 0; i < CELLS; i++)
        for (int c = 0; c < 8; c++)
            node[8 * i + c] = 4 * (i + lattice_vtk[c][0]) + 2 * lattice_vtk[c][1] + lattice_vtk[c][2];
    laplace *l = laplace_create(p, spacing, node, CELLS, NODES, NULL, &e);
    for (int n = 0; n < 4; n++)
        held[n] = true;
    ok(l && !laplace_solve(l, held, 7, u, &e), "a source %s", e.text);
    for (int n = 0; n < NODES; n++) {
        double s = .01 * (n / 4);
        worst = fmax(worst, fabs(u[n] - 7 * (.1 * s - s * s / 2)));
    }
    near_(worst, 0, 1e-12, "a parabola, exact at the nodes");
    for (int n = 0; n < 4; n++) {
        held[NODES - 1 - n] = true;
        u[NODES - 1 - n] = 5;
    }
    ok(!laplace_solve(l, held, 0, u, &e), "two ends %s", e.text);
    laplace_gradient(l, 3, u, gradient);
    near_(gradient[0], 50, 1e-8, "a constant slope");
    near_(fabs(gradient[1]) + fabs(gradient[2]), 0, 1e-8, "and none across");
    laplace_free(l);
    pool_destroy(p);
}

int main(void)
{
    a_rod();
    straight();
    bent();
    any_threads();
    return done_testing();
}
