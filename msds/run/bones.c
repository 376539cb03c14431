#include "msds/run/bones.h"

#include "base/mem.h"
#include "mesh/boundary.h"
#include "probe/narrow.h"

#include <stdlib.h>

enum { STEPS_MOST = 4000 };

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

int bones_make(bones *b, const msds_problem *p, const model *m, err *e)
{
    bool any = false, *rigid = mem_array(p->elements, sizeof *rigid, "bone", e);
    boundary outside = {0};
    *b = (bones){0};
    if (!rigid)
        return -1;
    for (int64_t t = 0; t < p->elements; t++) {
        const int32_t *n = p->element_node + 4 * t;
        rigid[t] = p->fixed[n[0]] && p->fixed[n[1]] && p->fixed[n[2]] && p->fixed[n[3]];
        any = any || rigid[t];
    }
    const int failed = any && (boundary_of(&outside, m, rigid, NULL, e) || take_faces(b, p, &outside, e));
    boundary_free(&outside);
    free(rigid);
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

double bones_gap(const bones *b, const probe_placed *at, double most)
{
    for (int64_t i = 0; i < b->faces && most > 0; i++)
        if (may_be_near(at, b->ball + 4 * i, most))
            most = narrow_gap(at, b->corner + 9 * i, most, fine * at->shape.size);
    return most;
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
    for (int i = 0; i < STEPS_MOST; i++) {
        const double next = fmin(1, share + fmax(gap - 2 * least, least) / length);
        const double then = gap_at(b, shape, way, next, (1 - next) * length + 2 * least);
        if (has_touched(shape, gap, then))
            return share;
        share = next;
        gap = then;
        if (share >= 1)
            return 1;
    }
    return share;
}
