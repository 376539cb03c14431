#include "voxelise/surfaces/crossing.h"

#include "voxelise/surfaces/expansion.h"

#include <float.h>
#include <math.h>

enum { CROSS_PARTS = 4 * GRID_PARTS }; /* components of a product of an edge (2) and a difference (5), and of its sum */

/* What crossing_first() counts from is included, so that its own rounding is within the bound. */
double crossing_error(const grid *g, int axis, double local, double far)
{
    double cells = fmax(fabs((double)g->low[axis]), fabs((double)g->high[axis])) + 4;
    return 2 * DBL_EPSILON * (2 * fmax(local, far) / g->spacing[axis] + cells);
}

/* The first of cells low to high that is past, where each after one that is past is too, and high is. */
typedef bool is_past(const void *context, int32_t cell);

static int32_t first_past(is_past *past, const void *context, int64_t low, int64_t high)
{
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (past(context, (int32_t)middle))
            high = middle;
        else
            low = middle + 1;
    }
    return (int32_t)low;
}

/* The same where x, which they are to be past, is known to within bound: only the cells that this leaves open are
 * asked. */
static int32_t first_near(is_past *past, const void *context, double x, double bound, int32_t low, int32_t high)
{
    double from = ceil(x - bound), to = ceil(x + bound);
    bool known = bound < INFINITY && from <= to; /* false for a nan */
    return first_past(past, context, known ? (int64_t)crossing_within(from, low, high) : low,
                      known ? (int64_t)crossing_within(to, low, high) : high);
}

/* ---- a vertex */

typedef struct point {
    const crossing_mesh *m;
    int axis;
    double x;
} point;

static bool past_point(const void *context, int32_t cell)
{
    const point *p = context;
    double h[GRID_PARTS];
    int n = grid_difference(p->m->g, p->axis, cell, p->x, h);
    return expansion_sign(n, h) >= 0; /* a centre beside it has been moved on */
}

int32_t crossing_of_point(const crossing_mesh *m, int axis, double x, double cell)
{
    int32_t low = (int32_t)m->g->low[axis], high = (int32_t)m->g->high[axis];
    int32_t at = crossing_first(cell, m->error[axis], low, high);
    if (at != CROSSING_OPEN)
        return at;
    point p = {m, axis, x};
    return first_near(past_point, &p, cell, m->error[axis], low, high);
}

/* ---- an edge */

/* h = p q - r s of expansions of at most 2 (p, r) and GRID_PARTS (q, s) components. */
static int cross(const double *p, int np, const double *q, int nq, const double *r, int nr, const double *s, int ns,
                 double *h)
{
    double pq[CROSS_PARTS], rs[CROSS_PARTS];
    int npq = expansion_product(np, p, nq, q, pq), nrs = expansion_product(nr, r, ns, s, rs);
    expansion_negate(nrs, rs);
    return expansion_sum(npq, pq, nrs, rs, h);
}

/* With w the differences from a to b and from a to the centre, along rows and columns: the bound. The fraction of the
 * edge at which it crosses is off by at most 3 error_row / (w_row - 2 error_row), the column then
 * by that times w_column, by 3 error_column, and by a few roundings, each less than half of an
 * error: less than half of this in all. */
crossing_line crossing_line_of(const crossing_mesh *m, int32_t a, int32_t b)
{
    const double *from = &m->cell[3 * (int64_t)a], *to = &m->cell[3 * (int64_t)b];
    int32_t first = m->first[3 * (int64_t)a + m->column], second = m->first[3 * (int64_t)b + m->column];
    double rows = to[m->row] - from[m->row], slope = (to[m->column] - from[m->column]) / rows;
    double bound = 8 * (m->error[m->column] + fabs(slope) * m->error[m->row]);
    return (crossing_line){.m = m,
                           .a = a,
                           .b = b,
                           .low = first < second ? first : second,
                           .high = first < second ? second : first,
                           .row = from[m->row],
                           .column = from[m->column],
                           .slope = slope,
                           .bound = rows >= 16 * m->error[m->row] ? bound : INFINITY};
}

typedef struct line_row {
    const crossing_line *l;
    int32_t row;
} line_row;

/* w_row c_column - w_column c_row, with w from a to b and c from a to the centre: its sign. Where that is 0 the centre
 * has moved by e^(1 + axis number) along each axis, so the derivative along the axis of the lower number decides, then
 * along the other; w_row is above 0. */
static bool past_line(const void *context, int32_t column)
{
    const line_row *c = context;
    const crossing_mesh *m = c->l->m;
    const double *a = &m->position[3 * (int64_t)c->l->a], *b = &m->position[3 * (int64_t)c->l->b];
    double wr[2], wc[2], cr[GRID_PARTS], cc[GRID_PARTS], h[2 * CROSS_PARTS];
    int nwr = expansion_of_sum(b[m->row], -a[m->row], wr), nwc = expansion_of_sum(b[m->column], -a[m->column], wc);
    int ncr = grid_difference(m->g, m->row, c->row, a[m->row], cr);
    int ncc = grid_difference(m->g, m->column, column, a[m->column], cc);
    int n = cross(wr, nwr, cc, ncc, wc, nwc, cr, ncr, h);
    if (n)
        return expansion_sign(n, h) > 0;
    return m->row > m->column || b[m->column] <= a[m->column];
}

int32_t crossing_line_exact(const crossing_line *l, int32_t row)
{
    line_row c = {l, row};
    return first_near(past_line, &c, l->column + (row - l->row) * l->slope, l->bound, l->low, l->high);
}

/* ---- a plane */

/* With n the normal and s the triangle's size, each component of n is off by at most d: with edges e
 * and f from the first corner, each off by 2.5 errors, their products by less than 5.5 (s error + error
 * s). The crossing is n.w / n_ray from the corner, w the way to the column, no longer than s: what that
 * may be off by is less than half of this. */
crossing_plane crossing_plane_of(const crossing_mesh *m, const int32_t *triangle)
{
    const double *a = &m->cell[3 * (int64_t)triangle[0]], *b = &m->cell[3 * (int64_t)triangle[1]];
    const double *c = &m->cell[3 * (int64_t)triangle[2]], *error = m->error;
    crossing_plane p = {.m = m, .triangle = triangle, .row = a[m->row], .column = a[m->column], .ray = a[m->ray]};
    double e[3], f[3], size[3], n[3], d[3], off = 0;
    p.low = INT32_MAX, p.high = INT32_MIN;
    for (int i = 0; i < 3; i++) {
        int32_t first = m->first[3 * (int64_t)triangle[i] + m->ray];
        p.low = first < p.low ? first : p.low;
        p.high = first > p.high ? first : p.high;
        e[i] = b[i] - a[i], f[i] = c[i] - a[i];
        size[i] = fabs(e[i]) + fabs(f[i]) + 4 * error[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = e[j] * f[k] - e[k] * f[j];
        d[i] = 8 * (size[j] * error[k] + size[k] * error[j]);
        off += d[i] * size[i] + 8 * fabs(n[i]) * error[i];
    }
    double sure = fabs(n[m->ray]) - d[m->ray];
    p.by_row = -n[m->row] / n[m->ray];
    p.by_column = -n[m->column] / n[m->ray];
    p.bound = sure > d[m->ray] ? 2 * off / sure : INFINITY;
    return p;
}

/* The normal's component i of the exact triangle. */
static int exact_normal(const double *const *p, int i, double *h)
{
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double ej[2], ek[2], fj[2], fk[2];
    int nej = expansion_of_sum(p[1][j], -p[0][j], ej), nek = expansion_of_sum(p[1][k], -p[0][k], ek);
    int nfj = expansion_of_sum(p[2][j], -p[0][j], fj), nfk = expansion_of_sum(p[2][k], -p[0][k], fk);
    return cross(ej, nej, fk, nfk, ek, nek, fj, nfj, h);
}

/* The exact triangle and a column. */
typedef struct plane_column {
    const crossing_mesh *m;
    const double *corner[3];
    double normal[3][CROSS_PARTS];
    int count[3], moved; /* moved: the sign of the first component of the normal that is not 0 */
    int32_t row, column;
} plane_column;

/* The side of the plane that a moved centre is on, against that of what lies far along the ray: n . (centre - corner),
 * then, where that is 0, the first component of the normal that is not. */
static bool past_plane(const void *context, int32_t cell)
{
    const plane_column *c = context;
    const crossing_mesh *m = c->m;
    int32_t at[3];
    at[m->ray] = cell, at[m->row] = c->row, at[m->column] = c->column;
    double total[EXPANSION_MOST];
    int count = 0;
    for (int i = 0; i < 3; i++) {
        double w[GRID_PARTS], term[EXPANSION_MOST], sum[EXPANSION_MOST];
        int nw = grid_difference(m->g, i, at[i], c->corner[0][i], w);
        int terms = expansion_product(c->count[i], c->normal[i], nw, w, term);
        count = expansion_sum(count, total, terms, term, sum);
        for (int t = 0; t < count; t++)
            total[t] = sum[t];
    }
    int sign = expansion_sign(count, total);
    return (sign ? sign : c->moved) == expansion_sign(c->count[m->ray], c->normal[m->ray]);
}

int32_t crossing_plane_exact(const crossing_plane *p, int32_t row, int32_t column)
{
    plane_column c = {.m = p->m, .row = row, .column = column};
    for (int i = 0; i < 3; i++)
        c.corner[i] = &p->m->position[3 * (int64_t)p->triangle[i]];
    for (int i = 0; i < 3; i++) {
        c.count[i] = exact_normal(c.corner, i, c.normal[i]);
        c.moved = c.moved ? c.moved : expansion_sign(c.count[i], c.normal[i]);
    }
    double x = p->ray + ((row - p->row) * p->by_row + (column - p->column) * p->by_column);
    return first_near(past_plane, &c, x, p->bound, p->low, p->high);
}
