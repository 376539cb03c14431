#include "msds/run/press.h"

#include "base/mem.h"
#include "base/num.h"

#include <stdlib.h>
#include <string.h>

/* Shares of the probe's size: deeper at the first pose is inside, deeper where nothing was touched before as well; how
 * far it goes in one move of easing in. And how many 60ths of a second, say, count between two poses. */
static const double inside_first = .01, inside_later = .25, ease = .25, frames_most = 10;

/* A share of the probe's size: what goes farther between two poses jumps, and is swept in moves of it, or of the same
 * share of a cell's side. A node that it meets is then no deeper than half of the way to where another way out would be
 * the shorter, and tissue that is a cell thick is not pressed through itself in one move. */
static const double stride = .5;

int press_make(press *s, const msds_problem *p, const probe *shape, int64_t iterations, double rate, err *e)
{
    *s = (press){.p = p, .shape = shape, .iterations = iterations, .rate = rate};
    s->u = mem_array(p->nodes, 3 * sizeof *s->u, "the probe's way", e);
    return s->u ? 0 : -1;
}

void press_free(press *s)
{
    free(s->u);
    bones_free(&s->bones);
    *s = (press){0};
}

int press_bones(press *s, const model *m, err *e)
{
    return bones_make(&s->bones, s->p, m, e);
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

const pose *press_end(const press_moves *moves)
{
    return &moves->list[moves->count - 1].at;
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

/* How far the probe is from every free node, m, at least; 0 or less: it touches one. */
static double clearance(const press *s, const pose *at)
{
    const probe_placed placed = probe_place(s->shape, at);
    double least = INFINITY;
    for (int64_t n = 0; n < s->p->nodes; n++) {
        double x[3], away = 0;
        for (int a = 0; a < 3 && !s->p->fixed[n]; a++) {
            x[a] = s->p->position[3 * n + a] + s->u[3 * n + a];
            away += (x[a] - placed.centre[a]) * (x[a] - placed.centre[a]);
        }
        if (!s->p->fixed[n] && away < (least + placed.reach) * (least + placed.reach))
            least = fmin(least, fmax(sqrt(away) - placed.reach, -probe_at(&placed, x).depth));
    }
    return least;
}

/* Whether it is in tissue or bone there. */
static bool is_inside(const press *s, const pose *at)
{
    const probe_placed placed = probe_place(s->shape, at);
    return deepest(s, at) > 0 || !(bones_gap(&s->bones, &placed, s->shape->size) > 0);
}

static pose drawn_back(const press *s, const pose *at, double by)
{
    const probe_placed placed = probe_place(s->shape, at);
    pose back = *at;
    for (int a = 0; a < 3; a++)
        back.position[a] -= by * placed.into[a];
    return back;
}

static double apart(const pose *a, const pose *b)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += (a->position[i] - b->position[i]) * (a->position[i] - b->position[i]);
    return sqrt(square);
}

/* From where it touches nothing; or from a hundred times its size, should that not be. On its way in, bone stops it. */
static void ease_in(const press *s, const pose *at, press_moves *m)
{
    const double step = .5 * s->shape->size;
    double back = 0;
    for (int i = 0; i < 200 && is_inside(s, at); i++) {
        back += step;
        pose out = drawn_back(s, at, back);
        if (!is_inside(s, &out))
            break;
    }
    const pose from = drawn_back(s, at, back);
    const screw way = screw_of(&from, at);
    const double share = bones_stop(&s->bones, s->shape, &way), end = (1 - share) * back;
    m->stopped = m->stopped || share < 1;
    m->back = back;
    m->count = (int)fmin(PRESS_MOVES, fmax(1, ceil(back / (ease * s->shape->size))));
    for (int i = 0; i < m->count; i++)
        m->list[i] = (press_move){drawn_back(s, at, end + (back - end) * (m->count - 1 - i) / m->count), s->iterations};
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
    const int64_t count = iterations_of(s, f);
    *moves = (press_moves){.count = 1, .list = {{f->at, count}}, .asked = count};
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

/* ---- jumps */

/* The share of the way through free space, at most `share`: by conservative advancement from node to node, as they lie
 * now. */
static double fly(const press *s, const screw *way, double share)
{
    const double length = screw_length(way, probe_lever(s->shape)), near = stride * s->shape->size;
    double at = 0;
    while (at < share) {
        const pose here = screw_at(way, at);
        const double clear = clearance(s, &here);
        if (clear <= near)
            return at;
        at += (clear - near / 2) / length;
    }
    return share;
}

/* Moves from a share of the way to another, of some iterations each at least. Springs, which live in time, share what
 * the frame has evenly; other methods take it for the last move. */
static void divide(const press *s, const screw *way, double from, double to, const press_frame *f, press_moves *m)
{
    const double length = screw_length(way, probe_lever(s->shape)) * (to - from);
    const int count = (int)fmin(PRESS_SWEEP - 1, fmax(1, ceil(length / (stride * fmin(s->shape->size, s->p->side)))));
    const int64_t flight = f->springs ? (int64_t)(from / to * (double)m->asked) : 0, left = m->asked - flight;
    const int64_t few = f->newton ? s->iterations : PRESS_TOGETHER;
    const int64_t even = left > count * few ? left : count * few;
    const int64_t last = left - few * (count - 1), half = (left + 1) / 2;
    if (flight)
        m->list[m->count++] = (press_move){screw_at(way, from), flight};
    for (int i = 0; i < count; i++) {
        int64_t each = f->springs ? even * (i + 1) / count - even * i / count : few;
        if (!f->springs && i + 1 == count)
            each = last > half ? last : half;
        m->list[m->count++] = (press_move){screw_at(way, from + (to - from) * (i + 1) / count), each};
    }
    m->list[m->count - 1].at = screw_at(way, to);
    m->swept = true;
}

/* A probe that bone stops, at a share of its way, may slide along it instead: toward where bone stops it as it comes
 * down on its pose along its own axis. Where that gets it nearer to its pose, this is the way. Returns its share. */
static double slide(const press *s, screw *way, double share)
{
    const pose at = way->to, stop = screw_at(way, share), above = drawn_back(s, &at, probe_lever(s->shape));
    const probe_placed placed = probe_place(s->shape, &above);
    if (!(bones_gap(&s->bones, &placed, s->shape->size) > 0))
        return share;
    const screw down = screw_of(&above, &at);
    const pose on = screw_at(&down, bones_stop(&s->bones, s->shape, &down));
    const screw other = screw_of(&way->from, &on);
    const double other_share = bones_stop(&s->bones, s->shape, &other);
    const pose end = screw_at(&other, other_share);
    if (apart(&end, &at) >= apart(&stop, &at))
        return share;
    *way = other;
    return other_share;
}

/* Where the probe jumps, its moves; where bone stops it, *to becomes where that is. A pose at which it touches nothing,
 * though bone is in the way, was come to by another way, which is not known. */
static int sweep(press *s, const msds_executor *device, msds_state *state, const press_frame *f, pose *to,
                 press_moves *m, err *e)
{
    screw way = screw_of(&s->last, &f->at);
    double share = bones_stop(&s->bones, s->shape, &way);
    const double lever = probe_lever(s->shape), near = stride * s->shape->size;
    if (share >= 1 && !(screw_length(&way, lever) > near))
        return 0;
    if (device->get(state, MSDS_DISPLACEMENT, s->u, e))
        return -1;
    if (share < 1 && !is_inside(s, &f->at)) {
        m->list[m->count++] = (press_move){f->at, m->asked};
        return 0;
    }
    m->stopped = share < 1;
    if (m->stopped)
        share = slide(s, &way, share);
    *to = screw_at(&way, share);
    const double length = share * screw_length(&way, lever);
    const double from = length > near ? fly(s, &way, share) : share;
    if (from < share)
        divide(s, &way, from, share, f, m);
    return 0;
}

static int look(press *s, const msds_executor *device, msds_state *state, const pose *at, press_moves *m, err *e)
{
    const double size = s->shape->size;
    if (s->any && (s->contacts || apart(&s->last, at) <= inside_later * size))
        return 0;
    if (device->get(state, MSDS_DISPLACEMENT, s->u, e))
        return -1;
    const probe_placed placed = probe_place(s->shape, at);
    const bool in_bone = !s->any && !(bones_gap(&s->bones, &placed, size) > 0);
    if (in_bone || deepest(s, at) > (s->any ? inside_later : inside_first) * size) {
        m->inside = true;
        ease_in(s, at, m);
    }
    return 0;
}

int press_to(press *s, const msds_executor *device, msds_state *state, const press_frame *f, press_moves *moves, err *e)
{
    const bool solid = s->shape->size > 0;
    pose to = f->at;
    *moves = (press_moves){.asked = iterations_of(s, f)};
    if (solid && s->any && sweep(s, device, state, f, &to, moves, e))
        return -1;
    if (solid && !moves->count && look(s, device, state, &to, moves, e))
        return -1;
    if (!moves->count && f->springs && solid)
        go_on(s, &to, moves->asked, moves);
    if (!moves->count) {
        moves->count = 1;
        moves->list[0] = (press_move){to, moves->asked};
    }
    pass(s, f->time);
    s->any = true;
    s->last = *press_end(moves);
    return 0;
}
