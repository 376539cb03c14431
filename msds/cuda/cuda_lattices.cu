/* The coarser lattices on the card, as smoothing wants them. The matrices there are in half precision: they only lead
 * the search (cuda_exact.cu), and half the bytes are half the time.
 */
#include "msds/cuda/cuda_exact.cuh"
#include "msds/cuda/cuda_room.cuh"

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

static int put_weights(char *memory, int64_t *used, tissue_weights *to, const levels_weights *from, err *e)
{
    return put(memory, used, &to->start, from->start, from->count + 1, e) ||
                   put(memory, used, &to->column, from->column, from->slots * LANES, e) ||
                   put(memory, used, &to->weight, from->weight, from->slots * LANES, e)
               ? -1
               : 0;
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
static int put_graph(char *memory, int64_t *used, const tissue *t, tissue_level *v, const level *from,
                     const host_level *h, err *e)
{
    const sell *g = &from->graph;
    if (!h->sums) {
        v->start = t->start, v->neighbour = t->neighbour, v->left = t->left, v->rest = t->pulled;
        return 0;
    }
    v->left = room<float4>(memory, used, g->nodes);
    v->rest = room<float4>(memory, used, g->nodes);
    return put(memory, used, &v->start, h->start, g->count + 1, e) ||
                   put(memory, used, &v->neighbour, g->neighbour, g->slots * LANES, e) ||
                   put(memory, used, &v->sums, h->sums, g->count * 9 * LANES, e)
               ? -1
               : 0;
}

static int put_level(char *memory, int64_t *used, const tissue *t, tissue_level *v, const level *from,
                     const host_level *h, err *e)
{
    const sell *g = &from->graph;
    v->nodes = (int32_t)g->nodes;
    v->chunks = (int32_t)pool_chunks(g->count, SELL_CHUNK);
    v->back = 1 / h->scale;
    choose_steps(v, from->largest);
    v->z[0] = room<float4>(memory, used, g->nodes);
    v->z[1] = room<float4>(memory, used, g->nodes);
    v->step = room<float4>(memory, used, g->nodes);
    return put_graph(memory, used, t, v, from, h, e) || put(memory, used, &v->eight, h->eight, g->slots * LANES, e) ||
                   put(memory, used, &v->ninth, h->ninth, g->slots * LANES, e) ||
                   put(memory, used, &v->inverse, from->inverse, g->count * 9 * LANES, e) ||
                   (from->up.start && (put_weights(memory, used, &v->up, &from->up, e) ||
                                       put_weights(memory, used, &v->down, &from->down, e)))
               ? -1
               : 0;
}

/* Lays out what is in memory, and fills what there is to fill; with no memory yet, counts only. */
static int lay_out(char *memory, int64_t *bytes, const tissue *t, tissue_exact *x, const levels *l, const host_level *h,
                   err *e)
{
    int64_t used = 0;
    for (int i = 0; i < l->count; i++)
        if (put_level(memory, &used, t, &x->at[i], &l->at[i], &h[i], e))
            return -1;
    x->count = l->count;
    x->order = (int32_t)l->order;
    x->gone = room<float4>(memory, &used, t->nodes);
    x->active = room<uint8_t>(memory, &used, t->nodes);
    if (put(memory, &used, &x->coarsest, l->coarsest, l->order * l->order, e))
        return -1;
    *bytes = used;
    return 0;
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
    if (!host_exact_make(h, p, s, m, threads, e) && !lay_out(NULL, bytes, t, x, &h->l, h->at, e)) {
        *memory = (char *)card_take(*bytes, "coarser lattices", e);
        result = *memory && !CARD_TRY(cudaMemset(*memory, 0, (size_t)*bytes)) &&
                         !lay_out(*memory, bytes, t, x, &h->l, h->at, e) && !CARD_TRY(cudaDeviceSynchronize())
                     ? 0
                     : -1;
    }
    for (int i = 0; i < h->l.count; i++)
        host_level_free(&h->at[i]);
    levels_free(&h->l);
    free(h);
    return result;
}
