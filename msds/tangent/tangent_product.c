#include "msds/tangent/tangent_product.h"

#include "base/mem.h"
#include "msds/cpu/sums.h"
#include "msds/cpu/tissue_work.h"

#include <stdlib.h>
#include <string.h>

int tangent_product_make(tangent_product *k, const sell *s, err *e)
{
    k->inverse = mem_array(s->nodes, sizeof *k->inverse, "the contact stiffness", e);
    k->sum = mem_array(pool_chunks(s->count, SELL_CHUNK), sizeof *k->sum, "the contact stiffness", e);
    return k->inverse && k->sum ? 0 : -1;
}

void tangent_product_free(tangent_product *k)
{
    free(k->matrix.diagonal);
    free(k->matrix.block);
    free(k->u);
    free(k->way);
    free(k->force);
    free(k->turn);
    free(k->inverse);
    free(k->sum);
    *k = (tangent_product){0};
}

/* ---- springs */

/* What a spring's pull changes by with the difference of its ends: k d d^T / x^2 + k (1 - x0/x) (I - d d^T / x^2). */
static void spring_block(const tangent_product *k, const msds_spring *s, double b[9])
{
    const double *p = k->of.p->position + 3 * (int64_t)s->node[0], *q = k->of.p->position + 3 * (int64_t)s->node[1];
    const int32_t *own = k->of.order->own_node;
    double d[3], square = 0;
    for (int a = 0; a < 3; a++) {
        const float *u = k->of.springs->u.x[a];
        d[a] = q[a] - p[a] + ((double)u[own[s->node[1]]] - (double)u[own[s->node[0]]]);
        square += d[a] * d[a];
    }
    memset(b, 0, 9 * sizeof *b);
    if (!(square > 0))
        return;
    const double pulled = s->stiffness * (1 - s->rest / sqrt(square)), across = k->careful ? fmax(0, pulled) : pulled;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            b[3 * i + j] = (s->stiffness - across) * d[i] * d[j] / square + (i == j ? across : 0);
}

static void springs_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tangent_product *k = context;
    const sell *s = k->of.order;
    double b[9], sum[9];
    (void)chunk;
    for (int64_t own = from * LANES; own < to * LANES; own++) {
        const int64_t slice = own / LANES, lane = own % LANES, node = s->model_node[own];
        memset(sum, 0, sizeof sum);
        for (int64_t slot = s->start[slice]; slot < s->start[slice + 1]; slot++) {
            const int32_t spring = s->spring[slot * LANES + lane];
            const bool is = spring >= 0 && node >= 0 && !k->of.p->fixed[node];
            memset(b, 0, sizeof b);
            if (is)
                spring_block(k, &k->of.p->spring[spring], b);
            for (int i = 0; i < 9; i++) {
                sum[i] += b[i];
                k->matrix.block[(9 * slot + i) * LANES + lane] = (float)-b[i];
            }
        }
        for (int i = 0; i < 9; i++)
            k->matrix.diagonal[(9 * slice + i) * LANES + lane] = (float)sum[i];
    }
}

static int begin_springs(tangent_product *k, err *e)
{
    const sell *s = k->of.order;
    lanes_matrix *m = &k->matrix;
    m->s = s;
    if (!m->diagonal)
        m->diagonal = mem_array(s->count, 9 * LANES * sizeof *m->diagonal, "the contact stiffness", e);
    if (m->diagonal && !m->block)
        m->block = mem_array(s->slots, 9 * LANES * sizeof *m->block, "the contact stiffness", e);
    if (!m->diagonal || !m->block)
        return -1;
    pool_run(k->of.threads, s->count, SELL_CHUNK, springs_work, k);
    k->has = m;
    return 0;
}

/* ---- elements that turn */

static void collect(const tangent_product *k, const lanes_field *from, double *to)
{
    for (int64_t n = 0; n < k->of.p->nodes; n++)
        for (int a = 0; a < 3; a++)
            to[3 * n + a] = (double)from->x[a][k->of.order->own_node[n]];
}

static int begin_warped(tangent_product *k, err *e)
{
    const msds_problem *p = k->of.p;
    if (!k->turn) {
        k->u = mem_array(p->nodes, 3 * sizeof *k->u, "the contact stiffness", e);
        k->way = k->u ? mem_array(p->nodes, 3 * sizeof *k->way, "the contact stiffness", e) : NULL;
        k->force = k->way ? mem_array(p->nodes, 3 * sizeof *k->force, "the contact stiffness", e) : NULL;
        k->turn = k->force ? mem_array(p->elements, 4 * sizeof *k->turn, "the contact stiffness", e) : NULL;
    }
    if (!k->turn)
        return -1;
    if (k->of.place)
        memcpy(k->u, k->of.place, 3 * (size_t)p->nodes * sizeof *k->u);
    else
        collect(k, &k->of.springs->u, k->u);
    stiffness_turns(k->of.cg->k, k->u, k->turn);
    return 0;
}

static double multiply_warped(tangent_product *k, const lanes_field *p, lanes_field *y)
{
    double sum = 0;
    collect(k, p, k->way);
    stiffness_along(k->of.cg->k, k->u, k->turn, k->way, k->force);
    for (int64_t n = 0; n < k->of.p->nodes; n++)
        for (int a = 0; a < 3; a++) {
            const double force = k->of.p->fixed[n] ? 0 : k->force[3 * n + a];
            y->x[a][k->of.order->own_node[n]] = (float)force;
            sum += k->way[3 * n + a] * force;
        }
    return sum;
}

/* ---- all */

/* Of the matrix, or, where warped elements have turned, of the one at rest. */
static void invert(tangent_product *k, const lanes_matrix *m)
{
    for (int64_t own = 0; own < k->of.order->nodes; own++) {
        const float *block = m->diagonal + own / LANES * 9 * LANES + own % LANES;
        const float trace = block[0] + block[4 * LANES] + block[8 * LANES];
        k->inverse[own] = trace > 0 ? 3 / trace : 0;
    }
}

int tangent_product_begin(tangent_product *k, const msds_parts *of, bool careful, err *e)
{
    k->careful = careful;
    k->of = *of;
    k->has = NULL;
    if (of->tissue) {
        tissue_pull(of->tissue, &of->tissue->pulled); /* with that, the derivatives here */
        memcpy(k->inverse, of->tissue->m.inverse, (size_t)of->order->nodes * sizeof *k->inverse);
        return 0;
    }
    if (of->method == MSDS_SPRINGS && begin_springs(k, e))
        return -1;
    if (of->cg && of->cg->k->turn && !careful && begin_warped(k, e))
        return -1;
    if (of->cg && (!of->cg->k->turn || careful))
        k->has = &of->cg->matrix;
    invert(k, k->has ? k->has : &of->cg->matrix);
    return 0;
}

static void multiply_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tangent_product *k = context;
    k->sum[chunk] = k->of.loops->multiply(k->has, k->from, k->to, from, to);
}

double tangent_product_of(tangent_product *k, const lanes_field *p, lanes_field *y)
{
    if (k->of.tissue)
        return tissue_tangent(k->of.tissue, p, y);
    if (!k->has)
        return multiply_warped(k, p, y);
    k->from = p;
    k->to = y;
    pool_run(k->of.threads, k->of.order->count, SELL_CHUNK, multiply_work, k);
    return sums_of(k->sum, pool_chunks(k->of.order->count, SELL_CHUNK));
}
