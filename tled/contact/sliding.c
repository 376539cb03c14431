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
    const model_array *name = model_find(m, "body.name"), *touches = model_find(m, "field.contact");
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
    s->ground.value = value->f32;
    s->ground.field = s->field;
    s->touches = touches ? touches->u8 : NULL;
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

/* ---- making it */

int sliding_make(sliding *s, tled_problem *p, const model *m, double friction, err *e)
{
    lattice l;
    double slope[3];
    *s = (sliding){.ground.friction = friction};
    const bool slides = model_find(m, "slide.node");
    if (!slides && !model_find(m, "field.contact"))
        return 0;
    if (slides && p->conforming)
        return err_set(e, NULL, 0, "nodes slide on bone in a model without a lattice; expected one of voxels");
    if (slides && p->films)
        return err_set(e, NULL, 0, "nodes slide on bone that holds the tissue by films; expected one of both");
    if (lattice_of(m, &l, e) || read_fields(s, m, &l, e) ||
        (slides && (read_nodes(s, m, p->nodes, e) || check_held(s, m, e))))
        return -1;
    memcpy(s->ground.spacing, l.spacing, sizeof l.spacing);
    for (int a = 0; a < 3; a++)
        s->ground.per[a] = 1 / l.spacing[a];
    for (int64_t i = 0; i < s->count; i++) {
        s->rest[i] = sliding_distance(&s->ground, s->of[i], p->position + 3 * (int64_t)s->node[i], slope);
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

int64_t sliding_samples(const sliding *s)
{
    int64_t count = 0;
    for (int64_t i = 0; i < s->fields; i++)
        count += (int64_t)s->field[i].samples[0] * s->field[i].samples[1] * s->field[i].samples[2];
    return count;
}

/* ---- a node */

sliding_node sliding_node_of(const tled_problem *p, int64_t i)
{
    const sliding *s = p->sliding;
    const int64_t node = 3 * (int64_t)s->node[i];
    sliding_node n = {.rest = s->rest[i], .of = s->of[i], .lifts = s->lifts && s->lifts[i]};
    memcpy(n.position, p->position + node, sizeof n.position);
    memcpy(n.hold, p->hold + node, sizeof n.hold);
    return n;
}

sliding_bone sliding_bone_at(const sliding *s, int32_t which, const double *value)
{
    return sliding_bone_of(&s->field[which], value);
}

sliding_load sliding_load_at(const tled_problem *p, int64_t i, const double *value, const double *displacement,
                             const double net[3])
{
    const sliding *s = p->sliding;
    const sliding_node n = sliding_node_of(p, i);
    const sliding_bone bone = sliding_bone_at(s, s->of[i], value);
    return sliding_load_of(&s->ground, &n, &bone, displacement + 3 * (int64_t)s->node[i], net);
}

/* How far node row i has slipped along the bone between two moments. */
static void find_slip(const tled_problem *p, int64_t i, const sliding_moment *was, const sliding_moment *is,
                      double slip[3])
{
    const sliding *s = p->sliding;
    const int64_t at = 3 * (int64_t)s->node[i];
    const sliding_node n = sliding_node_of(p, i);
    const sliding_bone from = sliding_bone_at(s, n.of, was->value), to = sliding_bone_at(s, n.of, is->value);
    const sliding_touch t = sliding_at(&s->ground, &n, &to, is->displacement + at);
    double before[3], after[3], along = 0;
    sliding_move(&from, t.where, before);
    sliding_move(&to, t.where, after);
    for (int a = 0; a < 3; a++) {
        slip[a] = is->displacement[at + a] - was->displacement[at + a] - (after[a] - before[a]);
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
    const double length = sliding_length(slip);
    const bool slips = length > sliding_touching(&s->ground) * 1e-2;
    const double rub = s->ground.friction * (was->load->pressed + is->load->pressed) / 2;
    for (int a = 0; a < 3; a++) {
        const double way = is->displacement[n + a] - was->displacement[n + a];
        const double friction = slips ? -rub * slip[a] / length : (was->load->stuck[a] + is->load->stuck[a]) / 2;
        work += ((was->load->normal[a] + is->load->normal[a]) / 2 + friction) * way;
    }
    return work;
}

double sliding_worst(const tled_problem *p, const double *value, const double *displacement, int64_t *beyond)
{
    const sliding *s = p->sliding;
    double worst = 0;
    *beyond = 0;
    for (int64_t i = 0; i < s->count; i++) {
        const sliding_node n = sliding_node_of(p, i);
        const sliding_bone bone = sliding_bone_at(s, n.of, value);
        const sliding_touch t = sliding_at(&s->ground, &n, &bone, displacement + 3 * (int64_t)s->node[i]);
        worst = fmax(worst, n.lifts ? -t.off : fabs(t.off));
        *beyond += sliding_beyond(&s->ground, n.of, t.where);
    }
    return worst;
}
