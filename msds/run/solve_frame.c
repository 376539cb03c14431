#include "msds/run/solve_frame.h"

#include "base/clock.h"
#include "msds/run/frame_report.h"

#include <math.h>
#include <string.h>

/* An array of one row. An array added is to be filled before the next. */
static int put_numbers(const session *s, frame *f, const char *name, const double *number, int count, err *e)
{
    model_array *a = frame_queue_array(f, &s->m, name, e);
    if (a)
        memcpy(a->f64, number, (size_t)count * sizeof *number);
    return a ? 0 : -1;
}

static int put_probe(const session *s, frame *f, const frame_input *from, err *e)
{
    double row[7];
    pose_to_row(press_end(&s->moves), row);
    if (from->has_pose && put_numbers(s, f, "probe.pose", row, 7, e))
        return -1;
    return put_numbers(s, f, "probe.force", s->reading.force, 3, e) ||
                   put_numbers(s, f, "probe.torque", s->reading.torque, 3, e)
               ? -1
               : 0;
}

/* What the table and the warnings say of the tetrahedra. */
static int look_at(session *s, const frame *f, err *e)
{
    if (s->reading.inverted >= 0) {
        inverted_add(&s->inverted, s->reading.inverted, f->time);
        return 0;
    }
    const double *u = frame_nodes_displacement(&s->of_nodes, f, e);
    if (!u || inverted_count(&s->inverted, u, f->time, e))
        return -1;
    openness_measure(&s->openness, u, f->time);
    return 0;
}

/* Takes a frame of the state, so that the state may go on while the frame is written. */
static int fill_frame(session *s, const frame_input *from, frame *f, err *e)
{
    if (!from->has_pose)
        frame_free(f); /* an earlier frame in it may have had a pose */
    f->index = s->next_frame++;
    f->time = from->time;
    return frame_nodes_begin(&s->of_nodes, f, e) || look_at(s, f, e) || put_probe(s, f, from, e) ||
                   (s->skin.vertices && skin_model_put(&s->skin, f, &s->m, e)) ||
                   frame_nodes_end(&s->of_nodes, f, false, e)
               ? -1
               : 0;
}

static int write_frame(session *s, const frame_input *from, err *e)
{
    frame *f = frame_queue_next(s->queue, e);
    return !f || fill_frame(s, from, f, e) || frame_queue_send(s->queue, e) ? -1 : 0;
}

/* What a move of a sweep that is not the last is made by: no exact solution of it is wanted. */
static msds_method method_along(const press_moves *moves, int i, msds_method method)
{
    const bool last = i + 1 == moves->count;
    return moves->swept && !last && method == MSDS_EXACT ? MSDS_FEM : method;
}

/* All moves of a frame but the last; fills the plan with that, and returns its count of steps, or -1 with e filled. The
 * skin, if there is one to go with it, makes the last one too. */
static int64_t make_moves(session *s, msds_state *state, const press_moves *moves, msds_plan *plan, bool with_skin,
                          err *e)
{
    int64_t count = 0;
    plan->elapsed = s->elapsed / moves->count;
    const msds_method method = plan->method;
    for (int i = 0; i < moves->count; i++) {
        plan->method = method_along(moves, i, method);
        plan->probe = probe_place(&s->probe, &moves->list[i].at);
        if (with_skin && s->skin.vertices &&
            skin_step(&s->skin, plan->touched ? &plan->probe : NULL, moves->list[i].iterations, e))
            return -1;
        count = moves->list[i].iterations * (plan->method == MSDS_SPRINGS ? s->substeps : 1);
        if (i + 1 < moves->count && s->device->step(state, plan, count, e))
            return -1;
    }
    return count;
}

static int diverged(const session *s, const frame_input *from, err *e)
{
    return err_diverged(e, s->source, from->line,
                        "diverged at %.6g s: displacements are no longer finite; expected a smaller --dt", from->time);
}

/* Moves the probe to its pose; the tissue and the skin follow. */
static int solve_pose(session *s, const frame_input *from, const press_moves *moves, msds_plan *plan, err *e)
{
    msds_reading reading = {0};
    const int64_t count = make_moves(s, s->state, moves, plan, true, e);
    if (count < 0 || s->device->step(s->state, plan, count, e) || s->device->monitor(s->state, &reading, e))
        return -1;
    if (skin_fetch(&s->skin, e))
        return -1;
    const double dent = s->skin.vertices ? skin_largest(&s->skin) : 0;
    s->diverged = !reading.finite || !isfinite(dent);
    if (s->diverged)
        return diverged(s, from, e);
    s->dented = s->dented || dent > 0;
    s->pressed = s->pressed || reading.met;
    s->reading = reading;
    s->press.contacts = reading.contacts;
    return 0;
}

/* The same moves by the other method, whose tissue is compared. */
static int solve_other(session *s, err *e)
{
    const method_word other = s->method == METHOD_MSDS ? s->last_fem : METHOD_MSDS;
    msds_plan *plan = &s->plan;
    plan->method = methods_solver(other);
    plan->warp = methods_warps(other);
    const int64_t count = make_moves(s, s->other->state, &s->moves, plan, false, e);
    return count < 0 ? -1 : compare_frame(s->other, s->device, s->state, plan, count, e);
}

frame_input solve_frame_input(const session *s, double time, const pose *at, int64_t line)
{
    return (frame_input){
        .time = time, .has_pose = true, .at = *at, .line = line, .method = s->method, .iterations = -1};
}

static void begin(session *s, const frame_input *from)
{
    s->elapsed = s->posed ? from->time - s->time : 0;
    s->time = from->time;
    s->used = from->method;
    s->plan = (msds_plan){.method = methods_solver(from->method),
                          .warp = methods_warps(from->method),
                          .dt = s->o->dt / (double)s->substeps,
                          .touched = s->o->probe && from->has_pose,
                          .listener = s->progress.on ? &s->listener : NULL};
}

int solve_frame_solve(session *s, const frame_input *from, err *e)
{
    const press_frame f = {.time = from->time,
                           .at = from->at,
                           .springs = from->method == METHOD_MSDS,
                           .newton = from->method == METHOD_TISSUE,
                           .iterations = from->iterations};
    const bool first = !s->press.any;
    s->diverged = false;
    begin(s, from);
    frame_report_work(s, NULL);
    if (!from->has_pose)
        press_wait(&s->press, &f, &s->moves);
    else if (press_to(&s->press, s->device, s->state, &f, &s->moves, e))
        return -1;
    if (s->plan.touched)
        frame_report_pose(s, &from->at, from->line, &s->moves, first);
    return solve_pose(s, from, &s->moves, &s->plan, e);
}

int solve_frame_rest(session *s, const frame_input *from, err *e)
{
    const press_frame f = {.time = from->time, .at = from->at, .iterations = 0};
    begin(s, from);
    press_wait(&s->press, &f, &s->moves);
    press_reset(&s->press);
    s->reading = (msds_reading){.residual = NAN, .finite = true, .inverted = -1};
    if (s->skin.vertices && skin_reset(&s->skin, e))
        return -1;
    return s->device->reset(s->state, e);
}

int solve_frame_write(session *s, const frame_input *from, err *e)
{
    if (write_frame(s, from, e) || (s->other && solve_other(s, e)))
        return -1;
    s->posed++;
    frame_report_row(s);
    return 0;
}

int solve_frame(session *s, const frame_input *from, err *e)
{
    const double start = clock_now();
    if (solve_frame_solve(s, from, e))
        return -1;
    const double solved = clock_now() - start;
    if (solve_frame_write(s, from, e))
        return -1;
    if (s->posed == 1)
        s->first_done = clock_now();
    else
        s->solving += solved;
    return 0;
}
