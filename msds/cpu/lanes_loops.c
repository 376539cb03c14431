/* The loops of lanes.h: an object for each instruction set, by the Makefile. All but its table is static. */
#include "msds/cpu/lanes.h"
#include "msds/problem/spring.h"
#include "solve/flush.h"

#include <string.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

typedef float real;

typedef float v8 __attribute__((vector_size(32), aligned(4), may_alias));
typedef double d4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef float v4 __attribute__((vector_size(16), aligned(4), may_alias));

#define INLINE static inline __attribute__((always_inline))

INLINE v8 load(const float *p)
{
    return *(const v8 *)(const void *)p;
}

INLINE void store(float *p, v8 v)
{
    *(v8 *)(void *)p = v;
}

/* Eight neighbours' values, in a row or not. */
INLINE v8 fetch(const float *field, bool row, int32_t first, const int32_t *neighbour)
{
    if (row)
        return load(field + first);
    v8 r = {0};
    for (int l = 0; l < LANES; l++)
        r[l] = field[neighbour[l]];
    return r;
}

/* What the probe pushes the nodes of a slice with: a spring and damper each, that do not pull. */
static void push(const lanes_springs *w, int64_t own, v8 force[3])
{
    for (int l = 0; l < LANES; l++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = (double)w->place.x[a][own + l] + (double)w->u.x[a][own + l];
        probe_touch t = probe_at(w->probe, x);
        double speed = 0;
        for (int a = 0; a < 3; a++)
            speed += t.way[a] * (double)w->v.x[a][own + l];
        double pushed = (double)w->repulsion[own + l] * (t.depth - w->damping * speed);
        if (!(t.depth > 0 && pushed > 0))
            continue;
        for (int a = 0; a < 3; a++)
            force[a][l] += (float)(pushed * t.way[a]);
        if (w->inverse[own + l] > 0)
            __atomic_store_n(w->met, true, __ATOMIC_RELAXED);
    }
}

/* The square of how far each of eight nodes is from the middle of the probe's ball. */
INLINE v8 away(const lanes_springs *w, int64_t own)
{
    v8 square = {0};
    for (int a = 0; a < 3; a++) {
        v8 d = load(w->place.x[a] + own) + load(w->u.x[a] + own) - w->centre[a];
        square += d * d;
    }
    return square;
}

INLINE bool any_below(v8 x, float limit)
{
    int any = 0;
    for (int l = 0; l < LANES; l++)
        any |= x[l] < limit;
    return any != 0;
}

/* The slots that a register takes: two where it has room for them. What waits for a
 * root and a division then waits for two. */
#if defined(__AVX512F__)
typedef float wide __attribute__((vector_size(64)));

INLINE wide both(v8 a, v8 b)
{
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

INLINE wide root(wide x)
{
    return (wide)_mm512_sqrt_ps((__m512)x);
}

INLINE wide at_least(wide x, wide least)
{
    return (wide)_mm512_max_ps((__m512)x, (__m512)least);
}

/* Adds the first slot's, then, if there is one, the second's. */
INLINE void add_slots(v8 *to, wide x, bool two)
{
    *to += __builtin_shufflevector(x, x, 0, 1, 2, 3, 4, 5, 6, 7);
    if (two)
        *to += __builtin_shufflevector(x, x, 8, 9, 10, 11, 12, 13, 14, 15);
}

enum { TWO = 1 };
#else
typedef v8 wide;

INLINE wide both(v8 a, v8 b)
{
    (void)b;
    return a;
}

INLINE wide root(wide x)
{
#if defined(__AVX__)
    return (v8)_mm256_sqrt_ps((__m256)x);
#else
    v8 r = x;
    for (int l = 0; l < LANES; l++)
        r[l] = __builtin_sqrtf(x[l]);
    return r;
#endif
}

INLINE wide at_least(wide x, wide least)
{
#if defined(__AVX__)
    return (v8)_mm256_max_ps((__m256)x, (__m256)least);
#else
    v8 r = x;
    for (int l = 0; l < LANES; l++)
        r[l] = x[l] > least[l] ? x[l] : least[l];
    return r;
#endif
}

INLINE void add_slots(v8 *to, wide x, bool two)
{
    (void)two;
    *to += x;
}

enum { TWO = 0 };
#endif

INLINE wide load_slots(const float *p, const int64_t slot[2])
{
    return both(load(p + slot[0] * LANES), load(p + slot[1] * LANES));
}

INLINE wide fetch_slots(const float *field, const sell *s, bool row, const int64_t slot[2])
{
    v8 first = fetch(field, row, s->first[slot[0]], s->neighbour + slot[0] * LANES);
    return both(first, row ? load(field + s->first[slot[1]]) : first);
}

/* Adds to force what the springs of a slot, or of two, which must be rows, pull with. */
INLINE void pull(const lanes_springs *w, bool row, const int64_t slot[2], const wide x[3], const wide u[3],
                 const wide v[3], v8 force[3])
{
    wide d[3], e[3], s[3], rest = load_slots(w->rest, slot), least = rest * rest * SPRING_LEAST;
    for (int a = 0; a < 3; a++) {
        wide at_rest = fetch_slots(w->place.x[a], w->s, row, slot) - x[a];
        wide du = fetch_slots(w->u.x[a], w->s, row, slot) - u[a];
        d[a] = at_rest + du;
        e[a] = du * (at_rest + d[a]);
        s[a] = (fetch_slots(w->v.x[a], w->s, row, slot) - v[a]) * d[a];
    }
    wide stretch = e[0] + e[1] + e[2], speed = s[0] + s[1] + s[2];
    wide square = at_least(rest * rest + stretch, least);
    wide length = root(square);
    wide k = load_slots(w->stiffness, slot), gamma = load_slots(w->damper, slot);
    wide scale = SPRING_FORCE(k, gamma, rest, square, speed, stretch, length);
    for (int a = 0; a < 3; a++)
        add_slots(&force[a], scale * d[a], slot[1] != slot[0]);
}

INLINE bool is_row(const sell *s, int64_t slot)
{
    return s->first[slot] != SELL_SCATTERED;
}

/* What the springs of a slice pull its nodes with, slot after slot. */
INLINE void pull_all(const lanes_springs *w, int64_t slice, const v8 x[3], const v8 u[3], const v8 v[3], v8 force[3])
{
    const sell *s = w->s;
    const int64_t end = s->start[slice + 1];
    wide own_x[3], own_u[3], own_v[3];
    for (int a = 0; a < 3; a++) {
        own_x[a] = both(x[a], x[a]);
        own_u[a] = both(u[a], u[a]);
        own_v[a] = both(v[a], v[a]);
    }
    for (int64_t slot = s->start[slice]; slot < end;) {
        const int64_t one[2] = {slot, slot};
        if (TWO && slot + 1 < end && is_row(s, slot) && is_row(s, slot + 1)) {
            const int64_t two[2] = {slot, slot + 1};
            pull(w, true, two, own_x, own_u, own_v, force);
            slot += 2;
            continue;
        }
        if (is_row(s, slot))
            pull(w, true, one, own_x, own_u, own_v, force);
        else
            pull(w, false, one, own_x, own_u, own_v, force);
        slot++;
    }
}

/* PST equations 3 to 5. */
static void step(const lanes_springs *w, int64_t from, int64_t to)
{
    const float reach = w->reach * w->reach;
    const unsigned before = flush_small();
    for (int64_t slice = from; slice < to; slice++) {
        const int64_t own = slice * LANES;
        v8 x[3], u[3], v[3], force[3];
        for (int a = 0; a < 3; a++) {
            x[a] = load(w->place.x[a] + own);
            u[a] = load(w->u.x[a] + own);
            v[a] = load(w->v.x[a] + own);
            force[a] = load(w->weight.x[a] + own);
        }
        pull_all(w, slice, x, u, v, force);
        if (w->touched && any_below(away(w, own), reach))
            push(w, own, force);
        v8 inverse = load(w->inverse + own);
        for (int a = 0; a < 3; a++) {
            v8 speed = v[a] + inverse * force[a];
            store(w->next_v.x[a] + own, speed);
            store(w->next_u.x[a] + own, u[a] + w->dt * speed);
        }
    }
    flush_as(before);
}

static int64_t inside(const lanes_springs *w, int64_t from, int64_t to, int32_t *list)
{
    const float reach = w->reach * w->reach;
    int64_t count = 0;
    for (int64_t slice = from; slice < to; slice++) {
        v8 square = away(w, slice * LANES);
        if (!any_below(square, reach))
            continue;
        for (int l = 0; l < LANES; l++)
            if (square[l] < reach && w->s->model_node[slice * LANES + l] >= 0)
                list[count++] = (int32_t)(slice * LANES) + l;
    }
    return count;
}

INLINE void block(const float *k, v8 p0, v8 p1, v8 p2, v8 y[3])
{
    for (int a = 0; a < 3; a++)
        y[a] +=
            load(k + (3 * a) * LANES) * p0 + load(k + (3 * a + 1) * LANES) * p1 + load(k + (3 * a + 2) * LANES) * p2;
}

INLINE void couple(const lanes_matrix *m, bool row, int64_t slot, const lanes_field *p, v8 y[3])
{
    const int32_t first = m->s->first[slot], *neighbour = m->s->neighbour + slot * LANES;
    block(m->block + slot * 9 * LANES, fetch(p->x[0], row, first, neighbour), fetch(p->x[1], row, first, neighbour),
          fetch(p->x[2], row, first, neighbour), y);
}

INLINE void sum_up(double sum[LANES], v8 x)
{
    for (int l = 0; l < LANES; l++)
        sum[l] += (double)x[l];
}

INLINE double sum_of(const double sum[LANES])
{
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

static double multiply(const lanes_matrix *m, const lanes_field *p, lanes_field *y, int64_t from, int64_t to)
{
    const unsigned before = flush_small();
    const sell *s = m->s;
    double sum[LANES] = {0};
    for (int64_t slice = from; slice < to; slice++) {
        const int64_t own = slice * LANES;
        v8 p0 = load(p->x[0] + own), p1 = load(p->x[1] + own), p2 = load(p->x[2] + own), t[3] = {{0}, {0}, {0}};
        block(m->diagonal + slice * 9 * LANES, p0, p1, p2, t);
        for (int64_t slot = s->start[slice]; slot < s->start[slice + 1]; slot++) {
            if (s->first[slot] != SELL_SCATTERED)
                couple(m, true, slot, p, t);
            else
                couple(m, false, slot, p, t);
        }
        for (int a = 0; a < 3; a++)
            store(y->x[a] + own, t[a]);
        sum_up(sum, p0 * t[0] + p1 * t[1] + p2 * t[2]);
    }
    flush_as(before);
    return sum_of(sum);
}

static double advance(lanes_field *u, lanes_field *r, const lanes_field *p, const lanes_field *y, float alpha,
                      int64_t from, int64_t to)
{
    const unsigned before = flush_small();
    double sum[LANES] = {0};
    for (int64_t own = from * LANES; own < to * LANES; own += LANES) {
        v8 square = {0};
        for (int a = 0; a < 3; a++) {
            store(u->x[a] + own, load(u->x[a] + own) + alpha * load(p->x[a] + own));
            v8 left = load(r->x[a] + own) - alpha * load(y->x[a] + own);
            store(r->x[a] + own, left);
            square += left * left;
        }
        sum_up(sum, square);
    }
    flush_as(before);
    return sum_of(sum);
}

static void turn(lanes_field *p, const lanes_field *r, float beta, int64_t from, int64_t to)
{
    const unsigned before = flush_small();
    for (int64_t own = from * LANES; own < to * LANES; own += LANES)
        for (int a = 0; a < 3; a++)
            store(p->x[a] + own, load(r->x[a] + own) + beta * load(p->x[a] + own));
    flush_as(before);
}

INLINE d4 load_d(const double *p)
{
    return *(const d4 *)(const void *)p;
}

INLINE void store_d(double *p, d4 v)
{
    *(d4 *)(void *)p = v;
}

INLINE d4 widen(const float *p)
{
    return __builtin_convertvector(*(const v4 *)(const void *)p, d4);
}

/* Four columns of rows i to i + 7. */
INLINE void tile(double *c, int64_t stride, const double *l, const double *top, int64_t count)
{
    d4 sum[4][2];
    for (int j = 0; j < 4; j++) {
        sum[j][0] = load_d(c + j * stride);
        sum[j][1] = load_d(c + j * stride + 4);
    }
    for (int64_t k = 0; k < count; k++) {
        d4 low = load_d(l + k * stride), high = load_d(l + k * stride + 4);
        for (int j = 0; j < 4; j++) {
            double by = top[k * stride + j];
            sum[j][0] -= by * low;
            sum[j][1] -= by * high;
        }
    }
    for (int j = 0; j < 4; j++) {
        store_d(c + j * stride, sum[j][0]);
        store_d(c + j * stride + 4, sum[j][1]);
    }
}

static void update(double *c, int64_t stride, const double *l, const double *top, int64_t rows, int64_t columns,
                   int64_t count)
{
    int64_t i = 0;
    for (; columns == 4 && i + 8 <= rows; i += 8)
        tile(c + i, stride, l + i, top, count);
    for (int64_t j = 0; j < columns; j++)
        for (int64_t k = 0; k < count; k++)
            for (int64_t at = i; at < rows; at++)
                c[j * stride + at] -= top[k * stride + j] * l[k * stride + at];
}

static void forward(double *y, const float *l, int64_t stride, int64_t rows, int64_t columns, const double *x)
{
    int64_t k = 0;
    for (; k + 4 <= columns; k += 4) {
        const float *c = l + k * stride;
        const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
        int64_t i = 0;
        for (; i + 4 <= rows; i += 4)
            store_d(y + i, load_d(y + i) - ((x0 * widen(c + i) + x1 * widen(c + stride + i)) +
                                            (x2 * widen(c + 2 * stride + i) + x3 * widen(c + 3 * stride + i))));
        for (; i < rows; i++)
            y[i] -= (x0 * (double)c[i] + x1 * (double)c[stride + i]) +
                    (x2 * (double)c[2 * stride + i] + x3 * (double)c[3 * stride + i]);
    }
    for (; k < columns; k++)
        for (int64_t i = 0; i < rows; i++)
            y[i] -= x[k] * (double)l[k * stride + i];
}

INLINE double across(d4 x)
{
    return (x[0] + x[1]) + (x[2] + x[3]);
}

static void backward(double *x, const float *l, int64_t stride, int64_t rows, int64_t columns, const double *y)
{
    for (int64_t k = 0; k < columns; k++) {
        const float *c = l + k * stride;
        d4 even = {0}, odd = {0};
        double sum = 0;
        int64_t i = 0;
        for (; i + 8 <= rows; i += 8) {
            even += widen(c + i) * load_d(y + i);
            odd += widen(c + i + 4) * load_d(y + i + 4);
        }
        for (; i < rows; i++)
            sum += (double)c[i] * y[i];
        x[k] -= across(even + odd) + sum;
    }
}

#include "msds/cpu/tissue_loops.h"

const lanes VECTORS_OF(lanes_) = {.name = VECTORS_NAME,
                                  .step = step,
                                  .multiply = multiply,
                                  .advance = advance,
                                  .turn = turn,
                                  .inside = inside,
                                  .update = update,
                                  .forward = forward,
                                  .backward = backward,
                                  .tissue_measure = tissue_measure,
                                  .tissue_stress = tissue_stress,
                                  .tissue_swell = tissue_swell,
                                  .tissue_tangent = tissue_tangent,
                                  .tissue_prestress = tissue_prestress,
                                  .tissue_points = tissue_points,
                                  .tissue_gather = tissue_gather,
                                  .tissue_advance = tissue_advance,
                                  .tissue_turn = tissue_turn};
