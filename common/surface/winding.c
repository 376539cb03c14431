#include "surface/winding.h"

#include "surface/closest.h"

#include <math.h>

static const double *corner_of(const winding *s, int64_t i)
{
    return s->position + 3 * (s->corner ? (int64_t)s->corner[i] : i);
}

winding winding_of(const double *position, const int32_t *corner, int64_t triangles)
{
    winding s = {.position = position, .corner = corner, .triangles = triangles};
    double largest = 0;
    for (int a = 0; a < 3; a++) {
        s.low[a] = INFINITY;
        s.high[a] = -INFINITY;
        for (int64_t i = 0; i < 3 * triangles; i++) {
            const double x = corner_of(&s, i)[a];
            s.low[a] = fmin(s.low[a], x);
            s.high[a] = fmax(s.high[a], x);
            largest = fmax(largest, fabs(x));
        }
    }
    s.near = 1e-12 * largest;
    for (int a = 0; a < 3; a++) {
        s.low[a] -= s.near;
        s.high[a] += s.near;
    }
    return s;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Half the solid angle of a triangle with these corners, as seen from 0:
 * tan = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|). */
static double half_angle(const double *a, const double *b, const double *c)
{
    const double la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), lc = sqrt(dot(c, c));
    const double n[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
    return atan2(dot(a, n), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/* Few boxes of triangles hold the point. */
bool winding_meets(const winding *s, const double *const at[3], const double point[3])
{
    double nearest[3];
    for (int a = 0; a < 3; a++)
        if (fmin(at[0][a], fmin(at[1][a], at[2][a])) > point[a] + s->near ||
            fmax(at[0][a], fmax(at[1][a], at[2][a])) < point[a] - s->near)
            return false;
    return closest_triangle(at[0], at[1], at[2], point, nearest) <= s->near * s->near;
}

bool winding_holds(const winding *s, const double point[3])
{
    const double pi = 3.14159265358979323846;
    double sum = 0, corner[3][3];
    for (int a = 0; a < 3; a++)
        if (!(point[a] >= s->low[a] && point[a] <= s->high[a]))
            return false;
    for (int64_t t = 0; t < s->triangles; t++) {
        const double *at[3];
        for (int i = 0; i < 3; i++) {
            at[i] = corner_of(s, 3 * t + i);
            for (int a = 0; a < 3; a++)
                corner[i][a] = at[i][a] - point[a];
        }
        if (winding_meets(s, at, point))
            return true;
        sum += half_angle(corner[0], corner[1], corner[2]);
    }
    return fabs(sum) > pi;
}
