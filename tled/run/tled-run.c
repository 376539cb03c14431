/* tled-run: moves a voxel model by total Lagrangian explicit dynamics under gravity, forces, displacements and the
 * contraction of its muscles, and writes frames. Miller et al. 2007; W&M section 4.2.
 */
#include "base/mem.h"
#include "cli/progress.h"
#include "model/hourglass_text.h"
#include "model/materials.h"
#include "model/stage.h"
#include "probe/probe_carry.h"
#include "tled/problem/collider.h"
#include "tled/problem/followers.h"
#include "tled/problem/loads.h"
#include "tled/problem/step.h"
#include "tled/problem/support.h"
#include "tled/run/checkpoint.h"
#include "tled/run/fingerprint.h"
#include "tled/run/folds.h"
#include "tled/run/options.h"
#include "tled/run/relax.h"
#include "tled/run/run.h"
#include "tled/run/timeline.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REST_STEPS = 200000 }; /* after the script's end, before a run to rest gives up */

static const double rest_tolerance = 1e-4;

/* What the functions called by the time loop share with main. */
typedef struct session {
    const tool *t;
    stage stage;
    model m;
    script script;
    tled_problem problem;
    support support;
    collider collider;
    pool *threads;
    run_setup run;
    run_log log;
    progress progress;
    checkpoint *checkpoint; /* NULL: none */
    int64_t next_frame;     /* its index */
    bool started;           /* the state that the run begins from has been written: as a frame that came */
    int64_t cut;            /* parts of a step, as said last */
    double stable;          /* s: at rest */
    folds folds;            /* of the frames written */
    notes warnings;
} session;

static int check_log(const struct options *o, err *e)
{
    if (o->log_every > 0 && !o->log)
        return err_usage(e, "--log-every without --log; expected both");
    if (o->tsv.count && !o->log)
        return err_usage(e, "--tsv without --log, in which it adds columns; expected both");
    for (int i = 0; i < o->tsv.count; i++)
        if (log_check_key(o->tsv.value[i], e))
            return -1;
    return 0;
}

/* The three files of a checkpoint, by either option. */
static int check_checkpoint(const tool *t, struct options *o, err *e)
{
    const char *path = o->restart ? o->restart : o->checkpoint;
    if (!path)
        return 0;
    if (o->restart && o->checkpoint && strcmp(o->checkpoint, o->restart) != 0)
        return err_usage(
            e, "--checkpoint '%s' and --restart '%s'; expected the same file: a continued run saves its state there",
            o->checkpoint, o->restart);
    if (!*path || !strcmp(path, "-"))
        return err_usage(e, "'%s' for a checkpoint; expected the name of a file", path);
    if (o->restart)
        o->checkpoint = NULL;
    for (int i = 0; i < CHECKPOINT_FILES; i++) {
        char *file = checkpoint_file(path, i, e);
        const int failed = file ? tool_check_written(t, o->restart ? "--restart" : "--checkpoint", file, e) : -1;
        free(file);
        if (failed)
            return -1;
    }
    return 0;
}

static int read_control(const struct options *o, hourglass_control *to, err *e)
{
    if (!hourglass_read(o->hourglass ? o->hourglass : "physical", to))
        return 0;
    return err_usage(e, "--hourglass '%s': expected physical or isotropic[:KAPPA], KAPPA from 0 to 1000", o->hourglass);
}

static int check_end(const struct options *o, err *e)
{
    hourglass_control control;
    if (o->checkpoint_every > 0 && !o->checkpoint && !o->restart)
        return err_usage(e, "--checkpoint-every without --checkpoint or --restart; expected one of them");
    int ends = (o->seconds >= 0) + (o->steps > 0) + (o->rest >= 0);
    if (ends > 1)
        return err_usage(e, "-t, -n and --rest are three ways to end; expected one of them");
    if (check_log(o, e) || read_control(o, &control, e))
        return -1;
    if (o->damping == 0 && (!ends || o->rest >= 0))
        return err_usage(e, "without damping nothing comes to rest; expected -t or -n to end, or a --damping above 0");
    return 0;
}

static int change_materials(session *s, const struct options *o, err *e)
{
    in *source = o->materials ? in_open(o->materials, e) : NULL;
    int result = o->materials && (!source || materials_override(&s->m, source, e)) ? -1 : 0;
    in_close(source);
    return result ? result : materials_set(&s->m, o->material.value, o->material.count, e);
}

static int make_script(session *s, const struct options *o, err *e)
{
    in *source = o->script ? in_open(o->script, e) : NULL;
    int result = o->script && (!source || script_read(&s->script, source, &s->m, e)) ? -1 : 0;
    in_close(source);
    for (int i = 0; !result && i < o->contract.count; i++)
        result = script_add_contract(&s->script, &s->m, o->contract.value[i], o->ramp, e);
    if (!result && o->gravity.count)
        result = script_add_gravity(&s->script, o->gravity.value, o->ramp, e);
    return result ? result : script_check_muscles(&s->script, &s->m, &s->warnings, e);
}

/* The step: half the stable one, or --dt if that is not above it. */
static int choose_rate(session *s, const struct options *o, err *e)
{
    int32_t stiffest = 0;
    s->stable = followers_step(followers_square_at_rest(&s->problem),
                               collider_step(&s->problem, step_at_rest(&s->problem, &stiffest)));
    s->run.rate_fixed = o->dt > 0;
    s->run.rate = o->dt > 0 ? 1 / o->dt : step_rate(s->stable, &s->run.check);
    if (o->dt > 0)
        s->run.check = STEP_UNSEEN_GIVEN;
    if (o->dt > s->stable)
        return err_set(e, NULL, 0, "--dt %g is above the stable step; expected at most %.6g s (volume '%s')", o->dt,
                       s->stable * (1 - 1e-5), s->problem.volume[stiffest].name); /* rounded down */
    return 0;
}

/* How many steps. Frames given are behind us: the problem's start stands. */
static int choose_end(session *s, const struct options *o, err *e)
{
    run_setup *r = &s->run;
    double left = o->seconds, first = fabs(s->problem.start) * r->rate;
    if (r->rest >= 0)
        left = fmax(0, collider_events_end(&s->problem) - s->problem.start);
    if (o->steps > 0)
        left = (double)o->steps / r->rate;
    if (!(first + left * r->rate < 1e15))
        return err_set(e, NULL, 0, "a run up to step %g; expected fewer than 1e15", first + left * r->rate);
    r->steps = o->steps > 0 ? o->steps : timeline_steps_to(left, r->rate) + (r->rest >= 0 ? REST_STEPS : 0);
    r->end = o->seconds >= 0 && timeline_is_between(left, r->rate) ? s->problem.start + left : -INFINITY;
    return 0;
}

static void choose_damping(session *s, const struct options *o)
{
    s->run.frequency = relax_guess(&s->problem, s->support.reach);
    s->run.damping = o->damping >= 0 ? o->damping : 2 * s->run.frequency;
    s->run.adapt = o->damping < 0 && s->run.rest >= 0;
}

/* After the options that were given: how it ends, what ran, and every default that changes the result. */
static int say_provenance(tool *t, const session *s, const struct options *o, err *e)
{
    char until[60], shape[300] = "", press[360] = "";
    const run_setup *r = &s->run;
    char control[HOURGLASS_TEXT];
    hourglass_text(s->problem.control, control);
    if (s->collider.poses) {
        probe_text(&s->collider.shape, shape, sizeof shape);
        snprintf(press, sizeof press, "--probe %s --repulsion %.9g ", shape, o->repulsion);
    }
    if (r->rest >= 0)
        snprintf(until, sizeof until, "--rest %.9g", r->rest);
    else if (o->steps > 0)
        snprintf(until, sizeof until, "-n %lld", (long long)o->steps);
    else
        snprintf(until, sizeof until, "-t %.9g", o->seconds);
    return tool_provenance(t, e, "%s%s --ramp %.9g --hourglass %s [%s %s, dt %.9g%s, damping %.9g%s]", press, until,
                           o->ramp, control, r->device->is.device, o->precision ? "single" : "double", 1 / r->rate,
                           r->rate_fixed ? "" : " or cut", r->damping, r->adapt ? " adapted" : "");
}

/* Reads the frames that came, passes them on, and starts from the last. Frames of other materials are not passed on. */
static int take_frames(session *s, bool changed, err *e)
{
    frame last = {0};
    const int64_t count = stage_last_frame(&s->stage, &s->m, !changed, &last, e);
    if (count > 0 && changed)
        notes_add(&s->warnings, "the materials changed: %lld frame%s dropped; going on from the last", (long long)count,
                  count == 1 ? "" : "s");
    if (count > 0)
        s->next_frame = last.index + 1;
    s->started = count > 0 && !changed;
    const int failed = count > 0 ? tled_problem_start(&s->problem, &last, &s->warnings, e) : 0;
    frame_free(&last);
    return count < 0 ? -1 : failed;
}

/* Writes it first: who waits for it need not wait for what is to be said of it. */
static int put_frame(session *s, const frame *f, err *e)
{
    if (model_write_frame(s->stage.writer, f, e) || out_failed(s->stage.sink, e))
        return -1;
    const model_array *u = frame_find(f, "node.displacement");
    if (u && u->rows == s->problem.nodes)
        folds_add(&s->folds, f->time, u->f64);
    return 0;
}

static int write_frame(void *context, double time, const field_values *state, err *e)
{
    session *s = context;
    frame f = {.index = s->next_frame++, .time = time};
    bool whole = !fields_lend(&s->problem.fields, FIELD_IN_FRAMES, state, &f, &s->m, e) &&
                 !(s->collider.poses && collider_add(&s->problem, &f, &s->m, state->of[TLED_DISPLACEMENT], e));
    int result = whole && !put_frame(s, &f, e) && !(s->checkpoint && checkpoint_add(s->checkpoint, &f, e)) ? 0 : -1;
    frame_free(&f);
    return result;
}

static int replay_frame(void *context, const frame *f, err *e)
{
    session *s = context;
    s->next_frame = f->index + 1;
    return put_frame(s, f, e);
}

static void checked(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                    double damping)
{
    session *s = context;
    char left[60] = "";
    progress_at(&s->progress, (double)step);
    if (isfinite(remaining))
        snprintf(left, sizeof left, "%.3g of its displacement to go, ", remaining);
    tool_detail(s->t, "%.6g s: %skinetic %.3g J, strain %.3g J, stable step %.4g ms, damping %.4g 1/s", reading->time,
                left, reading->kinetic, reading->strain, 1e3 * reading->stable, damping);
    if (cut != s->cut)
        tool_detail(s->t, "each step is cut into %lld from now on, because of element %lld", (long long)cut,
                    (long long)reading->stable_element);
    s->cut = cut;
}

static void say_cut(void *context, const monitor_reading *reading, int64_t parts)
{
    session *s = context;
    char why[400];
    monitor_words(&s->m, reading, why, sizeof why);
    progress_clear(&s->progress);
    tool_say(s->t, "at %.6g s each step is cut into %lld, of %.4g ms: %s", reading->time, (long long)parts,
             1e3 / (s->run.rate * (double)parts), why);
    s->cut = parts;
}

static int save(void *context, const run_point *at, double time, const field_values *state, err *e)
{
    const session *s = context;
    if (checkpoint_save(s->checkpoint, at, time, state, e))
        return -1;
    tool_detail(s->t, "%.6g s: saved", time);
    return 0;
}

/* The last before the run: all that decides it stands. What went on is from then on the problem's
 * start; frames from before go out again. */
static int begin_checkpoints(session *s, const struct options *o, err *e)
{
    const fingerprint_run run = {s->t->provenance, &s->m, &s->run, &s->problem, s->next_frame};
    if (!o->checkpoint && !o->restart)
        return 0;
    s->run.save = save;
    s->run.save_every = o->checkpoint_every > 0 ? o->checkpoint_every : 0;
    s->checkpoint =
        o->restart ? checkpoint_resume(o->restart, &run, &s->warnings, e) : checkpoint_begin(o->checkpoint, &run, e);
    if (!s->checkpoint || !o->restart)
        return s->checkpoint ? 0 : -1;
    s->run.point = checkpoint_take(s->checkpoint, &s->problem);
    s->run.first = false;
    return checkpoint_replay(s->checkpoint, replay_frame, s, e);
}

/* Ends the log and the output. Where there is a checkpoint, which then goes, both
 * are stored first, also by a shell's `>`. */
static void end_output(session *s, const tool *t, err *e)
{
    if (s->checkpoint && s->log.file && !e->status)
        log_store(&s->log, e);
    if (s->checkpoint && s->stage.sink)
        out_outlast(s->stage.sink);
    log_close(&s->log, e);
    stage_close(&s->stage, t, e);
}

static void end_checkpoints(session *s, err *e)
{
    const double saved = s->checkpoint ? checkpoint_saved(s->checkpoint) : NAN;
    if (e->status == STATUS_BAD && isfinite(saved))
        tool_say(s->t, "the run up to %.6g s is saved; --restart goes on from there", saved);
    else if (s->checkpoint && !e->status)
        checkpoint_remove(s->checkpoint, e);
    checkpoint_close(s->checkpoint);
}

static void say_start(const session *s, const char *device, const struct options *o)
{
    const tled_problem *p = &s->problem;
    const run_setup *r = &s->run;
    char sides[100];
    snprintf(sides, sizeof sides, "%g x %g x %g mm", 1e3 * p->side[0], 1e3 * p->side[1], 1e3 * p->side[2]);
    if (p->conforming)
        snprintf(sides, sizeof sides, "any shape, %.4g mm in the mean", 1e3 * p->side[0]);
    tool_say(s->t, "%lld elements of %s, %lld nodes, %lld held; %s, %s precision", (long long)p->elements, sides,
             (long long)p->nodes, (long long)p->held, device, o->precision ? "single" : "double");
    tool_say(s->t, "stable step %.6g ms, dt %.6g ms, damping %.4g 1/s%s", 1e3 * s->stable, 1e3 / r->rate, r->damping,
             r->adapt ? ", then adapted" : "");
    if (!r->point && p->start > 0 && p->start >= o->ramp && (o->contract.count || o->gravity.count))
        tool_say(s->t, "the run begins after the ramp of %g s: -c and -g act in full from the first step", o->ramp);
    if (r->point)
        tool_say(s->t, "the run goes on from %.6g s, after %lld steps", p->start,
                 (long long)(r->point->first - r->point->course.from));
    else if (r->rest >= 0)
        tool_say(s->t, "from %.6g s to rest, tolerance %g", p->start, r->rest);
    else
        tool_say(s->t, "from %.6g s, %lld step%s%s", p->start, (long long)r->steps, r->steps == 1 ? "" : "s",
                 isfinite(r->end) ? ", the last one shorter" : "");
}

/* Where multiples of an option's interval lie between two steps, other than the last's end, which is met. */
static void say_between(const session *s, const char *option, const char *what, double every)
{
    const run_setup *r = &s->run;
    const double rate = r->rate, start = s->problem.start, origin = timeline_plan(start, rate).origin;
    const double end = isfinite(r->end) ? r->end : start + (double)r->steps / rate, last = end - 1e-6 / rate - origin;
    if (every == 0)
        return;
    const double first = (floor(start / every) + 1) * every - origin;
    if (every * rate < 1)
        tool_say(s->t, "%s %g s is shorter than a step: one %s is written for each step", option, every, what);
    else if ((first < last && timeline_is_between(first, rate)) ||
             (first + every < last && timeline_is_between(every, rate)))
        tool_say(s->t,
                 "multiples of %s %g s lie between steps: each %s is of the first step after one, up to %.3g ms late",
                 option, every, what, 1e3 / rate);
}

/* Of the frames that were written, whether the run came to its end or not. */
static void say_folds(session *s, const run_end *end, bool ended)
{
    char folded[FOLDS_TEXT];
    if (!s->folds.frames || out_failed(s->stage.sink, &(err){0}))
        return;
    folds_text(&s->folds, ended, folded);
    tool_say(s->t, "%s", folded);
    folds_warn(&s->folds, ended, end->most_strain, &s->warnings);
}

static void say_end(session *s, const run_end *end)
{
    const monitor_reading *w = &end->reading;
    char left[80] = "";
    if (end->parts > 1)
        tool_say(s->t, "steps were cut into up to %lld: %lld steps were taken in place of %lld", (long long)end->parts,
                 (long long)end->taken, (long long)end->steps);
    if (end->rested)
        snprintf(left, sizeof left, ", %.3g of its displacement to go", end->remaining);
    tool_say(s->t, "%s %.6g s, after %lld steps: kinetic energy %.3g J, largest displacement %.6g mm%s",
             end->rested ? "at rest at" : "at", w->time, (long long)end->steps, w->kinetic, 1e3 * w->largest, left);
    say_folds(s, end, true);
    tool_detail(s->t, "%s: %.4g MB, %.4g bytes an element", s->run.device->is.device, 1e-6 * (double)end->bytes,
                (double)end->bytes / (double)s->problem.elements);
}

/* What presses, and where. Its stiffness is part of the stable step. */
static int read_collider(session *s, const struct options *o, err *e)
{
    if (!o->probe && !o->poses)
        return 0;
    if (!o->probe || !o->poses)
        return err_usage(e, "--%s without --%s; expected both", o->probe ? "probe" : "poses",
                         o->probe ? "poses" : "probe");
    return probe_read(&s->collider.shape, o->probe, o->unit, o->common.anonymous, &s->m, e) ||
                   collider_read_poses(&s->collider, o->poses, e) || model_axis_add(&s->m, "probe", 1, e) ||
                   probe_carry(&s->collider.shape, &s->m, &s->warnings, e)
               ? -1
               : 0;
}

static const tled_executor *choose_device(session *s, const struct options *o, char *device, size_t size, err *e)
{
    const executor *const *table = o->precision ? tled_executors_single : tled_executors_double;
    static const char *const names[] = {"auto", "cuda", "cpu"};
    const executor_need need = tled_need(&s->problem);
    return tled_executor_of(executor_choose(table, names[o->device], &need, device, size, e));
}

/* In the model, for whoever asks for hourglass energy later. */
static int say_control(model *m, hourglass_control control, err *e)
{
    char text[HOURGLASS_TEXT];
    hourglass_text(control, text);
    return model_meta_set(m, "hourglass.control", text, e);
}

/* From the model that came to the problem and how it is to be run. */
static int prepare(session *s, const struct options *o, char *device, size_t size, err *e)
{
    hourglass_control control;
    s->run.rest = o->rest >= 0 ? o->rest : o->seconds < 0 && !o->steps ? rest_tolerance : -1;
    if (change_materials(s, o, e) || read_collider(s, o, e) || make_script(s, o, e) || read_control(o, &control, e) ||
        tled_problem_make(&s->problem, &s->m, &s->script, control, e) || say_control(&s->m, control, e) ||
        support_of(&s->problem, &s->support, e) ||
        support_check(&s->support, &s->problem, s->run.rest >= 0, s->collider.poses, &s->warnings, e))
        return -1;
    loads_check(&s->problem, &s->m, &s->warnings);
    if (s->collider.poses)
        collider_join(&s->collider, &s->problem, o->repulsion);
    if (choose_rate(s, o, e))
        return -1;
    choose_damping(s, o);
    s->run.single = o->precision;
    s->run.device = choose_device(s, o, device, size, e);
    int threads = tool_threads(s->t, e);
    s->threads = s->run.device && threads > 0 ? pool_create(threads, e) : NULL;
    /* Where a device computes, processors are free for frames. */
    return s->threads ? folds_make(&s->folds, &s->problem, &s->m, s->run.device->monitor ? threads : 1, e) : -1;
}

/* What the run is asked for, and whom it calls. */
static void set_run(session *s, const struct options *o)
{
    s->run.p = &s->problem;
    s->run.threads = s->threads;
    s->run.every = o->every > 0 ? o->every : 0;
    s->run.first = s->run.every > 0 && !s->started;
    s->run.context = s;
    s->run.frame = write_frame;
    s->run.checked = checked;
    s->run.cut = say_cut;
    s->cut = 1;
    s->log.every = fmax(o->log_every, 0);
}

static int open_log(session *s, const struct options *o, err *e)
{
    if (!o->log)
        return 0;
    s->run.log = &s->log;
    return log_open(&s->log, o->log, &o->tsv, &s->m, s->run.point ? &s->run.point->log : NULL, e);
}

/* From the last frame that came, or from the checkpoint. */
static int begin_run(session *s, const struct options *o, err *e)
{
    if (take_frames(s, o->materials || o->material.count, e) || choose_end(s, o, e))
        return -1;
    if (s->collider.poses)
        collider_begin(&s->collider, &s->problem, s->next_frame ? 0 : o->ramp, &s->warnings);
    set_run(s, o);
    return begin_checkpoints(s, o, e) || open_log(s, o, e) ? -1 : 0;
}

/* Writes frames, and the log, as the run goes. */
static int simulate(session *s, const struct options *o, const char *device, err *e)
{
    run_end end = {0};
    if (begin_run(s, o, e))
        return -1;
    tool_warn(s->t, &s->warnings);
    say_start(s, device, o);
    say_between(s, "--every", "frame", s->run.every);
    say_between(s, "--log-every", "row", s->log.every);
    progress_start(&s->progress, "tled-run", "steps", s->run.rest < 0 ? (double)s->run.steps : 0,
                   o->common.quiet || o->common.verbose);
    int result = run_go(&s->run, &end, e);
    progress_stop(&s->progress);
    if (result)
        say_folds(s, &end, false);
    else
        say_end(s, &end);
    return result;
}

static int read_input(session *s, const tool *t, struct options *o, err *e)
{
    if (check_end(o, e) || check_checkpoint(t, o, e))
        return -1;
    return stage_open_output(&s->stage, t, e) || stage_read(&s->stage, &s->m, e) ? -1 : 0;
}

/* The body: all that comes before frames. */
static int write_model(session *s, tool *t, const struct options *o, err *e)
{
    return say_provenance(t, s, o, e) || stage_write(&s->stage, &s->m, e) ? -1 : 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.dt = -1,
                        .seconds = -1,
                        .rest = -1,
                        .ramp = .1,
                        .damping = -1,
                        .every = -1,
                        .log_every = -1,
                        .repulsion = 1,
                        .checkpoint_every = -1};
    err e = {0};
    tool t = {0};
    session s = {.t = &t};
    char device[300] = "";
    if (tool_begin(&t, &options_table, argc, argv, &o, &e) || t.done)
        goto out;
    if (read_input(&s, &t, &o, &e) || prepare(&s, &o, device, sizeof device, &e) || write_model(&s, &t, &o, &e) ||
        simulate(&s, &o, device, &e))
        goto out;
out:
    tool_warn(&t, &s.warnings);
    if (!t.done)
        end_output(&s, &t, &e);
    end_checkpoints(&s, &e);
    pool_destroy(s.threads);
    folds_free(&s.folds);
    tled_problem_free(&s.problem);
    collider_free(&s.collider);
    script_free(&s.script);
    model_free(&s.m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
