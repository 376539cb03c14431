#include "render/surface.h"

#include <stddef.h>

/* What Embree's (u, v) weigh of each corner. A quadrilateral is two triangles, 0 1 3 and 2 3 1, on the second of which
 * (u, v) come from the other end. */
static void weigh(int corners, float u, float v, float weight[4])
{
    bool far_half = corners == 4 && u + v > 1;
    weight[0] = far_half ? 0 : 1 - u - v;
    weight[1] = far_half ? 1 - v : u;
    weight[2] = corners == 3 ? v : far_half ? u + v - 1 : 0;
    weight[3] = corners == 3 ? 0 : far_half ? 1 - u : v;
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

typedef struct spot {
    float x, y;
} spot;

static spot project(const view *v, vec p)
{
    vec d = vec_sub(p, v->eye);
    float scale = 1 / (v->pixel * (v->orthographic ? 1 : vec_most(vec_dot(d, v->forward), 1e-9f)));
    return (spot){.5f * (float)v->width + vec_dot(d, v->unit_right) * scale,
                  .5f * (float)v->height - vec_dot(d, v->unit_up) * scale};
}

static float distance_squared(spot a, spot b, float x, float y)
{
    float dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    float t = length > 0 ? ((x - a.x) * dx + (y - a.y) * dy) / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    dx = a.x + t * dx - x;
    dy = a.y + t * dy - y;
    return dx * dx + dy * dy;
}

/* Lines would make one dark mass of faces that are as small as they: from many widths down to few they fade. */
static float fade(const spot *s, int corners, float width)
{
    float area = 0, longest = 0;
    for (int i = 0; i < corners; i++) {
        spot a = s[i], b = s[(i + 1) % corners];
        area += a.x * b.y - a.y * b.x;
        longest = vec_most(longest, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    }
    float across = longest > 0 ? (corners == 4 ? .5f : 1) * fabsf(area) / sqrtf(longest) : 0;
    float share = (across / width - 1.5f) / 6;
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

/* How much of the pixel about (x, y) the face's drawn edges cover: their distance in the picture, filtered by a box of
 * one pixel. Each of two neighbours draws its half of the line between them. */
static float cover(const view *v, const scene_mesh *m, size_t face, float x, float y)
{
    float width = (float)v->options->edge_width;
    if (!m->edges || !m->edges[face] || !(width > 0))
        return 0;
    spot s[4];
    for (int i = 0; i < m->corners; i++)
        s[i] = project(v, vec_of(&m->position[3 * (size_t)m->corner[face * (size_t)m->corners + (size_t)i]]));
    float least = INFINITY;
    for (int i = 0; i < m->corners; i++)
        if (m->edges[face] >> i & 1)
            least = vec_least(least, distance_squared(s[i], s[(i + 1) % m->corners], x, y));
    float share = vec_most(0, vec_least(vec_least(1, width), .5f * width + .5f - sqrtf(least)));
    return share > 0 ? share * fade(s, m->corners, width) : 0;
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
