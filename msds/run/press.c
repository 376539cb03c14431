#include "msds/run/press.h"

#include "base/mem.h"
#include "base/num.h"

#include <stdlib.h>
#include <string.h>

/* Shares of the probe's size: deeper at the first pose is inside, deeper where nothing was touched before as well; how
 * far it goes in one move of easing in. And how many 60ths of a second, say, count between two poses. */
static const double inside_first = .01, inside_later = .25, ease = .25, frames_most = 10;

int press_make(press *s, const msds_problem *p, const probe *shape, int64_t iterations, double rate, err *e)
{
    *s = (press){.p = p, .shape = shape, .iterations = iterations, .rate = rate};
    s->u = mem_array(p->nodes, 3 * sizeof *s->u, "the probe's way", e);
    return s->u ? 0 : -1;
}

void press_free(press *s)
{
    free(s->u);
    *s = (press){0};
}

void press_pace(press *s, int64_t iterations, double rate)
{
    s->iterations = iterations;
    s->rate = rate;
    s->begin = s->time;
    s->due = 0;
}

void press_from(press *s, const pose *at, double time)
{
    s->any = s->timed = true;
    s->last = *at;
    s->time = s->begin = time;
    s->due = 0;
}

void press_reset(press *s)
{
    s->any = false;
    s->contacts = 0;
}

int64_t press_sum(const press_moves *moves)
{
    int64_t sum = 0;
    for (int i = 0; i < moves->count; i++)
        sum += moves->list[i].iterations;
    return sum;
}

/* How deep the deepest free node is in the probe. */
static double deepest(const press *s, const pose *at)
{
    const probe_placed placed = probe_place(s->shape, at);
    double most = -INFINITY;
    for (int64_t n = 0; n < s->p->nodes; n++) {
        double x[3], away = 0;
        for (int a = 0; a < 3; a++) {
            x[a] = s->p->position[3 * n + a] + s->u[3 * n + a];
            away += (x[a] - placed.centre[a]) * (x[a] - placed.centre[a]);
        }
        if (!s->p->fixed[n] && away < placed.reach * placed.reach)
            most = fmax(most, probe_at(&placed, x).depth);
    }
    return most;
}

static pose drawn_back(const press *s, const pose *at, double by)
{
    const probe_placed placed = probe_place(s->shape, at);
    pose back = *at;
    for (int a = 0; a < 3; a++)
        back.position[a] -= by * placed.into[a];
    return back;
}

static double step_between(const press *s, const pose *at)
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += (at->position[a] - s->last.position[a]) * (at->position[a] - s->last.position[a]);
    return sqrt(square);
}

/* From where it touches nothing; or from a hundred times its size, should that not be. */
static void ease_in(const press *s, const pose *at, press_moves *m)
{
    const double stride = .5 * s->shape->size;
    double back = 0;
    for (int i = 0; i < 200 && deepest(s, at) > 0; i++) {
        back += stride;
        pose out = drawn_back(s, at, back);
        if (deepest(s, &out) <= 0)
            break;
    }
    m->back = back;
    m->count = (int)fmin(PRESS_MOVES, fmax(1, ceil(back / (ease * s->shape->size))));
    for (int i = 0; i < m->count; i++)
        m->list[i] = (press_move){drawn_back(s, at, back * (m->count - 1 - i) / m->count), s->iterations};
}

/* Iterations for the time since the last pose. Counted from the beginning, so that no rounding adds up. */
static int64_t iterations_to(press *s, double time)
{
    const double each = (double)s->iterations * s->rate, most = frames_most * (double)s->iterations;
    if (!s->timed || !(time > s->time) || !(s->rate > 0))
        return s->iterations;
    if ((time - s->time) * each > most || (time - s->begin) * each > 1e15) { /* a pause: begin again */
        s->begin = time;
        s->due = 0;
        return (int64_t)fmin(most, ceil((time - s->time) * each));
    }
    int64_t due = (int64_t)floor((time - s->begin) * each + .5), count = due - s->due;
    s->due = due;
    return count > 0 ? count : 1;
}

/* The same live: --iterations at most, of which a late frame leaves as many to the next. */
static int64_t iterations_live(press *s, double time)
{
    const double each = (double)s->iterations * s->rate;
    if (!s->timed || !(time > s->time) || !(s->rate > 0))
        return s->iterations;
    const int64_t due = (int64_t)floor((time - s->begin) * each + .5);
    const int64_t count = num_clamp_int(due - s->due, 1, s->iterations), most_left = s->iterations;
    s->due = due - num_clamp_int(due - s->due - count, 0, most_left);
    return count;
}

static int64_t iterations_of(press *s, const press_frame *f)
{
    if (f->iterations >= 0)
        return f->iterations;
    return s->live ? iterations_live(s, f->time) : iterations_to(s, f->time);
}

static void pass(press *s, double time)
{
    if (!s->timed)
        s->begin = time;
    s->timed = true;
    s->time = time;
}

void press_wait(press *s, const press_frame *f, press_moves *moves)
{
    *moves = (press_moves){.count = 1, .list = {{f->at, iterations_of(s, f)}}};
    pass(s, f->time);
}

static void go_on(press *s, const pose *at, int64_t count, press_moves *m)
{
    int64_t parts = (count + PRESS_TOGETHER - 1) / PRESS_TOGETHER;
    m->count = (int)(parts < PRESS_MOVES ? parts : PRESS_MOVES);
    m->count = s->any ? m->count : 1;
    for (int i = 0; i < m->count; i++) {
        int64_t from = count * i / m->count, to = count * (i + 1) / m->count;
        m->list[i] = (press_move){*at, to - from};
        if (i + 1 < m->count)
            m->list[i].at = pose_between(&s->last, at, (double)to / (double)count);
    }
}

int press_to(press *s, const msds_executor *device, msds_state *state, const press_frame *f, press_moves *moves, err *e)
{
    const pose *at = &f->at;
    const double size = s->shape->size;
    *moves = (press_moves){.count = 0};
    bool look = size > 0 && (!s->any || (!s->contacts && step_between(s, at) > inside_later * size));
    if (look) {
        if (device->get(state, MSDS_DISPLACEMENT, s->u, e))
            return -1;
        double depth = deepest(s, at);
        if (depth > (s->any ? inside_later : inside_first) * size) {
            moves->inside = true;
            ease_in(s, at, moves);
        }
    }
    int64_t count = iterations_of(s, f);
    if (!moves->count && f->springs && size > 0)
        go_on(s, at, count, moves);
    if (!moves->count) {
        moves->count = 1;
        moves->list[0] = (press_move){*at, count};
    }
    pass(s, f->time);
    s->any = true;
    s->last = *at;
    return 0;
}
