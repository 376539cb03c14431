/* msds-run: presses a probe on a tetrahedral model, pose by pose, and writes a frame for each as soon as it is solved:
 * by springs and dampers or by finite elements. PST sections III and the appendix.
 */
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

static int run_tool(int argc, char **argv)
{
    struct options o = {.method = METHOD_TISSUE,
                        .iterations = 20,
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
    if (check_options(&o, &e))
        goto out;
    if (o.live)
        stop_catch();
    if (o.haptics && !(s.socket = broadcast_open(o.haptics, &e)))
        goto out;
    session_ahead(&s);
    s.stage.lines_follow = o.live && (is_stdin(o.poses) || is_stdin(o.control));
    if (stage_open_output(&s.stage, &t, &e) || (o.replay && msds_record_probe(&s, &e)) ||
        stage_read(&s.stage, &s.m, &e) || session_prepare(&s, &e) || session_provenance(&s, &t, &e) ||
        stage_write(&s.stage, &s.m, &e) || session_start(&s, &e))
        goto out;
    progress_start(&s.progress, run_options_table.name, "poses", 0, o.common.quiet);
    s.listener = (msds_listener){frame_report_work, &s};
    session_finish(&s, !run(&s, &e), &e);
out:
    progress_stop(&s.progress);
    tool_warn(&t, &s.warnings);
    if (!t.done)
        stage_close(&s.stage, &t, &e);
    session_free(&s);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
