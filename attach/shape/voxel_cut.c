#include "attach/shape/voxel_cut.h"

#include "surface/triangle.h"

#include <math.h>
#include <string.h>

typedef struct polygon { /* in units of cells from the lattice's origin */
    double corner[VOXEL_CUT_MOST][3];
    int corners;
} polygon;

/* Clips a polygon by the plane x_axis = at. sign: 1 keeps the part above it, -1 the part below. */
static polygon clipped(const polygon *p, int axis, double at, int sign)
{
    polygon to = {.corners = 0};
    for (int i = 0; i < p->corners; i++) {
        const double *a = p->corner[i], *b = p->corner[(i + 1) % p->corners];
        const double from = sign * (a[axis] - at), next = sign * (b[axis] - at);
        if (from >= 0 && to.corners < VOXEL_CUT_MOST)
            memcpy(to.corner[to.corners++], a, sizeof to.corner[0]);
        if ((from > 0 && next < 0) || (from < 0 && next > 0)) {
            const double s = from / (from - next);
            for (int k = 0; k < 3 && to.corners < VOXEL_CUT_MOST; k++)
                to.corner[to.corners][k] = k == axis ? at : a[k] + s * (b[k] - a[k]);
            to.corners += to.corners < VOXEL_CUT_MOST;
        }
    }
    return to;
}

/* Its middle and its area, by the triangles of a fan. */
static void measure(voxel_piece *p)
{
    double sum[3] = {0};
    p->area = 0;
    for (int i = 1; i + 1 < p->corners; i++) {
        const double *a = p->corner[0], *b = p->corner[i], *c = p->corner[i + 1];
        double n[3];
        triangle_normal(a, b, c, n);
        const double area = triangle_length(n) / 2;
        p->area += area;
        for (int k = 0; k < 3; k++)
            sum[k] += area * (a[k] + b[k] + c[k]) / 3;
    }
    for (int k = 0; k < 3; k++)
        p->middle[k] = p->area > 0 ? sum[k] / p->area : 0;
}

static voxel_piece piece_of(const lattice *l, const polygon *p, const int64_t cell[3])
{
    voxel_piece to = {.corners = p->corners};
    memcpy(to.cell, cell, sizeof to.cell);
    for (int i = 0; i < 3 * p->corners; i++)
        to.corner[i / 3][i % 3] = l->origin[i % 3] + l->spacing[i % 3] * p->corner[i / 3][i % 3];
    measure(&to);
    return to;
}

/* The cells that a polygon reaches along an axis. */
static void reach(const polygon *p, int axis, int64_t *low, int64_t *high)
{
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < p->corners; i++) {
        least = fmin(least, p->corner[i][axis]);
        most = fmax(most, p->corner[i][axis]);
    }
    *low = (int64_t)floor(least);
    *high = most > least ? (int64_t)ceil(most) - 1 : *low;
}

/* Cuts along z, then y, then x. */
static int cut(const lattice *l, const polygon *p, int axis, int64_t cell[3], // NOLINT(misc-no-recursion): 3 deep
               int (*take)(void *context, const voxel_piece *piece), void *context)
{
    int64_t low, high;
    int status = 0;
    if (p->corners < 3)
        return 0;
    if (axis < 0) {
        const voxel_piece piece = piece_of(l, p, cell);
        return piece.area > 0 ? take(context, &piece) : 0;
    }
    reach(p, axis, &low, &high);
    for (int64_t k = low; k <= high && !status; k++) {
        const polygon above = k > low ? clipped(p, axis, (double)k, 1) : *p;
        const polygon slice = k < high ? clipped(&above, axis, (double)(k + 1), -1) : above;
        cell[axis] = k;
        status = cut(l, &slice, axis - 1, cell, take, context);
    }
    return status;
}

int voxel_cut(const lattice *l, double triangle[3][3], int (*take)(void *context, const voxel_piece *piece),
              void *context)
{
    polygon p = {.corners = 3};
    int64_t cell[3] = {0};
    for (int i = 0; i < 3; i++)
        lattice_local(l, triangle[i], p.corner[i]);
    return cut(l, &p, 2, cell, take, context);
}
