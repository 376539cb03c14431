#include "surface/closest.h"

#include "base/mem.h"
#include "surface/triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void minus(const double *a, const double *b, double *d)
{
    for (int i = 0; i < 3; i++)
        d[i] = a[i] - b[i];
}

static void cross(const double *a, const double *b, double *n)
{
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

static double squared_distance(const double *a, const double *b)
{
    double d[3];
    minus(a, b, d);
    return dot(d, d);
}

double closest_segment(const double *a, const double *b, const double *q, double *p)
{
    double ab[3], aq[3];
    minus(b, a, ab);
    minus(q, a, aq);
    double t = dot(aq, ab) / dot(ab, ab);
    if (!(t > 0)) /* also where a and b are one point */
        t = 0;
    for (int i = 0; i < 3; i++)
        p[i] = t < 1 ? a[i] + t * ab[i] : b[i];
    return squared_distance(p, q);
}

/* The foot of the perpendicular from q to abc's plane, where it lies in abc: with n = ab x ac, its weights of b and c
 * are (aq x ac).n / n.n and (ab x aq).n / n.n. */
static bool foot_inside(const double *a, const double *b, const double *c, const double *q, double *p)
{
    double ab[3], ac[3], aq[3], n[3], of_b[3], of_c[3];
    minus(b, a, ab);
    minus(c, a, ac);
    minus(q, a, aq);
    cross(ab, ac, n);
    cross(aq, ac, of_b);
    cross(ab, aq, of_c);
    double nn = dot(n, n), wb = dot(of_b, n) / nn, wc = dot(of_c, n) / nn;
    if (!(wb >= 0 && wc >= 0 && wb + wc <= 1)) /* a triangle without area gives nan */
        return false;
    for (int i = 0; i < 3; i++)
        p[i] = a[i] + wb * ab[i] + wc * ac[i];
    return true;
}

/* The nearest of the three sides, 0 to 2, and the foot of the perpendicular, 3: the sides alone are right for a
 * triangle so thin that its plane means nothing. */
static int nearest_of_four(const double *a, const double *b, const double *c, const double *q, double *p, double *d2)
{
    double near[4][3], distance[4];
    distance[0] = closest_segment(a, b, q, near[0]);
    distance[1] = closest_segment(b, c, q, near[1]);
    distance[2] = closest_segment(c, a, q, near[2]);
    distance[3] = foot_inside(a, b, c, q, near[3]) ? squared_distance(near[3], q) : INFINITY;
    int best = 0;
    for (int i = 1; i < 4; i++)
        if (distance[i] < distance[best])
            best = i;
    memcpy(p, near[best], sizeof near[best]);
    *d2 = distance[best];
    return best;
}

double closest_triangle(const double *a, const double *b, const double *c, const double *q, double *p)
{
    double d2;
    nearest_of_four(a, b, c, q, p, &d2);
    return d2;
}

double closest_triangle_on(const double *a, const double *b, const double *c, const double *q, double *p,
                           closest_feature *feature)
{
    static const closest_feature features[4] = {CLOSEST_AB, CLOSEST_BC, CLOSEST_CA, CLOSEST_INSIDE};
    const double *const corner[3] = {a, b, c};
    double d2;
    *feature = features[nearest_of_four(a, b, c, q, p, &d2)];
    for (int i = 0; i < 3; i++)
        if (p[0] == corner[i][0] && p[1] == corner[i][1] && p[2] == corner[i][2])
            *feature = (closest_feature)(CLOSEST_A + i);
    return d2;
}

/* Newell: the sum of the cross products of neighbouring corners, seen from the first. Less than rounding makes of
 * corners in a line counts as none. */
static void newell(const double *position, const int32_t *vertex, int64_t count, double *normal)
{
    double sum[3] = {0}, reach = 0, a[3], b[3], n[3];
    const double *first = &position[3 * (int64_t)vertex[0]];
    for (int64_t i = 1; i + 1 < count; i++) {
        minus(&position[3 * (int64_t)vertex[i]], first, a);
        minus(&position[3 * (int64_t)vertex[i + 1]], first, b);
        cross(a, b, n);
        for (int k = 0; k < 3; k++)
            sum[k] += n[k];
        reach = fmax(reach, fmax(dot(a, a), dot(b, b)));
    }
    double length = sqrt(dot(sum, sum));
    for (int k = 0; k < 3; k++)
        normal[k] = length > 1e-12 * reach ? sum[k] / length : 0;
}

static int cut(closest_shape *s, const double *position, const int32_t *vertex, int64_t count, err *e)
{
    if (mem_grow(&s->triangle, &s->triangle_capacity, 3 * s->parts, sizeof *s->triangle, "a polygon's triangles", e) ||
        triangulate(position, vertex, count, s->triangle, e))
        return -1;
    for (int64_t i = 0; i < 3 * s->parts; i++)
        memcpy(&s->point[3 * i], &position[3 * (int64_t)vertex[s->triangle[i]]], 3 * sizeof *position);
    newell(position, vertex, count, s->normal);
    return 0;
}

int closest_shape_of(closest_shape *s, const double *position, const int32_t *vertex, int64_t count, err *e)
{
    s->corners = count < 3 ? (int)count : 3;
    s->parts = count < 3 ? 1 : count - 2;
    memset(s->normal, 0, sizeof s->normal);
    if (mem_grow(&s->point, &s->point_capacity, 3 * s->corners * s->parts, sizeof *s->point, "a polygon", e))
        return -1;
    for (int a = 0; a < 3; a++) {
        s->low[a] = INFINITY;
        s->high[a] = -INFINITY;
        for (int64_t i = 0; i < count; i++) {
            s->low[a] = fmin(s->low[a], position[3 * (int64_t)vertex[i] + a]);
            s->high[a] = fmax(s->high[a], position[3 * (int64_t)vertex[i] + a]);
        }
    }
    if (count > 2)
        return cut(s, position, vertex, count, e);
    for (int64_t i = 0; i < count; i++)
        memcpy(&s->point[3 * i], &position[3 * (int64_t)vertex[i]], 3 * sizeof *position);
    return 0;
}

void closest_shape_free(closest_shape *s)
{
    free(s->point);
    free(s->triangle);
    *s = (closest_shape){0};
}

double closest_part(const closest_shape *s, int64_t part, const double *q, double *p)
{
    const double *at = &s->point[3 * s->corners * part];
    if (s->corners == 3)
        return sqrt(closest_triangle(at, at + 3, at + 6, q, p));
    if (s->corners == 2)
        return sqrt(closest_segment(at, at + 3, q, p));
    memcpy(p, at, 3 * sizeof *p);
    return sqrt(squared_distance(p, q));
}

double closest_distance(const closest_shape *s, const double *q)
{
    double nearest = INFINITY, p[3];
    for (int64_t part = 0; part < s->parts; part++)
        nearest = fmin(nearest, closest_part(s, part, q, p));
    return nearest;
}
