#include "base/num.h"
#include "mesh/rigid_body.h"
#include "place/pose_fit.h"
#include "probe/poses.h"
#include "tled/problem/script_reader.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* A move is four curves: the keys of the first are the translation t, of the others the quaternion's x y z, its w, and
 * the point c that it turns about: X goes to R (X - c) + c + t. Their values are b and the columns of A = R - I in
 *     u = b + A X,  b = t - A c. */
enum { CURVES = 4 };

typedef struct move {
    pose at; /* about: */
    double about[3];
} move;

/* R - I, a row a component, without the loss of digits that a subtraction has where the angle is small. */
static void turn_of(const double q[4], double a[9])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    a[0] = -2 * (y * y + z * z), a[1] = 2 * (x * y - z * w), a[2] = 2 * (x * z + y * w);
    a[3] = 2 * (x * y + z * w), a[4] = -2 * (x * x + z * z), a[5] = 2 * (y * z - x * w);
    a[6] = 2 * (x * z - y * w), a[7] = 2 * (y * z + x * w), a[8] = -2 * (x * x + y * y);
}

static void turned(const double a[9], const double v[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[3 * i] * v[0] + a[3 * i + 1] * v[1] + a[3 * i + 2] * v[2];
}

/* The same motion, told as one about another point. */
static move about_point(const move *m, const double point[3])
{
    move to = {.at = m->at};
    double a[9], gap[3], more[3];
    for (int i = 0; i < 3; i++) {
        to.about[i] = point[i];
        gap[i] = point[i] - m->about[i];
    }
    turn_of(m->at.quaternion, a);
    turned(a, gap, more);
    for (int i = 0; i < 3; i++)
        to.at.position[i] += more[i];
    return to;
}

/* ---- values */

static move move_none(void)
{
    return (move){.at = pose_none()};
}

static const double *key_of(const script *s, const script_curve *c, int32_t k)
{
    return s->value + 3 * ((int64_t)c->key_first + k);
}

static move move_of_key(const script *s, const script_curve *c, int32_t k)
{
    move m;
    memcpy(m.at.position, key_of(s, c, k), sizeof m.at.position);
    memcpy(m.at.quaternion, key_of(s, c + 1, k), 3 * sizeof *m.at.quaternion);
    m.at.quaternion[3] = *key_of(s, c + 2, k);
    memcpy(m.about, key_of(s, c + 3, k), sizeof m.about);
    return m;
}

/* Of the first of the four. */
static move move_at(const script *s, const script_curve *c, double time)
{
    const int32_t low = script_keys(s, c, time);
    const double *times = s->time + c->key_first;
    if (low == 0)
        return move_none();
    move m = move_of_key(s, c, low - 1);
    if (low == c->key_count)
        return m;
    const move next = move_of_key(s, c, low);
    m.at = pose_slerp(&m.at, &next.at, (time - times[low - 1]) / (times[low] - times[low - 1]));
    return m;
}

void script_move_values(const script *s, const script_curve *c, double time, double *value)
{
    const move m = move_at(s, c, time);
    double a[9], from[3];
    turn_of(m.at.quaternion, a);
    turned(a, m.about, from);
    for (int i = 0; i < 3; i++) {
        value[i] = m.at.position[i] - from[i];
        for (int k = 0; k < 3; k++)
            value[3 * (k + 1) + i] = a[3 * i + k];
    }
}

/* ---- keys */

/* What the four curves have as a key. */
static void numbers_of(const move *m, double value[CURVES][3])
{
    memset(value, 0, sizeof(double[CURVES][3]));
    memcpy(value[0], m->at.position, sizeof value[0]);
    memcpy(value[1], m->at.quaternion, sizeof value[1]);
    value[2][0] = m->at.quaternion[3];
    memcpy(value[3], m->about, sizeof value[3]);
}

static int hold(script *s, int64_t curve, const script_now *now, const move *was, const move *is, err *e)
{
    double from[CURVES][3], to[CURVES][3];
    numbers_of(was, from);
    numbers_of(is, to);
    for (int i = 0; i < CURVES; i++)
        if (script_hold(s, curve + i, now, from[i], to[i], e))
            return -1;
    return 0;
}

void script_move_stop(script *s, int64_t curve, const script_now *now, bool at_rest)
{
    const move is = at_rest ? move_none() : move_at(s, &s->curve[curve], now->from);
    hold(s, curve, now, &is, &is, &(err){0}); /* it has room of its own: nothing can fail */
}

/* Live: how its nodes have moved by now. */
static move moved_now(const script_reader *r, const script_curve *c)
{
    const model_array *position = model_find(r->m, "node.position");
    move m = move_none();
    if (c->key_count)
        return move_at(r->s, c, r->now->from);
    if (position && r->now->displacement && c->node_count && r->s->node[c->node_first] < position->rows)
        m.at = pose_fit(position->f64, r->now->displacement, r->s->node + c->node_first, c->node_count);
    return m;
}

static int add_key(script_reader *r, int64_t at, double time, const move *m, err *e)
{
    double value[CURVES][3];
    if (r->now) {
        const move now = moved_now(r, &r->s->curve[at]), was = about_point(&now, m->about);
        return hold(r->s, at, r->now, &was, m, e);
    }
    numbers_of(m, value);
    for (int i = 0; i < CURVES; i++)
        if (script_reader_key(r, at + i, time, value[i], e))
            return -1;
    return 0;
}

/* ---- lines */

/* The four curves of a body, whose nodes they have. */
static int64_t add_curves(script_reader *r, const script_curve *c, int32_t body, err *e)
{
    script_curve turn = *c;
    const int64_t at = script_add(r->s, c, e);
    if (at < 0 || script_nodes_of_body(r->s, r->m, &r->k, body, e))
        return -1;
    turn.verb = SCRIPT_TURN;
    for (int i = 1; i < CURVES; i++)
        if (script_add(r->s, &turn, e) < 0)
            return -1;
    return at;
}

/* In a file all lines of a body turn about one point: what lies between two of them is then an arc about it. */
static int check_about(const script_reader *r, int64_t at, const move *m, err *e)
{
    const script_entry *last = NULL;
    for (int64_t i = 0; i < r->count && !last; i++)
        last = r->entries[i].curve == at + CURVES - 1 ? &r->entries[i] : NULL;
    if (r->now || !last || !memcmp(last->value, m->about, sizeof m->about))
        return 0;
    return keyfile_error(&r->k, e,
                         "'%.200s' turns about another point than in line %" PRId64
                         "; expected the same in all lines of a body",
                         r->s->curve[at].target, r->s->curve[at].line);
}

static int take_move(script_reader *r, const char *word, double time, const move *m, err *e)
{
    bool fresh;
    const int32_t body = rigid_body_find(r->m, word, r->k.name, r->k.line, e);
    if (body < 0)
        return -1;
    char *name = model_find(r->m, "body.name")->str[body];
    const script_curve c = {.verb = SCRIPT_MOVE, .volume = -1, .mask = 7, .line = r->k.line, .target = name};
    int64_t at = script_find(r->s, &c);
    if (r->place && at >= 0 && at < r->first)
        return keyfile_error(&r->k, e, "'%.200s' is moved by line %" PRId64 " of the script too; expected one of them",
                             name, r->s->curve[at].line);
    fresh = at < 0;
    if (fresh && (at = add_curves(r, &c, body, e)) < 0)
        return -1;
    return check_about(r, at, m, e) || add_key(r, at, time, m, e) ? -1 : 0;
}

static int take_quaternion(const script_reader *r, const char *text, double q[4], err *e)
{
    if (num_list(text, q, 4) != 4)
        return keyfile_error(&r->k, e, "'%.200s'; expected QX,QY,QZ,QW, a unit quaternion", text);
    const double length = pose_unit(q);
    return pose_is_unit(length)
               ? 0
               : keyfile_error(&r->k, e, "a quaternion of length %.6g; expected 1, to within %g", length, POSE_LENGTH);
}

int script_line_move(script_reader *r, double time, err *e)
{
    const keyfile *k = &r->k;
    move m = move_none();
    if (k->count > 5 && strcmp(k->word[5], "about") != 0)
        return keyfile_error(k, e, "'%.200s'; expected about X,Y,Z", k->word[5]);
    if (script_reader_lengths(r, k->word[3], 3, m.at.position, "X,Y,Z: lengths in metres or with suffixes", e) ||
        take_quaternion(r, k->word[4], m.at.quaternion, e) ||
        (k->count > 5 &&
         script_reader_lengths(r, k->word[6], 3, m.about, "X,Y,Z: a point, in metres or with suffixes", e)))
        return -1;
    return take_move(r, k->word[2], time, &m, e);
}

/* A motion in the frame that the model lies in, as one of the model. */
static pose in_model(const pose *place, const pose *at)
{
    const pose back = pose_relative(place, at);
    return pose_compose(&back, place);
}

int script_line_pose(script_reader *r, err *e)
{
    keyfile k = r->k;
    poses_event of;
    if (k.count != 9)
        return keyfile_error(&k, e, "%d words; expected BODY time tx ty tz qx qy qz qw", k.count);
    memmove(k.word, k.word + 1, 8 * sizeof *k.word);
    k.count = 8;
    if (poses_take(&k, &of, e))
        return -1;
    if (of.time < 0)
        return keyfile_error(&k, e, "time %g s; expected times from 0 on", of.time);
    const move m = {.at = in_model(r->place, &of.at)};
    return take_move(r, r->k.word[0], of.time, &m, e);
}
