#include "msds/cpu/compliance.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum {
    PATHS_MOST = 2048, /* kept; past that all are forgotten */
    BATCH = 16,        /* paths made side by side */
    ROWS = 64,         /* of a dense S, likewise */
};

/* S is dense where that takes about as many multiplications as this many passes through the factor, or fewer: a frame's
 * forces take some thirty products with S, each of two passes. */
static const double few = 120;

int compliance_make(compliance *s, const msds_problem *p, factor *f, const contacts *c, pool *threads, err *e)
{
    s->p = p;
    s->factor = f;
    s->c = c;
    s->threads = threads;
    s->cached = mem_array(p->nodes, sizeof *s->cached, "the solver", e);
    s->work = mem_array((int64_t)BATCH * 3 * f->largest, sizeof *s->work, "the solver", e);
    s->load = mem_array(p->nodes, 3 * sizeof *s->load, "the solver", e);
    s->result = mem_array(p->nodes, 3 * sizeof *s->result, "the solver", e);
    s->led = mem_array(p->nodes, 3 * sizeof *s->led, "the solver", e);
    if (!s->cached || !s->work || !s->load || !s->result || !s->led)
        return -1;
    for (int64_t n = 0; n < p->nodes; n++)
        s->cached[n] = -1;
    return 0;
}

void compliance_free(compliance *s)
{
    free(s->cached);
    free(s->whose);
    free(s->path);
    free(s->work);
    free(s->normal);
    free(s->schur);
    free(s->load);
    free(s->result);
    free(s->led);
    *s = (compliance){0};
}

int64_t compliance_bytes(const compliance *s)
{
    return 4 * (s->room + s->normal_room) + 8 * s->schur_room;
}

void compliance_tell(compliance *s, const char *what, double share)
{
    if (!s->listener)
        return;
    s->now.what = what;
    s->now.share = share;
    s->now.contacts = s->c->count;
    s->listener->at(s->listener->context, &s->now);
}

void compliance_forget(compliance *s)
{
    for (int64_t i = 0; i < s->paths; i++)
        s->cached[s->whose[i]] = -1;
    s->paths = 0;
}

/* ---- dense */

static float *path_at(const compliance *s, int64_t i)
{
    return s->path + 3 * i * s->factor->path;
}

static void path_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    compliance *s = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        factor_path(s->factor, s->whose[s->fresh + i], s->work + 3 * i * s->factor->largest, path_at(s, s->fresh + i),
                    s->factor->path);
}

static int make_batch(compliance *s, const int32_t *node, int64_t count, err *e)
{
    if (MEM_ROOM(&s->path, &s->room, (s->paths + count) * 3 * s->factor->path, "contact", e) ||
        MEM_ROOM(&s->whose, &s->whose_room, s->paths + count, "contact", e))
        return -1;
    s->fresh = s->paths;
    for (int64_t i = 0; i < count; i++) {
        s->whose[s->fresh + i] = node[i];
        s->cached[node[i]] = (int32_t)(s->fresh + i);
    }
    pool_run(s->threads, count, 1, path_work, s);
    s->paths += count;
    return 0;
}

/* Paths of all contacts, of which most are known from the frame before. */
static int make_paths(compliance *s, err *e)
{
    int32_t batch[BATCH];
    int64_t count = 0, missing = 0;
    for (int64_t i = 0; i < s->c->count; i++)
        missing += s->cached[s->c->list[i].node] < 0;
    if (missing && s->paths + missing > PATHS_MOST)
        compliance_forget(s);
    for (int64_t i = 0; i < s->c->count; i++) {
        if (s->cached[s->c->list[i].node] < 0)
            batch[count++] = s->c->list[i].node;
        if (count == BATCH || (count && i == s->c->count - 1)) {
            compliance_tell(s, "solving for unit loads on them", (double)i / (double)s->c->count);
            if (make_batch(s, batch, count, e))
                return -1;
            count = 0;
        }
    }
    return 0;
}

static void normal_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    compliance *s = context;
    const int64_t stride = s->factor->path;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const contact *c = &s->c->list[i];
        const float *path = path_at(s, s->cached[c->node]);
        const float way[3] = {(float)c->way[0], (float)c->way[1], (float)c->way[2]};
        float *to_normal = s->normal + i * stride;
        for (int64_t k = 0; k < factor_path_length(s->factor, c->node); k++)
            to_normal[k] = way[0] * path[k] + way[1] * path[stride + k] + way[2] * path[2 * stride + k];
    }
}

/* Eight sums side by side: the order is fixed, and compilers make vectors of it. */
static double product(const float *a, const float *b, int64_t count)
{
    double sum[8] = {0}, rest = 0;
    int64_t i = 0;
    for (; i + 8 <= count; i += 8)
        for (int l = 0; l < 8; l++)
            sum[l] += (double)(a[i + l] * b[i + l]);
    for (; i < count; i++)
        rest += (double)(a[i] * b[i]);
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7])) + rest;
}

static void schur_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    compliance *s = context;
    const int64_t count = s->c->count, stride = s->factor->path;
    (void)chunk;
    for (int64_t i = s->row + from; i < s->row + to; i++)
        for (int64_t j = 0; j <= i; j++) {
            int64_t shared = factor_shared(s->factor, s->c->list[i].node, s->c->list[j].node);
            s->schur[i * count + j] = s->schur[j * count + i] =
                product(s->normal + i * stride, s->normal + j * stride, shared);
        }
}

static int make_schur(compliance *s, err *e)
{
    const int64_t count = s->c->count;
    if (make_paths(s, e) || MEM_ROOM(&s->normal, &s->normal_room, count * s->factor->path, "contact", e) ||
        MEM_ROOM(&s->schur, &s->schur_room, count * count, "contact", e))
        return -1;
    pool_run(s->threads, count, 1, normal_work, s);
    for (s->row = 0; s->row < count; s->row += ROWS) {
        compliance_tell(s, "compliances between them", (double)(s->row * s->row) / (double)(count * count));
        pool_run(s->threads, count - s->row < ROWS ? count - s->row : ROWS, 1, schur_work, s);
    }
    return 0;
}

static void multiply_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    compliance *s = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const double *row = s->schur + i * s->c->count;
        double sum[8] = {0};
        int64_t j = 0;
        for (; j + 8 <= s->c->count; j += 8)
            for (int l = 0; l < 8; l++)
                sum[l] += row[j + l] * s->force[j + l];
        for (; j < s->c->count; j++)
            sum[0] += row[j] * s->force[j];
        s->product[i] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
    }
}

/* ---- by solves */

/* result = K^-1 N force. */
static void solve(compliance *s, const double *force)
{
    memset(s->load, 0, 3 * (size_t)s->p->nodes * sizeof *s->load);
    for (int64_t i = 0; i < s->c->count; i++)
        for (int a = 0; a < 3; a++)
            s->load[3 * (int64_t)s->c->list[i].node + a] += force[i] * s->c->list[i].way[a];
    factor_forward(s->factor, s->load);
    factor_backward(s->factor, s->result);
}

/* ---- both */

int compliance_begin(compliance *s, err *e)
{
    const double count = (double)s->c->count;
    s->dense = count * count * (double)s->factor->path <= few * (double)s->factor->numbers;
    return s->dense && s->c->count ? make_schur(s, e) : 0;
}

void compliance_lead(compliance *s, const double *left, double *moved)
{
    factor_forward(s->factor, left);
    if (!s->dense)
        factor_backward(s->factor, s->led);
    for (int64_t i = 0; i < s->c->count; i++) {
        const contact *c = &s->c->list[i];
        moved[i] =
            s->dense ? factor_dot(s->factor, c->node, s->normal + i * s->factor->path) : contacts_along(c, s->led);
    }
}

void compliance_multiply(compliance *s, const double *force, double *product_)
{
    s->force = force;
    s->product = product_;
    if (s->dense)
        pool_run(s->threads, s->c->count, ROWS, multiply_work, s);
    else
        solve(s, force);
    for (int64_t i = 0; i < s->c->count; i++) {
        const contact *c = &s->c->list[i];
        if (!s->dense)
            product_[i] = contacts_along(c, s->result);
        if (s->p->options.penalty)
            product_[i] += force[i] / s->p->repulsion[c->node];
    }
}

void compliance_follow(compliance *s, const double *force, double *step)
{
    if (s->dense) {
        for (int64_t i = 0; i < s->c->count; i++)
            factor_add(s->factor, s->c->list[i].node, s->normal + i * s->factor->path, force[i]);
        factor_backward(s->factor, step);
        return;
    }
    solve(s, force);
    for (int64_t i = 0; i < 3 * s->p->nodes; i++)
        step[i] = s->led[i] + s->result[i];
}

double compliance_inverse(const compliance *s, const contact *c)
{
    const double *block = s->factor->k->diagonal + 9 * (int64_t)c->node;
    double stiff = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            stiff += c->way[i] * block[3 * i + j] * c->way[j];
    return s->p->options.penalty ? 1 / (1 / stiff + 1 / s->p->repulsion[c->node]) : stiff;
}
