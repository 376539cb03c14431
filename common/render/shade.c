#include "render/shade.h"

#include <stddef.h>

/* What Embree's (u, v) weigh of each corner. A quadrilateral is two triangles, 0 1 3 and 2 3 1, on the second of which
 * (u, v) come from the other end. */
static void weigh(int corners, float u, float v, float weight[4])
{
    bool far_half = corners == 4 && u + v > 1;
    weight[0] = far_half ? 0 : 1 - u - v;
    weight[1] = far_half ? 1 - v : u;
    weight[2] = far_half ? u + v - 1 : 0;
    weight[3] = far_half ? 1 - u : v;
    if (corners == 3) {
        weight[2] = v;
        weight[3] = 0;
    }
}

static vec blend(const float *row, const uint32_t *corner, int corners, const float *weight)
{
    vec sum = {0, 0, 0};
    for (int i = 0; i < corners; i++)
        sum = vec_along(sum, vec_of(&row[3 * (size_t)corner[i]]), weight[i]);
    return sum;
}

static vec mesh_colour(const scene_mesh *m, size_t face, const float *weight)
{
    if (m->face_colour)
        return vec_of(&m->face_colour[3 * face]);
    if (m->vertex_colour)
        return blend(m->vertex_colour, &m->corner[face * (size_t)m->corners], m->corners, weight);
    return vec_of(m->colour);
}

static vec mesh_normal(const scene_mesh *m, size_t face, const float *weight, vec flat)
{
    if (!m->normal)
        return flat;
    vec sum = {0, 0, 0};
    for (int i = 0; i < m->corners; i++)
        sum = vec_along(sum, vec_of(&m->normal[3 * (face * (size_t)m->corners + (size_t)i)]), weight[i]);
    sum = vec_unit(vec_dot(sum, flat) < 0 ? vec_scale(sum, -1) : sum);
    return vec_dot(sum, sum) > .5f ? sum : flat;
}

/* A face's corners in the picture, in pixels from the place that is seen. A triangle's fourth is its first again. The
 * loops over four run in vector registers. */
typedef struct outline {
    float x[4], y[4];
} outline;

static void project(const view *v, const scene_mesh *m, size_t face, float x, float y, outline *o)
{
    const uint32_t *corner = m->corner + face * (size_t)m->corners;
    float p[3][4];
    for (int i = 0; i < 4; i++) {
        const float *at = m->position + 3 * (size_t)corner[i < m->corners ? i : 0];
        for (int k = 0; k < 3; k++)
            p[k][i] = at[k];
    }
    float left = .5f * (float)v->width - x, top = .5f * (float)v->height - y;
    for (int i = 0; i < 4; i++) {
        float dx = p[0][i] - v->eye.x, dy = p[1][i] - v->eye.y, dz = p[2][i] - v->eye.z;
        float depth = dx * v->forward.x + dy * v->forward.y + dz * v->forward.z;
        if (v->orthographic)
            depth = 1;
        else if (!(depth > 1e-9f))
            depth = 1e-9f;
        float scale = 1 / (v->pixel * depth);
        o->x[i] = left + scale * (dx * v->unit_right.x + dy * v->unit_right.y + dz * v->unit_right.z);
        o->y[i] = top - scale * (dx * v->unit_up.x + dy * v->unit_up.y + dz * v->unit_up.z);
    }
}

/* The squared distance from the place to each side, and the sides' squared lengths. */
static void sides(const outline *o, int corners, float distance[4], float length[4])
{
    float ex[4], ey[4];
    for (int i = 0; i < 4; i++) {
        int next = i + 1 < corners ? i + 1 : 0;
        ex[i] = o->x[next];
        ey[i] = o->y[next];
    }
    for (int i = 0; i < 4; i++) {
        float dx = ex[i] - o->x[i], dy = ey[i] - o->y[i];
        length[i] = dx * dx + dy * dy;
        float t = -(o->x[i] * dx + o->y[i] * dy) / (length[i] + 1e-30f);
        t = vec_least(vec_most(t, 0), 1);
        float nx = o->x[i] + t * dx, ny = o->y[i] + t * dy;
        distance[i] = nx * nx + ny * ny;
    }
}

/* Lines would make one dark mass of faces that are as small as they: from many widths down to few they fade. */
static float fade(const outline *o, const float *length, int corners, float width)
{
    float area = 0, longest = 0;
    for (int i = 0; i < corners; i++) {
        int next = i + 1 < corners ? i + 1 : 0;
        area += o->x[i] * o->y[next] - o->y[i] * o->x[next];
        longest = vec_most(longest, length[i]);
    }
    const float share = corners == 4 ? .5f : 1;
    float across = longest > 0 ? share * fabsf(area) / sqrtf(longest) : 0;
    return vec_least(vec_most((across / width - 1.5f) / 6, 0), 1);
}

/* How much of the pixel about (x, y) the face's drawn edges cover: their distance in the picture, filtered by a box of
 * one pixel. Each of two neighbours draws its half of the line between them. */
static float cover(const view *v, const scene_mesh *m, size_t face, float x, float y)
{
    float width = (float)v->options->edge_width, distance[4], length[4], least = INFINITY;
    if (!m->edges || !m->edges[face] || !(width > 0))
        return 0;
    outline o;
    project(v, m, face, x, y, &o);
    sides(&o, m->corners, distance, length);
    for (int i = 0; i < m->corners; i++)
        if (m->edges[face] >> i & 1)
            least = vec_least(least, distance[i]);
    float reach = .5f * width + .5f;
    if (least >= reach * reach)
        return 0;
    float share = vec_least(vec_least(1, width), reach - sqrtf(least));
    return share * fade(&o, length, m->corners, width);
}

static void mesh_met(const view *v, const scene_mesh *m, const embree_packet *p, int i, float x, float y, surface *to)
{
    float weight[4];
    size_t face = p->item[i];
    weigh(m->corners, p->u[i], p->v[i], weight);
    to->normal = mesh_normal(m, face, weight, to->flat);
    to->colour = mesh_colour(m, face, weight);
    to->line = cover(v, m, face, x, y);
}

void surface_met(const view *v, const embree_packet *p, int i, float x, float y, surface *to)
{
    to->geometry = p->geometry[i];
    if (to->geometry == EMBREE_NONE)
        return;
    vec from = {p->from[0][i], p->from[1][i], p->from[2][i]}, along = {p->along[0][i], p->along[1][i], p->along[2][i]};
    vec flat = vec_unit((vec){p->normal[0][i], p->normal[1][i], p->normal[2][i]});
    to->place = vec_along(from, along, p->end[i]);
    to->flat = vec_dot(flat, along) > 0 ? vec_scale(flat, -1) : flat;
    if (to->geometry < v->scene->meshes) {
        mesh_met(v, &v->scene->mesh[to->geometry], p, i, x, y, to);
        return;
    }
    const scene_spheres *b = &v->scene->spheres[to->geometry - v->scene->meshes];
    to->normal = to->flat;
    to->colour = vec_of(b->sphere_colour ? &b->sphere_colour[3 * (size_t)p->item[i]] : b->colour);
    to->line = 0;
}

float surface_transparency(const view *v, const surface *s)
{
    return s->geometry < v->scene->meshes ? v->scene->mesh[s->geometry].transparency : 0;
}

/* Light from a large soft lamp: it reaches a little round the corner. */
static float soft(float cosine)
{
    float x = (cosine + .3f) / 1.3f;
    return x > 0 ? x * x : 0;
}

vec surface_shade(const view *v, const surface *s, float ambient, float key)
{
    float sky = .5f + .5f * vec_dot(s->normal, v->unit_up), cosine = vec_dot(s->normal, v->key);
    float light = (.22f + .14f * sky) * ambient;
    /* Deep places get less of the lamps too. Of a surface that turns away from the lamp the faces would show in its
     * shadow: there it has no more than the turning gives. */
    float open = .5f + .5f * ambient, turned = vec_least(1, vec_most(0, 3 * cosine));
    light += .66f * soft(cosine) * (1 - turned * (1 - key)) * open;
    light += .14f * soft(vec_dot(s->normal, v->fill)) * open;
    vec c = vec_scale(s->colour, light);
    if (!(s->line > 0))
        return c;
    vec edge = vec_of(v->scene->mesh[s->geometry].edge_colour);
    return vec_along(vec_scale(c, 1 - s->line), edge, s->line);
}
