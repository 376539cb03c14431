#include "link/serve_model.h"

#include "base/mem.h"
#include "base/space.h"
#include "link/igtl_content.h"
#include "mesh/bone.h"
#include "mesh/bound.h"
#include "surface/triangulate.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAMES = 500 };

typedef struct moved {
    char name[MODEL_NAME];
    int device;
    bool is_bound; /* else a skin, whose displacement frames have */
    bound b;
    bone bone;
    motion moves;
    int64_t triangles;
    int32_t *triangle; /* x 3 */
    double *place;     /* vertices x 3, mm, RAS */
} moved;

struct serve_model {
    serve_board *board;
    int probe, force, torque, text; /* devices; -1: not yet */
    moved *surface;
    int count;
    bool is_open;
    char names[NAMES];
    igtl_buffer content; /* what is being written */
};

serve_model *serve_model_make(serve_board *board, int probe, err *e)
{
    serve_model *s = mem_array(1, sizeof *s, "surfaces", e);
    if (!s)
        return NULL;
    s->board = board;
    s->probe = probe;
    s->force = s->torque = s->text = -1;
    return s;
}

void serve_model_free(serve_model *s)
{
    if (!s)
        return;
    for (int i = 0; i < s->count; i++) {
        if (s->surface[i].is_bound) {
            bone_free(&s->surface[i].bone);
            motion_free(&s->surface[i].moves);
        }
        free(s->surface[i].triangle);
        free(s->surface[i].place);
    }
    free(s->surface);
    igtl_buffer_free(&s->content);
    free(s);
}

const char *serve_model_names(const serve_model *s)
{
    return s->names;
}

/* ---- which surfaces */

/* Its faces as triangles. */
static int cut_faces(moved *m, err *e)
{
    const surface *s = &m->b.shape;
    int64_t count = 0, longest = 3;
    for (int64_t f = 0; f < s->faces; f++) {
        const int64_t corners = surface_end(s, f) - s->start[f];
        count += corners > 2 ? corners - 2 : 0;
        longest = corners > longest ? corners : longest;
    }
    m->triangle = mem_array(3 * count, sizeof *m->triangle, "a surface", e);
    int32_t *corner = m->triangle ? mem_array(3 * longest, sizeof *corner, "a surface", e) : NULL;
    int failed = !corner;
    for (int64_t f = 0; f < s->faces && !failed; f++) {
        const int32_t *vertex = s->vertex + s->start[f];
        const int64_t corners = surface_end(s, f) - s->start[f];
        failed = triangulate(s->position, vertex, corners, corner, e);
        for (int64_t i = 0; i < 3 * (corners - 2) && !failed; i++)
            m->triangle[3 * m->triangles + i] = vertex[corner[i]];
        m->triangles += corners > 2 ? corners - 2 : 0;
    }
    free(corner);
    return failed ? -1 : 0;
}

static const model_array *skin_of(const moved *m, const frame *f)
{
    char name[MODEL_NAME + 24];
    snprintf(name, sizeof name, "%s/vertex.displacement", m->name);
    const model_array *a = frame_find(f, name);
    return a && a->type == MODEL_F64 && a->columns == 3 && a->rows == m->b.shape.vertices ? a : NULL;
}

/* The surface named so, if it is bound, or a skin of the frame. */
static int add_surface(serve_model *s, const model *body, const frame *f, const char *name, err *e)
{
    moved *m = &s->surface[s->count];
    snprintf(m->name, sizeof m->name, "%s", name);
    const int is = bound_of(&m->b, body, m->name, e);
    if (is < 0)
        return -1;
    m->is_bound = is > 0;
    if (!m->is_bound && !skin_of(m, f))
        return 0;
    s->count++;
    if (m->is_bound && (bone_find(&m->bone, &m->b, body, e) ||
                        motion_open(&m->moves, &m->b, model_count(body, "node"), model_count(body, "element"), e)))
        return -1;
    m->place = mem_array(3 * m->b.shape.vertices, sizeof *m->place, "a surface", e);
    if (!m->place || cut_faces(m, e))
        return -1;
    m->device = serve_board_add(s->board, "POLYDATA", m->name, e);
    const size_t n = strlen(s->names);
    snprintf(s->names + n, NAMES - n, "%s%s", n ? ", " : "",
             m->device < 0 ? "" : serve_board_name(s->board, m->device));
    return m->device < 0 ? -1 : 0;
}

static int open_surfaces(serve_model *s, const model *body, const frame *f, err *e)
{
    char name[MODEL_NAME] = "";
    int at = 0, count = 0;
    s->is_open = true;
    while (model_surface(body, &at, name, sizeof name))
        count++;
    s->surface = mem_array(count, sizeof *s->surface, "surfaces", e);
    if (!s->surface)
        return -1;
    at = 0;
    while (model_surface(body, &at, name, sizeof name))
        if (add_surface(s, body, f, name, e))
            return -1;
    return 0;
}

/* ---- what a frame says */

static int put(serve_model *s, int device, uint64_t stamp, const frame *f, err *e)
{
    const int failed = serve_board_put(s->board, device, stamp, f->index, &s->content, e);
    s->content.size = 0;
    return failed;
}

static int move(moved *m, const frame *f, err *e)
{
    const model_array *nodes = m->is_bound ? frame_find(f, "node.displacement") : NULL;
    const model_array *u = nodes ? nodes : skin_of(m, f); /* or what the solver has computed of a bound one */
    if (!u)
        return err_set(e, NULL, 0,
                       "frame %" PRId64
                       " does not say how surface %s moves; expected displacements of nodes, or of its vertices",
                       f->index, m->name);
    if (nodes) {
        motion_set(&m->moves, u->f64, NULL);
        bone_set(&m->bone, f);
    }
    for (int64_t v = 0; v < m->b.shape.vertices; v++) {
        double d[3], *to = m->place + 3 * v;
        if (nodes)
            bone_displacement(&m->bone, &m->moves, v, d);
        else
            memcpy(d, u->f64 + 3 * v, sizeof d);
        for (int a = 0; a < 3; a++)
            d[a] += m->b.shape.position[3 * v + a];
        space_point_to_mm(d, SPACE_RAS, to);
        if (!isfinite(to[0]) || !isfinite(to[1]) || !isfinite(to[2]))
            return err_set(e, NULL, 0, "frame %" PRId64 " moves vertex %" PRId64 " of %s to a place that is not finite",
                           f->index, v, m->name);
    }
    return 0;
}

static int put_surface(serve_model *s, moved *m, uint64_t stamp, const frame *f, err *e)
{
    if (move(m, f, e) || igtl_write_surface(&s->content, m->place, m->b.shape.vertices, m->triangle, m->triangles, e))
        return -1;
    return put(s, m->device, stamp, f, e);
}

/* A row of a frame's array, or NULL. */
static const double *row_of(const frame *f, const char *name, int columns)
{
    const model_array *a = frame_find(f, name);
    return a && a->rows >= 1 && a->columns == columns && a->type == MODEL_F64 ? a->f64 : NULL;
}

static int put_pose(serve_model *s, uint64_t stamp, const frame *f, err *e)
{
    const double *row = s->probe < 0 ? NULL : row_of(f, "probe.pose", 7);
    double matrix[16];
    if (!row)
        return 0;
    pose at = pose_of_row(row);
    pose_unit(at.quaternion); /* the model's reader has seen that it is nearly one */
    space_matrix_of_pose(&at, SPACE_RAS, matrix);
    return igtl_write_transform(&s->content, matrix, e) || put(s, s->probe, stamp, f, e) ? -1 : 0;
}

/* Forces and torques are vectors: what turns them to RAS is what turns axes. */
static int put_sensor(serve_model *s, int *device, const char *name, const double *row, uint64_t unit, uint64_t stamp,
                      const frame *f, err *e)
{
    const igtl_sensor is = {.count = 3, .unit = unit, .value = {-row[0] + 0.0, -row[1] + 0.0, row[2]}};
    if (*device < 0 && (*device = serve_board_add(s->board, "SENSOR", name, e)) < 0)
        return -1;
    return igtl_write_sensor(&s->content, &is, e) || put(s, *device, stamp, f, e) ? -1 : 0;
}

static int put_force(serve_model *s, uint64_t stamp, const frame *f, err *e)
{
    const double *force = row_of(f, "probe.force", 3), *torque = row_of(f, "probe.torque", 3);
    char text[300];
    if (!force)
        return 0;
    if (put_sensor(s, &s->force, "ProbeForce", force, IGTL_NEWTON, stamp, f, e) ||
        (torque && put_sensor(s, &s->torque, "ProbeTorque", torque, IGTL_NEWTON_METRE, stamp, f, e)))
        return -1;
    int n = snprintf(text, sizeof text, "force %.6g %.6g %.6g N", -force[0] + 0.0, -force[1] + 0.0, force[2]);
    if (torque)
        n += snprintf(text + n, sizeof text - (size_t)n, ", torque %.6g %.6g %.6g N.m", -torque[0] + 0.0,
                      -torque[1] + 0.0, torque[2]);
    if (s->text < 0 && (s->text = serve_board_add(s->board, "STRING", "ProbeForce", e)) < 0)
        return -1;
    return igtl_write_string(&s->content, text, (size_t)n, e) || put(s, s->text, stamp, f, e) ? -1 : 0;
}

/* The small first: they are not to wait for surfaces. */
int serve_model_show(serve_model *s, const model *body, const frame *f, err *e)
{
    const uint64_t stamp = igtl_now();
    if (put_pose(s, stamp, f, e) || put_force(s, stamp, f, e) || (!s->is_open && open_surfaces(s, body, f, e)))
        return -1;
    for (int i = 0; i < s->count; i++)
        if (put_surface(s, &s->surface[i], stamp, f, e))
            return -1;
    return 0;
}
