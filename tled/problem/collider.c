#include "tled/problem/collider.h"

#include "base/mem.h"
#include "probe/poses.h"
#include "tled/problem/step.h"

#include <stdlib.h>
#include <string.h>

static int add_pose(collider *c, const poses_event *at, err *e)
{
    if (MEM_ROOM(&c->list, &c->pose_room, c->poses + 1, "poses", e) ||
        MEM_ROOM(&c->time, &c->time_room, c->poses + 1, "poses", e))
        return -1;
    c->list[c->poses] = at->at;
    c->time[c->poses++] = at->time;
    return 0;
}

int collider_read_poses(collider *c, const char *path, const placing *of, err *e)
{
    in *source = in_open(path, e);
    poses list = {.sequence = false};
    poses_event at;
    int got = source && !poses_open(&list, source, NULL, e) ? 1 : -1;
    if (of && of->has_marker)
        poses_of_marker(&list);
    while (got > 0 && (got = poses_next(&list, &at, e)) > 0) {
        if (at.kind != POSES_POSE)
            got = err_set(e, path, at.line,
                          "a line that changes the method; expected poses alone: methods are msds-run's");
        if (of)
            at.at = placing_of(of, &at.at);
        if (got < 0 || add_pose(c, &at, e))
            got = -1;
    }
    if (!got && !c->poses)
        got = err_set(e, path, 0, "no pose; expected lines `time tx ty tz qx qy qz qw`");
    in_close(source);
    return got;
}

void collider_free(collider *c)
{
    probe_free(&c->shape);
    free(c->time);
    free(c->list);
    *c = (collider){.poses = 0};
}

void collider_join(collider *c, tled_problem *p, double repulsion)
{
    double step = step_at_rest(p, NULL);
    c->stiffness = repulsion * 4 / (step * step);
    p->collider = c;
}

static double begin_inside(collider *c, const tled_problem *p, double ramp)
{
    const probe_placed first = collider_at(c, p->start);
    double deepest = 0;
    for (int64_t n = 0; n < p->nodes; n++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = p->position[3 * n + a] + p->at_start.of[TLED_DISPLACEMENT][3 * n + a];
        deepest = fmax(deepest, probe_at(&first, x).depth);
    }
    c->start = p->start;
    c->rises = deepest > .01 * c->shape.size ? ramp : 0;
    return c->rises > 0 ? deepest : 0;
}

static bool is_away(const collider *c, const tled_problem *p)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, room = 0;
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        low[i % 3] = fmin(low[i % 3], p->position[i]);
        high[i % 3] = fmax(high[i % 3], p->position[i]);
    }
    for (int a = 0; a < 3; a++)
        room = fmax(room, .5 * (high[a] - low[a]));
    room += 2 * c->shape.reach; /* the ball's middle turns with the probe */
    for (int64_t i = 0; i < c->poses; i++) {
        const int64_t next = i + 1 < c->poses ? i + 1 : i;
        const probe_placed from = probe_place(&c->shape, &c->list[i]), to = probe_place(&c->shape, &c->list[next]);
        bool near = true;
        for (int a = 0; a < 3; a++)
            near = near && fmin(from.centre[a], to.centre[a]) < high[a] + room &&
                   fmax(from.centre[a], to.centre[a]) > low[a] - room;
        if (near)
            return false;
    }
    return true;
}

void collider_begin(collider *c, const tled_problem *p, double ramp, notes *warnings)
{
    const double inside = begin_inside(c, p, ramp), side = cbrt(p->side[0] * p->side[1] * p->side[2]);
    const probe_placed first = collider_at(c, p->start);
    if (inside > 0)
        notes_add(warnings, "the probe begins %.3g mm inside the tissue: its contact force rises over %g s",
                  1e3 * inside, ramp);
    if (probe_is_thin(&c->shape, side))
        notes_add(
            warnings,
            "the probe is %.3g mm thick, elements are %.3g mm wide: it may slip between nodes; expected a finer mesh",
            2e3 * c->shape.size, 1e3 * side);
    if (is_away(c, p))
        notes_add(warnings, "the probe never comes near the tissue; expected poses in metres, in the model's space");
    if (probe_is_plate(&first, p->position, p->nodes))
        notes_add(warnings, "the probe's face is larger than the tissue: it presses like a plate");
}

pose collider_pose(const collider *c, double time)
{
    int64_t low = 0, high = c->poses - 1;
    while (high - low > 1) {
        int64_t middle = low + (high - low) / 2;
        if (c->time[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    double span = c->time[high] - c->time[low];
    double share = span > 0 ? fmin(1, fmax(0, (time - c->time[low]) / span)) : time >= c->time[high];
    return pose_between(&c->list[low], &c->list[high], share);
}

probe_placed collider_at(const collider *c, double time)
{
    const pose at = collider_pose(c, time);
    return probe_place(&c->shape, &at);
}

collider_moment collider_moment_at(const collider *c, double time)
{
    return (collider_moment){collider_pose(c, time), collider_up(c, time)};
}

int collider_begin_live(collider *c, err *e)
{
    enum { FROM_TO = 2 };
    if (MEM_ROOM(&c->list, &c->pose_room, FROM_TO, "poses", e) ||
        MEM_ROOM(&c->time, &c->time_room, FROM_TO, "poses", e))
        return -1;
    c->poses = FROM_TO;
    c->is_away = true;
    return 0;
}

void collider_move(collider *c, double from, double until, const pose *to)
{
    c->list[0] = c->is_away ? *to : c->list[1];
    c->list[1] = *to;
    c->time[0] = from;
    c->time[1] = until;
    c->is_away = false;
}

void collider_rise(collider *c, double from, double ramp)
{
    c->start = from;
    c->rises = ramp;
}

double collider_end(const collider *c)
{
    return c->time[c->poses - 1];
}

double collider_up(const collider *c, double time)
{
    return c->rises > 0 ? fmin(1, (time - c->start) / c->rises) : 1;
}

bool collider_push(const collider *c, const probe_placed *at, double up, const double x[3], double mass, double push[3])
{
    double away = 0;
    for (int a = 0; a < 3; a++)
        away += (x[a] - at->centre[a]) * (x[a] - at->centre[a]);
    if (away >= at->reach * at->reach)
        return false;
    const probe_touch t = probe_at(at, x);
    if (!(t.depth > 0))
        return false;
    for (int a = 0; a < 3; a++)
        push[a] = up * mass * c->stiffness * t.depth * t.way[a];
    return true;
}

int64_t collider_sum(const tled_problem *p, const collider_moment *now, const double *displacement, double force[3],
                     double torque[3])
{
    const probe_placed at = probe_place(&p->collider->shape, &now->at);
    int64_t count = 0;
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    for (int64_t n = 0; n < p->nodes; n++) {
        const int32_t *hold = p->hold + 3 * n;
        double x[3], push[3];
        for (int a = 0; a < 3; a++)
            x[a] = p->position[3 * n + a] + displacement[3 * n + a];
        bool is_free = hold[0] == HOLD_FREE || hold[1] == HOLD_FREE || hold[2] == HOLD_FREE;
        if (!is_free || !collider_push(p->collider, &at, now->up, x, p->mass[n], push))
            continue;
        for (int a = 0; a < 3; a++) {
            push[a] = hold[a] == HOLD_FREE ? -push[a] : 0;
            force[a] += push[a];
        }
        probe_torque(&at, x, push, torque);
        count++;
    }
    return count;
}

int collider_add(const tled_problem *p, const collider_moment *now, frame *f, const model *m,
                 const double *displacement, err *e)
{
    static const char *const names[] = {"probe.pose", "probe.force", "probe.torque"};
    double *to[3];
    for (int i = 0; i < 3; i++) {
        model_array *a = frame_add(f, m, names[i], e);
        if (!a)
            return -1;
        to[i] = a->f64;
    }
    pose_to_row(&now->at, to[0]);
    collider_sum(p, now, displacement, to[1], to[2]);
    return 0;
}

double collider_step(const tled_problem *p, double step)
{
    return p->collider ? 2 / sqrt(4 / (step * step) + p->collider->stiffness) : step;
}

double collider_events_end(const tled_problem *p)
{
    double end = script_end(p->script);
    return p->collider ? fmax(end, collider_end(p->collider)) : end;
}
