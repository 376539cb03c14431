#include "msds/cpu/mprgp.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* A projected step is taken whole where the best share of it is at least this: then the function falls. */
static const double whole = 2. / 3;

int mprgp_make(mprgp *m, int64_t most, err *e)
{
    double **fields[] = {&m->x, &m->g, &m->inverse, &m->way, &m->product, &m->move};
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        *fields[i] = mem_array(most, sizeof **fields[i], "contact", e);
        if (!*fields[i])
            return -1;
    }
    return 0;
}

void mprgp_free(mprgp *m)
{
    free(m->x);
    free(m->g);
    free(m->inverse);
    free(m->way);
    free(m->product);
    free(m->move);
    *m = (mprgp){0};
}

static double dot(const double *a, const double *b, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

double mprgp_off(const mprgp *m)
{
    double most = 0;
    for (int64_t i = 0; i < m->count; i++)
        most = fmax(most, m->x[i] > 0 ? fabs(m->g[i]) : -m->g[i]);
    return most;
}

/* The squares of what is left, over S's diagonal: of components above 0 (free), and of those at 0 that would rise
 * (off). */
static void measure(const mprgp *m, double *free_, double *off)
{
    *free_ = *off = 0;
    for (int64_t i = 0; i < m->count; i++) {
        const double square = m->g[i] * m->g[i] * m->inverse[i];
        if (m->x[i] > 0)
            *free_ += square;
        else if (m->g[i] < 0)
            *off += square;
    }
}

/* way = what is left of the free components over S's diagonal, plus beta way; 0 of the others. */
static void turn(mprgp *m, double beta)
{
    for (int64_t i = 0; i < m->count; i++)
        m->way[i] = m->x[i] > 0 ? m->inverse[i] * m->g[i] + beta * m->way[i] : 0;
}

/* x -= alpha way, whose product with S is known. */
static void advance(mprgp *m, double alpha)
{
    for (int64_t i = 0; i < m->count; i++) {
        m->x[i] = fmax(0, m->x[i] - alpha * m->way[i]);
        m->g[i] -= alpha * m->product[i];
    }
}

/* How far x may go along -way until a component comes to 0; which: that component. */
static double feasible(const mprgp *m, int64_t *which)
{
    double most = INFINITY;
    *which = -1;
    for (int64_t i = 0; i < m->count; i++)
        if (m->way[i] > 0 && m->x[i] < most * m->way[i]) {
            most = m->x[i] / m->way[i];
            *which = i;
        }
    return most;
}

/* product = S way. Returns way.S way, which rounding alone may leave at 0 or below. */
static double curve(mprgp *m)
{
    m->multiply(m->context, m->way, m->product);
    return dot(m->way, m->product, m->count);
}

/* Lets components go that are held and would rise. Returns how many products that took, or 0 where S is no longer
 * positive, as in step. */
static int64_t let_go(mprgp *m)
{
    for (int64_t i = 0; i < m->count; i++)
        m->way[i] = m->x[i] > 0 || m->g[i] >= 0 ? 0 : m->inverse[i] * m->g[i];
    const double curvature = curve(m);
    if (!(curvature > 0))
        return 0;
    advance(m, dot(m->g, m->way, m->count) / curvature);
    turn(m, 0);
    return 1;
}

/* x goes by alpha along -way, and what would go below 0 stays there; or, where the function would rise, only until
 * the first component comes to 0. Returns how many products that took. */
static int64_t project(mprgp *m, double alpha, double may, int64_t first)
{
    for (int64_t i = 0; i < m->count; i++)
        m->move[i] = m->x[i] - fmax(0, m->x[i] - alpha * m->way[i]);
    const double slope = dot(m->g, m->move, m->count);
    if (!(slope > 0)) {
        advance(m, may);
        m->x[first] = 0;
        turn(m, 0);
        return 0;
    }
    double *spare = m->way;
    m->way = m->move;
    m->move = spare;
    const double curvature = curve(m);
    advance(m, slope < whole * curvature ? slope / curvature : 1);
    turn(m, 0);
    return 1;
}

/* A step of conjugate gradients over the free components. */
static int64_t step(mprgp *m)
{
    int64_t first;
    const double curvature = curve(m);
    if (!(curvature > 0))
        return 0;
    const double alpha = dot(m->g, m->way, m->count) / curvature, may = feasible(m, &first);
    if (alpha >= may)
        return 1 + project(m, alpha, may, first);
    advance(m, alpha);
    double conjugate = 0;
    for (int64_t i = 0; i < m->count; i++)
        conjugate += m->x[i] > 0 ? m->inverse[i] * m->g[i] * m->product[i] : 0;
    turn(m, -conjugate / curvature);
    return 1;
}

void mprgp_scale(mprgp *m)
{
    if (!(dot(m->x, m->x, m->count) > 0))
        return;
    m->tell(m->context, 0);
    m->multiply(m->context, m->x, m->product);
    const double by = fmax(-1, -dot(m->g, m->x, m->count) / dot(m->x, m->product, m->count));
    for (int64_t i = 0; i < m->count; i++) {
        m->x[i] += by * m->x[i];
        m->g[i] += by * m->product[i];
    }
}

int64_t mprgp_solve(mprgp *m, double least, int64_t most)
{
    const double start = mprgp_off(m);
    double left = start, free_, off;
    int64_t count = 0, took = 1;
    turn(m, 0);
    while (left > least && count < most && took > 0) {
        m->tell(m->context, fmax(0, log(start / left) / log(start / least)));
        measure(m, &free_, &off);
        took = off > free_ ? let_go(m) : step(m);
        count += took;
        left = mprgp_off(m);
    }
    return count;
}
