/* The maths of skin that touches itself, or bone, one source for every executor; its equations are in self_contact.h.
 * In double. Nodes, elements and samples are rows of the self_contact; x: where its nodes are (x 3, m). Owns nothing.
 */
#ifndef SINEW_CONTACT_MATHS_H
#define SINEW_CONTACT_MATHS_H

#include "tled/contact/self_contact.h"

#include <float.h>

#define CONTACT_FUNCTION MOVES_FUNCTION

enum {
    CONTACT_CANDIDATES = SELF_CONTACT_BESIDE, /* of an element: those that its samples may be in */
    CONTACT_PASSES = 4,                       /* of Jacobi's iteration */
    CONTACT_TURNS = 2                         /* in which a place is found that moves blended */
};

/* Of an element's shortest side: how much wider boxes of elements are than these. */
#define CONTACT_MARGIN .5
/* By how much of its sides a place may be outside of an element: beyond stairs of voxels. */
#define CONTACT_BEYOND .5
/* How far a node may go before elements are listed anew, of the shortest side: an element's box and its margin move by
 * twice as much at most, and a sample too, where it is extrapolated. */
#define CONTACT_LISTED (CONTACT_MARGIN / 4)
/* Between the skin's normals at the middles of elements, cosine: what faces as much the same way is not listed. */
#define CONTACT_ALIKE .8
/* Skin touches skin that faces it: cosine between the normals. What comes in by the side of an edge is left alone until
 * it is nearer to what it faces, or skin would catch on every edge that it slides under. */
#define CONTACT_FACING (-.3)
/* Elements that have a neighbour in common, about the end of a slit, are nearly one piece: they touch where they face
 * each other, and not deeper than this, in shortest sides; others not deeper than that. */
#define CONTACT_NEAR_FACING (-.5)
#define CONTACT_NEAR_DEEP   .25
#define CONTACT_DEEP        .5
/* In bone, what is deeper has come another way. */
#define CONTACT_BONE_DEEP 1.
/* Skin touches bone that it faces, or where its own normal is not to be trusted, at its edges. */
#define CONTACT_SURE .25
/* A sample is looked at again when nodes may have come so much of what was clear: it and what it may touch both move,
 * and by more where they are extrapolated. No bound: beside an element, a sample may come to touch it sooner. */
#define CONTACT_SPARE (1. / 8)
/* Of an element's shortest side: what depth from before is taken back in a step at most. */
#define CONTACT_RECOVERED 1e-3

/* A sample in an element that it is no part of, or in bone. */
typedef struct touch {
    int32_t sample, element; /* rows; element: -1 in bone */
    int sides;               /* that move: the sample's, and the place's, unless that is bone; 0: it touches nothing */
    double carried[3];       /* m: by which bone moves there in the step; else 0 */
    int count;               /* of the place's nodes: */
    int32_t *node;           /* their rows, and shares: the executor's */
    double *share;
    double normal[3], off; /* off: g - g0, m */
    double part[2];        /* of the sides: they sum to 1 */
    double width;          /* no less than the sum of what units of lambda at all contacts move this one by */
    double fresh, lambda;  /* beta; m */
    double rubbed[3];      /* m/s: by friction */
} touch;

/* Which elements samples may be in, by cells of space that the middles of elements are in. */
typedef struct contact_table {
    double *at;         /* samples x 3, m: where they are */
    double *sampled;    /* elements x 6, m: the box of the samples of each; of none: low above high */
    double *middle;     /* elements x 3: the skin's normal at their middles */
    double *low, *high; /* elements x 3, m: their boxes, with margins */
    int32_t *count;     /* elements: those that their samples may be in: */
    int32_t *candidate; /* elements x CONTACT_CANDIDATES, ascending: the first of them, where there are more */
    int32_t *crowded;   /* elements: 1 where there were more in any list so far */
    int32_t *cell;      /* elements: the cell of the middle of each; -1: it is large */
    int32_t *start;     /* cells: where those of each begin in: */
    int32_t *of;        /* elements, by cells; last, those that are large */
    int32_t *filled;    /* cells: how many of each there are */
    int64_t cells;      /* a power of two: cells of space share them */
} contact_table;

/* ---- where elements and samples are */

CONTACT_FUNCTION double contact_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

CONTACT_FUNCTION deformed_map contact_map(const self_contact *c, const double *x, int32_t element)
{
    const int32_t *node = c->element + 8 * (int64_t)element;
    deformed_map d;
    for (int a = 0; a < 3; a++) {
        double value[8];
        for (int k = 0; k < 8; k++)
            value[k] = x[3 * (int64_t)node[k] + a];
        d.at[a] = deformed_factors_of(value);
    }
    return d;
}

CONTACT_FUNCTION void contact_place(const self_contact *c, const double *x, int64_t sample, double *to)
{
    to[0] = to[1] = to[2] = 0;
    for (int32_t k = c->lever_start[sample]; k < c->lever_start[sample + 1]; k++)
        for (int a = 0; a < 3; a++)
            to[a] += c->lever_share[k] * x[3 * (int64_t)c->lever_node[k] + a];
}

/* How far a normal is to be trusted, 0 to 1: a distance grows by 1 per m, but at an edge, where the normals of two
 * faces are mixed, what is trilinear grows by less. */
CONTACT_FUNCTION double contact_certainty(const self_contact *c, int32_t element, const double *xi)
{
    const double slope = deformed_rest_slope(xi, &c->distance[element], c->side);
    return slope < 1 ? slope * slope : 1;
}

/* The skin's normal at a sample, where it is: 0 where it has none. Returns how far it is to be trusted. */
CONTACT_FUNCTION double contact_normal(const self_contact *c, const double *x, int64_t sample, double *normal)
{
    const int32_t element = c->sample_element[sample];
    const deformed_map d = contact_map(c, x, element);
    const double *xi = c->place + 3 * sample;
    deformed_slope(&d, xi, &c->distance[element], normal);
    return contact_certainty(c, element, xi);
}

/* ---- lists */

CONTACT_FUNCTION void contact_box_samples(const self_contact *c, const contact_table *t, int64_t i)
{
    double *box = t->sampled + 6 * i;
    for (int a = 0; a < 3; a++)
        box[a] = DBL_MAX, box[3 + a] = -DBL_MAX;
    for (int32_t k = c->sample_start[i]; k < c->sample_start[i + 1]; k++) {
        const double *at = t->at + 3 * (int64_t)c->sample[k];
        for (int a = 0; a < 3; a++) {
            box[a] = at[a] < box[a] ? at[a] : box[a];
            box[3 + a] = at[a] > box[3 + a] ? at[a] : box[3 + a];
        }
    }
}

/* The boxes of an element and of its samples, which are at t->at, and the skin's normal at its middle. */
CONTACT_FUNCTION void contact_box(const self_contact *c, const double *x, const contact_table *t, int64_t i)
{
    const double half[3] = {.5, .5, .5};
    const deformed_map d = contact_map(c, x, (int32_t)i);
    deformed_slope(&d, half, &c->distance[i], t->middle + 3 * i);
    for (int a = 0; a < 3; a++) {
        double low = DBL_MAX, high = -DBL_MAX;
        for (int k = 0; k < 8; k++) {
            const double at = x[3 * (int64_t)c->element[8 * i + k] + a];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        const double over = CONTACT_BEYOND * (high - low) + CONTACT_MARGIN * c->shortest;
        t->low[3 * i + a] = low - over;
        t->high[3 * i + a] = high + over;
    }
    contact_box_samples(c, t, i);
}

/* The longest side of an element's box, or of its samples'. */
CONTACT_FUNCTION double contact_longest(const double *low, const double *high)
{
    return fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

/* Elements whose boxes are longer than a size are large, and in no cell: of these sizes, in boxes at rest, the least of
 * which CONTACT_LARGE or fewer elements are longer; or else none is large. */
enum { CONTACT_SIZES = 4, CONTACT_LARGE = 128 };

CONTACT_FUNCTION double contact_size(const self_contact *c, int which)
{
    const double rest =
        (1 + 2 * CONTACT_BEYOND) * fmax(c->side[0], fmax(c->side[1], c->side[2])) + 2 * CONTACT_MARGIN * c->shortest;
    const double times[CONTACT_SIZES] = {1.25, 1.5, 2, 3};
    return times[which] * rest;
}

/* longest: of all boxes; longer: how many are longer than each size. */
CONTACT_FUNCTION double contact_largest(const self_contact *c, double longest, const int32_t *longer)
{
    for (int k = 0; k < CONTACT_SIZES; k++)
        if (longer[k] <= CONTACT_LARGE)
            return contact_size(c, k) < longest ? contact_size(c, k) : longest;
    return longest;
}

/* Of a cell, m: an element's box, up to the largest, that meets a box of samples, up to the widest, has its middle in
 * the cell of that one's, or in one beside it. */
CONTACT_FUNCTION double contact_side(const self_contact *c, double largest, double widest)
{
    return fmax((largest + fmax(widest, 0.)) / 2, c->shortest);
}

/* The cell of space, side of this length, that is `more` cells on from that of a box's middle. */
CONTACT_FUNCTION int32_t contact_cell(const contact_table *t, double side, const double *low, const double *high,
                                      int more)
{
    const int beside[3] = {more % 3 - 1, more / 3 % 3 - 1, more / 9 - 1};
    const uint64_t prime[3] = {73856093, 19349663, 83492791}; /* Teschner et al. 2003 */
    uint64_t hash = 0;
    for (int a = 0; a < 3; a++) {
        const double at = fmin(fmax(floor((low[a] + high[a]) / 2 / side), -1e15), 1e15);
        hash ^= (uint64_t)((int64_t)at + beside[a]) * prime[a];
    }
    return (int32_t)(hash & (uint64_t)(t->cells - 1));
}

enum { CONTACT_HERE = 13, CONTACT_CELLS = 27 }; /* of what `more` counts */

CONTACT_FUNCTION bool contact_share_node(const self_contact *c, int32_t one, int32_t other)
{
    bool is = false;
    for (int i = 0; i < 8; i++) {
        const int32_t node = c->element[8 * (int64_t)other + i];
        for (int k = 0; k < 8; k++)
            is |= c->element[8 * (int64_t)one + k] == node;
    }
    return is;
}

/* How much of the boxes' margin is not used yet, m; come: the most that a node has come since these were made. */
CONTACT_FUNCTION double contact_spare(const self_contact *c, double come)
{
    return CONTACT_MARGIN * c->shortest - 2 * come;
}

/* Tells whether x lies in the box of an element, with as much of its margins as is used. */
CONTACT_FUNCTION bool contact_in_box(const contact_table *t, int32_t element, const double *x, double spare)
{
    bool is = true;
    for (int a = 0; a < 3; a++)
        is &= x[a] >= t->low[3 * (int64_t)element + a] + spare && x[a] <= t->high[3 * (int64_t)element + a] - spare;
    return is;
}

/* Whether an element's box meets that of samples (low, high). */
CONTACT_FUNCTION bool contact_meets(const contact_table *t, const double *box, int32_t other)
{
    bool is = true;
    for (int a = 0; a < 3; a++)
        is &= box[3 + a] >= t->low[3 * (int64_t)other + a] && box[a] <= t->high[3 * (int64_t)other + a];
    return is;
}

/* Whether samples of one element may touch the skin of the other. */
CONTACT_FUNCTION bool contact_may_touch(const self_contact *c, const contact_table *t, int32_t one, int32_t other)
{
    const double *n = t->middle + 3 * (int64_t)one, *m = t->middle + 3 * (int64_t)other;
    return contact_dot(n, m) < CONTACT_ALIKE && !contact_share_node(c, one, other);
}

/* Keeps ascending elements, once each: two cells of space may be one of the table. */
CONTACT_FUNCTION void contact_add_candidate(const contact_table *t, int64_t to, int32_t element)
{
    int32_t *list = t->candidate + CONTACT_CANDIDATES * to, n = t->count[to], at = n;
    while (at > 0 && list[at - 1] >= element)
        at--;
    if (at < n && list[at] == element)
        return;
    if (n == CONTACT_CANDIDATES)
        t->crowded[to] = 1;
    if (at == CONTACT_CANDIDATES)
        return;
    n = n < CONTACT_CANDIDATES ? n + 1 : n;
    for (int32_t k = n - 1; k > at; k--)
        list[k] = list[k - 1];
    list[at] = element;
    t->count[to] = n;
}

/* Lists what samples of element i may be in, where all elements are in cells but for so many large ones. */
CONTACT_FUNCTION void contact_list(const self_contact *c, const contact_table *t, double side, int32_t large, int64_t i)
{
    const double *box = t->sampled + 6 * i;
    t->count[i] = 0;
    if (!(box[0] <= box[3]))
        return;
    for (int n = 0; n <= CONTACT_CELLS; n++) {
        const int32_t cell = n < CONTACT_CELLS ? contact_cell(t, side, box, box + 3, n) : -1;
        const int32_t start = cell < 0 ? (int32_t)c->elements - large : t->start[cell];
        for (int32_t j = start; j < start + (cell < 0 ? large : t->filled[cell]); j++)
            if (contact_meets(t, box, t->of[j]) && contact_may_touch(c, t, (int32_t)i, t->of[j]))
                contact_add_candidate(t, i, t->of[j]);
    }
}

/* ---- what touches */

/* Of two sides that face each other the normal between, by how far each is to be trusted: skin that slides under an
 * edge does not catch on it. */
CONTACT_FUNCTION void contact_turn(double *normal, double sure, const double *own, double own_sure)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        normal[a] = sure * normal[a] - own_sure * own[a];
        square += normal[a] * normal[a];
    }
    for (int a = 0; a < 3; a++)
        normal[a] /= square > 0 ? sqrt(square) : 1;
}

/* Tells whether a sample, at a place of t's element, is nearer to the skin there than at rest; t: fills its normal and
 * off. If it is not, `clear` gets how far it may still go, m. */
CONTACT_FUNCTION bool contact_is_in(const self_contact *c, const double *x, const double *place, touch *t,
                                    double *clear)
{
    const deformed_factors *distance = &c->distance[t->element];
    const deformed_map d = contact_map(c, x, t->element);
    const double slope = deformed_slope(&d, place, distance, t->normal);
    if (!(slope > 0))
        return false;
    t->off = deformed_value(distance, place) / slope - c->rest[t->sample];
    *clear = fmin(fmax(t->off, 0.), *clear);
    return t->off < 0;
}

/* Tells whether it faces that, and is no deeper than skin can have come; turns t's normal. near: whether the elements
 * of the two have a neighbour in common. */
CONTACT_FUNCTION bool contact_faces(const self_contact *c, const double *x, const double *place, bool near, touch *t)
{
    double own[3];
    if (t->off < -(near ? CONTACT_NEAR_DEEP : CONTACT_DEEP) * c->shortest)
        return false;
    const double sure = contact_normal(c, x, t->sample, own), other = contact_certainty(c, t->element, place);
    const double dot = contact_dot(own, t->normal);
    contact_turn(t->normal, other, own, sure);
    return dot < (near ? CONTACT_NEAR_FACING : CONTACT_FACING);
}

/* Tells whether a sample at `at` is deeper in a bone than at rest, and faces it: as above. rest, m: how deep it is at
 * rest, at most 0; which: of the ground's fields; was, is: its bone, at the step's two ends. */
CONTACT_FUNCTION bool contact_touches_bone(const self_contact *c, const double *x, const double *at,
                                           const sliding_ground *g, int32_t which, const sliding_bone *was,
                                           const sliding_bone *is, double rest, touch *t, double *clear)
{
    double where[3], slope[3], before[3], after[3], own[3];
    for (int a = 0; a < 3; a++) {
        where[a] = 0;
        for (int i = 0; i < 3; i++)
            where[a] += is->turn[i][a] * (at[i] - is->to[i]);
    }
    *clear = c->shortest;
    if (sliding_beyond(g, which, where))
        return false;
    const double phi = sliding_distance(g, which, where, slope), length = sliding_length(slope);
    t->off = phi / fmax(length, SLIDING_SLOPE) - rest;
    *clear = fmax(t->off, 0.);
    if (!(t->off < 0) || t->off < -CONTACT_BONE_DEEP * c->shortest || !(length > 0))
        return false;
    for (int a = 0; a < 3; a++)
        t->normal[a] = (is->turn[a][0] * slope[0] + is->turn[a][1] * slope[1] + is->turn[a][2] * slope[2]) / length;
    sliding_move(was, where, before);
    sliding_move(is, where, after);
    for (int a = 0; a < 3; a++)
        t->carried[a] = after[a] - before[a];
    const double trusted = contact_normal(c, x, t->sample, own);
    return contact_dot(own, t->normal) < CONTACT_FACING || trusted < CONTACT_SURE;
}

/* The most that a corner of a field's box moves from one motion of its bone to another. */
CONTACT_FUNCTION double contact_bone_way(const sliding_field *f, const double *spacing, const sliding_bone *from,
                                         const sliding_bone *to)
{
    double most = 0;
    for (int c = 0; c < 8; c++) {
        double where[3], before[3], after[3], square = 0;
        for (int a = 0; a < 3; a++)
            where[a] = f->first[a] + (c >> a & 1 ? spacing[a] * (f->samples[a] - 1) : 0);
        sliding_move(from, where, before);
        sliding_move(to, where, after);
        for (int a = 0; a < 3; a++)
            square += (after[a] - before[a]) * (after[a] - before[a]);
        most = fmax(most, square);
    }
    return sqrt(most);
}

/* ---- impulses; way, speed: of the sample relative to the place */

/* The parts of the sides: what moves both so has equal and opposite momentum. mass: of the nodes, by their shares. */
CONTACT_FUNCTION void contact_part(touch *t, const double *mass)
{
    const double all = mass[0] + mass[1];
    t->part[0] = t->sides == 1 ? 1 : mass[0] > 0 && mass[1] > 0 ? mass[1] / all : .5;
    t->part[1] = 1 - t->part[0];
}

CONTACT_FUNCTION void contact_begin(const self_contact *c, touch *t, const double *speed, double dt)
{
    const double came =
        fmin(fmax(contact_dot(t->carried, t->normal) - contact_dot(speed, t->normal) * dt, 0.), -t->off);
    t->off = fmax(t->off, -came - CONTACT_RECOVERED * c->shortest);
    t->fresh = came / -t->off;
    t->lambda = 0;
    t->rubbed[0] = t->rubbed[1] = t->rubbed[2] = 0;
}

CONTACT_FUNCTION void contact_press(touch *t, const double *way)
{
    if (t->width > 0)
        t->lambda = fmax(t->lambda - (t->off + contact_dot(way, t->normal)) / t->width, 0.);
}

/* Adds the slip that is left to what friction takes, which is at most mu times what presses. */
CONTACT_FUNCTION void contact_rub(const self_contact *c, touch *t, const double *speed, double dt)
{
    double slip[3];
    if (!(t->width > 0))
        return;
    for (int a = 0; a < 3; a++)
        slip[a] = speed[a] - t->carried[a] / dt;
    const double along = contact_dot(slip, t->normal);
    for (int a = 0; a < 3; a++)
        t->rubbed[a] -= (slip[a] - along * t->normal[a]) / t->width;
    const double size = sqrt(contact_dot(t->rubbed, t->rubbed)), most = c->friction * t->fresh * t->lambda / dt;
    for (int a = 0; a < 3; a++)
        t->rubbed[a] *= size > most ? most / size : 1;
}

#endif
