/* us-slice: for each frame, the ultrasound image that its probe sees of a deformed volume (PST section IV). */
#include "probe/poses.h"
#include "slice/image/slice_live.h"
#include "slice/image/slice_session.h"

typedef struct job {
    slice_session s;
    in *pose_source;
    poses poses;
    bool more_poses;
    bool said; /* where poses come from */
} job;

/* The poses last: a FIFO opens when its writer comes. */
static int prepare(job *j, const slice_options *o, const tool *t, const char *path, err *e)
{
    if (slice_session_open(&j->s, o, t, path, e))
        return -1;
    if (!o->poses || o->live)
        return 0;
    j->pose_source = in_open(o->poses, e);
    j->more_poses = true;
    if (!j->pose_source || poses_open(&j->poses, j->pose_source, o->transform, e))
        return -1;
    if (o->marker)
        poses_of_marker(&j->poses);
    return 0;
}

/* Where poses come from, once the first is there: which transform a sequence gives, it says itself. */
static void say_poses(job *j)
{
    const plus *p = &j->poses.frames;
    const char *in_frame = j->s.o.body ? "that of the body, in which the volume lies as --body says" : "the volume's";
    if (j->said)
        return;
    j->said = true;
    if (!j->more_poses)
        tool_say(j->s.t, "poses: those of the frames");
    else if (j->poses.sequence)
        tool_say(j->s.t, "poses: %sTo%s of %s; their frame is %s", p->from, p->to, in_name(j->pose_source), in_frame);
    else
        tool_say(j->s.t, "poses: lines of %s; their frame is %s", in_name(j->pose_source), in_frame);
}

/* The next pose, in the volume's frame. 1, 0 at the end, -1. */
static int next_pose(job *j, pose *to, err *e)
{
    poses_event at;
    int got;
    do
        got = poses_next(&j->poses, &at, e);
    while (got > 0 && at.kind != POSES_POSE);
    if (got <= 0)
        return got;
    say_poses(j);
    *to = placing_of(&j->s.placing, &at.at);
    return 1;
}

/* The displacement of the last frame read; NULL where there was no frame: at rest. */
static int displacement_of(const job *j, const double **to, err *e)
{
    const source *m = &j->s.model;
    *to = m->frames ? slice_session_displacement(&j->s, &m->frame, e) : NULL;
    return m->frames && !*to ? -1 : 0;
}

static int frame_pose(job *j, pose *to, err *e)
{
    if (slice_session_pose(&j->s, &j->s.model.frame, to, e))
        return -1;
    say_poses(j);
    return 0;
}

/* A frame an image. */
static int slice_frames(job *j, err *e)
{
    int got;
    while ((got = source_next(&j->s.model, e)) > 0) {
        pose from;
        const double *u;
        int posed = j->more_poses ? next_pose(j, &from, e) : 1;
        if (posed < 0 || (!j->more_poses && frame_pose(j, &from, e)) || displacement_of(j, &u, e))
            return -1;
        if (!posed)
            return err_set(e, in_name(j->pose_source), 0,
                           "has %lld poses, fewer than there are frames; expected one each", (long long)j->s.images);
        if (slice_session_put(&j->s, j->s.model.frame.index, &from, u, e))
            return -1;
    }
    if (!got && !j->s.model.frames && !j->more_poses)
        return err_set(e, source_name(&j->s.model), 0,
                       "the model has no frames; expected those of msds-run, or --poses");
    return got;
}

/* A pose an image: of the volume as it lies, or as the last frame leaves it. */
static int slice_poses(job *j, err *e)
{
    pose from;
    const double *u = NULL;
    int got;
    if (!j->s.o.rigid && displacement_of(j, &u, e))
        return -1;
    while ((got = next_pose(j, &from, e)) > 0)
        if (slice_session_put(&j->s, j->s.images, &from, u, e))
            return -1;
    if (!got && !j->s.images)
        return err_set(e, in_name(j->pose_source), 0, "no pose; expected lines `time tx ty tz qx qy qz qw`");
    return got;
}

static int make_images(job *j, err *e)
{
    if (j->s.o.live)
        return slice_live_run(&j->s, e);
    if (j->s.o.replay)
        return slice_live_replay(&j->s, e);
    if (!j->s.o.rigid && slice_frames(j, e))
        return -1;
    return j->more_poses ? slice_poses(j, e) : 0;
}

static int run_tool(int argc, char **argv)
{
    slice_options o = slice_options_default();
    err e = {0};
    tool t = {0};
    job j = {0};
    if (tool_begin(&t, &slice_table, argc, argv, &o, &e) || t.done || slice_options_check(&o, &e))
        goto out;
    if (prepare(&j, &o, &t, argv[1], &e) || make_images(&j, &e))
        goto out;
    if (!j.s.lit && j.s.images)
        notes_add(&j.s.warnings,
                  "every image (of %lld) is black; expected poses in metres, in the volume's frame%s, that look "
                  "into it%s",
                  (long long)j.s.images, o.rigid ? "" : " (which is the model's too)",
                  j.s.coupling.beams ? ", with the face on tissue (--coupling)" : "");
out:
    tool_warn(&t, &j.s.warnings);
    slice_session_close(&j.s, &e);
    in_close(j.pose_source);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
