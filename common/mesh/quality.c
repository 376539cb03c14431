#include "mesh/quality.h"

#include <math.h>
#include <string.h>

/* The edges of a hexahedron along each axis, from and to; and those that meet at each corner. */
static const int edge_ends[3][4][2] = {
    {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {2, 6}, {3, 7}}};
static const int corner_edges[8][3] = {{0, 0, 0}, {0, 1, 1}, {1, 1, 2}, {1, 0, 3},
                                       {2, 2, 0}, {2, 3, 1}, {3, 3, 2}, {3, 2, 3}};

/* Edges of an element as the axes of its reference element run along them. */
typedef struct edges {
    double v[3][4][3];
} edges;

static inline double triple(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* Differences of what nodes have: of their places, or of their displacements. */
static void edges_of(const int32_t *node, const double *x, edges *to)
{
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 4; k++) {
            const double *from = x + 3 * (int64_t)node[edge_ends[a][k][0]];
            const double *end = x + 3 * (int64_t)node[edge_ends[a][k][1]];
            for (int i = 0; i < 3; i++)
                to->v[a][k][i] = end[i] - from[i];
        }
}

/* Of the four edges along an axis. */
static void mean_edge(const edges *x, int axis, double mean[3])
{
    for (int i = 0; i < 3; i++)
        mean[i] = ((x->v[axis][0][i] + x->v[axis][1][i]) + (x->v[axis][2][i] + x->v[axis][3][i])) / 4;
}

static double centre_of(const edges *x)
{
    double mean[3][3];
    for (int a = 0; a < 3; a++)
        mean_edge(x, a, mean[a]);
    return triple(mean[0], mean[1], mean[2]);
}

static double corner_of(const edges *x, int corner)
{
    const int *own = corner_edges[corner];
    return triple(x->v[0][own[0]], x->v[1][own[1]], x->v[2][own[2]]);
}

/* The smaller; nan where either is. */
static double lower(double a, double b)
{
    return a < b || isnan(a) ? a : b;
}

/* Every edge of the reference is a side: edges over it are the columns of F, J their triple product. */
static quality_j of_box(const int32_t *node, const double *side, const double *u)
{
    edges now;
    quality_j j;
    edges_of(node, u, &now);
    for (int a = 0; a < 3; a++) {
        const double per = 1 / side[a];
        for (int k = 0; k < 4; k++) {
            for (int i = 0; i < 3; i++)
                now.v[a][k][i] *= per;
            now.v[a][k][a] += 1;
        }
    }
    j.centre = centre_of(&now);
    j.corner = corner_of(&now, 0);
    for (int c = 1; c < 8; c++)
        j.corner = lower(j.corner, corner_of(&now, c));
    return j;
}

/* `now` over `rest`, which is above 0 in an element that has an inside. */
static double ratio(double now, double rest)
{
    return rest > 0 ? now / rest : (double)NAN;
}

static quality_j of_any(const int32_t *node, const double *rest, const double *u)
{
    edges at_rest, now;
    quality_j j;
    edges_of(node, rest, &at_rest);
    edges_of(node, u, &now);
    for (int n = 0; n < 36; n++)
        now.v[n / 12][n / 3 % 4][n % 3] += at_rest.v[n / 12][n / 3 % 4][n % 3];
    j.centre = ratio(centre_of(&now), centre_of(&at_rest));
    j.corner = ratio(corner_of(&now, 0), corner_of(&at_rest, 0));
    for (int c = 1; c < 8; c++)
        j.corner = lower(j.corner, ratio(corner_of(&now, c), corner_of(&at_rest, c)));
    return j;
}

static quality_j of_tetrahedron(const int32_t *node, const double *rest, const double *u)
{
    double at_rest[3][3], now[3][3];
    for (int n = 0; n < 9; n++) {
        const int64_t from = 3 * (int64_t)node[0] + n % 3, end = 3 * (int64_t)node[1 + n / 3] + n % 3;
        at_rest[n / 3][n % 3] = rest[end] - rest[from];
        now[n / 3][n % 3] = at_rest[n / 3][n % 3] + (u[end] - u[from]);
    }
    const double j = ratio(triple(now[0], now[1], now[2]), triple(at_rest[0], at_rest[1], at_rest[2]));
    return (quality_j){j, j};
}

/* At rest J is 1 in what has an inside, so that a displacement of nothing tells it. */
static quality_j of_rest(const quality_mesh *m, const int32_t *node)
{
    const double none[24] = {0};
    int32_t own[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    double rest[24] = {0};
    if (m->side)
        return of_box(own, m->side, none);
    for (int c = 0; c < m->corners; c++)
        memcpy(&rest[3 * c], m->rest + 3 * (int64_t)node[c], 3 * sizeof *rest);
    return m->corners == 8 ? of_any(own, rest, none) : of_tetrahedron(own, rest, none);
}

quality_j quality_of(const quality_mesh *m, int64_t element, const double *u)
{
    const int32_t *node = m->node + element * m->corners;
    if (!u)
        return of_rest(m, node);
    if (m->corners != 8)
        return of_tetrahedron(node, m->rest, u);
    return m->side ? of_box(node, m->side, u) : of_any(node, m->rest, u);
}

bool quality_is_folded(quality_j j)
{
    return !(j.centre > 0 && j.corner > 0);
}

quality quality_none(void)
{
    return (quality){.centre = NAN, .corner = NAN, .element = -1, .worst = INFINITY};
}

/* Whether a J is worse than the worst so far. */
static bool is_worse(double j, double worst)
{
    return !isnan(worst) && (isnan(j) || j < worst);
}

void quality_add(quality *to, int64_t element, quality_j j)
{
    to->centre = fmin(to->centre, j.centre);
    to->corner = fmin(to->corner, j.corner);
    to->folded += quality_is_folded(j);
    if (is_worse(j.corner, to->worst)) {
        to->worst = j.corner;
        to->element = element;
    }
}

void quality_join(quality *to, const quality *later)
{
    to->centre = fmin(to->centre, later->centre);
    to->corner = fmin(to->corner, later->corner);
    to->folded += later->folded;
    if (later->element >= 0 && is_worse(later->worst, to->worst)) {
        to->worst = later->worst;
        to->element = later->element;
    }
}

quality quality_look(const quality_mesh *m, const double *u, int64_t from, int64_t to)
{
    quality q = quality_none();
    for (int64_t i = from; i < to; i++)
        quality_add(&q, i, quality_of(m, i, u));
    return q;
}
