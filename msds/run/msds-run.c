/* msds-run: presses a probe on a tetrahedral model, pose by pose, and writes a frame for each as soon as it is solved:
 * by springs and dampers or by linear finite elements. PST sections III and the appendix.
 */
#include "base/mem.h"
#include "cli/progress.h"
#include "model/stage.h"
#include "msds/problem/largest.h"
#include "msds/problem/problem.h"
#include "msds/run/compare.h"
#include "msds/run/press.h"
#include "msds/run/run_options.h"
#include "msds/run/skin_model.h"
#include "probe/poses.h"
#include "probe/probe_carry.h"
#include "surface/scale.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SUBSTEPS_MOST = 1000 };

enum { MASS_STABLE, MASS_LUMPED };

/* The largest value of all poses: of a displacement (m) or of the force on the probe (N). */
typedef struct peak {
    double value, time;
    int64_t contacts;
} peak;

typedef struct session {
    const tool *t;
    const struct options *o;
    stage stage;
    model m;
    msds_problem problem;
    probe probe;
    press press;
    skin skin;
    char skin_name[SURFACE_NAME_MOST + 1];
    largest largest;
    int64_t substeps;
    double stable, sure; /* s: steps of springs that are stable at rest, and in any configuration */
    bool springs_told;
    const msds_executor *device;
    pool *threads;
    msds_state *state;
    compare *other; /* the other method, or NULL */
    in *source;
    poses poses;
    msds_method method;   /* now */
    msds_reading reading; /* of the last frame */
    int64_t next_frame;
    progress progress;
    msds_listener listener;
    int64_t posed; /* poses taken */
    double time;   /* s: of the last */
    peak moved, pushed;
    bool pressed; /* some node, in some frame */
    bool dented;  /* the skin */
    notes warnings;
} session;

/* Algorithm 1's constant, or 0 for auto. */
static int read_scale(const char *text, double *scale, err *e)
{
    num_length length;
    if (!strcmp(text, "auto")) {
        *scale = 0;
        return 0;
    }
    if (num_length_of(text, &length))
        return err_usage(e, "--spring-scale %.100s; expected a length above 0, such as .002, or auto", text);
    *scale = num_length_in(length, num_unit_of("m"), num_unit_of("m"));
    return *scale > 0 ? 0
                      : err_usage(e, "--spring-scale %.100s; expected a length above 0, such as .002, or auto", text);
}

static msds_method method_of(const session *s, bool fem)
{
    if (!fem)
        return MSDS_SPRINGS;
    return s->o->exact ? MSDS_EXACT : MSDS_FEM;
}

/* Scales inertia, or cuts the step, until the step of springs is stable in every configuration. */
static int choose_step(session *s, err *e)
{
    const struct options *o = s->o;
    msds_problem *p = &s->problem;
    if (largest_of(p, &s->largest, e))
        return -1;
    s->stable = largest_step(s->largest.rest, o->damping);
    s->sure = largest_step(s->largest.bound, o->damping);
    s->substeps = 1;
    if (o->mass == MASS_LUMPED)
        s->substeps = s->sure < o->dt ? (int64_t)fmin(ceil(o->dt / s->sure), 1e15) : 1;
    else
        p->mass_factor = fmax(1, largest_factor(s->largest.bound, o->damping, o->dt));
    if (s->substeps > SUBSTEPS_MOST)
        return err_set(e, NULL, 0, "--dt %g is %.3g times the stable step; expected at most %.3g s, or --mass stable",
                       o->dt, o->dt / s->sure, SUBSTEPS_MOST * s->sure);
    return 0;
}

/* Once, and only where springs move the tissue. */
static void say_springs(session *s)
{
    const struct options *o = s->o;
    const msds_problem *p = &s->problem;
    if (s->springs_told)
        return;
    s->springs_told = true;
    tool_say(s->t, "springs: %lld; k = %.6g m E", (long long)p->springs, p->scale);
    tool_say(s->t, "springs: stable step %.4g ms at rest, %.4g ms in any configuration, dt %.4g ms", 1e3 * s->stable,
             1e3 * s->sure, 1e3 * o->dt);
    if (o->mass == MASS_STABLE)
        tool_say(s->t, "springs: inertia is %.6g times the mass, for that step", p->mass_factor);
    else if (s->substeps > 1)
        tool_say(s->t, "springs: each step is cut into %lld", (long long)s->substeps);
}

static int make_problem(session *s, err *e)
{
    const struct options *o = s->o;
    msds_options options = {.damping = o->damping, .repulsion = o->repulsion, .penalty = o->contact, .warp = o->warp};
    for (int a = 0; a < 3 && o->gravity.count; a++)
        options.gravity[a] = o->gravity.value[a];
    if (read_scale(o->scale, &options.scale, e) || msds_problem_make(&s->problem, &s->m, &options, e) ||
        model_axis_add(&s->m, "probe", 1, e))
        return -1;
    tool_say(s->t, "%lld nodes, %lld tetrahedra", (long long)s->problem.nodes, (long long)s->problem.elements);
    return o->probe && probe_carry(&s->probe, &s->m, &s->warnings, e) ? -1 : choose_step(s, e);
}

static int say_provenance(tool *t, const session *s, err *e)
{
    char shape[300] = "";
    const struct options *o = s->o;
    if (o->probe) {
        char text[280];
        probe_text(&s->probe, text, sizeof text);
        snprintf(shape, sizeof shape, "--probe %s ", text);
    }
    return tool_provenance(
        t, e,
        "%s--method %s --iterations %lld --rate %.9g --dt %.9g --mass %s --spring-scale %.9g --damping %.9g "
        "--contact %s --repulsion %.9g [%s, inertia %.9g, %lld substeps]",
        shape, o->method ? "fem" : "msds", (long long)o->iterations, o->rate, o->dt, o->mass ? "lumped" : "stable",
        s->problem.scale, o->damping, o->contact ? "penalty" : "prescribed", o->repulsion, s->device->is.device,
        s->problem.mass_factor, (long long)s->substeps);
}

static int start_from(session *s, const frame *last, err *e)
{
    const model_array *last_pose = frame_find(last, "probe.pose");
    s->next_frame = last->index + 1;
    if (last_pose && last_pose->rows == 1 && s->o->probe) {
        const pose from = pose_of_row(last_pose->f64);
        press_from(&s->press, &from, last->time);
    }
    if (msds_problem_start(&s->problem, last, e))
        return -1;
    return s->skin.vertices ? skin_model_start(&s->skin, last, e) : 0;
}

/* Passes on the frames that came, and starts from the last. */
static int take_frames(session *s, err *e)
{
    frame last = {0};
    const int64_t count = stage_last_frame(&s->stage, &s->m, true, &last, e);
    const int failed = count > 0 ? start_from(s, &last, e) : 0;
    frame_free(&last);
    return count < 0 ? -1 : failed;
}

/* An array of one row. An array added is to be filled before the next. */
static int put_numbers(const session *s, frame *f, const char *name, const double *number, int count, err *e)
{
    model_array *a = frame_add(f, &s->m, name, e);
    if (a)
        memcpy(a->f64, number, (size_t)count * sizeof *number);
    return a ? 0 : -1;
}

static int write_frame(session *s, const poses_event *at, err *e)
{
    const msds_reading *reading = &s->reading;
    frame f = {.index = s->next_frame++, .time = at->time};
    int result = -1;
    model_array *u = frame_add(&f, &s->m, "node.displacement", e);
    if (!u || s->device->get(s->state, MSDS_DISPLACEMENT, u->f64, e))
        goto out;
    model_array *v = frame_add(&f, &s->m, "node.velocity", e);
    if (!v || s->device->get(s->state, MSDS_VELOCITY, v->f64, e))
        goto out;
    double row[7];
    pose_to_row(&at->at, row);
    if (put_numbers(s, &f, "probe.pose", row, 7, e) || put_numbers(s, &f, "probe.force", reading->force, 3, e) ||
        put_numbers(s, &f, "probe.torque", reading->torque, 3, e))
        goto out;
    if (s->skin.vertices && skin_model_put(&s->skin, &f, &s->m, e))
        goto out;
    result = model_write_frame(s->stage.writer, &f, e);
    out_flush(s->stage.sink);
out:
    frame_free(&f);
    return result;
}

/* Shows which pose, and, where that takes long, what of it. */
static void show_work(void *context, const msds_progress *now)
{
    session *s = context;
    char text[300], left[40] = "", at[80] = "", share[20] = "";
    if (!progress_due(&s->progress))
        return;
    if (now && now->share > 0)
        snprintf(share, sizeof share, ", %.0f %%", 100 * now->share);
    if (now && !isnan(now->residual))
        snprintf(left, sizeof left, ", residual %.2g", now->residual);
    if (now && now->solve)
        snprintf(at, sizeof at, "solve %d%s, %lld nodes near the probe: ", now->solve, left, (long long)now->contacts);
    snprintf(text, sizeof text, "pose %lld, %.6g s%s%s%s%s", (long long)s->posed, s->time, now ? ": " : "", at,
             now ? now->what : "", share);
    progress_text(&s->progress, text);
}

static double size_of(const double force[3])
{
    return sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

/* A row of the report on frames: with --residual, --compare or -v. */
static void say_row(const session *s, const char *row)
{
    progress_clear(&s->progress);
    if (s->o->residual || s->other)
        tool_say(s->t, "%s", row);
    else
        tool_detail(s->t, "%s", row);
}

static void say_heading(const session *s)
{
    char row[200];
    snprintf(row, sizeof row, "%10s  %-10s  %7s  %9s  %9s  %6s%s", "time/s", "method", "pressed", "force/N", "residual",
             "solves", s->other ? "  other's/N   rms/rms   max/max" : "");
    say_row(s, row);
}

static void say_frame(const session *s, double time)
{
    static const char *const names[] = {"msds", "fem", "fem-exact"};
    const msds_reading *reading = &s->reading;
    char left[40] = "-", solves[40] = "-", other[100] = "", row[300];
    if (!isnan(reading->residual))
        snprintf(left, sizeof left, "%.3g", reading->residual);
    if (reading->solves)
        snprintf(solves, sizeof solves, "%d", reading->solves);
    if (s->other)
        snprintf(other, sizeof other, "  %9.4g  %8.4g  %8.4g", size_of(s->other->reading.force), s->other->mean,
                 s->other->worst);
    snprintf(row, sizeof row, "%10.6g  %-10s  %7lld  %9.4g  %9s  %6s%s", time, names[s->method],
             (long long)reading->contacts, size_of(reading->force), left, solves, other);
    if (s->posed == 1)
        say_heading(s);
    say_row(s, row);
}

/* The largest values so far: the last pose may have left the tissue. */
static void find_peaks(session *s)
{
    const double force = size_of(s->reading.force);
    if (s->posed == 1 || s->reading.largest > s->moved.value)
        s->moved = (peak){s->reading.largest, s->time, 0};
    if (force > s->pushed.value)
        s->pushed = (peak){force, s->time, s->reading.contacts};
}

/* Of all poses. */
static void say_end(const session *s)
{
    char force[200] = "";
    const peak *u = &s->moved, *f = &s->pushed;
    if (f->value > 0)
        snprintf(force, sizeof force, "; largest force on the probe %.4g N, from %lld node%s, at %.6g s", f->value,
                 (long long)f->contacts, f->contacts == 1 ? "" : "s", f->time);
    else if (s->o->probe)
        snprintf(force, sizeof force, "; no force on the probe");
    tool_say(s->t, "%lld pose%s, to %.6g s: largest displacement %.6g mm, at %.6g s%s", (long long)s->posed,
             s->posed == 1 ? "" : "s", s->time, 1e3 * u->value, u->time, force);
}

/* What the first pose shows of the probe, and where it enters tissue at once. */
static void warn_of_pose(session *s, const poses_event *at, const press_moves *moves, bool first)
{
    const probe_placed placed = probe_place(&s->probe, &at->at);
    if (first && probe_is_plate(&placed, s->problem.position, s->problem.nodes))
        notes_add(&s->warnings, "the probe's face is larger than the tissue: it presses like a plate");
    if (first && probe_is_thin(&s->probe, s->problem.side))
        notes_add(
            &s->warnings,
            "the probe is %.3g mm thick, cells are %.3g mm wide: it may slip between nodes; expected a finer mesh",
            2e3 * s->probe.size, 1e3 * s->problem.side);
    if (moves->inside)
        notes_add(&s->warnings,
                  "%s:%lld: the probe begins inside the tissue; it is moved in along its axis, from %.3g mm back, in "
                  "%d moves",
                  in_name(s->source), (long long)at->line, 1e3 * moves->back, moves->count);
    if (s->warnings.count)
        progress_clear(&s->progress);
    tool_warn(s->t, &s->warnings);
}

/* All moves of a frame but the last; fills the plan with that, and returns its count of steps, or -1 with e filled. The
 * skin, if there is one to go with it, makes the last one too. */
static int64_t make_moves(session *s, msds_state *state, const press_moves *moves, msds_plan *plan, bool with_skin,
                          err *e)
{
    int64_t count = 0;
    for (int i = 0; i < moves->count; i++) {
        plan->probe = probe_place(&s->probe, &moves->list[i].at);
        if (with_skin && s->skin.vertices)
            skin_step(&s->skin, plan->touched ? &plan->probe : NULL, moves->list[i].iterations);
        count = moves->list[i].iterations * (plan->method == MSDS_SPRINGS ? s->substeps : 1);
        if (i + 1 < moves->count && s->device->step(state, plan, count, e))
            return -1;
    }
    return count;
}

static int diverged(const session *s, const poses_event *at, err *e)
{
    return err_diverged(e, in_name(s->source), at->line,
                        "diverged at %.6g s: displacements are no longer finite; expected a smaller --dt", at->time);
}

/* Moves the probe to its pose; the tissue and the skin follow. */
static int solve_pose(session *s, const poses_event *at, const press_moves *moves, msds_plan *plan, err *e)
{
    msds_reading reading = {0};
    const int64_t count = make_moves(s, s->state, moves, plan, true, e);
    if (count < 0 || s->device->step(s->state, plan, count, e) || s->device->monitor(s->state, &reading, e))
        return -1;
    const double dent = s->skin.vertices ? skin_largest(&s->skin) : 0;
    if (!reading.finite || !isfinite(dent))
        return diverged(s, at, e);
    s->dented = s->dented || dent > 0;
    s->pressed = s->pressed || reading.met;
    s->reading = reading;
    s->press.contacts = reading.contacts;
    return 0;
}

/* The same moves by the other method, whose tissue is compared. */
static int solve_other(session *s, const press_moves *moves, msds_plan *plan, err *e)
{
    plan->method = method_of(s, s->method == MSDS_SPRINGS);
    const int64_t count = make_moves(s, s->other->state, moves, plan, false, e);
    return count < 0 ? -1 : compare_frame(s->other, s->device, s->state, plan, count, e);
}

static int solve_frame(session *s, const poses_event *at, err *e)
{
    msds_plan plan = {.method = s->method,
                      .dt = s->o->dt / (double)s->substeps,
                      .touched = s->o->probe != NULL,
                      .listener = s->progress.on ? &s->listener : NULL};
    press_moves moves;
    const bool first = !s->press.any;
    if (press_to(&s->press, s->device, s->state, &at->at, at->time, s->method == MSDS_SPRINGS, &moves, e))
        return -1;
    if (plan.touched)
        warn_of_pose(s, at, &moves, first);
    if (solve_pose(s, at, &moves, &plan, e) || write_frame(s, at, e))
        return -1;
    return s->other ? solve_other(s, &moves, &plan, e) : 0;
}

/* A line that changes the method. */
static void change_method(session *s, const poses_event *at)
{
    progress_clear(&s->progress);
    s->method = method_of(s, at->kind == POSES_FEM);
    if (s->method == MSDS_SPRINGS)
        say_springs(s);
    tool_detail(s->t, "line %lld: the method is %s from here on", (long long)at->line, s->method ? "fem" : "msds");
}

static int take_pose(session *s, const poses_event *at, err *e)
{
    s->posed++;
    s->time = at->time;
    show_work(s, NULL);
    if (solve_frame(s, at, e))
        return -1;
    say_frame(s, at->time);
    find_peaks(s);
    return 0;
}

static void warn_of_misses(session *s)
{
    if (s->o->probe && !s->pressed)
        notes_add(
            &s->warnings,
            "the probe touches nothing in any frame (%lld in all); expected poses in metres, in the model's space, "
            "and nodes closer together than the probe is wide",
            (long long)s->posed);
    if (s->pressed && s->skin.vertices && !s->dented)
        notes_add(&s->warnings,
                  "the probe presses the tissue, but touches the skin in no frame; expected %s in the place of the "
                  "tissue; check --unit",
                  s->skin_name);
}

static int simulate(session *s, err *e)
{
    poses_event at;
    int got;
    progress_start(&s->progress, run_options_table.name, "poses", 0, s->o->common.quiet);
    s->listener = (msds_listener){show_work, s};
    while ((got = poses_next(&s->poses, &at, e)) > 0)
        if (at.kind != POSES_POSE)
            change_method(s, &at);
        else if (take_pose(s, &at, e))
            return -1;
    progress_clear(&s->progress);
    if (got < 0)
        return -1;
    if (!s->posed)
        return err_set(e, in_name(s->source), 0, "no pose; expected lines `time tx ty tz qx qy qz qw`");
    warn_of_misses(s);
    say_end(s);
    return 0;
}

static int read_probe(session *s, err *e)
{
    const struct options *o = s->o;
    return o->probe ? probe_read(&s->probe, o->probe, o->unit, o->common.anonymous, &s->m, e) : 0;
}

/* The skin's surface joins the body; its springs are made when there are threads. */
static int carry_skin(session *s, err *e)
{
    if (!s->o->skin)
        return 0;
    num_unit unit = scale_unit(s->o->unit, &s->m, e);
    return unit ? skin_model_carry(&s->m, s->o->skin, s->o->common.anonymous, scale_of(unit), s->skin_name,
                                   &s->warnings, e)
                : -1;
}

static int make_skin(session *s, err *e)
{
    const struct options *o = s->o;
    const skin_options options = {o->skin_stiffness, o->skin_anchors, o->skin_tension, o->damping, o->dt};
    surface shape;
    if (!o->skin)
        return 0;
    if (surface_of(&s->m, s->skin_name, &shape, e) || skin_make(&s->skin, &shape, &options, s->threads, e))
        return -1;
    tool_say(s->t, "skin %s: %lld vertices, %lld springs", s->skin_name, (long long)s->skin.vertices,
             (long long)s->skin.edges);
    return 0;
}

static int prepare(session *s, err *e)
{
    static const char *const names[] = {"auto", "cuda", "cpu"};
    const struct options *o = s->o;
    char device[300];
    if (read_probe(s, e) || carry_skin(s, e) || make_problem(s, e))
        return -1;
    const executor_need need = {.features = o->warp && !o->device ? EXECUTOR_WARP : 0}; /* -d cuda: where FEM begins */
    s->device = msds_executor_of(executor_choose(msds_executors, names[o->device], &need, device, sizeof device, e));
    int threads = tool_threads(s->t, e);
    s->threads = s->device && threads > 0 ? pool_create(threads, e) : NULL;
    if (!s->threads)
        return -1;
    tool_say(s->t, "%s", device);
    s->method = method_of(s, o->method);
    if (s->method == MSDS_SPRINGS || o->compare)
        say_springs(s);
    return make_skin(s, e) ? -1 : press_make(&s->press, &s->problem, &s->probe, o->iterations, o->rate, e);
}

/* The poses last: a FIFO opens when its writer comes. */
static int make_states(session *s, err *e)
{
    s->state = s->device->create(&s->problem, s->threads, e);
    if (!s->state)
        return -1;
    if (s->o->compare) {
        s->other = compare_make(&s->problem, s->device, s->threads, e);
        if (!s->other)
            return -1;
    }
    out_flush(s->stage.sink);
    s->source = in_open(s->o->poses, e);
    return s->source ? poses_open(&s->poses, s->source, s->o->transform, e) : -1;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.iterations = 20,
                        .rate = 60,
                        .dt = .01,
                        .damping = .1,
                        .repulsion = 1,
                        .scale = ".002",
                        .skin_stiffness = 100,
                        .skin_anchors = .01,
                        .skin_tension = .5};
    err e = {0};
    tool t = {0};
    session s = {.t = &t, .o = &o};
    if (tool_begin(&t, &run_options_table, argc, argv, &o, &e) || t.done)
        goto out;
    if (stage_open_output(&s.stage, &t, &e) || stage_read(&s.stage, &s.m, &e) || prepare(&s, &e) ||
        say_provenance(&t, &s, &e) || stage_write(&s.stage, &s.m, &e) || take_frames(&s, &e) || make_states(&s, &e) ||
        simulate(&s, &e))
        goto out;
out:
    progress_stop(&s.progress);
    tool_warn(&t, &s.warnings);
    if (!t.done)
        stage_close(&s.stage, &t, &e);
    compare_free(s.other, s.device);
    if (s.state)
        s.device->destroy(s.state);
    in_close(s.source);
    pool_destroy(s.threads);
    press_free(&s.press);
    skin_free(&s.skin);
    msds_problem_free(&s.problem);
    probe_free(&s.probe);
    model_free(&s.m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
