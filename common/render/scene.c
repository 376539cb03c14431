#include "render/scene.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void scene_mesh_free(scene_mesh *m)
{
    free(m->label);
    free(m->position);
    free(m->normal);
    free(m->corner);
    free(m->vertex_colour);
    free(m->face_colour);
    free(m->edges);
    *m = (scene_mesh){0};
}

static void free_spheres(scene_spheres *b)
{
    free(b->label);
    free(b->centre_radius);
    free(b->sphere_colour);
    *b = (scene_spheres){0};
}

void scene_free(scene *s)
{
    for (int64_t i = 0; i < s->meshes; i++)
        scene_mesh_free(&s->mesh[i]);
    for (int64_t i = 0; i < s->sphere_sets; i++)
        free_spheres(&s->spheres[i]);
    free(s->mesh);
    free(s->spheres);
    *s = (scene){0};
}

int scene_add_mesh(scene *s, scene_mesh *m, err *e)
{
    if (mem_grow(&s->mesh, &s->mesh_capacity, s->meshes + 1, sizeof *s->mesh, "a scene", e)) {
        scene_mesh_free(m);
        return -1;
    }
    s->mesh[s->meshes++] = *m;
    *m = (scene_mesh){0};
    return 0;
}

int scene_add_spheres(scene *s, scene_spheres *b, err *e)
{
    if (mem_grow(&s->spheres, &s->sphere_capacity, s->sphere_sets + 1, sizeof *s->spheres, "a scene", e)) {
        free_spheres(b);
        return -1;
    }
    s->spheres[s->sphere_sets++] = *b;
    *b = (scene_spheres){0};
    return 0;
}

static void widen(double low[3], double high[3], const float *p, double radius)
{
    for (int i = 0; i < 3; i++) {
        double from = (double)p[i] - radius, to = (double)p[i] + radius;
        low[i] = from < low[i] ? from : low[i];
        high[i] = to > high[i] ? to : high[i];
    }
}

bool scene_bounds(const scene *s, double low[3], double high[3])
{
    double l[3] = {INFINITY, INFINITY, INFINITY}, h[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t i = 0; i < s->meshes; i++) {
        const scene_mesh *m = &s->mesh[i];
        for (int64_t c = 0; c < m->faces * m->corners; c++)
            widen(l, h, &m->position[3 * (int64_t)m->corner[c]], 0);
    }
    for (int64_t i = 0; i < s->sphere_sets; i++)
        for (int64_t k = 0; k < s->spheres[i].count; k++) {
            const float *ball = s->spheres[i].centre_radius + 4 * k;
            widen(l, h, ball, (double)ball[3]);
        }
    if (!(l[0] <= h[0]))
        return false;
    memcpy(low, l, sizeof l);
    memcpy(high, h, sizeof h);
    return true;
}

/* ---- checks */

static const char *name_of(const char *label)
{
    return label ? label : "surface";
}

static int check_finite(const char *label, const char *what, const float *number, int64_t count, err *e)
{
    /* x - x is 0 for finite numbers only, and so is a sum of such. */
    float sum = 0;
    if (!number)
        return 0;
    for (int64_t i = 0; i < count; i++)
        sum += number[i] - number[i];
    if (sum == 0)
        return 0;
    int64_t i = 0;
    while (isfinite(number[i]))
        i++;
    return err_set(e, NULL, 0, "%s: %s %lld is not a finite number", name_of(label), what, (long long)i);
}

static int check_mesh(const scene_mesh *m, err *e)
{
    const char *label = name_of(m->label);
    if (m->corners != 3 && m->corners != 4)
        return err_set(e, NULL, 0, "%s: faces of %d corners; 3 or 4 can be drawn", label, m->corners);
    if (m->vertices < 0 || m->faces < 0 || m->vertices > UINT32_MAX || m->faces >= UINT32_MAX)
        return err_set(e, NULL, 0, "%s: %lld vertices and %lld faces; fewer than %u each can be drawn", label,
                       (long long)m->vertices, (long long)m->faces, UINT32_MAX);
    for (int64_t c = 0; c < m->faces * m->corners; c++)
        if (m->corner[c] >= m->vertices)
            return err_set(e, NULL, 0, "%s: face %lld has vertex %u of %lld", label, (long long)(c / m->corners),
                           m->corner[c], (long long)m->vertices);
    if (!(m->transparency >= 0 && m->transparency < 1))
        return err_set(e, NULL, 0, "%s: transparency %g; 0 to under 1 is expected", label, (double)m->transparency);
    return check_finite(label, "coordinate", m->position, 3 * m->vertices, e) ||
           check_finite(label, "normal", m->normal, 3 * m->faces * m->corners, e) ||
           check_finite(label, "colour", m->colour, 3, e) || check_finite(label, "edge colour", m->edge_colour, 3, e) ||
           check_finite(label, "vertex colour", m->vertex_colour, 3 * m->vertices, e) ||
           check_finite(label, "face colour", m->face_colour, 3 * m->faces, e);
}

static int check_spheres(const scene_spheres *b, err *e)
{
    if (b->count < 0 || b->count >= UINT32_MAX)
        return err_set(e, NULL, 0, "%s: %lld spheres; fewer than %u can be drawn", name_of(b->label),
                       (long long)b->count, UINT32_MAX);
    for (int64_t i = 0; i < b->count; i++)
        if (!(b->centre_radius[4 * i + 3] > 0))
            return err_set(e, NULL, 0, "%s: sphere %lld has the radius %g; more than 0 is expected", name_of(b->label),
                           (long long)i, (double)b->centre_radius[4 * i + 3]);
    return check_finite(b->label, "number", b->centre_radius, 4 * b->count, e) ||
           check_finite(b->label, "colour", b->colour, 3, e) ||
           check_finite(b->label, "sphere colour", b->sphere_colour, 3 * b->count, e);
}

int scene_check(const scene *s, err *e)
{
    for (int64_t i = 0; i < s->meshes; i++)
        if (check_mesh(&s->mesh[i], e))
            return -1;
    for (int64_t i = 0; i < s->sphere_sets; i++)
        if (check_spheres(&s->spheres[i], e))
            return -1;
    return 0;
}

/* ---- smooth normals */

/* The faces around every vertex: those of vertex v are face[start[v]] to face[start[v + 1]], each as face * corners +
 * its corner there. */
typedef struct fans {
    int64_t *start, *corner;
    float *unit; /* [faces][3], their normals */
} fans;

static void subtract(const float *a, const float *b, float *to)
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

static float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalise(float *v)
{
    float l = sqrtf(dot(v, v));
    for (int i = 0; l > 0 && i < 3; i++)
        v[i] /= l;
}

static const float *corner_place(const scene_mesh *m, int64_t face, int corner)
{
    return &m->position[3 * (int64_t)m->corner[face * m->corners + corner]];
}

/* By the diagonals: for a triangle its last corner counts twice. */
static void face_normal(const scene_mesh *m, int64_t face, float *to)
{
    float a[3], b[3];
    subtract(corner_place(m, face, 2), corner_place(m, face, 0), a);
    subtract(corner_place(m, face, m->corners == 4 ? 3 : 2), corner_place(m, face, 1), b);
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    normalise(to);
}

static float corner_angle(const scene_mesh *m, int64_t face, int corner)
{
    float a[3], b[3];
    const float *here = corner_place(m, face, corner);
    subtract(corner_place(m, face, (corner + 1) % m->corners), here, a);
    subtract(corner_place(m, face, (corner + m->corners - 1) % m->corners), here, b);
    normalise(a);
    normalise(b);
    return acosf(fmaxf(-1, fminf(1, dot(a, b))));
}

static int make_fans(const scene_mesh *m, fans *f, err *e)
{
    int64_t corners = m->faces * m->corners;
    f->start = mem_array(m->vertices + 2, sizeof *f->start, "smooth normals", e);
    f->corner = mem_array(corners, sizeof *f->corner, "smooth normals", e);
    f->unit = mem_array(m->faces, 3 * sizeof *f->unit, "smooth normals", e);
    if (!f->start || !f->corner || !f->unit)
        return -1;
    for (int64_t c = 0; c < corners; c++)
        f->start[m->corner[c] + 2]++;
    for (int64_t v = 2; v < m->vertices + 2; v++)
        f->start[v] += f->start[v - 1];
    for (int64_t c = 0; c < corners; c++)
        f->corner[f->start[m->corner[c] + 1]++] = c;
    for (int64_t i = 0; i < m->faces; i++)
        face_normal(m, i, &f->unit[3 * i]);
    return 0;
}

static void smooth_corner(const scene_mesh *m, const fans *f, const float *angle, float least, int64_t c, float *to)
{
    const float *own = &f->unit[3 * (c / m->corners)];
    uint32_t v = m->corner[c];
    to[0] = to[1] = to[2] = 0;
    for (int64_t k = f->start[v]; k < f->start[v + 1]; k++) {
        const float *other = &f->unit[3 * (f->corner[k] / m->corners)];
        float cosine = dot(own, other);
        if (fabsf(cosine) < least)
            continue;
        for (int i = 0; i < 3; i++)
            to[i] += copysignf(angle[f->corner[k]], cosine) * other[i];
    }
    normalise(to);
    if (!(dot(to, to) > 0))
        memcpy(to, own, 3 * sizeof *to);
}

int scene_smooth(scene_mesh *m, double crease, err *e)
{
    fans f = {0};
    int64_t corners = m->faces * m->corners;
    float *angle = mem_array(corners, sizeof *angle, "smooth normals", e);
    float *normal = mem_array(corners, 3 * sizeof *normal, "smooth normals", e);
    int status = angle && normal ? make_fans(m, &f, e) : -1;
    if (!status) {
        float least = cosf((float)(crease * 3.14159265358979 / 180));
        for (int64_t c = 0; c < corners; c++)
            angle[c] = corner_angle(m, c / m->corners, (int)(c % m->corners));
        for (int64_t c = 0; c < corners; c++)
            smooth_corner(m, &f, angle, least, c, &normal[3 * c]);
        free(m->normal);
        m->normal = normal;
        normal = NULL;
    }
    free(f.start);
    free(f.corner);
    free(f.unit);
    free(angle);
    free(normal);
    return status;
}
