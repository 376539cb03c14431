#include "msds/problem/stiffness.h"

#include "base/mem.h"
#include "msds/problem/springs.h"

#include <stdlib.h>
#include <string.h>

enum { ELEMENT_CHUNK = 256, NODE_CHUNK = 512 };

static void link_edges(stiffness *k)
{
    static const int corner[6][2] = SIMPLEX_EDGES;
    const msds_problem *p = k->p;
    for (int64_t t = 0; t < p->elements; t++)
        for (int i = 0; i < 6; i++)
            k->element_spring[6 * t + i] =
                springs_find(p, p->element_node[4 * t + corner[i][0]], p->element_node[4 * t + corner[i][1]]);
}

static void link_corners(stiffness *k)
{
    const msds_problem *p = k->p;
    for (int64_t c = 0; c < 4 * p->elements; c++)
        k->start[p->element_node[c] + 2]++;
    for (int64_t n = 2; n <= p->nodes + 1; n++)
        k->start[n] += k->start[n - 1];
    for (int64_t c = 0; c < 4 * p->elements; c++)
        k->corner[k->start[p->element_node[c] + 1]++] = (int32_t)c;
}

/* The element with its gradients turned: its blocks are then R K R^T. */
static simplex turned(const stiffness *k, int64_t t)
{
    simplex s = k->p->element[t];
    double r[3][3];
    if (!k->turn)
        return s;
    simplex_matrix(k->turn + 4 * t, r);
    for (int c = 0; c < 4; c++)
        for (int a = 0; a < 3; a++) {
            const double *g = k->p->element[t].gradient[c];
            s.gradient[c][a] = r[a][0] * g[0] + r[a][1] * g[1] + r[a][2] * g[2];
        }
    return s;
}

static void add_block(double *to, const double *b)
{
    for (int i = 0; i < 9; i++)
        to[i] += b[i];
}

static void fill(stiffness *k)
{
    static const int corner[6][2] = SIMPLEX_EDGES;
    const msds_problem *p = k->p;
    double b[9];
    memset(k->diagonal, 0, 9 * (size_t)p->nodes * sizeof *k->diagonal);
    memset(k->block, 0, 9 * (size_t)p->springs * sizeof *k->block);
    for (int64_t t = 0; t < p->elements; t++) {
        const simplex s = turned(k, t);
        const int32_t *n = p->element_node + 4 * t;
        for (int c = 0; c < 4; c++) {
            simplex_block(&s, c, c, b);
            add_block(k->diagonal + 9 * (int64_t)n[c], b);
        }
        for (int i = 0; i < 6; i++) {
            int first = corner[i][0], second = corner[i][1];
            if (n[first] < n[second])
                simplex_block(&s, first, second, b);
            else
                simplex_block(&s, second, first, b);
            add_block(k->block + 9 * (int64_t)k->element_spring[6 * t + i], b);
        }
    }
}

static void derivative_of(const stiffness *k, const double *of, int64_t t, double g[3][3])
{
    double u[4][3];
    for (int c = 0; c < 4; c++)
        memcpy(u[c], of + 3 * (int64_t)k->p->element_node[4 * t + c], sizeof u[c]);
    simplex_derivative(&k->p->element[t], u, g);
}

static void turn_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    stiffness *k = context;
    double g[3][3], r[3][3];
    (void)chunk;
    for (int64_t t = from; t < to; t++) {
        derivative_of(k, k->u, t, g);
        simplex_rotation(g, k->turning + 4 * t, r);
    }
}

static void turn_to(stiffness *k, const double *u, double *turn)
{
    k->u = u;
    k->turning = turn;
    pool_run(k->threads, k->p->elements, ELEMENT_CHUNK, turn_work, k);
}

void stiffness_turns(stiffness *k, const double *u, double *turn)
{
    memcpy(turn, k->turn, 4 * (size_t)k->p->elements * sizeof *turn);
    turn_to(k, u, turn);
}

void stiffness_warp(stiffness *k, const double *u, bool again)
{
    if (!k->turn)
        return;
    turn_to(k, u, k->turn);
    if (again)
        fill(k);
}

static void force_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    stiffness *k = context;
    double g[3][3], r[3][3], f[4][3];
    (void)chunk;
    for (int64_t t = from; t < to; t++) {
        derivative_of(k, k->u, t, g);
        if (k->turn) {
            simplex_matrix(k->turn + 4 * t, r);
            simplex_warped(&k->p->element[t], g, r, f);
        } else {
            simplex_force(&k->p->element[t], g, f);
        }
        memcpy(k->force + 12 * t, f, sizeof f);
    }
}

static void gather_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    stiffness *k = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++) {
        double sum[3] = {0};
        for (int64_t i = k->start[n]; i < k->start[n + 1]; i++)
            for (int a = 0; a < 3; a++)
                sum[a] += k->force[3 * (int64_t)k->corner[i] + a];
        memcpy(k->sum + 3 * n, sum, sizeof sum);
    }
}

void stiffness_force(stiffness *k, const double *u, double *force)
{
    k->u = u;
    k->sum = force;
    pool_run(k->threads, k->p->elements, ELEMENT_CHUNK, force_work, k);
    pool_run(k->threads, k->p->nodes, NODE_CHUNK, gather_work, k);
}

static void along_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    stiffness *k = context;
    double g[3][3], d[3][3], r[3][3], f[4][3];
    (void)chunk;
    for (int64_t t = from; t < to; t++) {
        derivative_of(k, k->u, t, g);
        derivative_of(k, k->way, t, d);
        simplex_matrix(k->turned + 4 * t, r);
        simplex_warped_along(&k->p->element[t], g, r, d, f);
        memcpy(k->force + 12 * t, f, sizeof f);
    }
}

void stiffness_along(stiffness *k, const double *u, const double *turn, const double *way, double *force)
{
    k->u = u;
    k->turned = turn;
    k->way = way;
    k->sum = force;
    pool_run(k->threads, k->p->elements, ELEMENT_CHUNK, along_work, k);
    pool_run(k->threads, k->p->nodes, NODE_CHUNK, gather_work, k);
}

int stiffness_make(stiffness *k, const msds_problem *p, bool warped, pool *threads, err *e)
{
    k->p = p;
    k->threads = threads;
    k->diagonal = mem_array(p->nodes, 9 * sizeof *k->diagonal, "the stiffness", e);
    k->block = mem_array(p->springs, 9 * sizeof *k->block, "the stiffness", e);
    k->element_spring = mem_array(p->elements, 6 * sizeof *k->element_spring, "the stiffness", e);
    k->start = mem_array(p->nodes + 2, sizeof *k->start, "the stiffness", e);
    k->corner = mem_array(p->elements, 4 * sizeof *k->corner, "the stiffness", e);
    k->force = mem_array(p->elements, 12 * sizeof *k->force, "the stiffness", e);
    if (warped)
        k->turn = mem_array(p->elements, 4 * sizeof *k->turn, "the stiffness", e);
    if (!k->diagonal || !k->block || !k->element_spring || !k->start || !k->corner || !k->force || (warped && !k->turn))
        return -1;
    for (int64_t t = 0; t < p->elements && k->turn; t++)
        k->turn[4 * t + 3] = 1;
    link_edges(k);
    link_corners(k);
    fill(k);
    return 0;
}

void stiffness_free(stiffness *k)
{
    free(k->diagonal);
    free(k->block);
    free(k->element_spring);
    free(k->start);
    free(k->corner);
    free(k->force);
    free(k->turn);
    *k = (stiffness){0};
}
