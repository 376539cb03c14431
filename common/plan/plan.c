#include "plan/plan.h"

#include "base/near.h"

#include <math.h>
#include <string.h>

/* Of all of a plan. */
enum { POSES_MOST = 100000000 };

static const double seconds_most = 1e6;

/* What a line does. */
typedef enum verb { AT, PRESS, SWEEP, FAN, ROCK, TURN, MOVE, HOLD, TREMOR, VERBS } verb;
static const char *const verbs[VERBS] = {"at", "press", "sweep", "fan", "rock", "turn", "move", "hold", "tremor"};

/* What it takes, for messages. */
static const char *const words[VERBS] = {"at PLACE [into AXIS] [columns AXIS]",
                                         "press DEPTH SECONDS",
                                         "sweep X,Y,Z SECONDS",
                                         "fan DEGREES SECONDS",
                                         "rock DEGREES SECONDS",
                                         "turn DEGREES SECONDS",
                                         "move PLACE [into AXIS] [columns AXIS] SECONDS",
                                         "hold SECONDS",
                                         "tremor LENGTH HZ"};

/* A motion from one pose: by a way, about an axis of the probe, or to another pose. */
typedef struct motion {
    pose from, to;
    double way[3]; /* m, in the probe's frame */
    int axis;      /* of the turn */
    double angle;  /* radians */
    bool is_to;
} motion;

static pose pose_at(const motion *m, double share)
{
    pose by = pose_none();
    if (m->is_to)
        return pose_slerp(&m->from, &m->to, share);
    for (int a = 0; a < 3; a++)
        by.position[a] = share * m->way[a];
    by.quaternion[m->axis] = sin(share * m->angle / 2);
    by.quaternion[3] = cos(share * m->angle / 2);
    return pose_compose(&m->from, &by);
}

/* A hand trembles along all axes of the probe, each at a frequency of its own, so that it does not repeat soon. */
static pose trembling(const plan *p, const pose *at, double time)
{
    static const double ratio[3] = {1, .8284271247461903, 1.1547005383792517}, phase[3] = {0, 1, 2};
    pose by = pose_none();
    for (int a = 0; a < 3; a++)
        by.position[a] = p->tremor * sin(2 * acos(-1) * p->hertz * ratio[a] * time + phase[a]);
    return p->tremor > 0 ? pose_compose(at, &by) : *at;
}

static void put_pose(plan *p, double time, const pose *at)
{
    const pose here = trembling(p, at, time);
    const double *x = here.position, *q = here.quaternion;
    out_format(p->to, "%.6f %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", time, x[0], x[1], x[2], q[0], q[1], q[2], q[3]);
    p->poses++;
}

/* Writes the poses before the time at which a motion ends; the next line writes those from there on. */
static int go(plan *p, const keyfile *k, const motion *m, double seconds, err *e)
{
    const double begin = p->time, end = begin + seconds, slight = 1e-9 * (1 + end);
    if (end * p->rate > POSES_MOST)
        return keyfile_error(k, e, "the plan has more than %d poses by here; expected a lower --rate, or less time",
                             (int)POSES_MOST);
    for (double time; (time = (double)p->poses / p->rate) < end - slight;) {
        const double s = (time - begin) / seconds;
        const pose at = pose_at(m, s * s * (3 - 2 * s));
        put_pose(p, time, &at);
    }
    p->at = pose_at(m, 1);
    p->time = end;
    return 0;
}

/* ---- lines */

static int need_words(const keyfile *k, verb v, int count, err *e)
{
    if (k->count == count)
        return 0;
    return keyfile_error(k, e, "%d words; expected %s", k->count, words[v]);
}

static int take_seconds(const keyfile *k, int at, double *to, err *e)
{
    if (at < k->count && !num_double(k->word[at], to) && *to > 0 && *to <= seconds_most)
        return 0;
    return keyfile_error(k, e, "'%.100s': expected seconds, above 0 and at most %g", at < k->count ? k->word[at] : "",
                         seconds_most);
}

static int take_angle(const keyfile *k, double *to, err *e)
{
    if (num_double(k->word[1], to) || !(fabs(*to) <= 36000))
        return keyfile_error(k, e, "'%.100s': expected degrees, from -36000 to 36000", k->word[1]);
    *to *= acos(-1) / 180;
    return 0;
}

static int take_at(plan *p, const keyfile *k, err *e)
{
    int next;
    if (stand_take(p->s, k, 1, &next, &p->at, e))
        return -1;
    if (next < k->count)
        return keyfile_error(k, e, "'%.100s': expected %s", k->word[next], words[AT]);
    p->is_placed = true;
    return 0;
}

static int take_move(const plan *p, const keyfile *k, motion *m, double *seconds, err *e)
{
    int next;
    m->is_to = true;
    if (stand_take(p->s, k, 1, &next, &m->to, e) || take_seconds(k, next, seconds, e))
        return -1;
    return next + 1 == k->count ? 0 : keyfile_error(k, e, "'%.100s': expected %s", k->word[next + 1], words[MOVE]);
}

static int take_tremor(plan *p, const keyfile *k, err *e)
{
    double size, hertz;
    if (need_words(k, TREMOR, 3, e) || stand_length(p->s, k, k->word[1], &size, e))
        return -1;
    if (!(size >= 0))
        return keyfile_error(k, e, "'%.100s': expected a length of 0 or more", k->word[1]);
    if (num_double(k->word[2], &hertz) || !(hertz > 0 && hertz <= 1000))
        return keyfile_error(k, e, "'%.100s': expected a frequency, above 0 and at most 1000 Hz", k->word[2]);
    p->tremor = size;
    p->hertz = hertz;
    return 0;
}

/* Of those that have a number or a place, and then seconds. */
static int take_motion(const plan *p, const keyfile *k, verb v, motion *m, double *seconds, err *e)
{
    if (v == MOVE)
        return take_move(p, k, m, seconds, e);
    if (need_words(k, v, v == HOLD ? 2 : 3, e) || take_seconds(k, k->count - 1, seconds, e))
        return -1;
    if (v == PRESS)
        return stand_length(p->s, k, k->word[1], &m->way[2], e);
    if (v == SWEEP)
        return stand_lengths(p->s, k, k->word[1], m->way, e);
    m->axis = v == FAN ? 0 : v == ROCK ? 1 : 2;
    return v == HOLD ? 0 : take_angle(k, &m->angle, e);
}

int plan_take(plan *p, const keyfile *k, err *e)
{
    int v = 0;
    double seconds = 0;
    while (v < VERBS && strcmp(k->word[0], verbs[v]) != 0)
        v++;
    if (v == VERBS)
        return near_unknown(e, k->name, k->line, "word", k->word[0], verbs, VERBS);
    if (v == AT)
        return take_at(p, k, e);
    if (v == TREMOR)
        return take_tremor(p, k, e);
    if (!p->is_placed)
        return keyfile_error(k, e, "%s before the probe is anywhere; expected at PLACE first", k->word[0]);
    motion m = {.from = p->at, .axis = 2};
    return take_motion(p, k, (verb)v, &m, &seconds, e) ? -1 : go(p, k, &m, seconds, e);
}

int plan_end(plan *p, const keyfile *k, err *e)
{
    if (!p->is_placed)
        return err_set(e, k->name, 0, "no line at PLACE; expected where the probe is");
    put_pose(p, (double)p->poses / p->rate, &p->at);
    return 0;
}
