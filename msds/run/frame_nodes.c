#include "msds/run/frame_nodes.h"

#include "base/mem.h"

#include <stdlib.h>

enum { WRITERS = 4, CHUNK = 4096 };

static const struct {
    const char *name, *unit;
} arrays[] = {{"node.displacement", "m"}, {"node.velocity", "m/s"}};

enum { DISPLACEMENT, VELOCITY };

/* ---- what is wanted */

static int list_moving(frame_nodes *n, err *e)
{
    uint8_t *is = mem_array(n->nodes, sizeof *is, "the frames", e);
    n->moving = is ? mem_array(n->nodes, sizeof *n->moving, "the frames", e) : NULL;
    if (n->moving)
        frame_choice_mark(n->choice, is);
    for (int64_t i = 0; n->moving && i < n->nodes; i++)
        if (is[i])
            n->moving[n->count++] = (int32_t)i;
    free(is);
    return n->moving ? 0 : -1;
}

static int make_numbers(const frame_nodes *n, bool wanted, double **to, err *e)
{
    *to = wanted ? mem_array(n->nodes, 3 * sizeof **to, "the frames", e) : NULL;
    return wanted && !*to ? -1 : 0;
}

static int make_beside(frame_nodes *n, err *e)
{
    const int threads = pool_threads(n->threads);
    const msds_frames of = {n->displacement, n->velocity, n->displacement ? NULL : n->moving,
                            n->displacement ? 0 : n->count};
    n->writers = pool_create(threads < WRITERS ? threads : WRITERS, e);
    if (!n->writers || n->device->frames(n->state, &of, e))
        return -1;
    for (int i = DISPLACEMENT; i <= VELOCITY; i++)
        if (make_numbers(
                n, (i == VELOCITY ? n->velocity : n->displacement) && !frame_choice_narrow(n->choice, arrays[i].name),
                &n->wide[i], e))
            return -1;
    return 0;
}

int frame_nodes_make(frame_nodes *n, const msds_problem *p, const frame_choice *choice, const model *m, pool *threads,
                     err *e)
{
    n->m = m;
    n->choice = choice;
    n->threads = threads;
    n->nodes = p->nodes;
    n->displacement = frame_choice_has(choice, arrays[DISPLACEMENT].name);
    n->velocity = frame_choice_has(choice, arrays[VELOCITY].name);
    n->moves = frame_choice_moves(choice);
    n->beside = n->device->snapshot && !p->cavities; /* how open these are, is measured by all nodes */
    if (n->moves && list_moving(n, e))
        return -1;
    const bool apart = n->beside ? n->moves : !n->displacement;
    return make_numbers(n, apart, &n->now, e) || (n->beside && make_beside(n, e)) ? -1 : 0;
}

void frame_nodes_free(frame_nodes *n)
{
    pool_destroy(n->writers);
    free(n->moving);
    free(n->now);
    free(n->all);
    free(n->wide[DISPLACEMENT]);
    free(n->wide[VELOCITY]);
    *n = (frame_nodes){.nodes = 0};
}

/* ---- by who sends */

/* Where the numbers stand is known once they are fetched. */
static int lend(const frame_nodes *n, frame *f, int which, err *e)
{
    static const double later = 0;
    return frame_find(f, arrays[which].name) ||
                   frame_lend(f, n->m, arrays[which].name, arrays[which].unit, "node", 3, &later, e)
               ? 0
               : -1;
}

static int get(const frame_nodes *n, frame *f, int which, err *e)
{
    const model_array *a = frame_queue_array(f, n->m, arrays[which].name, e);
    return a ? n->device->get(n->state, which == VELOCITY ? MSDS_VELOCITY : MSDS_DISPLACEMENT, a->f64, e) : -1;
}

/* Frames follow each other by 1, and no more than there are slots are on their way. */
static int slot_of(const frame *f)
{
    return (int)((uint64_t)f->index % MSDS_SLOTS);
}

int frame_nodes_begin(frame_nodes *n, frame *f, err *e)
{
    int (*const add)(const frame_nodes *, frame *, int, err *) = n->beside ? lend : get;
    if ((n->displacement && add(n, f, DISPLACEMENT, e)) || (n->velocity && add(n, f, VELOCITY, e)))
        return -1;
    if (n->beside)
        return n->device->snapshot(n->state, slot_of(f), e);
    return n->displacement ? 0 : n->device->get(n->state, MSDS_DISPLACEMENT, n->now, e);
}

const double *frame_nodes_displacement(frame_nodes *n, const frame *f, err *e)
{
    if (!n->beside)
        return n->displacement ? frame_find(f, arrays[DISPLACEMENT].name)->f64 : n->now;
    if (!n->all && make_numbers(n, true, &n->all, e))
        return NULL;
    return n->device->get(n->state, MSDS_DISPLACEMENT, n->all, e) ? NULL : n->all;
}

/* ---- by who writes */

typedef struct widening {
    const float *from;
    double *to;
} widening;

static void widen_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const widening *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        w->to[i] = (double)w->from[i];
}

/* Makes an array of what was taken: as it is, where that is how it is stored or rounded from. */
static void fill(frame_nodes *n, frame *f, int which, const float *single, const double *precise)
{
    model_array *a = frame_find(f, arrays[which].name);
    widening w = {single, n->wide[which]};
    if (precise)
        model_array_lend(a, MODEL_F64, precise);
    else if (!w.to)
        model_array_lend(a, MODEL_F32, single);
    else {
        pool_run(n->writers, 3 * n->nodes, CHUNK, widen_work, &w);
        model_array_lend(a, MODEL_F64, w.to);
    }
}

/* The displacement of the nodes that move surfaces, where they stand among all. */
static void scatter(const frame_nodes *n, const msds_values *of)
{
    for (int64_t i = 0; i < n->count; i++) {
        const int64_t to = 3 * (int64_t)n->moving[i], from = n->displacement ? to : 3 * i;
        for (int a = 0; a < 3; a++)
            n->now[to + a] = of->precise ? of->precise[from + a] : (double)of->displacement[from + a];
    }
}

static int fetch(frame_nodes *n, frame *f, err *e)
{
    msds_values of;
    if (n->device->fetch(n->state, slot_of(f), &of, e))
        return -1;
    if (n->displacement)
        fill(n, f, DISPLACEMENT, of.displacement, of.precise);
    if (n->velocity)
        fill(n, f, VELOCITY, of.velocity, NULL);
    if (n->moves)
        scatter(n, &of);
    return 0;
}

int frame_nodes_end(frame_nodes *n, frame *f, bool writes, err *e)
{
    if (writes != n->beside)
        return 0;
    if (writes && fetch(n, f, e))
        return -1;
    const double *u = writes ? n->now : frame_nodes_displacement(n, f, e);
    if (n->moves && frame_choice_add_surfaces(n->choice, f, n->m, u, writes ? n->writers : n->threads, e))
        return -1;
    frame_choice_take(n->choice, f);
    return 0;
}
