/* tled-run: moves a voxel model by total Lagrangian explicit dynamics under gravity, forces, displacements and the
 * contraction of its muscles, and writes frames. Miller et al. 2007; W&M section 4.2.
 */
#include "cli/batch.h"
#include "live/stop.h"
#include "model/hourglass_text.h"
#include "model/materials.h"
#include "tled/loop/fingerprint.h"
#include "tled/loop/timeline.h"
#include "tled/problem/bodies.h"
#include "tled/problem/loads.h"
#include "tled/problem/step.h"
#include "tled/run/tled_batch.h"
#include "tled/run/tled_frame.h"
#include "tled/run/tled_inputs.h"
#include "tled/run/tled_live.h"
#include "tled/run/tled_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REST_STEPS = 200000 };                               /* after the script's end, before a run to rest gives up */
static const int64_t LIVE_STEPS = INT64_C(900000000000000); /* longer than anyone waits */

static const double rest_tolerance = 1e-4;

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

static int read_control(struct options *o, err *e)
{
    if (!hourglass_read(o->hourglass ? o->hourglass : "physical", &o->control))
        return 0;
    return err_usage(e, "--hourglass '%s': expected physical or isotropic[:KAPPA], KAPPA from 0 to 1000", o->hourglass);
}

/* Shorter time constants than the shortest are none; the longest is longer than anyone's. */
static int check_levels(const struct options *o, err *e)
{
    static const double shortest = 1e-4, longest = 100; /* s */
    for (int i = 0; i < o->rise_fall.count; i++)
        if (!(o->rise_fall.value[i] >= shortest && o->rise_fall.value[i] <= longest))
            return err_usage(e, "--rise-fall %g,%g; expected two times from %g to %g s", o->rise_fall.value[0],
                             o->rise_fall.value[1], shortest, longest);
    if (o->between >= 0 && !o->activations)
        return err_usage(e, "--between without --activations, whose rows it is for; expected both");
    return 0;
}

static int check_results(struct options *o, err *e)
{
    for (int i = 0; i < o->results.count; i++)
        if (results_read(o->results.value[i], "--results", &o->which, e))
            return -1;
    return 0;
}

static int check_end(struct options *o, err *e)
{
    if (o->checkpoint_every > 0 && !o->checkpoint && !o->restart)
        return err_usage(e, "--checkpoint-every without --checkpoint or --restart; expected one of them");
    int ends = (o->seconds >= 0) + (o->steps > 0) + (o->rest >= 0);
    if (ends > 1)
        return err_usage(e, "-t, -n and --rest are three ways to end; expected one of them");
    if (check_log(o, e) || check_levels(o, e) || check_results(o, e))
        return -1;
    if (live_check(o, e))
        return -1;
    if (o->damping == 0 && !o->live && !o->replay && (!ends || o->rest >= 0))
        return err_usage(e, "without damping nothing comes to rest; expected -t or -n to end, or a --damping above 0");
    return 0;
}

static int change_materials(model *m, const struct options *o, err *e)
{
    in *source = o->materials ? in_open(o->materials, e) : NULL;
    int result = o->materials && (!source || materials_override(m, source, e)) ? -1 : 0;
    in_close(source);
    return result ? result : materials_set(m, o->material.value, o->material.count, e);
}

/* The step: half the stable one, or --dt if that is not above it. */
static int choose_rate(session *s, const struct options *o, err *e)
{
    int32_t stiffest = 0;
    s->stable = followers_step(followers_square_at_rest(&s->problem) + loads_square(&s->problem, NULL),
                               collider_step(&s->problem, step_at_rest(&s->problem, &stiffest)));
    if (o->dt > s->stable)
        return err_set(e, NULL, 0, "--dt %g is above the stable step; expected at most %.6g s (volume '%s')", o->dt,
                       s->stable * (1 - 1e-5), s->problem.volume[stiffest].name); /* rounded down */
    if (s->live)
        return live_prepare(s, o, e);
    s->run.rate_fixed = o->dt > 0;
    s->run.rate = o->dt > 0 ? 1 / o->dt : step_rate(s->stable, &s->run.check);
    if (o->dt > 0)
        s->run.check = STEP_UNSEEN_GIVEN;
    return 0;
}

/* How many steps. Frames given are behind us: the problem's start stands. */
static int choose_end(session *s, const struct options *o, err *e)
{
    run_setup *r = &s->run;
    if (s->live && o->seconds < 0 && !o->steps) {
        r->steps = LIVE_STEPS;
        r->end = -INFINITY;
        return 0;
    }
    double left = o->seconds, first = fabs(s->problem.start) * r->rate;
    if (r->rest >= 0)
        left = fmax(0, collider_events_end(&s->problem) - s->problem.start);
    if (o->steps > 0)
        left = (double)o->steps / r->rate;
    if (!(first + left * r->rate < 1e15))
        return err_set(e, NULL, 0, "a run up to step %g; expected fewer than 1e15", first + left * r->rate);
    r->steps = o->steps > 0 ? o->steps : timeline_steps_to(left, r->rate) + (r->rest >= 0 ? REST_STEPS : 0);
    r->end = !s->live && o->seconds >= 0 && timeline_is_between(left, r->rate) ? s->problem.start + left : -INFINITY;
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
    char until[80], shape[300] = "", press[360] = "";
    const run_setup *r = &s->run;
    char control[HOURGLASS_TEXT];
    hourglass_text(s->problem.control, control);
    if (s->collider.poses) {
        probe_text(&s->collider.shape, shape, sizeof shape);
        snprintf(press, sizeof press, "--probe %s --repulsion %.9g ", shape, o->repulsion);
    }
    if (s->live)
        snprintf(until, sizeof until, "--live");
    else if (r->rest >= 0)
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
    s->run.first = (s->run.every > 0 || s->live) && !s->started;
    const int failed = count > 0 && (tled_problem_start(&s->problem, &last, &s->warnings, e) ||
                                     (!changed && frame_choice_follow(&s->frames, &last, stage_name(&s->stage), e)))
                           ? -1
                           : 0;
    if (count > 0)
        sliding_start(&s->sliding, &last);
    frame_free(&last);
    return count < 0 ? -1 : failed;
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
    return checkpoint_replay(s->checkpoint, tled_frame_replay, s, e);
}

/* Ends the log and the output. Where there is a checkpoint, which then goes, both
 * are stored first, also by a shell's `>`. */
static void end_output(session *s, const tool *t, err *e)
{
    if (s->checkpoint && s->log.file && !e->status)
        log_store(&s->log, e);
    if (s->checkpoint && s->stage.sink && !stage_written(&s->stage, &(err){0}))
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

static const char *const device_names[] = {"auto", "cuda", "cpu"};

static const executor *const *executors_for(const struct options *o)
{
    return o->precision ? tled_executors_single : tled_executors_double;
}

static const tled_executor *choose_device(session *s, const struct options *o, char *device, size_t size, err *e)
{
    const executor_need need = tled_need(&s->problem);
    executor_ahead_wait(&s->ahead);
    return tled_executor_of(executor_choose(executors_for(o), device_names[o->device], &need, device, size, e));
}

/* What a run to rest in single precision goes on by where rounding stops it: the same device in double, if it can. */
static const tled_executor *choose_finer(const session *s)
{
    char says[300];
    err none = {0};
    const executor_need need = tled_need(&s->problem);
    if (!s->run.device || !s->run.single || s->run.rest < 0)
        return NULL;
    return tled_executor_of(
        executor_choose(tled_executors_double, s->run.device->is.device, &need, says, sizeof says, &none));
}

/* In the model, for whoever asks for hourglass energy later. */
static int say_control(model *m, hourglass_control control, err *e)
{
    char text[HOURGLASS_TEXT];
    hourglass_text(control, text);
    return model_meta_set(m, "hourglass.control", text, e);
}

static int check_friction(const session *s, const struct options *o, err *e)
{
    if (o->friction > 0 && !s->problem.sliding && !s->problem.self_contact)
        return err_option(e, "--friction",
                          "no node of the model slides on bone, and no skin touches itself; expected "
                          "some (attach --slide, bind --self-contact)");
    return 0;
}

/* Residuals have in them what presses skin that touches itself, so that they do not come to nothing. */
static int check_skin(session *s, err *e)
{
    const self_contact *c = s->problem.self_contact;
    if (c && s->run.rest >= 0)
        return err_option(e, "--rest",
                          "of skin that touches itself it is not known when it is at rest; expected -t or -n");
    if (c && c->deep)
        notes_add(
            &s->warnings,
            "%lld of %lld samples of skin are deeper in other tissue at rest than %g of a voxel, the deepest %.4g "
            "mm: they touch where they are deeper than that",
            (long long)c->deep, (long long)c->samples, SELF_CONTACT_DEEP, 1e3 * c->deepest);
    if (c && c->deep_in_bone)
        notes_add(&s->warnings,
                  "%lld of %lld samples of skin are deeper in bone at rest than %g of a voxel, the deepest %.4g mm: "
                  "they may stay as deep as that",
                  (long long)c->deep_in_bone, (long long)c->samples, SELF_CONTACT_DEEP, 1e3 * c->deepest_in_bone);
    if (!c && s->sliding.touches)
        notes_add(&s->warnings, "there is bone that skin may not enter (attach --contact), but no samples of skin; "
                                "expected some (bind --self-contact)");
    return 0;
}

/* From the model that came to the problem and how it is to be run. */
static int prepare(session *s, const struct options *o, char *device, size_t size, err *e)
{
    s->run.rest = o->rest >= 0 ? o->rest : o->seconds < 0 && !o->steps && !s->live ? rest_tolerance : -1;
    const int threads = tool_threads(s->t, e);
    s->threads = threads > 0 ? pool_create(threads, e) : NULL;
    if (!s->threads)
        return -1;
    s->problem.threads = s->threads;
    if ((!s->card && change_materials(&s->m, o, e)) || tled_inputs_collider(s, o, e) || tled_inputs_script(s, o, e) ||
        tled_problem_make(&s->problem, &s->m, &s->script, o->control, e) || say_control(&s->m, o->control, e) ||
        sliding_make(&s->sliding, &s->problem, &s->m, o->friction, e) ||
        self_contact_make(&s->skin, &s->problem, &s->m, &s->sliding, o->friction, NULL, e) || check_friction(s, o, e) ||
        check_skin(s, e) || support_of(&s->problem, &s->support, e) ||
        support_check(&s->support, &s->problem, s->run.rest >= 0, s->collider.poses, &s->warnings, e))
        return -1;
    loads_check(&s->problem, &s->m, &s->warnings);
    fibres_note(&s->problem.fibres, &s->m, &s->warnings);
    if (s->collider.poses)
        collider_join(&s->collider, &s->problem, o->repulsion);
    if (choose_rate(s, o, e))
        return -1;
    choose_damping(s, o);
    s->run.single = o->precision;
    s->run.device = choose_device(s, o, device, size, e);
    s->run.finer = choose_finer(s);
    /* Where a device computes, processors are free for frames. */
    if (!s->run.device ||
        folds_make(&s->folds, &s->problem, &s->m, s->run.device->monitor ? pool_threads(s->threads) : 1, e))
        return -1;
    return tled_frame_results(s, o, e) || tled_frame_choose(s, o, e) ? -1 : 0;
}

/* What the run is asked for, and whom it calls. */
static void set_run(session *s, const struct options *o)
{
    s->run.p = &s->problem;
    s->run.threads = s->threads;
    s->run.every = o->every > 0 ? o->every : 0;
    s->run.context = s;
    s->run.frame = tled_frame_write;
    s->run.last = tled_frame_last;
    s->run.checked = checked;
    s->run.cut = say_cut;
    s->run.refined = words_refined;
    s->cut = 1;
    s->log.every = fmax(o->log_every, 0);
}

static int open_log(session *s, const struct options *o, err *e)
{
    if (!o->log)
        return 0;
    s->run.log = &s->log;
    s->log.script = &s->script;
    s->log.p = &s->problem;
    return log_open(&s->log, o->log, &o->tsv, &s->m, s->run.point ? &s->run.point->log : NULL, e);
}

/* A run whose last state alone is wanted, to rest from rest, begins near its end if it can. A card has gone the whole
 * way before processors have made the coarser models. */
static int start_coarse(session *s, const struct options *o)
{
    const bool shown = o->every > 0 || o->log, goes_on = o->restart || s->next_frame;
    const bool is_card = strcmp(s->run.device->is.device, "cpu") != 0;
    err none = {0};
    if (o->coarse || is_card || !s->run.adapt || o->dt > 0 || o->checkpoint || shown || goes_on)
        return 0;
    s->run.coarser = multigrid_make(&s->run, &s->problem, &s->m, 0, &none);
    if (s->run.coarser && multigrid_start(s->run.coarser, &s->problem, &none)) {
        multigrid_free(s->run.coarser);
        s->run.coarser = NULL;
    }
    words_coarse(s, &none);
    s->run.smooth = MULTIGRID_SMOOTH;
    return 0;
}

/* Where what came of that failed: from the beginning. */
static int run_anew(session *s, const struct options *o, run_end *end, err *e)
{
    words_anew(s, e);
    *e = (err){0};
    multigrid_free(s->run.coarser);
    s->run.coarser = NULL;
    multigrid_forget(&s->problem);
    return choose_end(s, o, e) ? -1 : tled_batch_run(s, end, e);
}

/* From the last frame that came, or from the checkpoint. */
static int begin_run(session *s, const struct options *o, err *e)
{
    set_run(s, o);
    if (take_frames(s, o->materials || o->material.count, e) || frame_choice_open(&s->frames, &s->m, e) ||
        start_coarse(s, o) || choose_end(s, o, e))
        return -1;
    if (s->collider.poses && !s->live)
        collider_begin(&s->collider, &s->problem, s->next_frame ? 0 : o->ramp, &s->warnings);
    if (s->live)
        return live_open(s, o, e);
    return begin_checkpoints(s, o, e) || open_log(s, o, e) ? -1 : 0;
}

/* Writes frames, and the log, as the run goes. */
static int simulate(session *s, const struct options *o, const char *device, run_end *end, err *e)
{
    if (begin_run(s, o, e))
        return -1;
    tool_warn(s->t, &s->warnings);
    words_start(s, device, o);
    words_between(s, "--every", "frame", s->run.every);
    words_between(s, "--log-every", "row", s->log.every);
    progress_start(&s->progress, "tled-run", "steps", s->run.rest < 0 ? (double)s->run.steps : 0,
                   o->common.quiet || o->common.verbose);
    int result = s->live ? live_go(s, end, e) : tled_batch_run(s, end, e);
    if (result && s->run.coarser && !s->next_frame)
        result = run_anew(s, o, end, e);
    progress_stop(&s->progress);
    if (s->live)
        live_end(s);
    if (result)
        words_folds(s, end, false);
    else
        words_end(s, end);
    return result;
}

static int read_input(session *s, const tool *t, struct options *o, err *e)
{
    if (check_end(o, e) || read_control(o, e) || check_checkpoint(t, o, e) || live_create(s, o, e))
        return -1;
    if (s->live)
        stop_catch();
    executor_ahead_start(&s->ahead, executors_for(o), device_names[o->device], &(executor_need){.features = 0});
    s->stage.lines_follow = o->live && ((o->lines && !strcmp(o->lines, "-")) || (o->poses && !strcmp(o->poses, "-")));
    return stage_open_output(&s->stage, t, e) || stage_read(&s->stage, &s->m, e) ? -1 : 0;
}

/* The body: all that comes before frames, in a run that does not keep up with a clock while the solver is made. */
static int write_model(session *s, tool *t, const struct options *o, err *e)
{
    if (say_provenance(t, s, o, e))
        return -1;
    return s->live ? stage_write(&s->stage, &s->m, e) : stage_write_beside(&s->stage, &s->m, e);
}

/* Of a session whose model has come, to the end of its run. */
static int run_session(session *s, tool *t, const struct options *o, run_end *end, err *e)
{
    char device[300] = "";
    return prepare(s, o, device, sizeof device, e) || write_model(s, t, o, e) || simulate(s, o, device, end, e) ? -1
                                                                                                                : 0;
}

static void end_session(session *s, tool *t, err *e)
{
    tool_warn(t, &s->warnings);
    if (!t->done)
        end_output(s, t, e);
    end_checkpoints(s, e);
    executor_ahead_end(&s->ahead);
    live_destroy(s->live);
    pool_destroy(s->threads);
    results_destroy(s->results);
    free(s->activation);
    multigrid_free(s->run.coarser);
    folds_free(&s->folds);
    frame_choice_free(&s->frames);
    tled_problem_free(&s->problem);
    collider_free(&s->collider);
    sliding_free(&s->sliding);
    self_contact_free(&s->skin);
    script_free(&s->script);
    expressions_free(&s->expressions);
    model_free(&s->m);
}

/* What the command line says of logs is of the jobs that have one. */
static int check_job(void *options, err *e)
{
    struct options *o = options;
    if (!o->log) {
        o->log_every = options_defaults.log_every;
        o->tsv = options_defaults.tsv;
    }
    return check_end(options, e) || read_control(options, e) ? -1 : 0;
}

/* A job of --batch: a run like any other, of the model that all jobs share. */
static int run_job(void *context, tool *t, void *options, char said[BATCH_SAID], err *e)
{
    session s = {.t = t};
    run_end end = {0};
    if (!stage_open_output(&s.stage, t, e) && !tled_batch_share(context, &s, e) &&
        !run_session(&s, t, options, &end, e))
        tled_batch_words(&end, said);
    end_session(&s, t, e);
    return e->status ? -1 : 0;
}

static int run_batch(const tool *t, struct options *o, err *e)
{
    tled_batch b = {.card = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, 0}};
    const batch_use use = {sizeof *o, &options_defaults, o, check_job, run_job, &b};
    executor_ahead ahead = {0};
    executor_ahead_start(&ahead, executors_for(o), device_names[o->device], &(executor_need){.features = 0});
    const int failed = stage_read(&b.from.stage, &b.from.m, e) || change_materials(&b.from.m, o, e) ||
                               tled_batch_read(&b, o, e) || batch_go(t, o->batch, &use, e)
                           ? -1
                           : 0;
    executor_ahead_end(&ahead);
    tled_batch_free(&b);
    return failed;
}

static int run_tool(int argc, char **argv)
{
    struct options o = options_defaults;
    err e = {0};
    tool t = {0};
    session s = {.t = &t};
    run_end end = {0};
    if (tool_begin(&t, &options_table, argc, argv, &o, &e) || t.done)
        goto out;
    if (o.batch) {
        run_batch(&t, &o, &e);
        return tool_end(&t, &e);
    }
    if (!read_input(&s, &t, &o, &e))
        run_session(&s, &t, &o, &end, &e);
out:
    end_session(&s, &t, &e);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
