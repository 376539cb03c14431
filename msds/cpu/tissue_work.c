#include "msds/cpu/tissue_work.h"

#include "msds/cpu/sums.h"

#include <string.h>

static void measure_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_measure(&t->m, t->u, from, to);
}

static void stress_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_stress(&t->m, from, to);
}

static void swell_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_swell(&t->m, t->along, from, to);
}

static void tangent_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_tangent(&t->m, t->along, from, to);
}

static void points_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_points(&t->m, t->points, from, to);
}

static void gather_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    t->sum[chunk] = t->loops->tissue_gather(&t->m, t->along, t->to, from, to);
}

static void advance_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    t->sum[chunk] = t->loops->tissue_advance(&t->m, &t->step, &t->left, &t->way, &t->pulled, t->alpha, from, to);
}

static void turn_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    (void)chunk;
    t->loops->tissue_turn(&t->m, &t->way, &t->left, t->beta, from, to);
}

void tissue_groups(tissue *t, pool_work *work)
{
    pool_run(t->threads, t->m.groups, TISSUE_CHUNK, work, t);
}

void tissue_nodes(tissue *t, pool_work *work)
{
    pool_run(t->threads, t->pressed.s->count, SELL_CHUNK, work, t);
}

double tissue_nodes_sum(tissue *t, pool_work *work)
{
    tissue_nodes(t, work);
    return sums_of(t->sum, pool_chunks(t->pressed.s->count, SELL_CHUNK));
}

static void over_points(tissue *t, float *to)
{
    t->points = to;
    pool_run(t->threads, t->m.points / LANES, SELL_CHUNK, points_work, t);
}

void tissue_measure(tissue *t)
{
    tissue_groups(t, measure_work);
    over_points(t, t->m.pressure);
}

void tissue_pull(tissue *t, lanes_field *to)
{
    tissue_measure(t);
    tissue_groups(t, stress_work);
    t->along = NULL;
    t->to = to;
    tissue_nodes(t, gather_work);
}

double tissue_change(tissue *t, const lanes_field *way)
{
    t->along = way;
    t->to = &t->pulled;
    if (t->m.points)
        tissue_groups(t, swell_work);
    over_points(t, t->m.pressed);
    tissue_groups(t, tangent_work);
    return tissue_nodes_sum(t, gather_work);
}

double tissue_tangent(tissue *t, const lanes_field *way, lanes_field *to)
{
    t->along = way;
    t->to = to;
    if (t->m.points)
        tissue_groups(t, swell_work);
    over_points(t, t->m.pressed);
    for (int64_t i = 0; i < t->m.points; i++)
        t->m.pressed[i] /= 1 - t->m.keep[i];
    tissue_groups(t, tangent_work);
    return tissue_nodes_sum(t, gather_work);
}

double tissue_stiffness(tissue *t, const lanes_field *way)
{
    t->along = way;
    t->to = &t->pulled;
    for (int64_t i = 0; i < t->m.points; i++)
        t->m.pressed[i] = 0;
    tissue_groups(t, tangent_work);
    return tissue_nodes_sum(t, gather_work);
}

static void dot_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    tissue *t = context;
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            sum += (double)t->along->x[a][i] * (double)t->with->x[a][i];
    t->sum[chunk] = sum;
}

double tissue_dot(tissue *t, const lanes_field *f, const lanes_field *with)
{
    t->along = f;
    t->with = with;
    return tissue_nodes_sum(t, dot_work);
}

void tissue_clear(const tissue *t, lanes_field *f)
{
    memset(f->memory, 0, 3 * (size_t)(t->pressed.s->nodes + 2 * LANES) * sizeof *f->memory);
}

void tissue_copy(const tissue *t, lanes_field *to, const lanes_field *from)
{
    memcpy(to->memory, from->memory, 3 * (size_t)(t->pressed.s->nodes + 2 * LANES) * sizeof *to->memory);
}

double tissue_advance(tissue *t, double alpha)
{
    t->alpha = (float)alpha;
    return tissue_nodes_sum(t, advance_work);
}

void tissue_turn(tissue *t, double beta)
{
    t->beta = (float)beta;
    tissue_nodes(t, turn_work);
}
