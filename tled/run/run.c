#include "tled/run/run.h"

#include "base/mem.h"
#include "cli/progress.h"
#include "tled/problem/collider.h"
#include "tled/problem/step.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    CUTS_MAX = 10, /* a step cut 2^10 times is no step */
    SAVES = 60,    /* seconds between saves, by the clock */
    STUCK = 5000   /* steps, at least, without coming closer to rest */
};

/* A step is safe up to this share of the stable one: it changes a little between two checks. */
static const double margin = .8;

typedef struct run {
    const run_setup *r;
    void *state;
    watch *watch;
    relax relax;
    outbox *out;
    tled_plan plan;     /* plan.first: steps counted */
    int64_t from;       /* the first of this run */
    int64_t last;       /* where it ends at the latest */
    bool is_last_short; /* the step to there, which ends at r->end */
    int64_t kept_first; /* plan.first of the state that is kept: that at the last check */
    /* Frames are numbered, and taken into slots by their numbers modulo `slots`: `sent` of them are the outbox's, then come
     * those not yet known to be sound. */
    int slots;
    double frame_time[TLED_TAKEN];
    int64_t sent;
    int unsure;
    int cuts;
    int cuts_told;
    double damping;
    double dt, damped; /* s, 1/s: of the last steps */
    int64_t taken;     /* steps, each part of a cut one for itself, and those that were taken again */
    double closest;    /* to rest so far, as a share; and the step that it came so close in */
    int64_t closest_at;
    double remaining;
    double most_strain; /* J: at a check, so far */
    double *saved;      /* nodes x 6, to be filled: displacement, then velocity; NULL: nothing is to be saved */
    double next_save;   /* s: of the model's time, or of the clock */
    err *e;
} run;

/* Of a step: what is no farther from a whole number of them is one. */
static const double run_tolerance = 1e-6;

int64_t run_steps_to(double t, double rate)
{
    return (int64_t)fmin(ceil(t * rate - run_tolerance), 9e18); /* farther than any run */
}

bool run_is_between(double t, double rate)
{
    return ceil(t * rate - run_tolerance) - t * rate > run_tolerance;
}

tled_plan run_plan(double start, double rate)
{
    double steps = nearbyint(start * rate);
    tled_plan plan = {.rate = rate};
    if (fabs(steps) < 1e15 && steps / rate == start)
        plan.first = (int64_t)steps;
    else
        plan.origin = start;
    return plan;
}

double run_share(const watch_sight *s, double way)
{
    return way == 0 ? 0 : way / fmax(s->moved, .01 * s->moved_most);
}

/* Where the state of now stands (s). */
static double now(const run *n)
{
    return n->is_last_short && n->plan.first == n->last ? n->r->end : tled_time(&n->plan, 0);
}

static double step_now(const run *n)
{
    return ldexp(1 / n->r->rate, -n->cuts);
}

/* Status 3, with where and when, of what was looked at last. Returns -1. */
static int diverged(run *n)
{
    const tled_problem *p = n->r->p;
    const watch_sight *s = &n->watch->sight;
    if (watch_tell(n->watch, n->r->device, n->state, n->e))
        return -1;
    int64_t element = s->broken >= 0 ? s->broken : s->stable_element >= 0 ? s->stable_element : 0;
    char what[200] = "is no longer finite";
    if (s->broken >= 0 && s->inverted)
        snprintf(what, sizeof what, "is inverted");
    else if (s->broken < 0)
        snprintf(what, sizeof what, "has a stable step of %.3g ms now, below the step of %.3g ms%s", 1e3 * s->stable,
                 1e3 * step_now(n), n->r->rate_fixed ? "; expected a smaller --dt" : "");
    err_set(n->e, NULL, 0, "diverged at step %lld, %.6g s: element %lld (volume '%s') %s",
            (long long)(n->plan.first - n->from), s->time, (long long)element,
            p->volume[p->element_volume[element]].name, what);
    n->e->status = STATUS_DIVERGED;
    return -1;
}

static int look_at(run *n, double time)
{
    return watch_look(n->watch, n->r->device, n->state, time, n->e);
}

static int look(run *n)
{
    return look_at(n, now(n));
}

/* Whether the steps of now can have led to what was looked at last: nothing is broken, and they are stable still. */
static bool is_sound(const run *n)
{
    const watch_sight *s = &n->watch->sight;
    return s->broken < 0 && s->stable >= step_now(n) * (1 - 1e-12);
}

/* Accounts for the state of now in the log; `shown`, by a row. */
static int log_state(run *n, bool shown)
{
    const log_row row = {.step = n->plan.first - n->from,
                         .taken = n->taken,
                         .time = now(n),
                         .dt = n->dt,
                         .stable = n->watch->sight.stable,
                         .damping = n->damped,
                         .remaining = n->remaining};
    return log_look(n->r->log, n->r->device, n->state, &row, shown, n->e);
}

/* Keeps what was looked at last, to come back to. */
static int keep(run *n)
{
    n->kept_first = n->plan.first;
    return watch_keep(n->watch, n->r->device, n->state, n->e);
}

static int go_back(run *n)
{
    n->plan.first = n->kept_first;
    if (n->r->log && log_back(n->r->log, n->e))
        return -1;
    return n->r->device->back(n->state, n->e);
}

/* Says so where steps are cut in more parts than they ever were, and why. */
static void tell_cut(run *n, const watch_sight *why)
{
    if (n->cuts <= n->cuts_told)
        return;
    n->cuts_told = n->cuts;
    if (n->r->cut)
        n->r->cut(n->r->context, why, INT64_C(1) << n->cuts);
}

/* Chooses how often a step is cut: from the state alone, so that it is the same whatever went before. */
static int choose_step(run *n)
{
    if (n->r->rate_fixed)
        return 0;
    for (n->cuts = 0; n->cuts <= CUTS_MAX; n->cuts++)
        if (margin * n->watch->sight.stable >= step_now(n))
            return 0;
    n->cuts = CUTS_MAX;
    return diverged(n);
}

/* The steps from `first` on, as they are cut: all of one length, but the last where it is short. Of that one times are
 * counted back from its end, so that this is met to the last bit. */
static tled_plan cut_plan(const run *n, int64_t first)
{
    const int64_t parts = INT64_C(1) << n->cuts;
    tled_plan cut = {n->plan.origin, n->plan.rate * (double)parts, first * parts, n->damping};
    if (n->is_last_short && first == n->last - 1) {
        const double begins = tled_time(&n->plan, first - n->plan.first);
        cut = (tled_plan){n->r->end, (double)parts / (n->r->end - begins), -parts, n->damping};
    }
    return cut;
}

/* Steps of one length. */
static int step_to(run *n, int64_t to)
{
    const int64_t count = (to - n->plan.first) << n->cuts;
    const tled_plan cut = cut_plan(n, n->plan.first);
    if (n->r->device->step(n->state, &cut, count, n->e))
        return -1;
    n->dt = 1 / cut.rate;
    n->damped = n->damping;
    n->taken += count;
    n->plan.first = to;
    return 0;
}

static int advance(run *n, int64_t to)
{
    const int64_t even = n->is_last_short && to == n->last ? to - 1 : to;
    if (even > n->plan.first && step_to(n, even))
        return -1;
    return to > n->plan.first ? step_to(n, to) : 0;
}

/* Takes a frame of the state of now, which may yet turn out to be unsound. */
static int take(run *n)
{
    int64_t index = n->sent + n->unsure++;
    if (index >= n->slots && outbox_wait_fetched(n->out, index - n->slots, n->e))
        return -1;
    n->frame_time[index % n->slots] = now(n);
    return n->r->device->take(n->state, (int)(index % n->slots), n->e);
}

/* Those not known to be sound are: hands them on. */
static void send(run *n)
{
    for (; n->unsure; n->unsure--, n->sent++)
        outbox_send(n->out, (int)(n->sent % n->slots), n->frame_time[n->sent % n->slots]);
}

/* Of a state that is sound, as all before it are. */
static int write_frame(run *n)
{
    if (take(n))
        return -1;
    send(n);
    return 0;
}

/* The first step past `after` at or past a multiple of so many seconds; 0: never. */
static int64_t next_multiple(const run *n, double every, int64_t after)
{
    int64_t at = after;
    if (every == 0)
        return INT64_MAX;
    if (every * n->r->rate <= 1)
        return at + 1;
    double passed = floor(tled_time(&n->plan, after - n->plan.first) / every);
    for (int more = 0; at <= after; more++)
        at = run_steps_to((passed + more) * every - n->plan.origin, n->r->rate);
    return at;
}

/* The first step past `after` with a frame; with a row of the log, but for those at checks. */
static int64_t next_frame(const run *n, int64_t after)
{
    return next_multiple(n, n->r->every, after);
}

static int64_t next_row(const run *n, int64_t after)
{
    return next_multiple(n, n->r->log ? n->r->log->every : 0, after);
}

/* Of a state that is sound: in the log, where there is one, and a row of it where one is due. */
static int log_sound(run *n)
{
    run_log *log = n->r->log;
    if (!log)
        return 0;
    bool shown = log->every == 0 || next_row(n, n->plan.first - 1) == n->plan.first;
    return log_state(n, shown) || log_keep(log, n->e) ? -1 : 0;
}

/* Of the state that the run begins from. */
static int begin_log(run *n)
{
    const run_setup *r = n->r;
    if (r->log && r->point && r->point->log.length)
        return log_go_on(r->log, r->device, n->state, now(n), &r->point->log, n->e);
    return log_sound(n);
}

/* One part after another of the step past what is kept, until it breaks. */
static int find_part(run *n)
{
    int64_t parts = INT64_C(1) << n->cuts;
    tled_plan cut = cut_plan(n, n->kept_first);
    if (go_back(n))
        return -1;
    n->plan.first++;
    for (int64_t i = 0; i < parts; i++, cut.first++)
        if (n->r->device->step(n->state, &cut, 1, n->e) || look_at(n, tled_time(&cut, 1)))
            return -1;
        else if (!is_sound(n))
            break;
    return diverged(n);
}

/* What lies before `to` is not sound: goes there again, looking after each step, to say where and when it broke, and with the
 * frames before that. Returns -1. */
static int find_break(run *n, int64_t to)
{
    if (go_back(n))
        return -1;
    while (n->plan.first < to) {
        if (advance(n, n->plan.first + 1) || look(n))
            return -1;
        if (!is_sound(n))
            break;
        if (log_sound(n) || keep(n) || (next_frame(n, n->plan.first - 1) == n->plan.first && write_frame(n)))
            return -1;
    }
    return find_part(n);
}

/* Whether the frames before `to` are few enough to be taken on the way. */
static bool can_take(const run *n, int64_t to)
{
    int64_t at = n->plan.first;
    for (int count = 0; count < n->slots; count++) {
        at = next_frame(n, at);
        if (at >= to)
            return true;
    }
    return false;
}

/* Goes to `to`, taking frames if so asked and making rows of the log on the way. */
static int go_by(run *n, int64_t to, bool taking)
{
    for (;;) {
        int64_t shot = taking ? next_frame(n, n->plan.first) : INT64_MAX, row = next_row(n, n->plan.first);
        int64_t at = shot < row ? shot : row;
        if (at >= to)
            return advance(n, to);
        if (advance(n, at) || (at == shot && take(n)) || (at == row && log_state(n, true)))
            return -1;
    }
}

/* Goes to the next check, or the end, in steps that are cut until its state is sound, taking frames if so asked. */
static int cut_to(run *n, int64_t to, bool taking)
{
    const int cuts = n->cuts;
    watch_sight why = n->watch->sight;
    for (;; n->cuts++) {
        if (go_by(n, to, taking) || look(n))
            return -1;
        if (is_sound(n))
            break;
        n->unsure = 0;
        why = n->cuts == cuts ? n->watch->sight : why;
        if (n->r->rate_fixed || n->cuts == CUTS_MAX)
            return find_break(n, to);
        if (go_back(n))
            return -1;
    }
    send(n);
    tell_cut(n, &why);
    return n->r->log ? log_keep(n->r->log, n->e) : 0;
}

/* Goes on from what is kept to the next check, or the end, with the frames before it. */
static int go_to(run *n, int64_t to)
{
    bool taking = can_take(n, to);
    if (cut_to(n, to, taking))
        return -1;
    if (taking)
        return 0;
    if (go_back(n))
        return -1;
    for (int64_t at = next_frame(n, n->plan.first); at < to; at = next_frame(n, at))
        if (advance(n, at) || write_frame(n))
            return -1;
    return advance(n, to) || look(n) ? -1 : 0;
}

/* At rest, or single precision comes no closer. Returns -1, or whether it is at rest. */
static int is_at_rest(run *n)
{
    const run_setup *r = n->r;
    const watch_sight *s = &n->watch->sight;
    double period = 2 * acos(-1) / n->relax.lowest;
    double share = n->remaining = run_share(s, relax_remaining(&n->relax, s));
    if (share <= r->rest)
        return 1;
    if (n->closest == INFINITY || share < .9 * n->closest) {
        n->closest = share;
        n->closest_at = n->plan.first;
    }
    if (!r->single || (double)(n->plan.first - n->closest_at) <= fmax(STUCK, 20 * period * r->rate))
        return 0;
    return err_set(n->e, NULL, 0,
                   "not at rest: single precision leaves %.3g of the displacement to go; expected at most %.3g, a "
                   "larger --rest, or --precision double",
                   n->closest, r->rest);
}

/* What happens at a check. Returns -1, or whether the run is over. */
static int check(run *n)
{
    const run_setup *r = n->r;
    const watch_sight *s = &n->watch->sight;
    bool settled = r->rest >= 0 && s->time >= collider_events_end(r->p);
    int over = 0;
    n->most_strain = fmax(n->most_strain, s->strain);
    if (choose_step(n))
        return -1;
    tell_cut(n, &n->watch->sight);
    if (settled) {
        relax_update(&n->relax, s);
        over = is_at_rest(n);
    }
    if (settled && r->adapt)
        n->damping = 2 * n->relax.frequency;
    r->checked(r->context, n->plan.first - n->from, s, n->remaining, INT64_C(1) << n->cuts, n->damping);
    return over;
}

static run_point point_of(const run *n)
{
    return (run_point){.origin = n->plan.origin,
                       .first = n->plan.first,
                       .from = n->from,
                       .cuts = n->cuts,
                       .damping = n->damping,
                       .remaining = n->remaining,
                       .closest = n->closest,
                       .closest_at = n->closest_at,
                       .moved_most = n->watch->sight.moved_most,
                       .relax = n->relax,
                       .taken = n->taken,
                       .most_strain = n->most_strain,
                       .log = n->r->log ? log_point_of(n->r->log) : (log_point){.length = 0}};
}

static void go_on_from(run *n, const run_point *at)
{
    n->plan.origin = at->origin;
    n->plan.first = at->first;
    n->from = at->from;
    n->cuts = at->cuts;
    n->damping = at->damping;
    n->remaining = at->remaining;
    n->closest = at->closest;
    n->closest_at = at->closest_at;
    n->watch->sight.moved_most = at->moved_most;
    n->relax = at->relax;
    n->taken = at->taken;
    n->most_strain = at->most_strain;
}

/* Whether it is time to save again; if so, also notes when the next time is. */
static bool is_due(run *n)
{
    const double every = n->r->save_every > 0 ? n->r->save_every : SAVES;
    if (!n->saved)
        return false;
    const double at = n->r->save_every > 0 ? now(n) : progress_clock();
    if (at < n->next_save)
        return false;
    n->next_save = (floor(at / every) + 1) * every;
    return true;
}

/* Saves what was looked at last, once every frame before it is written, and every row of the log stored. */
static int save(run *n)
{
    const run_setup *r = n->r;
    const run_point at = point_of(n);
    double *velocity = n->saved + 3 * r->p->nodes;
    if ((n->sent && outbox_wait(n->out, n->sent - 1, n->e)) || (r->log && log_store(r->log, n->e)) ||
        r->device->get(n->state, TLED_DISPLACEMENT, n->saved, n->e) ||
        r->device->get(n->state, TLED_VELOCITY, velocity, n->e))
        return -1;
    return r->save(r->context, &at, now(n), n->saved, velocity, n->e);
}

/* Steps to the end. Decides only at checks. */
static int loop(run *n, run_end *end)
{
    const run_setup *r = n->r;
    int64_t written = -1;
    int over = look(n) ? -1 : n->watch->sight.broken >= 0 ? diverged(n) : r->point ? 0 : check(n);
    if (over >= 0 && !is_sound(n))
        return diverged(n);
    n->dt = step_now(n);
    if (over >= 0 && begin_log(n))
        return -1;
    if (over >= 0 && r->first) {
        written = n->plan.first;
        over = write_frame(n) ? -1 : over;
    }
    while (!over && n->plan.first < n->last) {
        if (is_due(n) && save(n)) /* here: at a check, and not at the end */
            return -1;
        int64_t to = (n->plan.first / r->check + 1) * r->check;
        to = to < n->last ? to : n->last;
        if (keep(n) || go_to(n, to))
            return -1;
        if (to % r->check == 0)
            over = check(n);
        if (over >= 0 && log_sound(n))
            return -1;
        if (over >= 0 && next_frame(n, to - 1) == to) {
            written = to;
            over = write_frame(n) ? -1 : over;
        }
    }
    if (over >= 0 && r->log && log_end(r->log, n->e))
        return -1;
    end->steps = n->plan.first - n->from;
    end->taken = n->taken;
    end->parts = INT64_C(1) << n->cuts_told;
    end->sight = n->watch->sight;
    end->rested = over > 0;
    end->remaining = n->remaining;
    if (over >= 0 && r->rest >= 0 && !end->rested)
        return err_set(n->e, NULL, 0,
                       "not at rest after %lld steps, %.6g s: %.3g of the displacement is still to go; expected at "
                       "most %.3g, a larger --rest, or -t to end at a time",
                       (long long)end->steps, end->sight.time, n->remaining, r->rest);
    return over < 0 ? -1 : written == n->plan.first ? 0 : write_frame(n);
}

/* As many as frames between two checks, and one that is still being fetched; where those are too many, fewer. */
static int choose_slots(const run_setup *r)
{
    double between = r->every > 0 ? ceil((double)r->check / r->rate / r->every) : 0;
    return between + 2 < TLED_TAKEN ? (int)between + 2 : TLED_TAKEN;
}

static int prepare(run *n)
{
    const run_setup *r = n->r;
    n->slots = choose_slots(r);
    n->watch = watch_create(r->p, r->threads, n->e);
    if (!n->watch)
        return -1;
    if (r->rate_fixed)
        n->watch->raise = 1;
    n->watch->differences = r->rest >= 0;
    if (r->log && log_begin(r->log, r->p, r->threads, n->e))
        return -1;
    n->relax = relax_of(r->frequency, n->watch->rest_step);
    if (r->point)
        go_on_from(n, r->point);
    n->last = n->from + r->steps;
    const double begins = tled_time(&n->plan, n->last - 1 - n->plan.first);
    n->is_last_short = r->steps > 0 && r->end > begins && r->end < tled_time(&n->plan, n->last - n->plan.first) &&
                       run_is_between(r->end - begins, r->rate);
    n->saved = r->save ? mem_array(r->p->nodes, 6 * sizeof *n->saved, "the state to save", n->e) : NULL;
    n->next_save = -INFINITY;
    if (r->save && !n->saved)
        return -1;
    n->state = r->device->create(r->p, r->threads, n->e);
    n->out = n->state ? outbox_create(r->p, r->device, n->state, r->frame, r->context, n->e) : NULL;
    return n->out ? 0 : -1;
}

int run_go(const run_setup *r, run_end *end, err *e)
{
    run n = {.r = r,
             .plan = run_plan(r->p->start, r->rate),
             .damping = r->damping,
             .closest = INFINITY,
             .remaining = INFINITY,
             .e = e};
    n.from = n.closest_at = n.plan.first;
    int result = prepare(&n) ? -1 : loop(&n, end);
    end->most_strain = n.most_strain;
    end->bytes = n.state ? r->device->bytes(n.state) : 0;
    if (outbox_close(n.out, e)) /* what is sound is written whatever happened then */
        result = -1;
    if (n.state)
        r->device->destroy(n.state);
    watch_destroy(n.watch);
    free(n.saved);
    return result;
}
