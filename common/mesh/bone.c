#include "mesh/bone.h"

#include "base/mem.h"
#include "mesh/held.h"
#include "mesh/rigid_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The nodes that anchors hold. */
typedef struct anchors {
    const model_array *name;
    const int32_t *of_node;
    int64_t nodes;
    const double *rest;
} anchors;

/* The first anchor among the names of a group, or -1. */
static int32_t anchor_of_group(const anchors *a, const char *names)
{
    for (int64_t i = 0; i < a->name->rows; i++)
        if (surface_in_group(names, a->name->str[i]))
            return (int32_t)i;
    return -1;
}

/* Marks the vertices of each face on a rigid surface with its anchor: the first face decides. */
static int mark(bone *b, const surface *s, const anchors *a, err *e)
{
    int32_t *of_group = mem_array(s->groups, sizeof *of_group, "groups", e);
    if (!of_group)
        return -1;
    for (int64_t g = 0; g < s->groups; g++)
        of_group[g] = anchor_of_group(a, s->group_name[g]);
    for (int64_t f = 0; f < s->faces; f++)
        for (int64_t c = s->start[f]; c < surface_end(s, f); c++)
            if (b->node[s->vertex[c]] < 0)
                b->node[s->vertex[c]] = of_group[s->group[f]];
    free(of_group);
    return 0;
}

static double distance2(const double *p, const double *q)
{
    double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
    return x * x + y * y + z * z;
}

/* Of an element's nodes the nearest to p that the anchor holds, or -1. */
static int32_t nearest_of(const anchors *a, int32_t anchor, const double *p, const int32_t *node, int corners)
{
    int32_t best = -1;
    double least = INFINITY;
    for (int i = 0; i < corners; i++) {
        double d = distance2(p, a->rest + 3 * (int64_t)node[i]);
        if (a->of_node[node[i]] == anchor && d < least) {
            best = node[i];
            least = d;
        }
    }
    return best;
}

/* A node in place of the anchor for each vertex that has one. Where only a part of a surface was voxelised, most
 * vertices may lie by an element of which their bone holds nothing. */
static int carry(bone *b, const bound *of, const anchors *a, err *e)
{
    held all;
    if (held_build(&all, a->rest, a->of_node, a->nodes, (int32_t)a->name->rows, e))
        return -1;
    for (int64_t v = 0; v < of->shape.vertices; v++) {
        const double *p = of->shape.position + 3 * v;
        int32_t anchor = b->node[v];
        if (anchor < 0)
            continue;
        b->node[v] = nearest_of(a, anchor, p, of->node + of->corners * (int64_t)of->element[v], of->corners);
        if (b->node[v] < 0)
            b->node[v] = held_nearest(&all, anchor, p);
        b->count += b->node[v] >= 0;
    }
    held_free(&all);
    return 0;
}

int bone_find(bone *b, const bound *of, const model *m, err *e)
{
    const model_array *name = model_find(m, "anchor.name"), *anchor = model_find(m, "node.anchor");
    b->node = mem_array(of->shape.vertices, sizeof *b->node, "vertices on bone", e);
    if (!b->node)
        return -1;
    for (int64_t v = 0; v < of->shape.vertices; v++)
        b->node[v] = -1;
    if (!name || !anchor)
        return 0;
    const model_array *body = model_find(m, "node.body");
    b->by_films = model_find(m, "bone.element") != NULL;
    b->body = body ? body->i32 : NULL;
    b->bodies = body ? model_count(m, "body") : 0;
    b->moved = mem_array(b->bodies, sizeof *b->moved, "rigid bodies", e);
    if (!b->moved)
        return -1;
    anchors a = {name, anchor->i32, anchor->rows, of->rest};
    return mark(b, &of->shape, &a, e) || carry(b, of, &a, e) ? -1 : 0;
}

void bone_set(bone *b, const frame *f)
{
    b->is_known = b->body && frame_find(f, "body.pose");
    for (int64_t i = 0; i < b->bodies && b->is_known; i++)
        b->moved[i] = rigid_body_pose(f, (int32_t)i);
}

static int32_t body_of(const bone *b, int64_t vertex)
{
    return b->node[vertex] >= 0 && b->is_known ? b->body[b->node[vertex]] : -1;
}

void bone_displacement(const bone *b, const motion *of, int64_t vertex, double *d)
{
    const int32_t node = b->node[vertex], body = body_of(b, vertex);
    const double *rest = of->of->shape.position + 3 * vertex;
    if (body >= 0) {
        pose_apply(&b->moved[body], rest, d);
        for (int a = 0; a < 3; a++)
            d[a] -= rest[a];
    } else if (node >= 0 && !b->by_films)
        memcpy(d, &of->u[3 * (int64_t)node], 3 * sizeof *d);
    else
        motion_displacement(of, vertex, d);
}

void bone_gradient(const bone *b, const motion *of, int64_t vertex, double *f)
{
    const int32_t body = body_of(b, vertex);
    if (b->node[vertex] < 0 || (b->by_films && body < 0)) {
        motion_gradient(of, vertex, f);
        return;
    }
    for (int i = 0; i < 9; i++)
        f[i] = i % 4 == 0;
    if (body >= 0)
        pose_matrix(b->moved[body].quaternion, f);
}

void bone_free(bone *b)
{
    free(b->node);
    free(b->moved);
    *b = (bone){0};
}
