#include "voxelise/crossing.h"

#include "voxelise/expansion.h"

#include <float.h>
#include <math.h>

enum { CROSS_PARTS = 4 * GRID_PARTS }; /* components of a product of an edge (2) and a difference (5), and of its sum */

double crossing_error(const grid *g, int axis, double local, double far)
{
    double first = fabs(grid_centre(g, axis, g->low[axis])), last = fabs(grid_centre(g, axis, g->high[axis]));
    double most = fmax(fmax(first, last), fmax(local, far));
    return 2 * DBL_EPSILON * most; /* 4 units of rounding: two sums in local, one product in a centre */
}

crossing_ray crossing_ray_at(const crossing_mesh *m, int axis, int64_t iu, int64_t iv)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return (crossing_ray){m, axis, u, v, iu, iv, grid_centre(m->g, u, iu), grid_centre(m->g, v, iv)};
}

static int sign_of(double x)
{
    return (x > 0) - (x < 0);
}

/* h = p q - r s of expansions of at most 2 (p, r) and GRID_PARTS (q, s) components. */
static int cross(const double *p, int np, const double *q, int nq, const double *r, int nr, const double *s, int ns,
                 double *h)
{
    double pq[CROSS_PARTS], rs[CROSS_PARTS];
    int npq = expansion_product(np, p, nq, q, pq), nrs = expansion_product(nr, r, ns, s, rs);
    expansion_negate(nrs, rs);
    return expansion_sum(npq, pq, nrs, rs, h);
}

/* e_u w_v - e_v w_u with the edge e from a to b and w from a to the ray: its exact sign. */
static int exact_turn(const crossing_ray *r, const double *a, const double *b)
{
    double eu[2], ev[2], wu[GRID_PARTS], wv[GRID_PARTS], h[2 * CROSS_PARTS];
    int neu = expansion_of_sum(b[r->u], -a[r->u], eu), nev = expansion_of_sum(b[r->v], -a[r->v], ev);
    int nwu = grid_difference(r->m->g, r->u, r->iu, a[r->u], wu);
    int nwv = grid_difference(r->m->g, r->v, r->iv, a[r->v], wv);
    int n = cross(eu, neu, wv, nwv, ev, nev, wu, nwu, h);
    return expansion_sign(n, h);
}

/* The same where that is 0: the ray moves by e^(1 + axis number) along each of its two axes, so its derivative
 * along the axis of the lower number decides, then along the other. */
static int moved_turn(const crossing_ray *r, const double *a, const double *b)
{
    int along_u = -sign_of(b[r->v] - a[r->v]), along_v = sign_of(b[r->u] - a[r->u]);
    if (r->u < r->v)
        return along_u ? along_u : along_v;
    return along_v ? along_v : along_u;
}

/* On which side of the edge from vertex a to b the ray runs: 1 left, -1 right, 0 only where a and b are one point in
 * the plane across the ray. The bound: with s the sizes of edge and difference, each product errs by at most
 * 4 (s_u error_v + s_v error_u), for an error is at least two roundings of either; twice that is taken. */
static int turn(const crossing_ray *r, int32_t a, int32_t b)
{
    const crossing_mesh *m = r->m;
    const double *la = &m->local[3 * (int64_t)a], *lb = &m->local[3 * (int64_t)b];
    double eu = lb[r->u] - la[r->u], ev = lb[r->v] - la[r->v];
    double wu = r->cu - la[r->u], wv = r->cv - la[r->v];
    double du = m->error[r->u], dv = m->error[r->v];
    double size_u = fabs(eu) + fabs(wu) + 4 * du, size_v = fabs(ev) + fabs(wv) + 4 * dv;
    double value = eu * wv - ev * wu;
    if (fabs(value) > 8 * (size_u * dv + size_v * du))
        return sign_of(value);
    const double *pa = &m->position[3 * (int64_t)a], *pb = &m->position[3 * (int64_t)b];
    int sign = exact_turn(r, pa, pb);
    return sign ? sign : moved_turn(r, pa, pb);
}

int crossing_of(const crossing_ray *r, const int32_t *triangle)
{
    int first = turn(r, triangle[0], triangle[1]);
    if (!first || turn(r, triangle[1], triangle[2]) != first || turn(r, triangle[2], triangle[0]) != first)
        return 0;
    return first;
}

/* A triangle's plane in doubles, from its first corner. */
typedef struct plane {
    const double *corner;       /* of `local` */
    double normal[3], error[3]; /* and a bound on the normal's error */
    double low, high;           /* the triangle's extent along the ray */
} plane;

static plane plane_of(const crossing_ray *r, const int32_t *triangle)
{
    const double *d = r->m->error, *a = &r->m->local[3 * (int64_t)triangle[0]];
    const double *b = &r->m->local[3 * (int64_t)triangle[1]], *c = &r->m->local[3 * (int64_t)triangle[2]];
    plane p = {.corner = a};
    double e[3], f[3], size[3];
    for (int i = 0; i < 3; i++) {
        e[i] = b[i] - a[i], f[i] = c[i] - a[i];
        size[i] = fabs(e[i]) + fabs(f[i]) + 4 * d[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        p.normal[i] = e[j] * f[k] - e[k] * f[j];
        p.error[i] = 8 * (size[j] * d[k] + size[k] * d[j]);
    }
    p.low = fmin(a[r->axis], fmin(b[r->axis], c[r->axis]));
    p.high = fmax(a[r->axis], fmax(b[r->axis], c[r->axis]));
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

/* The side of the plane on which a moved centre lies, exactly: normal . (centre - corner), then, where that is 0, the
 * first component of the normal that is not. */
static int exact_side(const crossing_ray *r, const int32_t *triangle, const int64_t *cell)
{
    const double *p[3];
    for (int i = 0; i < 3; i++)
        p[i] = &r->m->position[3 * (int64_t)triangle[i]];
    double total[EXPANSION_MOST];
    int count = 0, moved = 0;
    for (int i = 0; i < 3; i++) {
        double normal[CROSS_PARTS], w[GRID_PARTS], term[EXPANSION_MOST], sum[EXPANSION_MOST];
        int n = exact_normal(p, i, normal), nw = grid_difference(r->m->g, i, cell[i], p[0][i], w);
        int terms = expansion_product(n, normal, nw, w, term);
        count = expansion_sum(count, total, terms, term, sum);
        for (int t = 0; t < count; t++)
            total[t] = sum[t];
        if (!moved)
            moved = expansion_sign(n, normal);
    }
    int sign = expansion_sign(count, total);
    return sign ? sign : moved;
}

/* Whether the centre of cell i along the ray is behind the crossing: on the side that the normal shows, for a ray that
 * runs with the normal. */
static bool behind(const crossing_ray *r, const plane *p, const int32_t *triangle, int direction, int64_t i)
{
    const double *d = r->m->error;
    double w[3], value = 0, bound = 0;
    w[r->axis] = grid_centre(r->m->g, r->axis, i) - p->corner[r->axis];
    w[r->u] = r->cu - p->corner[r->u];
    w[r->v] = r->cv - p->corner[r->v];
    for (int a = 0; a < 3; a++) {
        value += p->normal[a] * w[a];
        bound += p->error[a] * (fabs(w[a]) + 4 * d[a]) + 4 * fabs(p->normal[a]) * d[a];
    }
    if (fabs(value) > 2 * bound)
        return sign_of(value) == direction;
    int64_t cell[3];
    cell[r->axis] = i, cell[r->u] = r->iu, cell[r->v] = r->iv;
    return exact_side(r, triangle, cell) == direction;
}

/* The cell to try first: where the plane in doubles meets the ray, within the triangle's extent and the grid. */
static int64_t guess(const crossing_ray *r, const plane *p)
{
    const grid *g = r->m->g;
    double over = p->normal[r->u] * (r->cu - p->corner[r->u]) + p->normal[r->v] * (r->cv - p->corner[r->v]);
    double x = p->corner[r->axis] - over / p->normal[r->axis];
    x = x >= p->low ? fmin(x, p->high) : p->low; /* a nan becomes low */
    double cell = ceil(x / g->spacing[r->axis] - 0.5);
    if (!(cell > (double)g->low[r->axis]))
        return g->low[r->axis];
    return cell < (double)g->high[r->axis] ? (int64_t)cell : g->high[r->axis] - 1;
}

int64_t crossing_cell(const crossing_ray *r, const int32_t *triangle, int direction)
{
    plane p = plane_of(r, triangle);
    int64_t before = r->m->g->low[r->axis] - 1, after = r->m->g->high[r->axis]; /* the answer: before < i <= after */
    if (after - before < 2)
        return after;
    int64_t at = guess(r, &p);
    /* Steps that double, away from the guess, until the answer is between two cells tried; then halves. */
    for (int64_t step = 1; after - before > 1; step *= 2) {
        bool is_behind = behind(r, &p, triangle, direction, at);
        int64_t next = is_behind ? at - step : at + step;
        if (is_behind)
            after = at;
        else
            before = at;
        at = next > before && next < after ? next : before + (after - before) / 2;
    }
    return after;
}
