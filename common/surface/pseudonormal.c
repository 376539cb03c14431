#include "surface/pseudonormal.h"

#include "base/mem.h"
#include "surface/coincident.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *n)
{
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

static void minus(const double *a, const double *b, double *d)
{
    for (int i = 0; i < 3; i++)
        d[i] = a[i] - b[i];
}

static void add(double *sum, double factor, const double *a)
{
    for (int i = 0; i < 3; i++)
        sum[i] += factor * a[i];
}

/* ---- Triangles and corners */

static void add_triangle(pseudonormal *n, const double *position, int64_t t)
{
    const double *at[3];
    double side[3][3], normal[3], from_middle[3];
    for (int i = 0; i < 3; i++)
        at[i] = position + 3 * (int64_t)n->corner[3 * t + i];
    for (int i = 0; i < 3; i++)
        minus(at[(i + 1) % 3], at[i], side[i]);
    cross(side[0], side[1], normal);
    const double length = sqrt(dot(normal, normal));
    if (!(length > 0))
        return;
    minus(at[0], position + 3 * (int64_t)n->corner[0], from_middle);
    n->volume += dot(from_middle, normal) / 6;
    add(n->face + 3 * t, 1 / length, normal);
    for (int i = 0; i < 3; i++) { /* the angle between a side and the one before it, backwards */
        const double angle = atan2(length, -dot(side[i], side[(i + 2) % 3]));
        add(n->at + 3 * (int64_t)n->place[n->corner[3 * t + i]], angle, n->face + 3 * t);
    }
}

/* ---- Edges */

/* A side of a triangle, in the list of the lower of the numbers of its places. */
typedef struct edge {
    int32_t high;
    bool back; /* it runs from high to low */
    bool idle; /* of a triangle that has two corners at one place: its neighbours meet there */
    int64_t side;
} edge;

static int compare_edges(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->side > b->side) - (a->side < b->side);
}

typedef struct edges {
    int64_t *start; /* places + 1: of the list of each */
    edge *list;
} edges;

/* The side as an edge, and the lower of its places; -1 where it has no length. */
static int32_t edge_of(const pseudonormal *n, int64_t side, edge *to)
{
    const int32_t *corner = n->corner + side / 3 * 3;
    const int32_t place[3] = {n->place[corner[0]], n->place[corner[1]], n->place[corner[2]]};
    const int32_t from = place[side % 3], next = place[(side + 1) % 3];
    to->high = from < next ? next : from;
    to->back = from > next;
    to->idle = place[0] == place[1] || place[1] == place[2] || place[2] == place[0];
    to->side = side;
    if (from == next)
        return -1;
    return from < next ? from : next;
}

static int list_edges(edges *l, const pseudonormal *n, int64_t places, int64_t triangles, err *e)
{
    edge made;
    l->start = mem_array(places + 2, sizeof *l->start, "a surface's edges", e);
    l->list = l->start ? mem_array(3 * triangles, sizeof *l->list, "a surface's edges", e) : NULL;
    if (!l->list)
        return -1;
    /* Counted two places up, so that filling leaves each list's first in its place. */
    for (int64_t s = 0; s < 3 * triangles; s++) {
        const int32_t low = edge_of(n, s, &made);
        if (low >= 0)
            l->start[low + 2]++;
    }
    for (int64_t p = 0; p < places; p++)
        l->start[p + 2] += l->start[p + 1];
    for (int64_t s = 0; s < 3 * triangles; s++) {
        const int32_t low = edge_of(n, s, &made);
        if (low >= 0)
            l->list[l->start[low + 1]++] = made;
    }
    return 0;
}

/* The sides that are one edge, which begins at place `low`. */
static void add_edge(pseudonormal *n, int32_t low, const edge *list, int64_t count)
{
    double sum[3] = {0};
    int64_t used = 0, back = 0;
    for (int64_t i = 0; i < count; i++) {
        add(sum, 1, n->face + list[i].side / 3 * 3);
        used += !list[i].idle;
        back += !list[i].idle && list[i].back;
    }
    n->turned += used == 2 && back != 1;
    n->border += used == 1;
    for (int64_t i = 0; i < count; i++) {
        memcpy(n->side + 3 * list[i].side, sum, sizeof sum);
        n->side_border[list[i].side] = used == 1;
    }
    if (used == 1)
        n->place_border[low] = n->place_border[list->high] = true;
}

static int add_edges(pseudonormal *n, int64_t places, int64_t triangles, err *e)
{
    edges l = {0};
    const int status = list_edges(&l, n, places, triangles, e);
    for (int64_t p = 0; !status && p < places; p++) {
        const int64_t end = l.start[p + 1];
        qsort(l.list + l.start[p], (size_t)(end - l.start[p]), sizeof *l.list, compare_edges);
        for (int64_t first = l.start[p], last; first < end; first = last) {
            for (last = first + 1; last < end && l.list[last].high == l.list[first].high;)
                last++;
            add_edge(n, (int32_t)p, l.list + first, last - first);
        }
    }
    free(l.start);
    free(l.list);
    return status;
}

int pseudonormal_of(pseudonormal *n, const double *position, int64_t vertices, const int32_t *corner, int64_t triangles,
                    err *e)
{
    static const char what[] = "a surface's normals";
    *n = (pseudonormal){.corner = corner};
    n->place = mem_array(vertices, sizeof *n->place, what, e);
    const int64_t places = n->place ? coincident_places(position, vertices, n->place, e) : -1;
    if (places < 0 || !(n->face = mem_array(triangles, 3 * sizeof *n->face, what, e)) ||
        !(n->side = mem_array(triangles, 9 * sizeof *n->side, what, e)) ||
        !(n->at = mem_array(places, 3 * sizeof *n->at, what, e)) ||
        !(n->side_border = mem_array(triangles, 3, what, e)) || !(n->place_border = mem_array(places, 1, what, e)))
        return -1;
    for (int64_t t = 0; t < triangles; t++)
        add_triangle(n, position, t);
    return add_edges(n, places, triangles, e);
}

void pseudonormal_free(pseudonormal *n)
{
    free(n->place);
    free(n->face);
    free(n->side);
    free(n->at);
    free(n->side_border);
    free(n->place_border);
    *n = (pseudonormal){0};
}

/* ---- What is asked */

static int32_t place_of(const pseudonormal *n, const triangle_hit *hit)
{
    return n->place[n->corner[3 * hit->triangle + (hit->feature - CLOSEST_A)]];
}

static int64_t side_of(const triangle_hit *hit)
{
    return 3 * hit->triangle + (hit->feature - CLOSEST_AB);
}

/* Of any length. */
static const double *normal_of(const pseudonormal *n, const triangle_hit *hit)
{
    if (hit->feature < CLOSEST_AB)
        return n->at + 3 * (int64_t)place_of(n, hit);
    return hit->feature < CLOSEST_INSIDE ? n->side + 3 * side_of(hit) : n->face + 3 * hit->triangle;
}

bool pseudonormal_outside(const pseudonormal *n, const triangle_hit *hit, const double q[3])
{
    double away[3];
    minus(q, hit->point, away);
    return dot(away, normal_of(n, hit)) >= 0;
}

void pseudonormal_at(const pseudonormal *n, const triangle_hit *hit, double normal[3])
{
    memcpy(normal, normal_of(n, hit), 3 * sizeof *normal);
}

bool pseudonormal_on_border(const pseudonormal *n, const triangle_hit *hit)
{
    if (hit->feature < CLOSEST_AB)
        return n->place_border[place_of(n, hit)];
    return hit->feature < CLOSEST_INSIDE && n->side_border[side_of(hit)];
}
