#include "probe/poses.h"

#include "base/num.h"
#include "base/space.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

int poses_open(poses *p, in *source, const char *transform, err *e)
{
    *p = (poses){.last = -(double)INFINITY};
    int first = in_peek(source, e);
    if (first == -2)
        return -1;
    p->sequence = first >= 'A' && first <= 'Z';
    keyfile_open(&p->lines, source);
    if (!p->sequence && first >= 0 && transform)
        return err_set(e, in_name(source), 0, "lines of poses have no transform %.100s; expected a PLUS sequence",
                       transform);
    return p->sequence ? plus_open(&p->frames, source, transform, e) : 0;
}

static const char *place(const poses *p)
{
    return p->lines.name;
}

static int check_time(poses *p, double time, int64_t line, err *e)
{
    if (time < p->last)
        return err_set(e, place(p), line, "time %.9g comes after %.9g; expected times that do not decrease", time,
                       p->last);
    p->last = time;
    return 0;
}

/* ---- TUM */

int poses_take(const keyfile *k, poses_event *to, err *e)
{
    double v[8];
    if (k->count != 8)
        return keyfile_error(k, e, "%d words; expected time tx ty tz qx qy qz qw, method NAME, or set KEY VALUE",
                             k->count);
    for (int i = 0; i < 8; i++)
        if (num_double(k->word[i], &v[i]))
            return keyfile_error(k, e, "'%.100s' is not a finite number; expected time tx ty tz qx qy qz qw",
                                 k->word[i]);
    const double length = pose_unit(v + 4);
    if (!pose_is_unit(length))
        return keyfile_error(k, e, "a quaternion of length %.6g; expected 1, to within %g", length, POSE_LENGTH);
    *to = (poses_event){.kind = POSES_POSE, .line = k->line, .time = v[0]};
    memcpy(to->at.position, v + 1, sizeof to->at.position);
    memcpy(to->at.quaternion, v + 4, sizeof to->at.quaternion);
    return 0;
}

static bool is_control(const keyfile *k)
{
    return !strcmp(k->word[0], "method") || !strcmp(k->word[0], "set");
}

static int next_line(poses *p, poses_event *to, err *e)
{
    int more = keyfile_next(&p->lines, e);
    if (more <= 0)
        return more;
    if (is_control(&p->lines)) {
        *to = (poses_event){.kind = POSES_CONTROL, .line = p->lines.line};
        return 1;
    }
    return poses_take(&p->lines, to, e) || check_time(p, to->time, to->line, e) ? -1 : 1;
}

/* ---- sequences */

/* An image's frame as a probe's: +x along the columns, +z along the rows (into the tissue), +y against its normal. */
static void turn_image(double axis[3][3])
{
    for (int i = 0; i < 3; i++) {
        double down = axis[1][i];
        axis[1][i] = -axis[2][i];
        axis[2][i] = down;
    }
}

static int next_frame(poses *p, poses_event *to, err *e)
{
    double m[16], axis[3][3], length[3];
    int more = plus_next(&p->frames, &to->time, &to->line, m, e);
    if (more <= 0)
        return more;
    bool image = !strcmp(p->frames.from, "Image");
    if (image && !p->frames.width)
        return err_set(e, place(p), to->line,
                       "the width of the images is not known; expected DimSize before the frames");
    double middle = image ? (double)(p->frames.width - 1) / 2 : 0;
    if (space_axes(m, axis, length))
        return err_set(e, place(p), to->line, "%sTo%s is not a rotation; expected axes at right angles, right-handed",
                       p->frames.from, p->frames.to);
    for (int i = 0; i < 3; i++) {
        to->at.position[i] = (m[4 * i] * middle + m[4 * i + 3]) / 1e3;
        if (!isfinite(to->at.position[i]))
            return err_set(e, place(p), to->line, "%sTo%s lies too far away; expected mm", p->frames.from,
                           p->frames.to);
    }
    if (image)
        turn_image(axis);
    pose_axes(axis, to->at.quaternion);
    to->kind = POSES_POSE;
    return check_time(p, to->time, to->line, e) ? -1 : 1;
}

int poses_next(poses *p, poses_event *to, err *e)
{
    *to = (poses_event){0};
    return p->sequence ? next_frame(p, to, e) : next_line(p, to, e);
}
