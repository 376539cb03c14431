/* A live run of a block without a clock, with lines that come before its ticks, for tests of the executors.
 */
#ifndef SINEW_TLED_LIVE_TRIAL_H
#define SINEW_TLED_LIVE_TRIAL_H

#include "tled_card.h"

static const block trial_block = {{4, 3, 5}, {.01, .012, .009}, 3000, .45, 1000, 30000, 2, 1, 0, {1, 0, 0}, 0, false};

/* For trial_touch. */
static const block trial_touching = {
    {5, 3, 2 * SKIN_MIDDLE}, {.01, .012, .009}, 3000, .45, 1000, 30000, 0, 1, 0, {1, 0, 0}, 0, false};

enum { TRIAL_TICKS = 24, TRIAL_RATE = 60 };

/* What comes before which tick. */
typedef struct trial_event {
    int tick;
    const char *line;
} trial_event;

static const trial_event trial_lines[] = {{1, "now gravity 0,0,-4"},
                                          {3, "now force 20mm,12mm,45mm 13mm .02,0,.01"},
                                          {5, "pull p 40mm,36mm,45mm 13mm 45mm,36mm,50mm 6"},
                                          {6, "pull p 40mm,36mm,45mm 13mm 48mm,36mm,50mm 6"},
                                          {7, "now contract m .3"},
                                          {9, "now displace 0,0,0,1,1,0 1mm,-,-"},
                                          {10, "now displace 0,0,0,1,1,0 2mm,-,-"},
                                          {11, "pull p 40mm,36mm,45mm 9mm 48mm,36mm,50mm 6"},
                                          {12, "pull q 0,0,45mm 13mm 0,0,50mm 6"},
                                          {13, "now move rod 0,0,1mm 0,0.03,0,0.99955 about 0,0,2cm"},
                                          {14, "release p"},
                                          {15, "now displace 0,0,45mm,12mm,13mm,45mm -,-,2mm"},
                                          {16, "now move rod 0,1mm,1mm 0,0.05,0.02,0.99855"},
                                          {16, "now force 20mm,12mm,45mm 13mm 0,0,0"},
                                          {17, "now pull r 0,36mm,45mm 13mm 0,36mm,50mm 6"},
                                          {20, "now release r"},
                                          {0, NULL}};

/* Nodes that slide, and nodes of skin, are held and moved. */
static const trial_event trial_touching_lines[] = {{1, "now gravity 0,0,-4"},
                                                   {2, "now displace 2cm,0,0,1,1,0 .5mm,-,-"},
                                                   {4, "now displace 3cm,0,27mm,1,1,27mm -,1mm,-"},
                                                   {6, "now contract m .2"},
                                                   {8, "now move rod 0,0,1mm 0,0.03,0,0.99955 about 0,0,2cm"},
                                                   {11, "now displace 3cm,0,27mm,1,1,27mm -,2mm,-"},
                                                   {13, "now displace 2cm,0,0,1,1,0 1mm,-,-"},
                                                   {14, "now displace 0,0,0,0,1,0 2mm,-,-"},
                                                   {0, NULL}};

typedef struct live_trial {
    bench b; /* first: the context of frames */
    run_live live;
    const trial_event *next;
    int tick, broke;
    int64_t taken, restored;
    double *seen; /* displacements before the last tick */
} live_trial;

static inline int trial_take(void *context, const run_tick *at, bool *anew, err *e)
{
    live_trial *t = context;
    double *u = t->seen;
    const int now_is = t->tick++;
    int status = at->displacement(at->run, u, e);
    for (; !status && t->next->line && t->next->tick == now_is; t->next++) {
        char text[200];
        keyfile k = {.name = "live"};
        const script_now now = {at->from, at->until, u};
        snprintf(text, sizeof text, "%s", t->next->line);
        keyfile_take(&k, text, (int64_t)strlen(text), now_is, e);
        status = script_take_now(&t->b.script, &t->b.m, &k, &now, anew, e);
    }
    return status ? -1 : 1;
}

static inline int trial_put(void *context, double time, int64_t taken, int restored, err *e)
{
    live_trial *t = context;
    (void)time, (void)e;
    t->taken += taken;
    t->restored += restored;
    return 0;
}

static inline void trial_broke(void *context, double time, double until, bool anew, const monitor_reading *reading)
{
    live_trial *t = context;
    const script_now now = {time, until, NULL};
    (void)reading;
    script_release_all(&t->b.script, &now);
    if (anew)
        script_forget_all(&t->b.script, &now);
    t->broke++;
}

/* Without the metadata, a block of boxes is a mesh like any other. */
static inline void trial_forget_lattice(model *m)
{
    for (int i = 0; i < m->metas; i++) {
        free(m->meta[i].key);
        free(m->meta[i].value);
    }
    m->metas = 0;
    lookup_free(&m->meta_index);
}

static inline void trial_begin(live_trial *t, const block *what, bool mesh, const trial_event *events, int threads)
{
    bench *b = &t->b;
    memset(t, 0, sizeof *t);
    block_make(what, &b->m);
    block_add_body(&b->m, "rod", (const double[]){0, 0, .009, 0, 0, .036});
    if (mesh)
        trial_forget_lattice(&b->m);
    bench_must(script_add_idle(&b->script, &b->m, &b->e) ||
                   tled_problem_make(&b->problem, &b->m, &b->script, PHYSICAL, &b->e),
               &b->e);
    if (in_sliding)
        add_sliding(b, what);
    if (in_touching)
        add_skin(b, what);
    bench_finish(b, threads);
    bench_steps(b, TRIAL_TICKS, b->setup.damping);
    const double parts = ceil(1. / TRIAL_RATE / (RUN_MARGIN * step_at_rest(&b->problem, NULL)));
    b->problem.spare_curves = 8;
    b->problem.spare_nodes = 1000;
    b->setup.rate = TRIAL_RATE;
    b->setup.check = 1;
    b->setup.first = true;
    b->setup.context = t;
    t->next = events;
    t->seen = calloc(3 * (size_t)b->problem.nodes, sizeof *t->seen);
    bench_must(!t->seen, &b->e);
    t->live = (run_live){.p = &b->problem,
                         .m = &b->m,
                         .tick = 1,
                         .parts = (int64_t)parts,
                         .take = trial_take,
                         .put = trial_put,
                         .broke = trial_broke};
}

static inline int trial_go(live_trial *t)
{
    return run_live_go(&t->b.setup, &t->live, &t->b.end, &t->b.e);
}

static inline void trial_free(live_trial *t)
{
    free(t->seen);
    bench_free(&t->b);
}

/* Two executors, live, beside each other: the same to the end but for `least` of the largest displacement. */
static inline void trial_beside(const block *what, const trial_event *events, const tled_executor *one,
                                const tled_executor *other, double least, const char *name)
{
    live_trial here, there;
    double most = 0, off = 0;
    trial_begin(&here, what, false, events, 1);
    trial_begin(&there, what, false, events, 1);
    here.b.setup.device = one;
    there.b.setup.device = other;
    ok(!trial_go(&here) && !trial_go(&there), "%s, live: goes on to its end %s", name, there.b.e.text);
    for (int64_t i = 0; i < 3 * here.b.problem.nodes; i++) {
        most = fmax(most, fabs(here.seen[i]));
        off = fmax(off, fabs(here.seen[i] - there.seen[i]));
    }
    ok(most > 1e-3 && off < least * most && there.b.frames == here.b.frames, "%s, live: as on a processor, to %.1e",
       name, off / most);
    trial_free(&here);
    trial_free(&there);
}

/* From here on, or no longer, skin of a slit touches itself and a bone below, on which nodes slide: for
 * trial_touching. */
static inline void trial_touch(bool is)
{
    static const touching all = {.3, true, true};
    in_slit = is ? &slits[2] : NULL;
    in_touching = is ? &all : NULL;
    in_sliding = is;
}

#endif
