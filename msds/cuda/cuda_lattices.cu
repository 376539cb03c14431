/* The coarser lattices on the card, as smoothing wants them. The matrices there are in half precision: they only lead
 * the search (cuda_exact.cu), and half the bytes are half the time.
 */
#include "solve/card_layout.cuh"

#include "msds/cuda/cuda_exact.cuh"

extern "C" {
#include "base/mem.h"
}

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of a matrix in half precision, whose own largest is 65504 and whose digits go from 6e-5 up. */
static const float half_most = 1024;

/* The steps of Chebyshev's polynomial on eigenvalues from smooth_share of the largest up to it. */
static void choose_steps(tissue_level *v, double largest)
{
    const double middle = .5 * (1 + smooth_share) * largest, half = .5 * (1 - smooth_share) * largest;
    double share = half / middle;
    v->keep[0] = 0;
    v->take[0] = (float)(1 / middle);
    for (int i = 1; i < SMOOTH; i++) {
        const double next = 1 / (2 * middle / half - share);
        v->keep[i] = (float)(next * share);
        v->take[i] = (float)(2 * next / half);
        share = next;
    }
}

static void list_weights(card_layout *a, tissue_weights *to, const levels_weights *from)
{
    card_layout_copy(a, &to->start, from->start, from->count + 1);
    card_layout_copy(a, &to->column, from->column, from->slots * LANES);
    card_layout_copy(a, &to->weight, from->weight, from->slots * LANES);
}

/* A level's matrix as smoothing wants it: blocks in half precision, times `scale`; and what a row's blocks sum up to,
 * which is nothing on the mesh. */
typedef struct host_level {
    uint4 *eight;
    __half *ninth;
    float *sums;
    int32_t *start;
    float scale;
} host_level;

static void host_level_free(host_level *h)
{
    free(h->eight);
    free(h->ninth);
    free(h->sums);
    free(h->start);
}

static void fill_halves(const level *from, host_level *h)
{
    const sell *g = &from->graph;
    float most = 0;
    for (int64_t i = 0; i < g->count * 9 * LANES; i++)
        most = fmaxf(most, fabsf(from->matrix.diagonal[i]));
    h->scale = most > 0 ? half_most / most : 1;
    for (int64_t at = 0; at < g->slots * LANES; at++) {
        __half nine[9];
        for (int i = 0; i < 9; i++)
            nine[i] = __float2half(h->scale * from->matrix.block[(at / LANES * 9 + i) * LANES + at % LANES]);
        memcpy(&h->eight[at], nine, sizeof h->eight[at]);
        h->ninth[at] = nine[8];
    }
}

static void fill_sums(const level *from, host_level *h)
{
    const sell *g = &from->graph;
    for (int64_t slice = 0; slice < g->count; slice++)
        for (int64_t i = 0; i < 9 * LANES; i++) {
            double sum = (double)from->matrix.diagonal[slice * 9 * LANES + i];
            for (int64_t slot = g->start[slice]; slot < g->start[slice + 1]; slot++)
                sum += (double)from->matrix.block[slot * 9 * LANES + i];
            h->sums[slice * 9 * LANES + i] = (float)sum;
        }
}

static int host_level_make(const level *from, bool mesh, host_level *h, err *e)
{
    const sell *g = &from->graph;
    h->eight = (uint4 *)mem_array(g->slots * LANES, sizeof *h->eight, "the solver", e);
    h->ninth = (__half *)mem_array(g->slots * LANES, sizeof *h->ninth, "the solver", e);
    h->start = (int32_t *)mem_array(g->count + 1, sizeof *h->start, "the solver", e);
    h->sums = mesh ? NULL : (float *)mem_array(g->count, 9 * LANES * sizeof *h->sums, "the solver", e);
    if (!h->eight || !h->ninth || !h->start || (!mesh && !h->sums))
        return -1;
    for (int64_t i = 0; i <= g->count; i++)
        h->start[i] = (int32_t)g->start[i];
    fill_halves(from, h);
    if (!mesh)
        fill_sums(from, h);
    return 0;
}

/* What the mesh has already stays where it is. */
static void list_graph(card_layout *a, const tissue *t, tissue_level *v, const level *from, const host_level *h)
{
    const sell *g = &from->graph;
    if (!h->sums) {
        v->start = t->start, v->neighbour = t->neighbour, v->left = t->left, v->rest = t->pulled;
        return;
    }
    card_layout_add(a, &v->left, g->nodes);
    card_layout_add(a, &v->rest, g->nodes);
    card_layout_copy(a, &v->start, h->start, g->count + 1);
    card_layout_copy(a, &v->neighbour, g->neighbour, g->slots * LANES);
    card_layout_copy(a, &v->sums, h->sums, g->count * 9 * LANES);
}

static void list_level(card_layout *a, const tissue *t, tissue_level *v, const level *from, const host_level *h)
{
    const sell *g = &from->graph;
    v->nodes = (int32_t)g->nodes;
    v->chunks = (int32_t)pool_chunks(g->count, SELL_CHUNK);
    v->back = 1 / h->scale;
    choose_steps(v, from->largest);
    card_layout_add(a, &v->z[0], g->nodes);
    card_layout_add(a, &v->z[1], g->nodes);
    card_layout_add(a, &v->step, g->nodes);
    list_graph(a, t, v, from, h);
    card_layout_copy(a, &v->eight, h->eight, g->slots * LANES);
    card_layout_copy(a, &v->ninth, h->ninth, g->slots * LANES);
    card_layout_copy(a, &v->inverse, from->inverse, g->count * 9 * LANES);
    if (from->up.start) {
        list_weights(a, &v->up, &from->up);
        list_weights(a, &v->down, &from->down);
    }
}

static void list_exact(card_layout *a, const tissue *t, tissue_exact *x, const levels *l, const host_level *h)
{
    for (int i = 0; i < l->count; i++)
        list_level(a, t, &x->at[i], &l->at[i], &h[i]);
    x->count = l->count;
    x->order = (int32_t)l->order;
    card_layout_add(a, &x->gone, t->nodes);
    card_layout_add(a, &x->active, t->nodes);
    card_layout_copy(a, &x->coarsest, l->coarsest, l->order * l->order);
}

typedef struct host_exact {
    levels l;
    host_level at[LEVELS_MOST];
} host_exact;

static int host_exact_make(host_exact *h, const msds_problem *p, const sell *s, const lanes_matrix *m, pool *threads,
                           err *e)
{
    if (levels_make(&h->l, p, s, m, threads, e))
        return -1;
    for (int i = 0; i < h->l.count; i++)
        if (host_level_make(&h->l.at[i], i == 0, &h->at[i], e))
            return -1;
    return 0;
}

int tissue_exact_make(tissue_exact *x, const tissue *t, const msds_problem *p, const sell *s, const lanes_matrix *m,
                      pool *threads, char **memory, int64_t *bytes, err *e)
{
    host_exact *h = (host_exact *)mem_array(1, sizeof *h, "the solver", e);
    int result = -1;
    if (!h)
        return -1;
    if (!host_exact_make(h, p, s, m, threads, e)) {
        card_layout layout = {0};
        list_exact(&layout, t, x, &h->l, h->at);
        *bytes = layout.bytes;
        if (!card_layout_place(&layout, true, "coarser lattices", memory, e))
            result = card_check(cudaDeviceSynchronize(), "cudaDeviceSynchronize()", -1, e);
    }
    for (int i = 0; i < h->l.count; i++)
        host_level_free(&h->at[i]);
    levels_free(&h->l);
    free(h);
    return result;
}
