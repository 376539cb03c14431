#include "tled/contact/sliding.h"

#include "base/mem.h"
#include "base/pose.h"
#include "mesh/lattice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- from the model */

static int read_fields(sliding *s, const model *m, const lattice *l, err *e)
{
    const model_array *first = model_need(m, "field.first", e), *samples = model_need(m, "field.samples", e);
    const model_array *value = model_need(m, "distance.value", e), *body = model_find(m, "field.body");
    const model_array *name = model_find(m, "body.name");
    int64_t count = 0;
    if (!first || !samples || !value)
        return -1;
    s->fields = first->rows;
    s->field = mem_array(s->fields, sizeof *s->field, "the distance fields", e);
    for (int64_t i = 0; s->field && i < s->fields; i++) {
        sliding_field *f = &s->field[i];
        const int32_t *n = samples->i32 + 3 * i;
        if (n[0] < 2 || n[1] < 2 || n[2] < 2)
            return err_set(e, NULL, 0, "field.samples, row %lld, is %d %d %d; expected each at least 2", (long long)i,
                           n[0], n[1], n[2]);
        *f = (sliding_field){.start = count, .hold = -1, .still.turn = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        memcpy(f->samples, n, sizeof f->samples);
        lattice_corner(l, first->i32 + 3 * i, f->first);
        if (n[0] > value->rows / n[1] || (int64_t)n[0] * n[1] > value->rows / n[2])
            return err_set(
                e, NULL, 0,
                "field.samples, row %lld, is %d %d %d; expected no more than the %lld rows of distance.value",
                (long long)i, n[0], n[1], n[2], (long long)value->rows);
        count += (int64_t)n[0] * n[1] * n[2];
    }
    if (s->field && count != value->rows)
        return err_set(e, NULL, 0, "distance.value has %lld rows; expected %lld, as field.samples say",
                       (long long)value->rows, (long long)count);
    s->value = value->f32;
    s->body = body && name ? body->i32 : NULL;
    s->name = s->body ? name->str : NULL;
    return s->field ? 0 : -1;
}

static int read_nodes(sliding *s, const model *m, int64_t nodes, err *e)
{
    const model_array *node = model_need(m, "slide.node", e), *of = model_need(m, "slide.field", e);
    const model_array *lifts = model_find(m, "slide.lifts");
    if (!node || !of)
        return -1;
    s->count = node->rows;
    s->node = node->i32;
    s->of = of->i32;
    s->lifts = lifts ? lifts->u8 : NULL;
    s->row = mem_array(nodes, sizeof *s->row, "the sliding nodes", e);
    s->rest = s->row ? mem_array(s->count, sizeof *s->rest, "the sliding nodes", e) : NULL;
    if (!s->rest)
        return -1;
    for (int64_t n = 0; n < nodes; n++)
        s->row[n] = -1;
    for (int64_t i = 0; i < s->count; i++) {
        if (s->node[i] < 0 || s->of[i] < 0)
            return err_set(e, NULL, 0,
                           "slide.node and slide.field, row %lld, are %d and %d; expected a node and a field",
                           (long long)i, s->node[i], s->of[i]);
        if (i && s->node[i] <= s->node[i - 1])
            return err_set(e, NULL, 0, "slide.node, row %lld, is %d after %d; expected ascending numbers", (long long)i,
                           s->node[i], s->node[i - 1]);
        s->row[s->node[i]] = (int32_t)i;
    }
    return 0;
}

static int check_held(const sliding *s, const model *m, err *e)
{
    const model_array *rigid = model_find(m, "node.rigid");
    for (int64_t i = 0; rigid && i < s->count; i++)
        if (rigid->u8[s->node[i]])
            return err_set(e, NULL, 0, "node %d is rigid and slides; expected one of both", s->node[i]);
    return 0;
}

/* ---- the field */

/* phi at X, and its gradient; beyond the field, along the gradient at its border. */
static double distance_at(const sliding *s, int32_t which, const double where[3], double slope[3])
{
    const sliding_field *f = &s->field[which];
    const int64_t row = f->samples[0], sheet = row * f->samples[1];
    double t[3], over[3];
    int64_t at = f->start;
    for (int a = 0; a < 3; a++) {
        const double local = (where[a] - f->first[a]) / s->spacing[a], most = f->samples[a] - 1;
        const double inside = fmin(fmax(local, 0), most), cell = fmin(floor(inside), most - 1);
        t[a] = inside - cell;
        over[a] = s->spacing[a] * (local - inside);
        at += (int64_t)cell * (a == 0 ? 1 : a == 1 ? row : sheet);
    }
    double x[4], along[4]; /* along x, at the four edges */
    for (int k = 0; k < 4; k++) {
        const float *v = s->value + at + k % 2 * row + k / 2 * sheet;
        along[k] = (double)v[1] - (double)v[0];
        x[k] = (double)v[0] + t[0] * along[k];
    }
    const double low = x[0] + t[1] * (x[1] - x[0]), high = x[2] + t[1] * (x[3] - x[2]);
    slope[0] =
        ((1 - t[2]) * ((1 - t[1]) * along[0] + t[1] * along[1]) + t[2] * ((1 - t[1]) * along[2] + t[1] * along[3])) /
        s->spacing[0];
    slope[1] = ((1 - t[2]) * (x[1] - x[0]) + t[2] * (x[3] - x[2])) / s->spacing[1];
    slope[2] = (high - low) / s->spacing[2];
    return low + t[2] * (high - low) + (over[0] * slope[0] + over[1] * slope[1] + over[2] * slope[2]);
}

static bool is_beyond(const sliding *s, int32_t which, const double where[3])
{
    const sliding_field *f = &s->field[which];
    for (int a = 0; a < 3; a++)
        if (!(where[a] >= f->first[a] && where[a] <= f->first[a] + s->spacing[a] * (f->samples[a] - 1)))
            return true;
    return false;
}

sliding_bone sliding_bone_at(const sliding *s, int32_t which, const double *value)
{
    sliding_bone b = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    const int32_t hold = s->field[which].hold;
    if (hold < 0)
        return s->field[which].still;
    for (int a = 0; a < 3; a++) { /* moves.h: u = b + A X */
        b.to[a] = value[3 * (int64_t)hold + a];
        for (int k = 0; k < 3; k++)
            b.turn[a][k] += value[3 * ((int64_t)hold + 1 + k) + a];
    }
    return b;
}

static void move_with(const sliding_bone *b, const double where[3], double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = b->to[a] + ((b->turn[a][0] * where[0] + b->turn[a][1] * where[1]) + b->turn[a][2] * where[2]);
}

/* Of a distance, whose slope is 1 but where the bone on two sides is as near. */
static const double least_slope = .5;

sliding_touch sliding_at(const sliding *s, int64_t i, const sliding_bone *bone, const double x[3])
{
    sliding_touch t;
    double slope[3], length = 0;
    for (int a = 0; a < 3; a++) {
        t.where[a] = 0;
        for (int k = 0; k < 3; k++)
            t.where[a] += bone->turn[k][a] * (x[k] - bone->to[k]);
    }
    const double phi = distance_at(s, s->of[i], t.where, slope);
    for (int a = 0; a < 3; a++)
        length += slope[a] * slope[a];
    length = sqrt(length);
    t.off = (phi - s->rest[i]) / fmax(length, least_slope);
    for (int a = 0; a < 3; a++) {
        t.normal[a] = 0;
        for (int k = 0; k < 3 && length > 0; k++)
            t.normal[a] += bone->turn[a][k] * slope[k] / length;
    }
    return t;
}

/* ---- making it */

int sliding_make(sliding *s, tled_problem *p, const model *m, double friction, err *e)
{
    lattice l;
    double slope[3];
    *s = (sliding){.friction = friction};
    if (!model_find(m, "slide.node"))
        return 0;
    if (p->conforming)
        return err_set(e, NULL, 0, "nodes slide on bone in a model without a lattice; expected one of voxels");
    if (p->films)
        return err_set(e, NULL, 0, "nodes slide on bone that holds the tissue by films; expected one of both");
    if (lattice_of(m, &l, e) || read_fields(s, m, &l, e) || read_nodes(s, m, p->nodes, e) || check_held(s, m, e))
        return -1;
    memcpy(s->spacing, l.spacing, sizeof s->spacing);
    for (int64_t i = 0; i < s->count; i++) {
        s->rest[i] = distance_at(s, s->of[i], p->position + 3 * (int64_t)s->node[i], slope);
        if (!isfinite(s->rest[i]))
            return err_set(e, NULL, 0, "distance.value is not finite at node %d; expected a distance in m", s->node[i]);
    }
    sliding_follow(s, p->script);
    p->sliding = s->count ? s : NULL;
    return 0;
}

void sliding_free(sliding *s)
{
    free(s->rest);
    free(s->row);
    free(s->field);
    *s = (sliding){.count = 0};
}

void sliding_start(sliding *s, const frame *f)
{
    const model_array *at = frame_find(f, "body.pose");
    for (int64_t i = 0; at && s->body && i < s->fields; i++) {
        if (s->body[i] < 0)
            continue;
        const pose moved = pose_of_row(at->f64 + 7 * (int64_t)s->body[i]);
        sliding_bone *to = &s->field[i].still;
        double turn[9];
        pose_matrix(moved.quaternion, turn);
        for (int k = 0; k < 9; k++)
            to->turn[k / 3][k % 3] = turn[k];
        memcpy(to->to, moved.position, sizeof to->to);
    }
}

void sliding_follow(sliding *s, const script *of)
{
    for (int64_t f = 0; f < s->fields; f++)
        s->field[f].hold = -1;
    for (int64_t c = 0; c < of->curves; c++)
        for (int64_t f = 0; s->body && of->curve[c].verb == SCRIPT_MOVE && f < s->fields; f++)
            if (s->body[f] >= 0 && !strcmp(s->name[s->body[f]], of->curve[c].target))
                s->field[f].hold = (int32_t)c;
}

/* ---- a node */

/* n in the components that nothing holds; returns the square of its length there, 0 where that is less than half: what
 * holds the others then holds the node. */
static double free_normal(const tled_problem *p, int64_t node, const double normal[3], double to[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        to[a] = p->hold[3 * node + a] == HOLD_FREE ? normal[a] : 0;
        square += to[a] * to[a];
    }
    return square >= .25 ? square : 0;
}

static void place_of(const tled_problem *p, int64_t node, const double u[3], double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = p->position[3 * node + a] + u[a];
}

/* As near to the bone as counts as touching it, in its least spacing. */
static const double touch = 1e-4;

static double touching(const sliding *s)
{
    return touch * fmin(s->spacing[0], fmin(s->spacing[1], s->spacing[2]));
}

double sliding_bear(const tled_problem *p, int64_t i, const sliding_bone *bone, const double u[3], double force[3])
{
    const sliding *s = p->sliding;
    double x[3], n[3], along = 0;
    place_of(p, s->node[i], u, x);
    const sliding_touch t = sliding_at(s, i, bone, x);
    const double square = free_normal(p, s->node[i], t.normal, n);
    const bool lifts = s->lifts && s->lifts[i];
    for (int a = 0; a < 3; a++)
        along += force[a] * n[a];
    if (!(square > 0) || (lifts && (along > 0 || t.off > touching(s))))
        return 0;
    for (int a = 0; a < 3; a++)
        force[a] -= along / square * n[a];
    return -along / sqrt(square);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

sliding_load sliding_load_at(const tled_problem *p, int64_t i, const double *value, const double *displacement,
                             const double net[3])
{
    const sliding *s = p->sliding;
    const int64_t node = s->node[i];
    const sliding_bone bone = sliding_bone_at(s, s->of[i], value);
    sliding_load load;
    double left[3];
    for (int a = 0; a < 3; a++)
        left[a] = p->hold[3 * node + a] == HOLD_FREE ? net[a] : 0;
    memcpy(load.stuck, left, sizeof left);
    load.pressed = fmax(sliding_bear(p, i, &bone, displacement + 3 * node, left), 0);
    const double most = s->friction * load.pressed, along = length_of(left), part = along > most ? most / along : 1;
    for (int a = 0; a < 3; a++) {
        load.normal[a] = left[a] - load.stuck[a];
        load.stuck[a] = most > 0 ? -part * left[a] : 0;
    }
    return load;
}

/* How far node row i has slipped along the bone between two moments. */
static void find_slip(const tled_problem *p, int64_t i, const sliding_moment *was, const sliding_moment *is,
                      double slip[3])
{
    const sliding *s = p->sliding;
    const int64_t n = 3 * (int64_t)s->node[i];
    const sliding_bone from = sliding_bone_at(s, s->of[i], was->value), to = sliding_bone_at(s, s->of[i], is->value);
    double x[3], before[3], after[3], along = 0;
    place_of(p, s->node[i], is->displacement + n, x);
    const sliding_touch t = sliding_at(s, i, &to, x);
    move_with(&from, t.where, before);
    move_with(&to, t.where, after);
    for (int a = 0; a < 3; a++) {
        slip[a] = is->displacement[n + a] - was->displacement[n + a] - (after[a] - before[a]);
        along += slip[a] * t.normal[a];
    }
    for (int a = 0; a < 3; a++)
        slip[a] -= along * t.normal[a];
}

double sliding_work(const tled_problem *p, int64_t i, const sliding_moment *was, const sliding_moment *is)
{
    const sliding *s = p->sliding;
    const int64_t n = 3 * (int64_t)s->node[i];
    double slip[3], work = 0;
    find_slip(p, i, was, is, slip);
    const double length = length_of(slip);
    const bool slips = length > touching(s) * 1e-2;
    const double rub = s->friction * (was->load->pressed + is->load->pressed) / 2;
    for (int a = 0; a < 3; a++) {
        const double way = is->displacement[n + a] - was->displacement[n + a];
        const double friction = slips ? -rub * slip[a] / length : (was->load->stuck[a] + is->load->stuck[a]) / 2;
        work += ((was->load->normal[a] + is->load->normal[a]) / 2 + friction) * way;
    }
    return work;
}

/* Takes from v, along the bone, at most `most` of what is relative to it, whose point there moves from was to is in dt.
 */
static void rub(const tled_problem *p, int64_t i, const sliding_touch *t, const sliding_bone *was,
                const sliding_bone *is, double most, double dt, double v[3])
{
    const int64_t node = p->sliding->node[i];
    double n[3], before[3], after[3], slip[3], along = 0;
    const double square = free_normal(p, node, t->normal, n);
    if (!(square > 0) || !(most > 0))
        return;
    move_with(was, t->where, before);
    move_with(is, t->where, after);
    for (int a = 0; a < 3; a++) {
        slip[a] = p->hold[3 * node + a] == HOLD_FREE ? v[a] - (after[a] - before[a]) / dt : 0;
        along += slip[a] * n[a];
    }
    for (int a = 0; a < 3; a++)
        slip[a] -= along / square * n[a];
    const double speed = length_of(slip), part = speed > most ? most / speed : 1;
    for (int a = 0; a < 3; a++)
        v[a] -= part * slip[a];
}

void sliding_rub(const tled_problem *p, int64_t i, const sliding_bone *past, const sliding_bone *is, double borne,
                 double dt, const double u[3], double v[3])
{
    const sliding *s = p->sliding;
    double x[3];
    if (!(s->friction > 0) || !(borne > 0))
        return;
    place_of(p, s->node[i], u, x);
    const sliding_touch t = sliding_at(s, i, is, x);
    rub(p, i, &t, past, is, s->friction * borne * dt / 2, dt, v);
}

void sliding_place(const tled_problem *p, int64_t i, const sliding_bone *was, const sliding_bone *is, double borne,
                   double dt, double u[3], double v[3])
{
    enum { TURNS = 3 };
    const sliding *s = p->sliding;
    const double most = touching(s) / touch / 2; /* half a voxel a turn */
    const int64_t node = s->node[i];
    const bool lifts = s->lifts && s->lifts[i];
    double x[3], n[3], square = 0, pushed = 0;
    sliding_touch t;
    for (int k = 0; k < TURNS; k++) {
        place_of(p, node, u, x);
        t = sliding_at(s, i, is, x);
        square = free_normal(p, node, t.normal, n);
        if (!(square > 0) || (lifts && t.off > 0) || (k && fabs(t.off) < touching(s)))
            break;
        const double back = fmin(fmax(t.off, -most), most) / square;
        for (int a = 0; a < 3; a++) {
            u[a] -= back * n[a];
            v[a] -= back * n[a] / dt;
        }
        pushed -= back * sqrt(square) / dt;
    }
    pushed += borne * dt / 2;
    if (s->friction > 0 && pushed > 0) {
        double slid[3];
        memcpy(slid, v, sizeof slid);
        rub(p, i, &t, was, is, s->friction * pushed, dt, v);
        for (int a = 0; a < 3; a++)
            u[a] += dt * (v[a] - slid[a]);
    }
}

double sliding_worst(const tled_problem *p, const double *value, const double *displacement, int64_t *beyond)
{
    const sliding *s = p->sliding;
    double worst = 0;
    *beyond = 0;
    for (int64_t i = 0; i < s->count; i++) {
        const sliding_bone bone = sliding_bone_at(s, s->of[i], value);
        double x[3];
        place_of(p, s->node[i], displacement + 3 * (int64_t)s->node[i], x);
        const sliding_touch t = sliding_at(s, i, &bone, x);
        worst = fmax(worst, s->lifts && s->lifts[i] ? -t.off : fabs(t.off));
        *beyond += is_beyond(s, s->of[i], t.where);
    }
    return worst;
}
