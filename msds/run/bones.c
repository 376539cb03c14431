#include "msds/run/bones.h"

#include "base/mem.h"
#include "mesh/boundary.h"
#include "probe/narrow.h"

#include <stdlib.h>

/* Shares of the probe's size: what counts as touched, and how exactly gaps are found. */
static const double touched = .005, fine = .0005;

static void take_face(bones *b, const msds_problem *p, const int32_t *node, int64_t face)
{
    double *corner = b->corner + 9 * face, *ball = b->ball + 4 * face, square = 0;
    for (int i = 0; i < 9; i++) {
        const int64_t at = 3 * (int64_t)node[i / 3] + i % 3;
        corner[i] = p->position[at] + p->displacement[at];
        ball[i % 3] += corner[i] / 3;
    }
    for (int k = 0; k < 3; k++) {
        double away = 0;
        for (int a = 0; a < 3; a++)
            away += (corner[3 * k + a] - ball[a]) * (corner[3 * k + a] - ball[a]);
        square = fmax(square, away);
    }
    ball[3] = sqrt(square);
}

static int take_faces(bones *b, const msds_problem *p, const boundary *outside, err *e)
{
    if (!outside->faces)
        return 0;
    b->corner = mem_array(outside->faces, 9 * sizeof *b->corner, "bone", e);
    b->ball = b->corner ? mem_array(outside->faces, 4 * sizeof *b->ball, "bone", e) : NULL;
    if (!b->ball)
        return -1;
    b->faces = outside->faces;
    for (int64_t i = 0; i < b->faces; i++)
        take_face(b, p, outside->node + 3 * i, i);
    return 0;
}

static bool is_held(const msds_problem *p, int64_t t)
{
    const int32_t *n = p->element_node + 4 * t;
    return p->fixed[n[0]] && p->fixed[n[1]] && p->fixed[n[2]] && p->fixed[n[3]];
}

/* Which elements are of volumes that are held as a whole; some, where two sides that are held meet, are held alone.
 * moves: volumes, zeroed. Returns whether there are any. */
static bool find_rigid(const msds_problem *p, bool *moves, bool *rigid)
{
    bool any = false;
    for (int64_t t = 0; t < p->elements; t++)
        moves[p->volume[t]] = moves[p->volume[t]] || !is_held(p, t);
    for (int64_t t = 0; t < p->elements; t++) {
        rigid[t] = !moves[p->volume[t]];
        any = any || rigid[t];
    }
    return any;
}

int bones_make(bones *b, const msds_problem *p, const model *m, err *e)
{
    bool *rigid = mem_array(p->elements, sizeof *rigid, "bone", e);
    bool *moves = rigid ? mem_array(model_count(m, "volume"), sizeof *moves, "bone", e) : NULL;
    boundary outside = {0};
    *b = (bones){0};
    const int failed = !moves || (find_rigid(p, moves, rigid) &&
                                  (boundary_of(&outside, m, rigid, NULL, e) || take_faces(b, p, &outside, e)));
    boundary_free(&outside);
    free(rigid);
    free(moves);
    return failed ? -1 : 0;
}

void bones_free(bones *b)
{
    free(b->corner);
    free(b->ball);
    *b = (bones){0};
}

/* Whether a face may be nearer than that: by balls, then by where the middle is. */
static bool may_be_near(const probe_placed *at, const double ball[4], double than)
{
    const double reach = ball[3] + at->reach + than;
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += (ball[a] - at->centre[a]) * (ball[a] - at->centre[a]);
    return square < reach * reach && -probe_at(at, ball).depth - ball[3] < than;
}

/* Twice the signed area of a, b and x across the x axis; *left: its sign, where a point on the edge is on one side of
 * it, whichever way a face goes along the edge. */
static double turn(const double *a, const double *b, const double *x, bool *left)
{
    const bool swapped = a[1] > b[1] || (a[1] == b[1] && a[2] > b[2]);
    const double *p = swapped ? b : a, *q = swapped ? a : b;
    const double area = (q[1] - p[1]) * (x[2] - p[2]) - (q[2] - p[2]) * (x[1] - p[1]);
    *left = (area >= 0) != swapped;
    return swapped ? -area : area;
}

/* Whether the line from x along the x axis goes through a face. */
static bool is_crossed(const double *corner, const double *x)
{
    bool left[3];
    const double side[3] = {turn(corner + 3, corner + 6, x, &left[0]), turn(corner + 6, corner, x, &left[1]),
                            turn(corner, corner + 3, x, &left[2])};
    const double all = side[0] + side[1] + side[2];
    if (left[0] != left[1] || left[1] != left[2] || all == 0)
        return false;
    return (side[0] * corner[0] + side[1] * corner[3] + side[2] * corner[6]) / all > x[0];
}

static bool is_in_bone(const bones *b, const double x[3])
{
    bool within = false;
    for (int64_t i = 0; i < b->faces; i++)
        if (is_crossed(b->corner + 9 * i, x))
            within = !within;
    return within;
}

double bones_gap(const bones *b, const probe_placed *at, double most)
{
    for (int64_t i = 0; i < b->faces && most > 0; i++)
        if (may_be_near(at, b->ball + 4 * i, most))
            most = narrow_gap(at, b->corner + 9 * i, most, fine * at->shape.size);
    return most > 0 && is_in_bone(b, at->centre) ? 0 : most;
}

static double gap_at(const bones *b, const probe *shape, const screw *way, double share, double most)
{
    const pose at = screw_at(way, share);
    const probe_placed placed = probe_place(shape, &at);
    return bones_gap(b, &placed, most);
}

/* Whether it has come too near: more than is found by chance, or at all where it is nearer yet. */
static bool has_touched(const probe *shape, double before, double now)
{
    const double least = touched * shape->size;
    return (now < least && now < before - fine * shape->size) || (now < least / 2 && now < before);
}

double bones_stop(const bones *b, const probe *shape, const screw *way)
{
    const double length = screw_length(way, probe_lever(shape)), least = touched * shape->size;
    if (!b->faces || !(length > 0))
        return 1;
    double share = 0, gap = gap_at(b, shape, way, 0, length + 2 * least);
    if (!(gap > 0) || gap >= length + least)
        return 1;
    for (;;) {
        const double next = fmin(1, share + fmax(gap - 2 * least, least) / length);
        const double then = gap_at(b, shape, way, next, (1 - next) * length + 2 * least);
        if (has_touched(shape, gap, then))
            return share;
        share = next;
        gap = then;
        if (share >= 1)
            return 1;
    }
}
