/* The probe where a frame has it: a mesh of the points that are farthest along directions all around. */
#include "base/mem.h"
#include "contact/probe.h"
#include "render/showing_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 192, RINGS = 96 };

static const double crease = 30; /* degrees */
static const uint8_t grey[3] = {92, 104, 122};

/* The shape that msds-run wrote beside its results. 1: there is one; 0: none; -1: e filled. */
static int shape_of(probe *p, const model *m, err *e)
{
    const char *text = model_meta_of(m, "probe.shape");
    if (!text)
        return 0;
    if (probe_of(p, text, e))
        return -1;
    if (p->kind == PROBE_CONVEX)
        return err_set(e, NULL, 0,
                       "the probe is the OBJ %s, which the model does not hold; expected another shape to show",
                       p->file);
    return 1;
}

static int place(const probe *p, const double pose[7], scene_mesh *to, err *e)
{
    probe_pose at;
    memcpy(at.position, pose, sizeof at.position);
    memcpy(at.quaternion, pose + 3, sizeof at.quaternion);
    to->vertices = (int64_t)AROUND * (RINGS + 1);
    to->position = mem_array(to->vertices, 3 * sizeof *to->position, "the probe", e);
    for (int64_t v = 0; to->position && v < to->vertices; v++) {
        /* Half a step off, so that no direction lies in a plane of symmetry. */
        const int64_t ring = v / AROUND;
        double across = M_PI * (double)ring / RINGS, round = 2 * M_PI * ((double)(v % AROUND) + .5) / AROUND;
        double d[3] = {sin(across) * cos(round), sin(across) * sin(round), cos(across)}, own[3], world[3];
        probe_farthest(p, d, own);
        probe_turn(at.quaternion, own, world);
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

static int join(scene_mesh *to, err *e)
{
    to->corner = mem_array((int64_t)AROUND * RINGS * 2, 3 * sizeof *to->corner, "the probe", e);
    for (uint32_t r = 0; to->corner && r < RINGS; r++)
        for (uint32_t i = 0; i < AROUND; i++) {
            const uint32_t a = r * AROUND + i, b = r * AROUND + (i + 1) % AROUND;
            const uint32_t two[2][3] = {{a, a + AROUND, b + AROUND}, {a, b + AROUND, b}};
            for (int t = 0; t < 2; t++)
                if (is_face(to, two[t]))
                    memcpy(to->corner + 3 * to->faces++, two[t], sizeof two[t]);
        }
    return to->corner ? 0 : -1;
}

int showing_probe(showing *b, const model *m, const showing_want *want, err *e)
{
    probe p;
    const model_array *pose = want->moved ? frame_find(want->moved, "probe.pose") : NULL;
    if (!(want->things & SHOWING_PROBE) || !want->moved)
        return 0;
    int there = shape_of(&p, m, e);
    if (there < 0)
        return -1;
    if (!there || !pose || pose->rows < 1)
        return err_set(e, NULL, 0, "the model has no probe to show; expected a model from msds-run --probe");
    scene_mesh mesh = {.corners = 3};
    mesh.label = mem_text("probe", e);
    showing_linear(grey, mesh.colour);
    if (mesh.label && !place(&p, pose->f64, &mesh, e) && !join(&mesh, e) && !scene_smooth(&mesh, crease, e)) {
        b->seen |= SHOWING_PROBE;
        return showing_add(b, &mesh, NULL, e);
    }
    scene_mesh_free(&mesh);
    return -1;
}
