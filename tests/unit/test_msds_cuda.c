/* msds-run's CUDA executor against the CPU's: springs and conjugate gradients give the same numbers to the bit, exact
 * frames and those of the method tissue come within 1e-5 of the largest displacement; on lattices, on a mesh with no
 * order, through changes of method, with contact of both kinds; and a hundred repeats give the same bytes; so do skins.
 * Without a card all is skipped.
 * `test_msds_cuda small` is short enough for compute-sanitizer.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c msds/run/msds_executors.c msds/run/skin.c
#include "msds_block.h"
#include "skin_sheet.h"

#include "base/mem.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "msds/problem/simplex.h"

#include "tap.h"

static bool shortened;

typedef struct pair { /* the same model here and there */
    model m;
    msds_problem p;
    pool *threads;
    const msds_executor *device[2]; /* the CPU, the card */
    msds_state *state[2];
    double *u[2], *v[2];
    msds_reading reading[2];
    double worst, force, torque; /* m, N, N m: the largest difference so far */
    int64_t different;           /* numbers that are not the same */
    int64_t sent, unlike; /* frames; numbers of theirs that are not the state's, and wrong counts of tetrahedra */
    double largest;       /* m, N: the largest so far */
    double pressed, twisted;
    double lever; /* m: the probe's size */
} pair;

static const msds_executor *find_cuda(const char **why)
{
    *why = "built without CUDA";
    for (int i = 0; msds_executors[i]; i++)
        if (!strcmp(msds_executors[i]->device, "cuda")) {
            *why = msds_executors[i]->unusable();
            return *why ? NULL : msds_executor_of(msds_executors[i]);
        }
    return NULL;
}

/* Moves the nodes a little, each its own way, so that no two springs are the same. */
static void shake(const tets *b, model *m)
{
    double *x = model_find(m, "node.position")->f64;
    uint32_t seed = 12345;
    for (int64_t i = 0; i < 3 * model_count(m, "node"); i++) {
        seed = seed * 1664525u + 1013904223u;
        x[i] += .15 * b->size[i % 3] / (b->nodes[i % 3] - 1) * ((double)(seed >> 8) / 8388608. - 1);
    }
}

static void make(pair *c, const tets *b, const msds_options *o, bool shaken, const msds_executor *cuda)
{
    err e = {0};
    largest l;
    tets_make(b, &c->m);
    if (shaken)
        shake(b, &c->m);
    tets_must(!msds_problem_make(&c->p, &c->m, o, &e) && !largest_of(&c->p, &l, &e), &e);
    c->p.mass_factor = fmax(1, largest_factor(l.bound, o->damping, .01));
    c->threads = pool_create(2, &e);
    tets_must(c->threads != NULL, &e);
    c->device[0] = &msds_cpu;
    c->device[1] = cuda;
    for (int i = 0; i < 2; i++) {
        c->state[i] = c->device[i]->create(&c->p, c->threads, &e);
        c->u[i] = mem_array(c->p.nodes, 3 * sizeof *c->u[i], "test", &e);
        c->v[i] = mem_array(c->p.nodes, 3 * sizeof *c->v[i], "test", &e);
        tets_must(c->state[i] && c->u[i] && c->v[i], &e);
    }
    const msds_frames all = {.displacement = true, .velocity = true};
    tets_must(!cuda->frames(c->state[1], &all, &e), &e);
}

static void drop(pair *c)
{
    for (int i = 0; i < 2; i++) {
        c->device[i]->destroy(c->state[i]);
        free(c->u[i]);
        free(c->v[i]);
    }
    pool_destroy(c->threads);
    msds_problem_free(&c->p);
    model_free(&c->m);
}

static void compare_wrench(pair *c)
{
    double off = 0, size = 0, twist = 0, torque = 0;
    for (int a = 0; a < 3; a++) {
        off += pow(c->reading[1].force[a] - c->reading[0].force[a], 2);
        size += pow(c->reading[0].force[a], 2);
        twist += pow(c->reading[1].torque[a] - c->reading[0].torque[a], 2);
        torque += pow(c->reading[0].torque[a], 2);
    }
    c->pressed = fmax(c->pressed, sqrt(size));
    c->force = fmax(c->force, sqrt(off));
    c->twisted = fmax(c->twisted, sqrt(torque));
    c->torque = fmax(c->torque, sqrt(twist));
}

static int64_t count_inverted(const pair *c, const double *u)
{
    int64_t count = 0;
    for (int64_t t = 0; t < c->p.elements; t++) {
        double x[4][3];
        for (int i = 0; i < 4; i++)
            for (int a = 0; a < 3; a++) {
                const int64_t k = 3 * (int64_t)c->p.element_node[4 * t + i] + a;
                x[i][a] = c->p.position[k] + u[k];
            }
        count += !(simplex_volume(x[0], x[1], x[2], x[3]) > 0);
    }
    return count;
}

/* A frame that the card has sent has the state's numbers. */
static void compare_sent(pair *c)
{
    err e = {0};
    msds_values got;
    const int slot = (int)(c->sent++ % MSDS_SLOTS);
    tets_must(!c->device[1]->snapshot(c->state[1], slot, &e) && !c->device[1]->fetch(c->state[1], slot, &got, &e), &e);
    for (int64_t k = 0; k < 3 * c->p.nodes; k++) {
        const double u = got.precise ? got.precise[k] : (double)got.displacement[k];
        c->unlike += u != c->u[1][k] || (double)got.velocity[k] != c->v[1][k];
    }
    c->unlike += c->reading[1].inverted != count_inverted(c, c->u[1]);
}

static void frame_of(pair *c, const msds_plan *plan, int64_t count)
{
    err e = {0};
    for (int i = 0; i < 2; i++)
        tets_must(!c->device[i]->step(c->state[i], plan, count, &e) &&
                      !c->device[i]->monitor(c->state[i], &c->reading[i], &e) &&
                      !c->device[i]->get(c->state[i], MSDS_DISPLACEMENT, c->u[i], &e) &&
                      !c->device[i]->get(c->state[i], MSDS_VELOCITY, c->v[i], &e),
                  &e);
    compare_sent(c);
    for (int64_t k = 0; k < 3 * c->p.nodes; k++) {
        c->worst = fmax(c->worst, fabs(c->u[1][k] - c->u[0][k]));
        c->different += c->u[1][k] != c->u[0][k] || c->v[1][k] != c->v[0][k];
    }
    c->largest = fmax(c->largest, c->reading[0].largest);
    compare_wrench(c);
    c->different += c->reading[1].met != c->reading[0].met;
    if (!(fabs(c->reading[1].largest - c->reading[0].largest) <= 1e-5 * c->largest))
        c->different++;
}

/* Presses a ball, or another body, in from above, off the middle, sliding, and takes it away again; stops after so many
 * frames. */
static void press_until(pair *c, const tets *b, const probe *shape, msds_method method, int frames, int stop,
                        int64_t count)
{
    for (int i = 0; i < stop; i++) {
        msds_plan plan = tets_plan(method);
        double t = (double)i / (frames - 1), depth = .3 * b->size[2] * sin(3.3 * t);
        tets_press(&plan, .25 * b->size[0], (.45 + .1 * t) * b->size[0], .5 * b->size[1], b->size[2] - depth);
        if (shape) {
            pose at = {{(.45 + .1 * t) * b->size[0], .5 * b->size[1], b->size[2] - depth}, {1, 0, 0, 0}};
            plan.probe = probe_place(shape, &at);
        }
        c->lever = plan.probe.reach;
        frame_of(c, &plan, count);
    }
}

static void press(pair *c, const tets *b, const probe *shape, msds_method method, int frames, int64_t count)
{
    press_until(c, b, shape, method, frames, frames, count);
}

/* A torque's share is that of the force on the lever that a probe is: a ball's torque is
 * nearly nothing, the difference of many. */
static bool close_enough(const pair *c)
{
    return c->worst < 1e-5 * c->largest && c->force < 1e-5 * c->pressed && c->torque < 1e-5 * c->pressed * c->lever;
}

typedef struct setting {
    const tets *block;
    const probe *shape; /* or NULL: a ball */
    msds_options options;
    bool shaken;
    int stop; /* after so many frames; 0: after all */
} setting;

static void test_same(const setting *g, msds_method method, const msds_executor *cuda, const char *name)
{
    pair c = {0};
    const int frames = shortened ? 4 : 24;
    make(&c, g->block, &g->options, g->shaken, cuda);
    press_until(&c, g->block, g->shape, method, frames, g->stop > 0 ? g->stop : frames, 20);
    ok(c.largest > 1e-3 && c.pressed > 1e-3 && c.twisted > 1e-7, "%s: %.3g mm, %.3g N, %.3g N m", name, 1e3 * c.largest,
       c.pressed, c.twisted);
    ok(close_enough(&c), "%s: within 1e-5: %.3g, forces %.3g, torques %.3g", name, c.worst / c.largest,
       c.force / c.pressed, c.torque / (c.pressed * c.lever));
    ok(!c.unlike && c.sent, "%s: %lld frames are sent as the state is, inverted tetrahedra counted", name,
       (long long)c.sent);
    if (method < MSDS_EXACT && !g->options.penalty)
        ok(!c.different, "%s: the same numbers as the CPU's (%lld differ)", name, (long long)c.different);
    if (method != MSDS_SPRINGS)
        ok(fabs(c.reading[1].residual - c.reading[0].residual) <=
               (method == MSDS_EXACT ? 1e-6 : 1e-4 * c.reading[0].residual),
           "%s: leaves %.4g, %.4g", name, c.reading[0].residual, c.reading[1].residual);
    drop(&c);
}

static void test_changes(const tets *b, const msds_executor *cuda)
{
    static const msds_method methods[] = {MSDS_TISSUE, MSDS_SPRINGS, MSDS_TISSUE, MSDS_FEM,
                                          MSDS_TISSUE, MSDS_EXACT,   MSDS_FEM,    MSDS_EXACT};
    pair c = {0};
    msds_options o = tets_options();
    o.gravity[2] = -3;
    make(&c, b, &o, false, cuda);
    for (int i = 0; i < 8; i++)
        press(&c, b, NULL, methods[i], 5, 7 + i);
    ok(!c.unlike && c.sent, "%lld frames are sent, in single and double precision, as the state is", (long long)c.sent);
    ok(close_enough(&c), "methods change and the state goes along: %.3g, forces %.3g", c.worst / c.largest,
       c.force / c.pressed);
    drop(&c);
}

static void test_repeats(const tets *b, msds_method method, const msds_executor *cuda, const char *name)
{
    err e = {0};
    pair c = {0};
    msds_options o = tets_options();
    const int repeats = shortened ? 2 : 100;
    int different = 0;
    make(&c, b, &o, false, cuda);
    for (int repeat = 0; repeat <= repeats; repeat++) {
        msds_state *state = cuda->create(&c.p, c.threads, &e);
        tets_must(state != NULL, &e);
        for (int i = 0; i < 4; i++) {
            msds_plan plan = tets_plan(method);
            tets_press(&plan, .25 * b->size[0], .5 * b->size[0], .5 * b->size[1], b->size[2] * (1 - .05 * i));
            tets_must(!cuda->step(state, &plan, 20, &e), &e);
        }
        double *to = c.u[repeat > 0];
        tets_must(!cuda->get(state, MSDS_DISPLACEMENT, to, &e) && !cuda->monitor(state, &c.reading[repeat > 0], &e),
                  &e);
        different += repeat > 0 && (memcmp(c.u[0], c.u[1], 3 * (size_t)c.p.nodes * sizeof *to) != 0 ||
                                    memcmp(c.reading[0].force, c.reading[1].force, sizeof c.reading[0].force) != 0);
        cuda->destroy(state);
    }
    ok(!different && c.reading[0].largest > 1e-3, "%s: %d repeats, the same bytes", name, repeats);
    drop(&c);
}

static void test_refused(const msds_executor *cuda)
{
    static const tets b = {{4, 3, 3}, {.03, .02, .02}, 1e4, .3, 1000, 2, false};
    pair c = {0};
    err e = {0};
    msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_FEM);
    plan.warp = true;
    make(&c, &b, &o, false, cuda);
    ok(cuda->step(c.state[1], &plan, 1, &e) && strstr(e.text, "expected -d cpu"), "warping is refused: %s", e.text);
    drop(&c);
    c = (pair){0};
    e = (err){0};
    plan.warp = false;
    plan.method = MSDS_EXACT;
    make(&c, &b, &o, false, cuda);
    memset(c.p.fixed, 0, (size_t)c.p.nodes);
    ok(cuda->step(c.state[1], &plan, 1, &e) && strstr(e.text, "nothing holds"), "so is what nothing holds: %s", e.text);
    drop(&c);
}

static const tets small = {{5, 4, 4}, {.04, .03, .03}, 1e4, .3, 1000, 2, false};
static const tets odd = {{21, 14, 9}, {.1, .07, .045}, 1e4, .45, 1000, 2, false};
static const tets paper = {{32, 16, 16}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
static const tets large = {{64, 40, 40}, {.16, .1, .1}, 1e4, .45, 1000, 2, false};

/* An octagonal prism, its axis along x, that points down with an edge. */
static probe prism(void)
{
    static double plane[10][4];
    probe p = {
        .kind = PROBE_CONVEX, .planes = 10, .plane = plane[0], .middle = {0, 0, -.02}, .reach = .03, .size = .018};
    for (int i = 0; i < 8; i++) {
        plane[i][1] = sin(.3 + i * acos(0) / 2);
        plane[i][2] = cos(.3 + i * acos(0) / 2);
        plane[i][3] = .018 + plane[i][2] * -.02;
    }
    for (int i = 8; i < 10; i++) {
        plane[i][0] = i == 8 ? 1 : -1;
        plane[i][3] = .02;
    }
    return p;
}

static void test_shapes(msds_method method, const msds_executor *cuda, const char *name)
{
    const probe shapes[] = {probe_linear(.03, .01, .0025), probe_curved(.03, 1.2, .014, .003), prism()};
    static const char *const names[] = {"linear", "curved", "convex"};
    char what[80];
    for (int i = 0; i < 3; i++) {
        const setting g = {&odd, &shapes[i], tets_options(), false, 0};
        snprintf(what, sizeof what, "%s, %s", name, names[i]);
        test_same(&g, method, cuda, what);
    }
}

static void test_method(msds_method method, const msds_executor *cuda, const char *name)
{
    char what[80];
    const tets *all[] = {&small, &odd, &paper, &large};
    setting g = {&odd, NULL, tets_options(), false, 0};
    const int whole = method >= MSDS_EXACT ? 3 : 4;
    for (int i = 0; i < (shortened ? 2 : whole); i++) {
        g.block = all[i];
        snprintf(what, sizeof what, "%s, %dx%dx%d", name, all[i]->nodes[0], all[i]->nodes[1], all[i]->nodes[2]);
        test_same(&g, method, cuda, what);
    }
    g.block = &odd;
    g.shaken = true;
    snprintf(what, sizeof what, "%s, no lattice", name);
    test_same(&g, method, cuda, what);
    g.shaken = false;
    g.options.gravity[0] = 1, g.options.gravity[2] = -5;
    snprintf(what, sizeof what, "%s, gravity", name);
    test_same(&g, method, cuda, what);
    g.options.penalty = true;
    snprintf(what, sizeof what, "%s, a penalty", name);
    if (method != MSDS_SPRINGS)
        test_same(&g, method, cuda, what);
    test_shapes(method, cuda, name);
    test_repeats(&odd, method, cuda, name);
}

/* Tissue that holds pressures from frame to frame, and a mesh of several chunks to a block. So many nodes are far from
 * equilibrium after 20 iterations, and then whatever differs grows: by the eighth frame the CPU's own differ by a third
 * of their largest displacement from those with a gravity of 1e-7 m/s2. So only the first are compared. */
static void test_tissue(const msds_executor *cuda)
{
    static const tets tight = {{21, 14, 9}, {.1, .07, .045}, 1e4, .499, 1000, 2, false};
    setting g = {&tight, NULL, tets_options(), false, 0};
    test_same(&g, MSDS_TISSUE, cuda, "tissue, nu .499");
    if (shortened)
        return;
    g.block = &large;
    g.stop = 2;
    test_same(&g, MSDS_TISSUE, cuda, "tissue, 64x40x40");
    g.options.penalty = true;
    g.stop = 4;
    test_same(&g, MSDS_TISSUE, cuda, "tissue, 64x40x40, a penalty");
}

/* Presses, goes on with other options, and from rest; the skin's displacements, vertices x 3, go to `to`. */
static void dent(const model *m, const probe *p, const skin_device *device, double *to)
{
    err e = {0};
    skin s = {.vertices = 0};
    skin_options o = sheet_options();
    sheet_make(&s, m, &o, 2);
    s.device = device;
    const size_t bytes = 3 * (size_t)s.vertices * sizeof *to;
    for (int part = 0; part < 3; part++, to += 3 * s.vertices) {
        for (int t = 0; t < 20; t++) {
            const pose at = {{.1 + .001 * t, .1, -.001 * t}, {1, 0, 0, 0}};
            const probe_placed placed = probe_place(p, &at);
            sheet_step(&s, t < 18 ? &placed : NULL, 7);
        }
        memcpy(to, s.u, bytes);
        o.stiffness *= 2, o.damping /= 2;
        sheet_must(!(part ? skin_reset(&s, &e) : skin_change(&s, &o, &e)), &e);
    }
    sheet_done(&s);
}

static void test_skins(const msds_executor *cuda)
{
    enum { NUMBERS = 9 * SHEET_SIDE * SHEET_SIDE };
    const probe shapes[] = {probe_sphere(.03), probe_linear(.03, .01, .0025), probe_curved(.03, 1.2, .014, .003),
                            prism()};
    static const char *const names[] = {"a ball", "a linear array", "a curved array", "a convex probe"};
    static double here[NUMBERS], there[NUMBERS];
    model m = {0};
    sheet_add(&m, .005);
    for (int i = 0; i < 4; i++) {
        double most = 0;
        dent(&m, &shapes[i], NULL, here);
        dent(&m, &shapes[i], cuda->skin, there);
        for (int k = 0; k < NUMBERS; k++)
            most = fmax(most, fabs(here[k]));
        ok(most > .005 && !memcmp(here, there, sizeof here), "a skin under %s, %.3g mm deep: the processor's bytes",
           names[i], 1e3 * most);
    }
    model_free(&m);
}

int main(int argc, char **argv)
{
    shortened = argc > 1 && !strcmp(argv[1], "small");
    const char *why;
    const msds_executor *cuda = find_cuda(&why);
    if (!cuda) {
        skip(1, why);
        return done_testing();
    }
    test_method(MSDS_SPRINGS, cuda, "springs");
    test_method(MSDS_FEM, cuda, "20 cg");
    test_method(MSDS_EXACT, cuda, "exact");
    test_method(MSDS_TISSUE, cuda, "tissue");
    test_tissue(cuda);
    test_changes(&odd, cuda);
    test_skins(cuda);
    test_refused(cuda);
    return done_testing();
}
