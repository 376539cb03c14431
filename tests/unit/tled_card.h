/* What tests of the CUDA executors have in common, whoever plays the card: models, a script, and the look. */
#ifndef SINEW_TLED_CARD_H
#define SINEW_TLED_CARD_H

#include "form_tried.h"
#include "tled_bench.h"

#include <inttypes.h>

static const block lump = {{17, 9, 6}, {.01, .008, .0125}, 30000, .45, 1000, 30000, 0, 1, 0, {0, 0, 0}, 0, false};
static const block muscle = {{11, 6, 5}, {.0025, .0025, .0025}, 3000, .45, 1000, 30000, 2, 1, 0, {1, 0, 0}, 0, false};

/* Of two columns whose threads nearly all have an element, and of layers that end. */
static const block small = {{29, 14, 9}, {.001, .001, .001}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 1, 0}, 0, false};

/* Fibres that act by themselves. */
static const block_fibres quadratic_fibres = {.name = "quadratic fibres", .kind = {"quadratic"}, .k1 = {2e4}};
static const block_fibres hgo_fibres = {
    .name = "hgo fibres", .kind = {"hgo", "hgo"}, .k1 = {1e4, 3e4}, .k2 = {2, 5}, .kappa = {0, .15}};
static const block_fibres two_families = {.name = "two families",
                                          .kind = {"hgo", "quadratic"},
                                          .k1 = {1e4, 2e4},
                                          .k2 = {3, 0},
                                          .kappa = {.1, 0},
                                          .angle = {35, 0}};
static const block_fibres passive_muscles = {.name = "passive muscles", .passive = {.05, 0}, .optimum = {.9, 0}};
static const block_fibres all_fibres = {.name = "passive muscles with two families",
                                        .kind = {NULL, "hgo"},
                                        .k1 = {0, 2e4},
                                        .k2 = {0, 3},
                                        .angle = {0, 50},
                                        .passive = {.1, .05},
                                        .optimum = {0, 1.1}};

/* In series with springs: one of two muscles, or both, without or with fibres beside. */
static const block_fibres serial_muscles = {
    .name = "muscles in series with springs", .passive = {0, .05}, .optimum = {1.1, 0}, .vmax = {10, 0}};
static const block_fibres serial_fibres = {.name = "such muscles with fibres",
                                           .kind = {"quadratic", NULL},
                                           .k1 = {2e4, 0},
                                           .passive = {.1, 0},
                                           .vmax = {5, 10}};

static const block_fibres fung_tissue = {
    .name = "the law fung", .kind = {NULL, "hgo"}, .k1 = {0, 1e4}, .k2 = {0, 2}, .fung = {2e3, 8, 2, 4}};

/* The hourglass control that a new problem gets. */
static hourglass_control in_control = {HOURGLASS_PHYSICAL, 0};

static inline void read_script(bench *b, const char *text)
{
    in *source = in_memory(text, strlen(text), "script", &b->e);
    bench_must(!source || script_read(&b->script, source, &b->m, &b->e), &b->e);
    in_close(source);
    tled_problem_free(&b->problem);
    bench_must(tled_problem_make(&b->problem, &b->m, &b->script, in_control, &b->e), &b->e);
}

/* All that a script can do, on a block of several bricks that hangs from a side. */
static inline void add_script(bench *b)
{
    block_add_body(&b->m, "base", (const double[]){0, 0, 0, 0, 1, 1});
    read_script(b, "0 gravity 0,0,0\n"
                   "0.02 gravity 0,1,-9.81\n"
                   "0 force 0.17,0.072,0.075 0.03 0,0,0\n"
                   "0.03 force 0.17,0.072,0.075 0.03 .01,.005,0\n"
                   "0 force 0.17,0.05,0.075 0.05 .001,.002,.003\n"
                   "0 pull p 0.1,0.072,0.075 0.03 0.1,0.075,0.07 20\n"
                   "0.01 pull q 0.17,0.072,0.075 0.03 0.18,0.075,0.07 10\n"
                   "0.02 pull q 0.17,0.072,0.075 0.03 0.17,0.08,0.07 10\n"
                   "0.025 release q\n"
                   "0 displace 0.169,-1,-1,1,0.001,1 -,0,0\n"
                   "0.04 displace 0.169,-1,-1,1,0.001,1 -,0.002,-0.003\n"
                   "0 move base 0,0,0 0,0,0,1 about 0,3cm,4cm\n"
                   "0.05 move base 1mm,0,-2mm 0.06,0.03,-0.02,0.997547 about 0,3cm,4cm\n");
}

/* The form that problems which are made are in; their moduli stay. */
static form in_form = FORM_NEO_HOOKEAN;

static inline void put_in_form(tled_problem *p)
{
    bool has = true;
    p->form = in_form;
    for (int32_t i = 0; i < p->volumes; i++)
        has = form_tried(in_form, p->volume[i].law.mu, p->volume[i].law.bulk, p->volume[i].law.c) && has;
    for (int64_t i = 0; i < p->laws; i++)
        has = form_tried(in_form, p->law[i].mu, p->law[i].bulk, p->law[i].c) && has;
    if (!has)
        ok(false, "form %d: form_tried.h has coefficients", (int)in_form);
}

/* Whether skin at a slit all through the middle of a block of 6 layers, and below it, touches itself, and the ball that
 * nodes slide on; NULL: it does not. */
typedef struct touching {
    double friction;
    bool blended, in_bone;
} touching;
static const touching *in_touching;

/* Whether the lowest nodes slide on a ball below them, which moves with the body, if there is one; every third may come
 * off. */
static bool in_sliding;

enum { SLIDING_AROUND = 4 }; /* samples of the field beyond the block */

static inline void add_field(bench *b, const block *what)
{
    const int32_t nx = what->cells[0] + 2 * SLIDING_AROUND + 1, ny = what->cells[1] + 2 * SLIDING_AROUND + 1;
    const int32_t nz = 2 * SLIDING_AROUND + 1, size[3] = {nx, ny, nz};
    const double *h = what->side, radius = .1;
    bench_must(model_axis_add(&b->m, "field", 1, &b->e) ||
                   model_axis_add(&b->m, "distance", (int64_t)nx * ny * nz, &b->e),
               &b->e);
    int32_t *first = block_array(&b->m, "field.first")->i32, *samples = block_array(&b->m, "field.samples")->i32;
    for (int a = 0; a < 3; a++) {
        first[a] = -SLIDING_AROUND;
        samples[a] = size[a];
    }
    if (model_find(&b->m, "body.name"))
        block_array(&b->m, "field.body")->i32[0] = 0;
    if (in_touching && in_touching->in_bone)
        block_array(&b->m, "field.contact")->u8[0] = 1;
    float *to = block_array(&b->m, "distance.value")->f32;
    for (int32_t k = 0; k < nz; k++)
        for (int32_t j = 0; j < ny; j++)
            for (int32_t i = 0; i < nx; i++) {
                const double x = h[0] * (i - SLIDING_AROUND - what->cells[0] / 2.);
                const double y = h[1] * (j - SLIDING_AROUND - what->cells[1] / 2.);
                const double z = h[2] * (k - SLIDING_AROUND) + radius;
                *to++ = (float)(sqrt(x * x + y * y + z * z) - radius);
            }
}

static inline void add_sliding(bench *b, const block *what)
{
    const model_array *rigid = model_find(&b->m, "node.rigid"), *at = model_find(&b->m, "node.position");
    int64_t count = 0;
    for (int64_t n = 0; n < at->rows; n++)
        count += !rigid->u8[n] && at->f64[3 * n + 2] < what->side[2] / 2;
    bench_must(model_axis_add(&b->m, "slide", count, &b->e), &b->e);
    int32_t *node = block_array(&b->m, "slide.node")->i32;
    uint8_t *lifts = block_array(&b->m, "slide.lifts")->u8;
    memset(block_array(&b->m, "slide.field")->i32, 0, (size_t)count * sizeof *node);
    for (int64_t n = 0; n < at->rows; n++)
        if (!rigid->u8[n] && at->f64[3 * n + 2] < what->side[2] / 2) {
            *lifts++ = n % 3 == 0;
            *node++ = (int32_t)n;
        }
    add_field(b, what);
    bench_must(sliding_make(&b->sliding, &b->problem, &b->m, .1, &b->e), &b->e);
}

enum { SKIN_MIDDLE = 3, SKIN_SAMPLES = 2, SKIN_ALONG = 5 }; /* samples: of each face; along: elements along x */

/* Returns which face of an element is skin: 0 for its lower one, 1 for its upper one; -1 where none is, as of elements
 * beyond the first few. */
static inline int skin_face(const bench *b, int64_t element)
{
    const tled_problem *p = &b->problem;
    const double *at = p->position + 3 * (int64_t)p->element_node[8 * element];
    const long k = lround(at[2] / p->side[2]);
    if (at[0] > SKIN_ALONG * p->side[0])
        return -1;
    if (k == SKIN_MIDDLE || k == 0)
        return 0;
    return k == SKIN_MIDDLE - 1 ? 1 : -1;
}

static inline void add_skin(bench *b, const block *what)
{
    static const double at[SKIN_SAMPLES][2] = {{.3, .4}, {.85, .1}};
    const model_array *place = model_find(&b->m, "node.position");
    const double middle = SKIN_MIDDLE * what->side[2];
    const double along = (SKIN_ALONG + 1.5) * what->side[0];
    int64_t count = 0, nodes = 0;
    for (int64_t n = 0; n < place->rows; n++)
        nodes += place->f64[3 * n] < along;
    for (int64_t i = 0; i < b->problem.elements; i++)
        count += skin_face(b, i) >= 0 ? SKIN_SAMPLES : 0;
    bench_must(model_axis_add(&b->m, "contact", count, &b->e) || model_axis_add(&b->m, "skin", nodes, &b->e), &b->e);
    int32_t *element = block_array(&b->m, "contact.element")->i32, *node = block_array(&b->m, "skin.node")->i32;
    double *weight = block_array(&b->m, "contact.weight")->f64;
    float *distance = block_array(&b->m, "skin.distance")->f32;
    if (in_touching->blended)
        memset(block_array(&b->m, "contact.blended")->u8, 1, (size_t)count);
    for (int64_t n = 0; n < place->rows; n++) {
        const double z = place->f64[3 * n + 2];
        if (place->f64[3 * n] < along) {
            *node++ = (int32_t)n;
            *distance++ = (float)-fmin(z, fabs(z - middle));
        }
    }
    for (int64_t i = 0; i < b->problem.elements; i++)
        for (int k = 0; k < SKIN_SAMPLES && skin_face(b, i) >= 0; k++, weight += 3) {
            *element++ = (int32_t)i;
            weight[0] = at[k][0];
            weight[1] = at[k][1];
            weight[2] = 1 - skin_face(b, i);
        }
    if (!in_sliding && in_touching->in_bone) {
        add_field(b, what);
        bench_must(sliding_make(&b->sliding, &b->problem, &b->m, .1, &b->e), &b->e);
    }
    bench_must(self_contact_make(&b->skin, &b->problem, &b->m, &b->sliding, in_touching->friction, NULL, &b->e), &b->e);
}

/* What presses on the block's top, past the middle, and goes down and aside; NULL: nothing does. */
static const probe *in_pressing;

static inline void add_probe(bench *b, const block *what)
{
    const double *h = what->side, top = what->cells[2] * h[2], depth = .3 * h[2];
    pose at = {{.6 * what->cells[0] * h[0], .4 * what->cells[1] * h[1], top}, {1, 0, 0, 0}};
    b->probe.shape = *in_pressing;
    bench_must(collider_begin_live(&b->probe, &b->e), &b->e);
    collider_move(&b->probe, 0, 0, &at);
    at.position[0] += h[0];
    at.position[2] -= depth;
    collider_move(&b->probe, 0, .05, &at);
    collider_join(&b->probe, &b->problem, 1);
}

/* So many steps of a fraction of the stable one, which is never cut, so that both take the same. */
static inline void make(bench *b, const block *what, double level, bool scripted, const tled_executor *device,
                        int64_t steps)
{
    bench_make(b, what, NULL, level, in_control, 2);
    if (scripted)
        add_script(b);
    if (in_form != FORM_NEO_HOOKEAN) /* which they are in */
        put_in_form(&b->problem);
    if (in_sliding)
        add_sliding(b, what);
    if (in_touching)
        add_skin(b, what);
    if (in_pressing)
        add_probe(b, what);
    bench_steps(b, steps, b->setup.damping);
    b->setup.device = device;
    b->setup.rate = 3 / step_at_rest(&b->problem, NULL);
    b->setup.rate_fixed = true;
    b->setup.check = 50;
    b->setup.every = .0123;
}

static inline bool close_to(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance * fmax(fabs(a), fabs(b));
}

/* A state that is everywhere bent, in the middle of what curves do. */
static inline void bend(bench *b)
{
    const tled_problem *p = &b->problem;
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        p->at_start.of[TLED_DISPLACEMENT][i] = .07 * p->side[i % 3] * sin((double)(i * i % 1009));
        p->at_start.of[TLED_VELOCITY][i] = 30 * p->at_start.of[TLED_DISPLACEMENT][i];
    }
    b->problem.start = .03;
}

/* Whether what a device looks at begins bent. */
static bool in_bent;

/* The device's look, after so many steps and as many more, against that of the monitor on what get() gives. */
static inline void test_look(const block *what, bool scripted, int64_t steps, const tled_executor *cuda,
                             const char *name, double tolerance)
{
    bench b;
    tled_executor blind = *cuda;
    tled_plan plan = {0};
    blind.monitor = NULL;
    make(&b, what, scripted ? 0 : .8, scripted, cuda, steps);
    if (in_bent)
        bend(&b);
    plan.rate = b.setup.rate;
    plan.origin = b.problem.start;
    tled_state *state = cuda->create(&b.problem, b.setup.threads, &b.e);
    monitor *w = monitor_create(&b.problem, b.setup.threads, &b.e),
            *v = monitor_create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || !w || !v, &b.e);
    w->differences = v->differences = true;
    for (int part = 0; part < 2; part++, plan.first += steps) {
        bench_must(cuda->step(state, &plan, steps, &b.e), &b.e);
        bench_must(monitor_read(w, cuda, state, tled_time(&plan, steps), &b.e), &b.e);
        bench_must(monitor_read(v, &blind, state, tled_time(&plan, steps), &b.e), &b.e);
        if (!part)
            bench_must(monitor_save(v, &blind, state, &b.e) || monitor_save(w, cuda, state, &b.e), &b.e);
    }
    const monitor_reading *s = &w->reading, *t = &v->reading;
    ok(close_to(s->kinetic, t->kinetic, tolerance) && close_to(s->strain, t->strain, tolerance) &&
           close_to(s->acceleration, t->acceleration, tolerance) && close_to(s->speed, t->speed, tolerance) &&
           close_to(s->moved, t->moved, tolerance) && close_to(s->largest, t->largest, tolerance),
       "%s: the same energies and means: %.9g %.9g J", name, s->kinetic, t->kinetic);
    ok(close_to(s->stiffness, t->stiffness, tolerance) && close_to(s->inertia, t->inertia, tolerance) && s->inertia > 0,
       "%s: and differences: %.9g %.9g", name, s->stiffness, t->stiffness);
    ok(close_to(s->stable, t->stable, .011) && s->broken == t->broken, "%s: the stable step %.6g, %.6g ms", name,
       1e3 * s->stable, 1e3 * t->stable);
    w->raise = v->raise = 1;
    bench_must(monitor_read(w, cuda, state, tled_time(&plan, 0), &b.e), &b.e);
    bench_must(monitor_read(v, &blind, state, tled_time(&plan, 0), &b.e), &b.e);
    ok(close_to(s->stable, t->stable, 1e-12), "%s: exactly %.12g, %.12g ms", name, 1e3 * s->stable, 1e3 * t->stable);
    cuda->destroy(state);
    monitor_destroy(w);
    monitor_destroy(v);
    bench_free(&b);
}

#endif
