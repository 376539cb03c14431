/* The probe where a frame has it: a mesh of the points that are farthest along directions all around; of a convex one
 * its own triangles. */
#include "base/mem.h"
#include "probe/probe_carry.h"
#include "render/showing_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 192, RINGS = 96 };

static const double crease = 30; /* degrees */
static const uint8_t grey[3] = {92, 104, 122};

/* The v-th of a shape's places, in its own frame. */
static void place_of(const probe *p, int64_t v, double to[3])
{
    /* Half a step off, so that no direction lies in a plane of symmetry. */
    const int64_t ring = v / AROUND;
    double across = M_PI * (double)ring / RINGS, round = 2 * M_PI * ((double)(v % AROUND) + .5) / AROUND;
    const double wide =
        ring < RINGS ? sin(across) : 0; /* the last is one point, as the first is: what is flat there is closed */
    double d[3] = {wide * cos(round), wide * sin(round), cos(across)};
    if (p->kind == PROBE_CONVEX)
        memcpy(to, p->corner + 3 * v, 3 * sizeof *to);
    else
        probe_farthest(p, d, to);
}

static int place(const probe *p, const double row[7], scene_mesh *to, err *e)
{
    const pose at = pose_of_row(row);
    to->vertices = p->kind == PROBE_CONVEX ? p->corners : (int64_t)AROUND * (RINGS + 1);
    to->position = mem_array(to->vertices, 3 * sizeof *to->position, "the probe", e);
    for (int64_t v = 0; to->position && v < to->vertices; v++) {
        double own[3], world[3];
        place_of(p, v, own);
        pose_turn(at.quaternion, own, world);
        for (int a = 0; a < 3; a++)
            to->position[3 * v + a] = (float)(world[a] + at.position[a]);
    }
    return to->position ? 0 : -1;
}

/* Whether three vertices are more than a line. */
static bool is_face(const scene_mesh *m, const uint32_t c[3])
{
    double u[3], v[3], n = 0, size = 0;
    for (int a = 0; a < 3; a++) {
        u[a] = (double)m->position[3 * c[1] + a] - (double)m->position[3 * c[0] + a];
        v[a] = (double)m->position[3 * c[2] + a] - (double)m->position[3 * c[0] + a];
        size += u[a] * u[a] + v[a] * v[a];
    }
    for (int a = 0; a < 3; a++) {
        double w = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
        n += w * w;
    }
    return n > 1e-12 * size * size;
}

static void add_face(scene_mesh *to, const uint32_t corner[3])
{
    if (is_face(to, corner))
        memcpy(to->corner + 3 * to->faces++, corner, 3 * sizeof *corner);
}

static void join_rings(scene_mesh *to)
{
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t i = 0; i < AROUND; i++) {
            const uint32_t a = r * AROUND + i, b = r * AROUND + (i + 1) % AROUND;
            add_face(to, (uint32_t[]){a, a + AROUND, b + AROUND});
            add_face(to, (uint32_t[]){a, b + AROUND, b});
        }
}

static int join(const probe *p, scene_mesh *to, err *e)
{
    const bool convex = p->kind == PROBE_CONVEX;
    to->corner = mem_array(convex ? p->faces : (int64_t)AROUND * RINGS * 2, 3 * sizeof *to->corner, "the probe", e);
    if (to->corner && !convex)
        join_rings(to);
    for (int64_t f = 0; to->corner && convex && f < p->faces; f++) {
        const int32_t *c = p->face + 3 * f;
        add_face(to, (uint32_t[]){(uint32_t)c[0], (uint32_t)c[1], (uint32_t)c[2]});
    }
    return to->corner ? 0 : -1;
}

static int add_probe(showing *b, const probe *p, const double row[7], const showing_want *want, err *e)
{
    const uint64_t cleared = showing_cleared(want, "probe");
    scene_mesh mesh = {.corners = 3, .transparency = cleared ? .75f : 0};
    mesh.label = mem_text("probe", e);
    showing_linear(grey, mesh.colour);
    if (mesh.label && !place(p, row, &mesh, e) && !join(p, &mesh, e) && !scene_smooth(&mesh, crease, e)) {
        b->seen |= SHOWING_PROBE;
        b->cleared |= cleared;
        return showing_add(b, &mesh, NULL, e);
    }
    scene_mesh_free(&mesh);
    return -1;
}

int showing_probe(showing *b, const model *m, const showing_want *want, err *e)
{
    probe p = {0};
    const model_array *at = want->moved ? frame_find(want->moved, "probe.pose") : NULL;
    if (!(want->things & SHOWING_PROBE) || !want->moved)
        return 0;
    int there = probe_carried(&p, m, e), bad = -1;
    if (there > 0 && at && at->rows > 0)
        bad = add_probe(b, &p, at->f64, want, e);
    else if (there >= 0)
        err_set(e, NULL, 0, "the model has no probe to show; expected one from msds-run or tled-run with --probe");
    probe_free(&p);
    return bad;
}
