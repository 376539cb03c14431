/* msds-run: presses a probe on a tetrahedral model, pose by pose, and writes a frame for each as soon as it is solved:
 * by springs and dampers or by finite elements. PST sections III and the appendix.
 */
#include "cli/batch.h"
#include "live/spnav.h"
#include "live/stop.h"
#include "msds/run/frame_report.h"
#include "msds/run/msds_live.h"
#include "msds/run/msds_record.h"
#include "msds/run/session.h"
#include "msds/run/settings.h"
#include "msds/run/solve_frame.h"
#include "probe/poses.h"

#include <string.h>

static int take_poses(session *s, poses *p, err *e)
{
    poses_event at;
    int got;
    while ((got = poses_next(p, &at, e)) > 0) {
        const pose here = placing_of(&s->placing, &at.at);
        const frame_input from = solve_frame_input(s, at.time, &here, at.line);
        if (at.kind == POSES_CONTROL ? settings_take(s, &p->lines, e) : solve_frame(s, &from, e))
            return -1;
    }
    progress_clear(&s->progress);
    if (got < 0)
        return -1;
    if (!s->posed)
        return err_set(e, s->source, 0, "no pose; expected lines `time tx ty tz qx qy qz qw`");
    frame_report_end(s);
    return 0;
}

/* The poses last: a FIFO opens when its writer comes. */
static int simulate(session *s, err *e)
{
    poses p;
    in *source = in_open(s->o->poses, e);
    if (!source)
        return -1;
    s->source = in_name(source);
    int failed = poses_open(&p, source, s->o->transform, e);
    if (!failed && s->o->marker)
        poses_of_marker(&p);
    failed = failed || take_poses(s, &p, e);
    in_close(source);
    return failed ? -1 : 0;
}

static bool is_stdin(const char *path)
{
    return path && !strcmp(path, "-");
}

static int check_live(const struct options *o, err *e)
{
    if (!o->poses && !o->control)
        return err_usage(e, "--live without --poses and --control; expected one of them, a FIFO, or - for stdin");
    if (o->transform || o->compare)
        return err_usage(e, "--%s with --live, which takes lines of poses; expected one of the two",
                         o->transform ? "transform" : "compare");
    if (o->haptics && !(o->probe && o->poses))
        return err_usage(e, "--haptics without --probe and --poses, of which it tells; expected them too");
    return o->force && !o->record ? err_usage(e, "--force without --record, which it is for") : 0;
}

static int check_replay(const struct options *o, err *e)
{
    if (o->live || o->poses || o->marker || o->control || o->record || o->compare || o->haptics)
        return err_usage(e, "--replay with --live, --poses, --marker, --control, --record, --haptics or --compare; "
                            "expected it alone: what came live is in the record, with poses as they were used");
    return 0;
}

static int check_options(const struct options *o, err *e)
{
    if (o->replay)
        return check_replay(o, e);
    if (o->marker && !o->poses)
        return err_usage(e, "--marker without --poses, which are of the marker; expected both");
    if (o->live)
        return check_live(o, e);
    if (!o->poses)
        return err_usage(e, "missing option --poses; expected --poses FILE");
    if (spnav_refuse(o->poses, e))
        return -1;
    if (o->control || o->record || o->force || o->haptics)
        return err_usage(e, "--control, --record, --force and --haptics are for --live; expected it too");
    return 0;
}

static int run(session *s, err *e)
{
    if (s->o->replay)
        return msds_record_replay(s, e);
    return s->o->live ? msds_live_run(s, e) : simulate(s, e);
}

static int run_to_end(session *s, err *e)
{
    const int failed = run(s, e);
    return session_finish(s, !failed, e) || failed ? -1 : 0;
}

/* Has what is on the device, from its making to its end. On a card jobs do this one after another, while the next are
 * prepared. */
static int make_frames(session *s, err *e)
{
    const bool waits = s->card && strcmp(s->device->is.device, "cpu") != 0;
    if (waits)
        pthread_mutex_lock(s->card);
    const int failed = session_start(s, e) || run_to_end(s, e) ? -1 : 0;
    session_leave(s);
    if (waits)
        pthread_mutex_unlock(s->card);
    return failed;
}

/* Of a session whose model has come, to its last frame. */
static int run_session(session *s, tool *t, err *e)
{
    if (session_prepare(s, e) || session_provenance(s, t, e) || stage_write(&s->stage, &s->m, e))
        return -1;
    s->listener = (msds_listener){frame_report_work, s};
    if (!s->card)
        progress_start(&s->progress, run_options_table.name, "poses", 0, s->o->common.quiet);
    return make_frames(s, e);
}

static void end_session(session *s, tool *t, err *e)
{
    progress_stop(&s->progress);
    tool_warn(t, &s->warnings);
    if (!t->done)
        stage_close(&s->stage, t, e);
    session_free(s);
}

static int read_input(session *s, const tool *t, err *e)
{
    struct options *o = s->o;
    if (check_options(o, e))
        return -1;
    if (o->live)
        stop_catch();
    if (o->haptics && !(s->socket = broadcast_open(o->haptics, e)))
        return -1;
    session_ahead(s);
    s->stage.lines_follow = o->live && (is_stdin(o->poses) || is_stdin(o->control));
    return stage_open_output(&s->stage, t, e) || (o->replay && msds_record_probe(s, e)) ||
                   stage_read(&s->stage, &s->m, e)
               ? -1
               : 0;
}

/* ---- Jobs of --batch */

typedef struct jobs {
    stage_shared from;
    pthread_mutex_t card;
} jobs;

static int check_job(void *options, err *e)
{
    const struct options *o = options;
    if (o->poses && spnav_is(o->poses))
        return err_usage(e, "--poses %.60s in a job; expected a file of poses", o->poses);
    return check_options(o, e);
}

/* A run like any other, of the model that all jobs share. */
static int run_job(void *context, tool *t, void *options, char said[BATCH_SAID], err *e)
{
    jobs *b = context;
    session s = {.t = t, .o = options, .card = &b->card};
    if (!stage_open_output(&s.stage, t, e) && !stage_shared_lend(&b->from, &s.stage, &s.m, e) && !run_session(&s, t, e))
        frame_report_words(&s, said, BATCH_SAID);
    end_session(&s, t, e);
    return e->status ? -1 : 0;
}

static int run_batch(const tool *t, const struct options *o, err *e)
{
    jobs b = {.from = {.frames = 0}};
    const batch_use use = {sizeof *o, &run_options_defaults, o, check_job, run_job, &b};
    pthread_mutex_init(&b.card, NULL);
    const int failed =
        stage_read(&b.from.stage, &b.from.m, e) || stage_shared_read(&b.from, e) || batch_go(t, o->batch, &use, e) ? -1
                                                                                                                   : 0;
    pthread_mutex_destroy(&b.card);
    stage_shared_free(&b.from);
    return failed;
}

static int run_tool(int argc, char **argv)
{
    struct options o = run_options_defaults;
    err e = {0};
    tool t = {0};
    session s = {.t = &t, .o = &o};
    if (tool_begin(&t, &run_options_table, argc, argv, &o, &e) || t.done)
        goto out;
    if (o.batch) {
        run_batch(&t, &o, &e);
        return tool_end(&t, &e);
    }
    if (!read_input(&s, &t, &e))
        run_session(&s, &t, &e);
out:
    end_session(&s, &t, &e);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
