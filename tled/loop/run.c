#include "tled/loop/run.h"

#include "base/clock.h"
#include "tled/loop/multigrid.h"
#include "tled/loop/run_parts.h"
#include "tled/loop/timeline.h"
#include "tled/problem/collider.h"
#include "tled/problem/step.h"

#include <math.h>
#include <stdlib.h>

enum {
    CHECKPOINTS = 60, /* seconds between them, by the clock */
    STUCK = 5000      /* steps, at least, without coming closer to rest, before a run fails */
};

/* Of the slowest motion that is damped critically between two corrections; see the diary of the benchmarks. */
static const double SMOOTHED = 3;

/* ---- What is decided at a check */

/* Chooses how often a step is cut: from the state alone, so that it is the same whatever went before. */
static int choose_step(run *n)
{
    if (n->live)
        run_choose_parts(n);
    if (n->r->rate_fixed || n->live)
        return 0;
    for (n->course.cuts = 0; n->course.cuts <= CUTS_MAX; n->course.cuts++)
        if (run_margin(n) * n->monitor->reading.stable >= run_part(n))
            return 0;
    n->course.cuts = CUTS_MAX;
    return run_diverged(n);
}

/* Once nothing acts anew: steps as long as they may be, uncut, if that is a gain. Times go on from now. */
static void hasten(run *n)
{
    const double now = run_now(n), longest = RUN_HASTE * n->monitor->reading.stable;
    if (n->r->rate_fixed || n->live || longest < 1.05 * run_part(n))
        return;
    n->plan.rate = 1 / longest;
    n->plan.origin = now - (double)n->plan.first / n->plan.rate;
    n->course.cuts = 0;
}

static void note_closest(run *n)
{
    if (n->course.closest == INFINITY || n->course.remaining < .9 * n->course.closest) {
        n->course.closest = n->course.remaining;
        n->course.closest_at = n->plan.first;
    }
}

/* Whether single precision comes no closer to rest: for so many steps, and so many periods, it has not. Soon, where it
 * can go on in double: what is asked too early costs time alone. */
static bool is_stuck(const run *n)
{
    const double period = 2 * acos(-1) / n->course.relax.lowest * n->plan.rate;
    const double since = (double)(n->plan.first - n->course.closest_at);
    if (!n->r->single || n->course.finer > 0)
        return false;
    return since > (n->r->finer ? period : fmax(STUCK, 20 * period));
}

/* Where memory is short for two states, one is at a time. */
int run_go_on_from(run *n, const tled_executor *device, const field_values *values)
{
    const run_setup *r = n->r;
    frame_writer *writer = n->writer;
    n->writer = NULL;
    n->sent = 0;
    if (frame_writer_close(writer, n->e))
        return -1;
    n->device->destroy(n->state);
    n->moved = *r->p;
    n->moved.at_start = *values;
    n->moved.start = run_now(n);
    n->device = device;
    n->state = device->create(&n->moved, r->threads, n->e);
    n->moved.at_start = r->p->at_start;
    n->writer = n->state ? frame_writer_create(r->p, n->device, n->state, r->frame, r->last, r->context, n->e) : NULL;
    return n->writer ? 0 : -1;
}

/* Goes on in double, at a check: all frames before are written by then. */
int run_refine(run *n)
{
    const run_setup *r = n->r;
    field_values values = {{0}};
    int failed = fields_allocate(&r->p->fields, FIELDS_ALL, &values, "the state to go on from", n->e);
    for (int i = 0; i < r->p->fields.count && !failed; i++)
        failed = n->device->get(n->state, i, values.of[i], n->e);
    failed = failed || run_go_on_from(n, r->finer, &values);
    fields_free(&values);
    if (failed)
        return -1;
    if (r->refined)
        r->refined(r->context, run_now(n), n->course.closest);
    if (r->coarser)
        multigrid_refine(r->coarser);
    n->course.finer = 1;
    n->course.closest = INFINITY;
    return 0;
}

/* A little less than critical damping: the last of a motion at that frequency is gone sooner. What far higher damping
 * was for is over by the next check, while Rayleigh's quotient, of the way since the last one, still has it: from there
 * it falls to a tenth at once, if it asks for less at all, but not below what the guess asks for. */
static double adapted(const run *n)
{
    const relax *x = &n->course.relax;
    const double wanted = RELAX_DAMPING * x->frequency, was = n->course.damping;
    const double least = fmax(was / 10, RELAX_DAMPING * x->guess);
    return x->states > 1 && was > least ? fmin(wanted, least) : wanted;
}

/* Between corrections steps are to take away the fast motions alone, which coarser models do not have: critical for one
 * that falls in that time by SMOOTHED of its radians. */
static double smoothing(const run *n)
{
    return 2 * SMOOTHED * n->plan.rate / (double)n->check;
}

/* Estimates from the reading how the tissue moves, which sets the damping, and whether it is at rest. */
static int judge_rest(run *n)
{
    const run_setup *r = n->r;
    if (run_corrects(n) && run_read_way(n))
        return -1;
    relax_update(&n->course.relax, &n->monitor->reading);
    if (r->adapt)
        n->course.damping = run_corrects(n) ? smoothing(n) : adapted(n);
    n->course.remaining = relax_share(&n->course.relax, &n->monitor->reading);
    n->rested = n->course.remaining <= r->rest;
    if (n->rested)
        return 0;
    note_closest(n);
    if (!is_stuck(n))
        return 0;
    if (r->finer)
        return run_refine(n);
    return err_set(n->e, NULL, 0,
                   "not at rest: single precision leaves %.3g of the displacement to go; expected at most %.3g, a "
                   "larger --rest, or --precision double",
                   n->course.closest, r->rest);
}

/* Decides at a check, from the reading of its state: the step, the damping, and whether the run is over. */
static int decide(run *n)
{
    const run_setup *r = n->r;
    const monitor_reading *s = &n->monitor->reading;
    const bool settles = r->rest >= 0 && s->time >= collider_events_end(r->p);
    n->course.most_strain = fmax(n->course.most_strain, s->strain);
    if (choose_step(n))
        return -1;
    if (settles)
        hasten(n);
    run_tell_cut(n, s);
    const int result = settles ? judge_rest(n) : 0;
    r->checked(r->context, n->plan.first - n->course.from, s, n->course.remaining, INT64_C(1) << n->course.cuts,
               n->course.damping);
    if (result || !settles || n->rested || n->course.relax.states < 2 || !run_corrects(n))
        return result;
    return run_correct(n) ? -1 : 0;
}

/* ---- Checkpoints */

static run_point point_of(const run *n)
{
    return (run_point){.origin = n->plan.origin,
                       .rate = n->plan.rate,
                       .first = n->plan.first,
                       .moved_most = n->monitor->reading.moved_most,
                       .course = n->course,
                       .log = n->r->log ? log_point_of(n->r->log) : (log_point){.length = 0}};
}

static void resume_from(run *n, const run_point *at)
{
    n->plan.origin = at->origin;
    if (at->rate > 0)
        n->plan.rate = at->rate;
    n->plan.first = at->first;
    n->monitor->reading.moved_most = at->moved_most;
    n->course = at->course;
}

/* Whether it is time for a checkpoint; if so, also notes when the next one is. */
static bool is_checkpoint_due(run *n)
{
    const double every = n->r->save_every > 0 ? n->r->save_every : CHECKPOINTS;
    if (!n->r->save)
        return false;
    const double at = n->r->save_every > 0 ? run_now(n) : clock_now();
    if (at < n->next_checkpoint)
        return false;
    n->next_checkpoint = (floor(at / every) + 1) * every;
    return true;
}

/* Saves the state that was monitored last, once all frames before it are written and all rows of the log are stored. */
static int write_checkpoint(run *n)
{
    const run_setup *r = n->r;
    const run_point at = point_of(n);
    if (n->sent && frame_writer_wait(n->writer, n->sent - 1, n->e))
        return -1;
    if (r->log && log_store(r->log, n->e))
        return -1;
    for (int i = 0; i < r->p->fields.count; i++)
        if (n->checkpoint.of[i] && n->device->get(n->state, i, n->checkpoint.of[i], n->e))
            return -1;
    return r->save(r->context, &at, run_now(n), &n->checkpoint, n->e);
}

/* ---- The loop */

static int begin_log(run *n)
{
    const run_setup *r = n->r;
    if (r->log && r->point && r->point->log.length)
        return log_resume(r->log, n->device, n->state, run_now(n), &r->point->log, n->e);
    return run_log_sound(n, run_due_now(n).row);
}

/* The first check. A run that goes on from a checkpoint has decided there. */
int run_begin(run *n)
{
    if (run_monitor(n))
        return -1;
    if (n->monitor->reading.broken >= 0)
        return run_diverged(n);
    if (!n->r->point && decide(n))
        return -1;
    if (!run_is_sound(n))
        return run_diverged(n);
    n->dt = run_part(n);
    if (begin_log(n))
        return -1;
    return n->r->first ? run_write_frame(n) : 0;
}

/* The next check, or the end. */
static int64_t next_check(const run *n)
{
    const int64_t at = (n->plan.first / n->check + 1) * n->check;
    return at < n->last ? at : n->last;
}

/* From a check to the next one, or to the end, which need not be a check. */
static int step_to_next_check(run *n)
{
    const int64_t to = next_check(n);
    if (is_checkpoint_due(n) && write_checkpoint(n))
        return -1;
    if (run_advance(n, to))
        return -1;
    const run_due due = run_due_now(n);
    if (to % n->check == 0 && decide(n))
        return -1;
    if (run_log_sound(n, due.row))
        return -1;
    return due.frame ? run_write_frame(n) : 0;
}

/* The last state is always in a frame. */
static int end_with_frame(run *n)
{
    const run_setup *r = n->r;
    if (r->log && log_end(r->log, n->e))
        return -1;
    if (r->rest >= 0 && !n->rested)
        return err_set(n->e, NULL, 0,
                       "not at rest after %lld steps, %.6g s: %.3g of the displacement is still to go; expected at "
                       "most %.3g, a larger --rest, or -t to end at a time",
                       (long long)(n->plan.first - n->course.from), n->monitor->reading.time, n->course.remaining,
                       r->rest);
    return n->written == n->plan.first ? 0 : run_write_frame(n);
}

static int loop(run *n)
{
    if (run_begin(n))
        return -1;
    while (!n->rested && n->plan.first < n->last)
        if (step_to_next_check(n))
            return -1;
    return end_with_frame(n);
}

/* ---- What a run has */

/* As many as frames between two checks, and one that is still being fetched; where those are too many, fewer. */
static int choose_slots(const run_setup *r)
{
    double between = r->every > 0 ? ceil((double)r->check / r->rate / r->every) : 0;
    return between + 2 < TLED_SLOTS ? (int)between + 2 : TLED_SLOTS;
}

static int make_monitor(run *n)
{
    const run_setup *r = n->r;
    n->monitor = monitor_create(r->p, r->threads, n->e);
    if (!n->monitor)
        return -1;
    if (r->rate_fixed)
        n->monitor->raise = 1;
    n->monitor->differences = r->rest >= 0 && !r->coarser;
    return 0;
}

/* The last step, and whether r->end lies within it. */
static void find_last(run *n)
{
    const run_setup *r = n->r;
    n->last = n->course.from + r->steps;
    const double begins = tled_time(&n->plan, n->last - 1 - n->plan.first);
    n->is_last_short = r->steps > 0 && r->end > begins && r->end < tled_time(&n->plan, n->last - n->plan.first) &&
                       timeline_is_between(r->end - begins, r->rate);
}

static int make_state(run *n)
{
    const run_setup *r = n->r;
    if (r->save && fields_allocate(&r->p->fields, FIELD_IN_CHECKPOINTS, &n->checkpoint, "the state to save", n->e))
        return -1;
    n->device = n->course.finer > 0 && r->finer ? r->finer : r->device;
    n->state = n->device->create(r->p, r->threads, n->e);
    if (!n->state)
        return -1;
    n->writer = frame_writer_create(r->p, n->device, n->state, r->frame, r->last, r->context, n->e);
    return n->writer ? 0 : -1;
}

static int prepare(run *n)
{
    const run_setup *r = n->r;
    n->slots = choose_slots(r);
    n->check = r->check;
    if (r->coarser && r->smooth)
        n->check = r->smooth;
    if (make_monitor(n) || (r->log && log_begin(r->log, r->p, r->threads, n->e)))
        return -1;
    n->course.relax = relax_of(r->frequency, n->monitor->rest_step);
    if (r->point)
        resume_from(n, r->point);
    find_last(n);
    if (r->coarser && run_corrector_make(n))
        return -1;
    return make_state(n);
}

/* However the run ended, also where it was not prepared to its end. */
static run_end end_of(const run *n)
{
    run_end end = {.steps = n->plan.first - n->course.from,
                   .taken = n->course.taken,
                   .corrections = run_corrections(n),
                   .parts = INT64_C(1) << n->cuts_told,
                   .rested = n->rested,
                   .remaining = n->course.remaining,
                   .most_strain = n->course.most_strain,
                   .crowded = n->crowded};
    if (n->monitor)
        end.reading = n->monitor->reading;
    if (n->state)
        end.bytes = n->device->bytes(n->state);
    return end;
}

int run_count_crowded(run *n, err *e)
{
    const tled_executor *device = n->device;
    int64_t count = 0;
    if (n->state && device->crowded && device->crowded(n->state, &count, e))
        return -1;
    n->crowded = count > n->crowded ? count : n->crowded;
    return 0;
}

int run_by(const run_setup *r, const run_live *live, int (*by)(run *n), run_end *end, err *e)
{
    run n = {.r = r,
             .live = live,
             .plan = timeline_plan(r->p->start, r->rate),
             .written = INT64_MIN,
             .course = {.damping = r->damping, .closest = INFINITY, .remaining = INFINITY},
             .next_checkpoint = -INFINITY,
             .e = e};
    n.course.from = n.course.closest_at = n.plan.first;
    int result = prepare(&n) ? -1 : by(&n);
    if (!result && r->ended)
        result = r->ended(r->context, n.device, n.state, run_now(&n), e);
    err later = {0}; /* the first is the one that is told */
    if (run_count_crowded(&n, result ? &later : e))
        result = -1;
    *end = end_of(&n);
    if (frame_writer_close(n.writer, e)) /* what is sound is written whatever happened then */
        result = -1;
    if (n.state)
        n.device->destroy(n.state);
    monitor_destroy(n.monitor);
    run_corrector_free(n.corrector);
    fields_free(&n.checkpoint);
    fields_free(&n.began);
    return result;
}

int run_go(const run_setup *r, run_end *end, err *e)
{
    return run_by(r, NULL, loop, end, e);
}
