#include "tled/contact/self_contact.h"

#include "base/mem.h"
#include "mesh/motion.h"
#include "mesh/weights.h"
#include "tled/contact/contact_blend.h"
#include "tled/contact/contact_bone.h"
#include "tled/contact/contact_near.h"
#include "tled/contact/contact_room.h"
#include "tled/contact/contact_touch.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RING_MOST = 512 }; /* nodes about an element, with those that come again */

/* ---- from the model */

typedef struct reader {
    self_contact *c;
    const tled_problem *p;
    const int32_t *of;    /* samples: elements of the model */
    const double *weight; /* samples x 3 */
    int64_t distances;
    const int32_t *at; /* distances: nodes of the model */
    const float *value;
    int32_t *row; /* nodes of the model: of `at`, or -1 */
    err *e;
} reader;

static int find_arrays(reader *r, const model *m)
{
    const model_array *element = model_need(m, "contact.element", r->e),
                      *weight = model_need(m, "contact.weight", r->e);
    const model_array *node = model_need(m, "skin.node", r->e), *value = model_need(m, "skin.distance", r->e);
    if (!element || !weight || !node || !value)
        return -1;
    r->c->samples = element->rows;
    r->of = element->i32;
    r->weight = weight->f64;
    r->distances = node->rows;
    r->at = node->i32;
    r->value = value->f32;
    r->row = mem_array(r->p->nodes, sizeof *r->row, "the skin", r->e);
    if (!r->row)
        return -1;
    for (int64_t n = 0; n < r->p->nodes; n++)
        r->row[n] = -1;
    for (int64_t i = 0; i < r->distances; i++) {
        if (r->at[i] < 0 || (i && r->at[i] <= r->at[i - 1]))
            return err_set(r->e, NULL, 0, "skin.node, row %lld, is %d; expected nodes in ascending order", (long long)i,
                           r->at[i]);
        if (!isfinite(r->value[i]))
            return err_set(r->e, NULL, 0, "skin.distance, row %lld, is not finite; expected a distance in m",
                           (long long)i);
        r->row[r->at[i]] = (int32_t)i;
    }
    return 0;
}

/* Whether all nodes of an element have distances, and some are inside: samples may then be in it. */
static bool has_distances(const reader *r, int64_t element)
{
    bool inside = false;
    for (int i = 0; i < 8; i++) {
        const int32_t row = r->row[r->p->element_node[8 * element + i]];
        if (row < 0)
            return false;
        inside |= r->value[row] < 0;
    }
    return inside;
}

/* Elements that samples may be in or are bound to: `rank` gets their rows, or -1. */
static int list_elements(reader *r, int32_t *rank)
{
    self_contact *c = r->c;
    for (int64_t i = 0; i < r->p->elements; i++)
        rank[i] = has_distances(r, i) ? 0 : -1;
    for (int64_t i = 0; i < c->samples; i++) {
        if (r->of[i] < 0 || !isfinite(r->weight[3 * i] + r->weight[3 * i + 1] + r->weight[3 * i + 2]))
            return err_set(r->e, NULL, 0,
                           "contact.element and contact.weight, row %lld: expected an element and three "
                           "finite weights",
                           (long long)i);
        if (rank[r->of[i]] < 0)
            return err_set(r->e, NULL, 0,
                           "contact.element, row %lld, is element %d, of which nodes are not in skin.node or all are "
                           "outside; expected the arrays of one run of sinew bind --self-contact",
                           (long long)i, r->of[i]);
    }
    for (int64_t i = 0; i < r->p->elements; i++)
        if (rank[i] >= 0)
            rank[i] = (int32_t)c->elements++;
    return 0;
}

static int take_elements(reader *r, const int32_t *rank)
{
    self_contact *c = r->c;
    c->node = mem_array(r->distances, sizeof *c->node, "the skin", r->e);
    c->element = mem_array(c->elements, 8 * sizeof *c->element, "the skin", r->e);
    c->distance = mem_array(c->elements, sizeof *c->distance, "the skin", r->e);
    c->sample_element = mem_array(c->samples, sizeof *c->sample_element, "the skin", r->e);
    c->place = mem_array(c->samples, 3 * sizeof *c->place, "the skin", r->e);
    c->rest = mem_array(c->samples, sizeof *c->rest, "the skin", r->e);
    if (!c->node || !c->element || !c->distance || !c->sample_element || !c->place || !c->rest)
        return -1;
    c->nodes = r->distances;
    memcpy(c->node, r->at, (size_t)c->nodes * sizeof *c->node);
    for (int64_t i = 0; i < 8 * r->p->elements; i++)
        if (rank[i / 8] >= 0) {
            const int64_t to = 8 * (int64_t)rank[i / 8] + i % 8;
            c->element[to] = r->row[r->p->element_node[i]];
        }
    for (int64_t i = 0; i < c->elements; i++) {
        double value[8];
        for (int k = 0; k < 8; k++)
            value[k] = (double)r->value[c->element[8 * i + k]];
        c->distance[i] = deformed_factors_of(value);
    }
    for (int64_t i = 0; i < c->samples; i++) {
        double share[8];
        c->sample_element[i] = rank[r->of[i]];
        weights_shares(r->weight + 3 * i, share);
        deformed_place_of_shares(share, c->place + 3 * i);
    }
    return 0;
}

/* Samples by elements. */
static int order_samples(self_contact *c, err *e)
{
    c->sample_start = mem_array(c->elements + 1, sizeof *c->sample_start, "the skin", e);
    c->sample = c->sample_start ? mem_array(c->samples, sizeof *c->sample, "the skin", e) : NULL;
    if (!c->sample)
        return -1;
    for (int64_t i = 0; i < c->samples; i++)
        c->sample_start[c->sample_element[i]]++;
    for (int64_t k = 0; k < c->elements; k++)
        c->sample_start[k + 1] += c->sample_start[k];
    for (int64_t i = c->samples; i-- > 0;)
        c->sample[--c->sample_start[c->sample_element[i]]] = (int32_t)i;
    return 0;
}

/* The elements, a vertex in each, as a surface whose motion lists what is around them. */
typedef struct blended_skin {
    bound of;
    double *position, *weight;
    int32_t *element;
    uint8_t *blended;
} blended_skin;

static int make_skin(blended_skin *k, const reader *r, const int32_t *rank)
{
    const tled_problem *p = r->p;
    const int64_t count = r->c->elements;
    if (!(k->position = mem_array(count, 3 * sizeof *k->position, "the skin", r->e)) ||
        !(k->weight = mem_array(count, 3 * sizeof *k->weight, "the skin", r->e)) ||
        !(k->element = mem_array(count, sizeof *k->element, "the skin", r->e)) ||
        !(k->blended = mem_array(count, sizeof *k->blended, "the skin", r->e)))
        return -1;
    k->of = (bound){.shape = {.position = k->position, .vertices = count},
                    .element = k->element,
                    .weight = k->weight,
                    .blended = k->blended,
                    .node = p->element_node,
                    .corners = 8,
                    .rest = p->position};
    memset(k->blended, 1, (size_t)count);
    for (int64_t i = 0; i < p->elements; i++)
        if (rank[i] >= 0)
            k->element[rank[i]] = (int32_t)i;
    return 0;
}

/* Nodes that move elements, and are not among those that have distances. */
static int add_nodes(reader *r, const motion *all)
{
    self_contact *c = r->c;
    int64_t room = c->nodes;
    for (int64_t i = 0; i < 8 * all->entries; i++) {
        const int32_t n = r->p->element_node[8 * (int64_t)all->element[i / 8] + i % 8];
        if (r->row[n] >= 0)
            continue;
        if (mem_grow(&c->node, &room, c->nodes + 1, sizeof *c->node, "the skin", r->e))
            return -1;
        r->row[n] = (int32_t)c->nodes;
        c->node[c->nodes++] = n;
    }
    return 0;
}

/* The elements' rings are made by then, of the nodes that have distances alone. */
static int make_blend(reader *r, const int32_t *rank)
{
    self_contact *c = r->c;
    blended_skin k = {.position = NULL};
    motion all = {.of = NULL};
    c->blend = mem_array(1, sizeof *c->blend, "the skin", r->e);
    const int failed =
        !c->blend || make_skin(&k, r, rank) || motion_open(&all, &k.of, r->p->nodes, r->p->elements, r->e) ||
        add_nodes(r, &all) ||
        contact_blend_make(c->blend, &all, k.element, c->elements, r->p->element_node, r->row, r->p->side, r->e);
    motion_free(&all);
    free(k.position);
    free(k.weight);
    free(k.element);
    free(k.blended);
    return failed ? -1 : 0;
}

/* What moves a sample: returns how many nodes. */
static int sample_shares(const self_contact *c, int64_t sample, int32_t *node, double *share)
{
    const int64_t element = c->sample_element[sample];
    if (c->blend)
        return contact_blend_lever(c->blend, element, c->place + 3 * sample, node, share);
    memcpy(node, c->element + 8 * element, 8 * sizeof *node);
    deformed_shares(c->place + 3 * sample, share);
    return 8;
}

static int make_levers(const reader *r)
{
    self_contact *c = r->c;
    int64_t nodes = 0, shares = 0, count = 0;
    c->lever_start = mem_array(c->samples + 1, sizeof *c->lever_start, "the skin", r->e);
    for (int64_t i = 0; c->lever_start && i < c->samples; i++) {
        if (mem_grow(&c->lever_node, &nodes, count + BLEND_MOST, sizeof *c->lever_node, "the skin", r->e) ||
            mem_grow(&c->lever_share, &shares, count + BLEND_MOST, sizeof *c->lever_share, "the skin", r->e))
            return -1;
        count += sample_shares(c, i, c->lever_node + count, c->lever_share + count);
        c->lever_start[i + 1] = (int32_t)count;
    }
    return c->lever_start ? 0 : -1;
}

/* The nodes of the elements around an element's nodes, ascending. Returns how many. */
static int find_ring(const reader *r, const int32_t *rank, int64_t element, int32_t *to)
{
    const self_contact *c = r->c;
    int count = 0, kept = 0;
    for (int k = 0; k < 64; k++) {
        const int32_t corner = r->p->corner[8 * (int64_t)c->node[c->element[8 * element + k / 8]] + k % 8];
        const int32_t row = corner < 8 * r->p->elements ? rank[corner / 8] : -1;
        for (int j = 0; j < 8 && row >= 0; j++)
            to[count++] = c->element[8 * (int64_t)row + j];
    }
    qsort(to, (size_t)count, sizeof *to, contact_by_number);
    for (int i = 0; i < count; i++)
        if (!i || to[i] != to[kept - 1])
            to[kept++] = to[i];
    return kept;
}

static int make_rings(reader *r, const int32_t *rank)
{
    self_contact *c = r->c;
    int32_t ring[RING_MOST];
    int64_t room = 0, count = 0;
    c->ring_start = mem_array(c->elements + 1, sizeof *c->ring_start, "the skin", r->e);
    for (int64_t i = 0; c->ring_start && i < c->elements; i++) {
        const int n = find_ring(r, rank, i, ring);
        if (mem_grow(&c->ring, &room, count + n, sizeof *c->ring, "the skin", r->e))
            return -1;
        memcpy(c->ring + count, ring, (size_t)n * sizeof *ring);
        count += n;
        c->ring_start[i + 1] = (int32_t)count;
    }
    return c->ring_start ? 0 : -1;
}

static int read_all(reader *r, const model *m)
{
    int32_t *rank = mem_array(r->p->elements, sizeof *rank, "the skin", r->e);
    const int failed = !rank || find_arrays(r, m) || list_elements(r, rank) || take_elements(r, rank) ||
                       order_samples(r->c, r->e) || make_rings(r, rank) ||
                       (model_find(m, "contact.blended") && make_blend(r, rank)) || make_levers(r);
    free(rank);
    free(r->row);
    return failed ? -1 : 0;
}

void self_contact_free(self_contact *c)
{
    free(c->ring_start);
    free(c->ring);
    free(c->node);
    free(c->sample_element);
    free(c->sample_start);
    free(c->sample);
    free(c->place);
    free(c->lever_start);
    free(c->lever_node);
    free(c->lever_share);
    if (c->blend)
        contact_blend_free(c->blend);
    free(c->blend);
    free(c->element);
    free(c->distance);
    free(c->rest);
    free(c->solid);
    free(c->bone_rest);
    *c = (self_contact){.samples = 0};
}

/* ---- impulses */

/* The nodes of a contact, of each side that moves: their rows and shares. */
typedef struct lever {
    int sides, count[2];
    const int32_t *node[2];
    const double *share[2];
} lever;

static lever lever_of(const self_contact_work *w, const touch *t)
{
    const self_contact *c = w->c;
    const int32_t from = c->lever_start[t->sample];
    return (lever){t->sides,
                   {c->lever_start[t->sample + 1] - from, t->count},
                   {c->lever_node + from, t->node},
                   {c->lever_share + from, t->share}};
}

static bool is_free(const self_contact_work *w, int32_t node, int axis)
{
    return w->p->hold[3 * (int64_t)w->c->node[node] + axis] == HOLD_FREE;
}

/* What the sample moves by relative to the place, of values at nodes (x 3). */
static void relative(const lever *l, const double *value, double to[3])
{
    to[0] = to[1] = to[2] = 0;
    for (int side = 0; side < l->sides; side++)
        for (int k = 0; k < l->count[side]; k++)
            for (int a = 0; a < 3; a++)
                to[a] += (side ? -1 : 1) * l->share[side][k] * value[3 * (int64_t)l->node[side][k] + a];
}

/* Adds what `way` moves both sides by: each node by its share and its side's part. */
static void push(const self_contact_work *w, const touch *t, const lever *l, const double way[3], double *to)
{
    for (int side = 0; side < l->sides; side++)
        for (int k = 0; k < l->count[side]; k++) {
            const int32_t n = l->node[side][k];
            const double share = (side ? -1 : 1) * t->part[side] * l->share[side][k];
            for (int a = 0; a < 3; a++)
                to[3 * (int64_t)n + a] += is_free(w, n, a) ? share * way[a] : 0;
        }
}

/* The parts of the sides: what moves both so has equal and opposite momentum. */
static void find_parts(const self_contact_work *w, touch *t)
{
    const lever l = lever_of(w, t);
    double mass[2] = {0, 0};
    for (int side = 0; side < l.sides; side++)
        for (int k = 0; k < l.count[side]; k++)
            mass[side] += l.share[side][k] * w->p->mass[w->c->node[l.node[side][k]]];
    contact_part(t, mass);
}

/* The shares of the contacts at each node; and the nodes that have any. */
static void sum_shares(self_contact_work *w)
{
    for (int64_t i = 0; i < w->touches; i++) {
        const lever l = lever_of(w, &w->touch[i]);
        for (int side = 0; side < l.sides; side++)
            for (int k = 0; k < l.count[side]; k++) {
                double *sum = &w->sum[l.node[side][k]];
                if (*sum == 0)
                    w->about[w->abouts++] = l.node[side][k];
                *sum += w->touch[i].part[side] * fabs(l.share[side][k]) + DBL_MIN; /* above 0 where it is counted */
            }
    }
}

static void find_width(const self_contact_work *w, touch *t)
{
    const lever l = lever_of(w, t);
    t->width = 0;
    for (int side = 0; side < l.sides; side++)
        for (int k = 0; k < l.count[side]; k++)
            for (int a = 0; a < 3; a++)
                t->width += is_free(w, l.node[side][k], a)
                                ? fabs(l.share[side][k]) * w->sum[l.node[side][k]] * t->normal[a] * t->normal[a]
                                : 0;
}

static void begin_touch(const self_contact_work *w, touch *t, double dt)
{
    const lever l = lever_of(w, t);
    double speed[3];
    find_width(w, t);
    relative(&l, w->v, speed);
    contact_begin(w->c, t, speed, dt);
}

static void forget_changes(self_contact_work *w)
{
    for (int32_t k = 0; k < w->abouts; k++)
        memset(w->change + 3 * (int64_t)w->about[k], 0, 3 * sizeof *w->change);
}

/* Jacobi's iteration: into `change`. */
static void solve(self_contact_work *w)
{
    forget_changes(w);
    for (int pass = 0; pass < CONTACT_PASSES; pass++) {
        for (int64_t i = 0; i < w->touches; i++) {
            touch *t = &w->touch[i];
            const lever l = lever_of(w, t);
            double way[3];
            relative(&l, w->change, way);
            contact_press(t, way);
        }
        forget_changes(w);
        for (int64_t i = 0; i < w->touches; i++) {
            const touch *t = &w->touch[i];
            const lever l = lever_of(w, t);
            const double way[3] = {t->lambda * t->normal[0], t->lambda * t->normal[1], t->lambda * t->normal[2]};
            push(w, t, &l, way, w->change);
        }
    }
}

/* Displacements as solved, velocities by what came in this step. */
static void apply(self_contact_work *w, double dt)
{
    for (int32_t k = 0; k < w->abouts; k++)
        for (int64_t i = 3 * (int64_t)w->about[k], end = i + 3; i < end; i++)
            w->u[i] += w->change[i];
    for (int64_t i = 0; i < w->touches; i++) {
        const touch *t = &w->touch[i];
        const lever l = lever_of(w, t);
        const double size = t->fresh * t->lambda / dt;
        const double more[3] = {size * t->normal[0], size * t->normal[1], size * t->normal[2]};
        push(w, t, &l, more, w->v);
    }
}

static void rub_touch(const self_contact_work *w, touch *t, double dt)
{
    const lever l = lever_of(w, t);
    double speed[3], more[3];
    relative(&l, w->v, speed);
    relative(&l, w->change, more);
    for (int a = 0; a < 3; a++)
        speed[a] += more[a];
    contact_rub(w->c, t, speed, dt);
}

/* Friction takes from the velocity along the skin, and from the way in the step. */
static void rub(self_contact_work *w, double dt)
{
    forget_changes(w);
    for (int pass = 0; pass < CONTACT_PASSES; pass++) {
        for (int64_t i = 0; i < w->touches; i++)
            rub_touch(w, &w->touch[i], dt);
        forget_changes(w);
        for (int64_t i = 0; i < w->touches; i++) {
            const lever l = lever_of(w, &w->touch[i]);
            push(w, &w->touch[i], &l, w->touch[i].rubbed, w->change);
        }
    }
    for (int32_t k = 0; k < w->abouts; k++)
        for (int64_t i = 3 * (int64_t)w->about[k], end = i + 3; i < end; i++) {
            w->v[i] += w->change[i];
            w->u[i] += dt * w->change[i];
        }
}

int32_t self_contact_find(self_contact_work *w, pool *threads, const double *was, const double *is,
                          const int32_t **rows)
{
    contact_touches(w, threads);
    contact_bones(w, threads, was, is);
    for (int32_t k = 0; k < w->abouts; k++)
        w->sum[w->about[k]] = 0;
    w->abouts = 0;
    for (int64_t i = 0; i < w->touches; i++)
        find_parts(w, &w->touch[i]);
    sum_shares(w);
    *rows = w->about;
    return w->abouts;
}

void self_contact_solve(self_contact_work *w, double dt)
{
    for (int64_t i = 0; i < w->touches; i++)
        begin_touch(w, &w->touch[i], dt);
    solve(w);
    apply(w, dt);
    if (w->c->friction > 0)
        rub(w, dt);
}

/* ---- making it */

/* And in bone, of each on its own. */
static void find_bone_rest(self_contact *c, const self_contact_work *w)
{
    for (int32_t k = 0; k < c->solids; k++)
        for (int64_t i = 0; i < c->samples; i++) {
            double x[3], slope[3];
            contact_place(c, w->x, i, x);
            if (sliding_beyond(&c->bones->ground, c->solid[k], x))
                continue;
            const double phi = sliding_distance(&c->bones->ground, c->solid[k], x, slope);
            const double depth = -phi / fmax(sliding_length(slope), SLIDING_SLOPE);
            if (!(depth > 0))
                continue;
            c->bone_rest[k * c->samples + i] = -depth;
            c->deep_in_bone += depth > SELF_CONTACT_DEEP * c->shortest;
            c->deepest_in_bone = fmax(c->deepest_in_bone, depth);
        }
}

/* How deep samples are at rest. */
static int find_rest(self_contact *c, const tled_problem *p, pool *threads, err *e)
{
    self_contact_work *w = contact_room_make(p, c, e);
    if (!w)
        return -1;
    contact_touches(w, threads);
    for (int64_t i = 0; i < w->touches; i++) {
        const double depth = -w->touch[i].off;
        c->rest[w->touch[i].sample] = -depth;
        c->deep += depth > SELF_CONTACT_DEEP * c->shortest;
        c->deepest = fmax(c->deepest, depth);
    }
    find_bone_rest(c, w);
    self_contact_room_free(w);
    return 0;
}

/* The fields that skin may not enter. */
static int find_solids(self_contact *c, sliding *bones, err *e)
{
    c->bones = bones;
    for (int64_t f = 0; bones->touches && f < bones->fields; f++)
        c->solids += bones->touches[f] != 0;
    c->solid = mem_array(c->solids, sizeof *c->solid, "the bones", e);
    c->bone_rest = c->solid ? mem_array(c->solids * c->samples, sizeof *c->bone_rest, "the bones", e) : NULL;
    for (int32_t f = 0, k = 0; c->bone_rest && k < c->solids; f++)
        if (bones->touches[f])
            c->solid[k++] = f;
    return c->bone_rest ? 0 : -1;
}

int self_contact_make(self_contact *c, tled_problem *p, const model *m, sliding *bones, double friction, pool *threads,
                      err *e)
{
    reader r = {.c = c, .p = p, .e = e};
    *c = (self_contact){.friction = friction};
    if (!model_find(m, "contact.element"))
        return 0;
    if (p->conforming)
        return err_set(e, NULL, 0, "skin touches itself in a model without a lattice; expected one of voxels");
    if (read_all(&r, m))
        return -1;
    memcpy(c->side, p->side, sizeof c->side);
    c->shortest = fmin(p->side[0], fmin(p->side[1], p->side[2]));
    if (find_solids(c, bones, e) || find_rest(c, p, threads, e))
        return -1;
    p->self_contact = c->samples ? c : NULL;
    return 0;
}
