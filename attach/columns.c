#include "columns.h"

#include "base/mem.h"
#include "surface/closest.h"

#include <math.h>
#include <stdlib.h>

enum { COLUMNS_MOST = 512 }; /* along an axis */

static const double *corner_of(const columns *c, int64_t triangle, int i)
{
    return c->of->position + 3 * (int64_t)c->of->corner[3 * triangle + i];
}

static int64_t column_at(const columns *c, int axis, double x)
{
    const double at = floor((x - c->low[axis]) / c->side);
    return (int64_t)fmin(fmax(at, 0), (double)(c->count[axis] - 1));
}

/* The columns that a triangle's box reaches. */
static void reach_of(const columns *c, int64_t triangle, int64_t first[2], int64_t last[2])
{
    for (int a = 0; a < 2; a++) {
        const double x = corner_of(c, triangle, 0)[a], y = corner_of(c, triangle, 1)[a],
                     z = corner_of(c, triangle, 2)[a];
        first[a] = column_at(c, a, fmin(x, fmin(y, z)));
        last[a] = column_at(c, a, fmax(x, fmax(y, z)));
    }
}

/* Counts the triangles of each column into start, or, where there is room for them, lists them. */
static void sort_triangles(columns *c)
{
    for (int64_t t = 0; t < c->of->triangles; t++) {
        int64_t first[2], last[2];
        reach_of(c, t, first, last);
        for (int64_t j = first[1]; j <= last[1]; j++)
            for (int64_t i = first[0]; i <= last[0]; i++) {
                int64_t *at = &c->start[j * c->count[0] + i];
                if (c->triangle)
                    c->triangle[*at] = (int32_t)t;
                ++*at;
            }
    }
}

int columns_make(columns *c, const trimesh *of, double side, err *e)
{
    *c = (columns){.of = of, .whole = winding_of(of->position, of->corner, of->triangles), .side = side};
    for (int a = 0; a < 2; a++) {
        c->low[a] = c->whole.low[a];
        c->side = fmax(c->side, (c->whole.high[a] - c->low[a]) / COLUMNS_MOST);
    }
    for (int a = 0; a < 2; a++)
        c->count[a] = 1 + (int64_t)((c->whole.high[a] - c->low[a]) / c->side);
    const int64_t all = c->count[0] * c->count[1];
    c->start = mem_array(all + 1, sizeof *c->start, "a part", e);
    if (!c->start)
        return -1;
    sort_triangles(c);
    int64_t sum = 0;
    for (int64_t i = 0; i <= all; i++) {
        const int64_t here = c->start[i];
        c->start[i] = sum;
        sum += here;
    }
    c->triangle = mem_array(sum, sizeof *c->triangle, "a part", e);
    if (!c->triangle)
        return -1;
    sort_triangles(c); /* which moves each start to the next one's */
    for (int64_t i = all; i > 0; i--)
        c->start[i] = c->start[i - 1];
    c->start[0] = 0;
    return 0;
}

void columns_free(columns *c)
{
    free(c->start);
    free(c->triangle);
    *c = (columns){.of = NULL};
}

/* Twice the area of the triangle a, b, p, seen along z. */
static double area(const double *a, const double *b, const double *p)
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* How often a triangle is crossed by the ray from p along +z, with the sense; 2: it comes too near to its edges or to
 * p to say. */
static int crossing(const columns *c, int64_t triangle, const double *p)
{
    static const double near = 1e-9;
    const double *x = corner_of(c, triangle, 0), *y = corner_of(c, triangle, 1), *z = corner_of(c, triangle, 2);
    const double size = fmax(fmax(fabs(y[0] - x[0]), fabs(z[0] - x[0])), fmax(fabs(y[1] - x[1]), fabs(z[1] - x[1])));
    for (int a = 0; a < 2; a++)
        if (p[a] < fmin(x[a], fmin(y[a], z[a])) - near * size || p[a] > fmax(x[a], fmax(y[a], z[a])) + near * size)
            return 0;
    const double of_z = area(x, y, p), of_x = area(y, z, p), of_y = area(z, x, p), all = of_x + of_y + of_z;
    if (fmin(fabs(of_x), fmin(fabs(of_y), fabs(of_z))) <= near * size * size)
        return 2;
    if ((of_x > 0) != (of_y > 0) || (of_x > 0) != (of_z > 0))
        return 0;
    const double height = (of_x * x[2] + of_y * y[2] + of_z * z[2]) / all;
    if (fabs(height - p[2]) <= c->whole.near + near * size)
        return 2;
    if (height < p[2])
        return 0;
    return all > 0 ? 1 : -1;
}

bool columns_hold(const columns *c, const double point[3])
{
    int sum = 0;
    for (int a = 0; a < 3; a++)
        if (!(point[a] >= c->whole.low[a] && point[a] <= c->whole.high[a]))
            return false;
    const int64_t at = column_at(c, 1, point[1]) * c->count[0] + column_at(c, 0, point[0]);
    for (int64_t i = c->start[at]; i < c->start[at + 1]; i++) {
        const int crossed = crossing(c, c->triangle[i], point);
        if (crossed == 2)
            return winding_holds(&c->whole, point);
        sum += crossed;
    }
    return sum != 0;
}

double columns_away(const columns *c, const double point[3])
{
    double nearest = INFINITY, p[3];
    for (int a = 0; a < 3; a++)
        if (point[a] < c->whole.low[a] - c->side || point[a] > c->whole.high[a] + c->side)
            return INFINITY;
    int64_t first[2], last[2];
    for (int a = 0; a < 2; a++) {
        first[a] = column_at(c, a, point[a] - c->side);
        last[a] = column_at(c, a, point[a] + c->side);
    }
    for (int64_t j = first[1]; j <= last[1]; j++)
        for (int64_t k = c->start[j * c->count[0] + first[0]]; k < c->start[j * c->count[0] + last[0] + 1]; k++) {
            const int64_t t = c->triangle[k];
            nearest =
                fmin(nearest, closest_triangle(corner_of(c, t, 0), corner_of(c, t, 1), corner_of(c, t, 2), point, p));
        }
    return sqrt(nearest) <= c->side ? sqrt(nearest) : INFINITY;
}
