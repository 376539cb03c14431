#include "attach/shape/laplace.h"

#include "base/mem.h"
#include "mesh/lattice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 2048 };             /* elements or nodes: the sums depend on it */
static const double small = 1e-10; /* of the residual at the start */

struct laplace {
    pool *threads;
    const int32_t *node;
    const float *share;
    int64_t elements, nodes;
    double spacing[3];
    double stiffness[8][8]; /* of an element that conducts by 1, m */
    double volume;          /* m3 */
    int64_t *start;         /* nodes + 1: a node's first place in corner */
    int64_t *corner;        /* 8 element + corner, node after node, rising */
    double *flow;           /* elements x 8: what each corner gets */
    double *x, *r, *p, *y;  /* nodes: solution, residual, direction, K p */
    double *diagonal;       /* nodes */
    double *part;           /* chunks x 2: sums */
    const bool *held;
    double step; /* of the loop at hand */
};

/* The products of the slopes and values of the shape functions along one axis, integrated: d = 1, slopes; 0, values. */
static double along(int d, int a, int b, double h)
{
    if (d)
        return a == b ? 1 / h : -1 / h;
    return a == b ? h / 3 : h / 6;
}

static void make_stiffness(laplace *l)
{
    for (int m = 0; m < 8; m++)
        for (int n = 0; n < 8; n++) {
            l->stiffness[m][n] = 0;
            for (int axis = 0; axis < 3; axis++) {
                double product = 1;
                for (int a = 0; a < 3; a++)
                    product *= along(a == axis, lattice_vtk[m][a], lattice_vtk[n][a], l->spacing[a]);
                l->stiffness[m][n] += product;
            }
        }
    l->volume = l->spacing[0] * l->spacing[1] * l->spacing[2];
}

/* The corners that meet at each node. */
static void sort_corners(laplace *l)
{
    for (int64_t c = 0; c < 8 * l->elements; c++)
        l->start[l->node[c] + 2]++;
    for (int64_t n = 0; n < l->nodes; n++)
        l->start[n + 2] += l->start[n + 1];
    for (int64_t c = 0; c < 8 * l->elements; c++)
        l->corner[l->start[l->node[c] + 1]++] = c;
}

laplace *laplace_create(pool *threads, const double *spacing, const int32_t *node, int64_t elements, int64_t nodes,
                        const float *share, err *e)
{
    laplace *l = mem_array(1, sizeof *l, "a potential", e);
    if (!l)
        return NULL;
    *l = (laplace){.threads = threads, .node = node, .share = share, .elements = elements, .nodes = nodes};
    for (int a = 0; a < 3; a++)
        l->spacing[a] = spacing[a];
    make_stiffness(l);
    /* Counted two places up, so that filling leaves each node's first in its place. */
    l->start = mem_array(nodes + 2, sizeof *l->start, "a potential", e);
    l->corner = l->start ? mem_array(8 * elements, sizeof *l->corner, "a potential", e) : NULL;
    l->flow = l->corner ? mem_array(8 * elements, sizeof *l->flow, "a potential", e) : NULL;
    double **each[] = {&l->r, &l->p, &l->y, &l->diagonal};
    bool all = l->flow;
    for (int i = 0; i < 4 && all; i++)
        all = (*each[i] = mem_array(nodes, sizeof(double), "a potential", e)) != NULL;
    l->part = all ? mem_array(2 * pool_chunks(nodes, CHUNK), sizeof *l->part, "a potential", e) : NULL;
    if (!l->part) {
        laplace_free(l);
        return NULL;
    }
    sort_corners(l);
    return l;
}

void laplace_free(laplace *l)
{
    if (!l)
        return;
    free(l->start);
    free(l->corner);
    free(l->flow);
    free(l->r);
    free(l->p);
    free(l->y);
    free(l->diagonal);
    free(l->part);
    free(l);
}

static double share_of(const laplace *l, int64_t element)
{
    return l->share ? l->share[element] : 1;
}

/* ---- loops over elements and nodes; p: what they multiply */

static void flow_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    laplace *l = context;
    (void)chunk;
    for (int64_t e = from; e < to; e++) {
        const double share = share_of(l, e);
        double sum[8] = {0};
        for (int n = 0; n < 8; n++) { /* the matrix is symmetric: its rows are its columns */
            const double in = share * l->p[l->node[8 * e + n]];
            for (int m = 0; m < 8; m++)
                sum[m] += l->stiffness[n][m] * in;
        }
        memcpy(&l->flow[8 * e], sum, sizeof sum);
    }
}

/* y = K p at nodes that are not held, 0 at those; p.y. */
static void gather_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    laplace *l = context;
    double dot = 0;
    for (int64_t n = from; n < to; n++) {
        double sum = 0;
        for (int64_t c = l->start[n]; c < l->start[n + 1] && !l->held[n]; c++)
            sum += l->flow[l->corner[c]];
        l->y[n] = sum;
        dot += l->p[n] * sum;
    }
    l->part[2 * chunk] = dot;
}

/* x += step p, r -= step y; r.r and r.r / diagonal. */
static void advance_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    laplace *l = context;
    double square = 0, scaled = 0;
    for (int64_t n = from; n < to; n++) {
        l->x[n] += l->step * l->p[n];
        l->r[n] -= l->step * l->y[n];
        square += l->r[n] * l->r[n];
        scaled += l->r[n] * l->r[n] / l->diagonal[n];
    }
    l->part[2 * chunk] = square;
    l->part[2 * chunk + 1] = scaled;
}

/* p = r / diagonal + step p. */
static void turn_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    laplace *l = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        l->p[n] = l->r[n] / l->diagonal[n] + l->step * l->p[n];
}

static void over_nodes(laplace *l, pool_work *work)
{
    pool_run(l->threads, l->nodes, CHUNK, work, l);
}

static double sum_of(const laplace *l, int which)
{
    double sum = 0;
    for (int64_t c = 0; c < pool_chunks(l->nodes, CHUNK); c++)
        sum += l->part[2 * c + which];
    return sum;
}

static void multiply(laplace *l)
{
    pool_run(l->threads, l->elements, CHUNK, flow_some, l);
    over_nodes(l, gather_some);
}

/* The residual source - K u, and the diagonal of K. */
static void begin(laplace *l, double source)
{
    for (int64_t n = 0; n < l->nodes; n++)
        l->p[n] = l->x[n];
    multiply(l);
    for (int64_t n = 0; n < l->nodes; n++) {
        double given = 0;
        l->diagonal[n] = 0;
        for (int64_t c = l->start[n]; c < l->start[n + 1]; c++) {
            double share = share_of(l, l->corner[c] / 8);
            l->diagonal[n] += share * l->stiffness[0][0];
            given += share * source * l->volume / 8;
        }
        l->r[n] = l->held[n] ? 0 : given - l->y[n];
        l->p[n] = 0;
    }
}

int laplace_solve(laplace *l, const bool *held, double source, double *u, err *e)
{
    int64_t most = 10 * l->nodes + 1000;
    l->held = held;
    l->x = u;
    begin(l, source);
    l->step = 0;
    over_nodes(l, advance_some);
    double first = sum_of(l, 0), before = sum_of(l, 1);
    for (int64_t i = 0; first > 0; i++) {
        if (i == most)
            return err_set(e, NULL, 0, "a potential of %lld nodes did not converge", (long long)l->nodes);
        over_nodes(l, turn_some);
        multiply(l);
        l->step = before / sum_of(l, 0);
        over_nodes(l, advance_some);
        if (!(sum_of(l, 0) > small * small * first))
            break;
        double now = sum_of(l, 1);
        l->step = now / before;
        before = now;
    }
    return 0;
}

void laplace_gradient(const laplace *l, int64_t element, const double *u, double *gradient)
{
    for (int a = 0; a < 3; a++) {
        gradient[a] = 0;
        for (int n = 0; n < 8; n++)
            gradient[a] += (lattice_vtk[n][a] - 0.5) * u[l->node[8 * element + n]] / (2 * l->spacing[a]);
    }
}
