/* The loops of slice_lanes.h: an object for each instruction set, by the Makefile. All but its table is static. */
#include "slice/image/slice_lanes.h"

#include <math.h>
#include <string.h>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline))

/* ---- nodes and tetrahedra */

INLINE uint8_t code_of(const double at[3], const double last[2])
{
    return (uint8_t)((at[2] < 0 ? SLICE_CUT_BEFORE : SLICE_CUT_BEHIND) | (at[0] < 0) << 2 | (at[0] > last[0]) << 3 |
                     (at[1] < 0) << 4 | (at[1] > last[1]) << 5);
}

static void project(const slice_projection *p, const double *rest, const double *displacement, int64_t from, int64_t to,
                    slice_node *at, uint8_t *code)
{
    for (int64_t n = from; n < to; n++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = rest[3 * n + a] + (displacement ? displacement[3 * n + a] : 0) - p->origin[a];
        for (int a = 0; a < 3; a++)
            at[n].at[a] = p->axis[a][0] * x[0] + p->axis[a][1] * x[1] + p->axis[a][2] * x[2];
        code[n] = code_of(at[n].at, p->last);
    }
}

/* On which side of the image all nodes of a group are: it has four times fewer of them than its
 * tetrahedra, few of which meet the image. */
INLINE unsigned beside(const slice_tets *t, int64_t group)
{
    unsigned sides = UINT8_MAX;
    for (int64_t i = t->start[group]; i < t->start[group + 1]; i++)
        sides &= t->code[t->group[i]];
    return sides;
}

static int64_t meet(const slice_tets *t, int64_t from, int64_t to, int32_t *list)
{
    int64_t count = 0;
    for (int64_t first = from; first < to; first += SLICE_GROUP) {
        const int64_t end = first + SLICE_GROUP < to ? first + SLICE_GROUP : to;
        if (beside(t, first / SLICE_GROUP))
            continue;
        for (int64_t i = first; i < end; i++) {
            const int32_t *n = t->node + 4 * i;
            list[count] = (int32_t)i;
            count += !(t->code[n[0]] & t->code[n[1]] & t->code[n[2]] & t->code[n[3]]);
        }
    }
    return count;
}

/* Which edges the plane crosses, around, for the corners behind it (a bit each); edges as 4 a + b, a < b. */
typedef struct crossed {
    uint8_t count, edge[4];
} crossed;

#define EDGE(a, b) (4 * (a) + (b))
static const crossed crossings[16] = {
    {0},
    {3, {EDGE(0, 1), EDGE(0, 2), EDGE(0, 3)}},
    {3, {EDGE(0, 1), EDGE(1, 2), EDGE(1, 3)}},
    {4, {EDGE(0, 2), EDGE(0, 3), EDGE(1, 3), EDGE(1, 2)}},
    {3, {EDGE(0, 2), EDGE(1, 2), EDGE(2, 3)}},
    {4, {EDGE(0, 1), EDGE(0, 3), EDGE(2, 3), EDGE(1, 2)}},
    {4, {EDGE(0, 1), EDGE(0, 2), EDGE(2, 3), EDGE(1, 3)}},
    {3, {EDGE(0, 3), EDGE(1, 3), EDGE(2, 3)}},
    {3, {EDGE(0, 3), EDGE(1, 3), EDGE(2, 3)}},
    {4, {EDGE(0, 1), EDGE(0, 2), EDGE(2, 3), EDGE(1, 3)}},
    {4, {EDGE(0, 1), EDGE(0, 3), EDGE(2, 3), EDGE(1, 2)}},
    {3, {EDGE(0, 2), EDGE(1, 2), EDGE(2, 3)}},
    {4, {EDGE(0, 2), EDGE(0, 3), EDGE(1, 3), EDGE(1, 2)}},
    {3, {EDGE(0, 1), EDGE(1, 2), EDGE(1, 3)}},
    {3, {EDGE(0, 1), EDGE(0, 2), EDGE(0, 3)}},
    {0},
};

/* Where the plane crosses an edge: the same bits whichever tetrahedron asks, since nodes are in ascending order; and
 * exactly at a node that lies in the plane. */
INLINE void cross(const slice_tets *t, int32_t a, int32_t b, double *u, double *v, double place[3])
{
    const double *low = t->at[a].at, *high = t->at[b].at;
    const double by = low[2] / (low[2] - high[2]), left = 1 - by;
    *u = left * low[0] + by * high[0];
    *v = left * low[1] + by * high[1];
    for (int i = 0; i < 3; i++)
        place[i] = left * t->place[3 * (int64_t)a + i] + by * t->place[3 * (int64_t)b + i];
}

/* The affine map through the corners: by two directions across the piece; or by one, where it is but a line. */
INLINE void map(slice_piece *p, double place[4][3])
{
    const int one = p->corners == 4 ? 2 : 1, two = p->corners - 1, from = p->corners == 4;
    const double au = p->u[one] - p->u[0], av = p->v[one] - p->v[0];
    const double bu = p->u[two] - p->u[from], bv = p->v[two] - p->v[from];
    const double area = au * bv - av * bu, a2 = au * au + av * av, b2 = bu * bu + bv * bv;
    const bool flat = !(fabs(area) > 1e-9 * (a2 + b2)), first = a2 > b2;
    const double lu = first ? au : bu;
    const double lv = first ? av : bv;
    const double l2 = first ? a2 : b2;
    double by = 1 / area;
    if (flat)
        by = a2 + b2 > 0 ? 1 / l2 : 0;
    for (int i = 0; i < 3; i++) {
        const double a = place[one][i] - place[0][i], b = place[two][i] - place[from][i];
        const double l = first ? a : b;
        const double across = (flat ? l * lu : a * bv - b * av) * by;
        const double down = (flat ? l * lv : b * au - a * bu) * by;
        p->across[i] = SLICE_ONE * across;
        p->down[i] = SLICE_ONE * down;
        p->place[i] = SLICE_ONE * (place[0][i] - across * p->u[0] - down * p->v[0]);
    }
    p->across[3] = p->down[3] = p->place[3] = 0;
}

/* The first whole number that is not below x, within 0 and most; 0 for a nan. */
INLINE int32_t whole(double x, int32_t most)
{
    if (!(x > 0))
        return 0;
    if (x >= most)
        return most;
    const int32_t i = (int32_t)x;
    return i + (i < x);
}

INLINE bool within(const slice_cells *c, double place[4][3], int corners)
{
    bool inside = true;
    for (int k = 0; k < corners; k++)
        for (int i = 0; i < 3; i++)
            inside &= place[k][i] >= .5 && place[k][i] <= c->size[i] + .5;
    return inside;
}

/* An edge that two pieces share has the same ends in both, and so the same crossings with
 * rows to the bit: no pixel falls between. */
INLINE void edge(slice_piece *p, int k)
{
    int a = k, b = k + 1 < p->corners ? k + 1 : 0;
    if (p->v[a] > p->v[b]) {
        b = k;
        a = k + 1 < p->corners ? k + 1 : 0;
    }
    p->from[k] = p->v[a];
    p->to[k] = p->v[b];
    p->slope[k] = (p->u[b] - p->u[a]) / (p->v[b] - p->v[a]);
    p->start[k] = p->u[a];
}

static void cut(const slice_tets *t, const slice_cells *c, const int32_t *list, int64_t count, int32_t rows,
                slice_piece *to)
{
    for (int64_t i = 0; i < count; i++) {
        const int32_t *n = t->node + 4 * (int64_t)list[i];
        slice_piece *p = to + i;
        double place[4][3], top = (double)INFINITY, bottom = -(double)INFINITY;
        unsigned behind = 0;
        for (int k = 0; k < 4; k++)
            behind |= (unsigned)(t->code[n[k]] & SLICE_CUT_BEHIND) << k >> 1;
        const crossed *x = &crossings[behind];
        p->tet = list[i];
        p->corners = x->count;
        for (int k = 0; k < x->count; k++) {
            cross(t, n[x->edge[k] >> 2], n[x->edge[k] & 3], &p->u[k], &p->v[k], place[k]);
            top = p->v[k] < top ? p->v[k] : top;
            bottom = p->v[k] > bottom ? p->v[k] : bottom;
        }
        p->first = whole(top, rows);
        p->end = whole(bottom, rows);
        p->inside = within(c, place, p->corners);
        if (p->first >= p->end)
            continue;
        map(p, place);
        for (int k = 0; k < p->corners; k++)
            edge(p, k);
        if (p->corners == 3)
            p->from[3] = p->to[3] = p->start[3] = p->slope[3] = 0;
    }
}

/* ---- rows */

typedef double d4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t l4 __attribute__((vector_size(32)));
typedef int32_t i4 __attribute__((vector_size(16)));

INLINE d4 load4(const double *p)
{
    return *(const d4 *)(const void *)p;
}

/* Rounded to the nearest; what fixed point does not hold is brought to its ends. */
INLINE i4 fixed(d4 x)
{
    const d4 low = {-2147483647., -2147483647., -2147483647., -2147483647.};
    const d4 high = {2147483646., 2147483646., 2147483646., 2147483646.};
    l4 above = x > low;
    x = (d4)((above & (l4)x) | (~above & (l4)low));
    l4 below = x < high;
    x = (d4)((below & (l4)x) | (~below & (l4)high));
    const l4 sign = {INT64_MIN, INT64_MIN, INT64_MIN, INT64_MIN};
    const d4 half = {.5, .5, .5, .5};
    return __builtin_convertvector(x + (d4)(((l4)x & sign) | (l4)half), i4);
}

/* Rows of a piece, side by side: as many as a register has doubles. */
#if defined(__AVX512BW__)
enum { SIDE = 8 };
#elif defined(__AVX2__)
enum { SIDE = 4 };
#else
enum { SIDE = 2 };
#endif
typedef double ds __attribute__((vector_size(8 * SIDE), aligned(8), may_alias));
typedef int64_t ls __attribute__((vector_size(8 * SIDE)));
typedef int32_t is __attribute__((vector_size(4 * SIDE)));

#ifndef __AVX512BW__ /* which has instructions for it */
INLINE ds choose(ls which, ds yes, ds no)
{
    return (ds)((which & (ls)yes) | (~which & (ls)no));
}
#endif

INLINE ds all(double x)
{
    return x - (ds){0};
}

/* A step for each of a register's pixels. */
#if defined(__AVX512BW__)

typedef __m512i steps;
enum { WIDE = 16, HALF = 8 };

INLINE steps steps_of(int32_t step)
{
    return _mm512_mullo_epi32(_mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15),
                              _mm512_set1_epi32(step));
}

INLINE void put(int32_t *to, int32_t count, int32_t from, steps s)
{
    const __mmask16 which = (__mmask16)(count >= 16 ? 0xffffU : (1U << count) - 1);
    _mm512_mask_storeu_epi32(to, which, _mm512_add_epi32(_mm512_set1_epi32(from), s));
}

/* The same for no more than HALF: half as much to store is stored faster. */
INLINE void put_half(int32_t *to, int32_t count, int32_t from, steps s)
{
    const __m256i at = _mm256_add_epi32(_mm256_set1_epi32(from), _mm512_castsi512_si256(s));
    _mm256_mask_storeu_epi32(to, (__mmask8)((1U << count) - 1), at);
}

#elif defined(__AVX2__)

typedef __m256i steps;
enum { WIDE = 8, HALF = 0 };

INLINE steps steps_of(int32_t step)
{
    return _mm256_mullo_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32(step));
}

INLINE void put(int32_t *to, int32_t count, int32_t from, steps s)
{
    const __m256i along = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    _mm256_maskstore_epi32(to, _mm256_cmpgt_epi32(_mm256_set1_epi32(count), along),
                           _mm256_add_epi32(_mm256_set1_epi32(from), s));
}

#else

typedef int32_t steps;
enum { WIDE = 8, HALF = 0 };

INLINE steps steps_of(int32_t step)
{
    return step;
}

INLINE void put(int32_t *to, int32_t count, int32_t from, steps s)
{
    for (int32_t i = 0; i < count && i < WIDE; i++)
        to[i] = (int32_t)((uint32_t)from + (uint32_t)s * (uint32_t)i);
}

#endif

#if !defined(__AVX512BW__)
INLINE void put_half(int32_t *to, int32_t count, int32_t from, steps s)
{
    put(to, count, from, s);
}
#endif

enum { RUN = 64 };

/* Columns [from, end) of a row. Steps in fixed point add up their rounding: no more than RUN of them. */
INLINE void run(const slice_piece *p, d4 across, d4 start, i4 step, int32_t from, int32_t end, slice_places *to,
                int64_t row)
{
    for (int32_t c = from; c < end; c += RUN) {
        const double column = c;
        const i4 at = fixed(start + across * (d4){column, column, column, column});
        const int32_t count = end - c < RUN ? end - c : RUN;
        for (int a = 0; a < 3; a++) {
            const steps wide = steps_of(step[a]);
            const uint32_t next = (uint32_t)step[a] * WIDE, first = (uint32_t)at[a];
            for (int32_t i = 0; i < count; i += WIDE)
                put(to->at[a] + row + c + i, count - i, (int32_t)(first + next * (uint32_t)(i / WIDE)), wide);
        }
    }
    if (to->owner)
        for (int32_t c = from; c < end; c++)
            to->owner[row + c] = p->tet;
}

/* Those of the columns whose places are within the volume. */
INLINE void clip(const slice_fill *f, const slice_piece *p, double row, int32_t *from, int32_t *end)
{
    double first = *from, last = *end - 1;
    for (int a = 0; a < 3; a++) {
        const double start = p->place[a] + p->down[a] * row, step = p->across[a];
        const double one = (.5 * SLICE_ONE - start) / step, two = (f->end[a] - start) / step;
        if (step != 0) {
            first = fmax(first, ceil(fmin(one, two)));
            last = fmin(last, floor(fmax(one, two)));
        } else if (!(start >= .5 * SLICE_ONE && start <= f->end[a])) {
            last = first - 1;
        }
    }
    if (last < first) {
        *end = *from;
    } else {
        *from = (int32_t)first;
        *end = (int32_t)last + 1;
    }
}

/* Black is a z; whatever x and y are then, they are within the volume's ends. */
static void clear(int32_t black, int64_t size, slice_places *to)
{
    for (int64_t i = 0; i < size; i++)
        to->at[2][i] = black;
    for (int64_t i = 0; to->owner && i < size; i++)
        to->owner[i] = -1;
}

static void line(const slice_fill *f, const slice_piece *p, int32_t row, int32_t from, int32_t end, int64_t offset,
                 slice_places *to)
{
    const double r = row;
    const d4 across = load4(p->across);
    if (!p->inside)
        clip(f, p, r, &from, &end);
    if (from < end)
        run(p, across, load4(p->place) + load4(p->down) * (d4){r, r, r, r}, fixed(across), from, end, to, offset);
}

typedef struct side {
    int32_t from[SIDE], count[SIDE], at[3][SIDE];
} side;

/* As whole(). */
INLINE is whole_side(ds x, double most)
{
#if defined(__AVX512BW__)
    const __m512d up = _mm512_roundscale_pd((__m512d)x, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
    return (is)_mm512_cvttpd_epi32(_mm512_min_pd(_mm512_max_pd(up, _mm512_setzero_pd()), _mm512_set1_pd(most)));
#elif defined(__AVX2__)
    const __m256d up = _mm256_ceil_pd((__m256d)x);
    return (is)_mm256_cvttpd_epi32(_mm256_min_pd(_mm256_max_pd(up, _mm256_setzero_pd()), _mm256_set1_pd(most)));
#else
    x = choose(x > all(0), x, all(0));
    x = choose(x < all(most), x, all(most));
    is i = __builtin_convertvector(x, is);
    return i - __builtin_convertvector(__builtin_convertvector(i, ds) < x, is);
#endif
}

/* Widens low to high by the crossings of an edge with the rows that it meets: from <= row < to. */
INLINE void widen(ds rows, double from, double to, ds x, ds *low, ds *high)
{
#if defined(__AVX512BW__)
    const __mmask8 meets = _mm512_mask_cmp_pd_mask(_mm512_cmp_pd_mask((__m512d)rows, _mm512_set1_pd(from), _CMP_GE_OQ),
                                                   (__m512d)rows, _mm512_set1_pd(to), _CMP_LT_OQ);
    *low = (ds)_mm512_mask_min_pd((__m512d)*low, meets, (__m512d)x, (__m512d)*low);
    *high = (ds)_mm512_mask_max_pd((__m512d)*high, meets, (__m512d)x, (__m512d)*high);
#else
    const ls meets = (rows >= all(from)) & (rows < all(to));
    *low = choose(meets & (x < *low), x, *low);
    *high = choose(meets & (x > *high), x, *high);
#endif
}

/* Where rows from `first` on enter the piece and leave it; and, of a piece within the
 * volume, the places of their first pixels. */
INLINE void look(const slice_piece *p, int32_t first, int32_t columns, side *to)
{
    static const double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const ds rows = all(first) + *(const ds *)(const void *)numbers;
    ds low = all((double)INFINITY), high = all(-(double)INFINITY);
    for (int k = 0; k < 4; k++) {
        const ds x = all(p->start[k]) + (rows - all(p->from[k])) * all(p->slope[k]);
        widen(rows, p->from[k], p->to[k], x, &low, &high);
    }
    const is from = whole_side(low, columns), count = whole_side(high, columns) - from;
    const ds column = __builtin_convertvector(from, ds);
    memcpy(to->from, &from, sizeof to->from);
    memcpy(to->count, &count, sizeof to->count);
    for (int a = 0; a < 3 && p->inside; a++) {
        const ds place = (all(p->place[a]) + all(p->down[a]) * rows) + all(p->across[a]) * column;
        const is at = __builtin_convertvector(place + all(.5), is);
        memcpy(to->at[a], &at, sizeof to->at[a]);
    }
}

INLINE void fill_shown(const slice_fill *f, const slice_piece *p, int32_t row, int32_t from, int32_t end,
                       int64_t offset, slice_places *to)
{
    const slice_shown *s = &f->shown[row];
    for (int k = 0; k < 2; k++) {
        const int32_t first = from > s->from[k] ? from : s->from[k];
        line(f, p, row, first, end < s->to[k] ? end : s->to[k], offset, to);
    }
}

/* A bit for each of the rows whose count is above one number and not above another. */
INLINE unsigned which(const side *s, int32_t above, int32_t most)
{
#if defined(__AVX512BW__)
    const __m256i count = _mm256_loadu_si256((const __m256i *)(const void *)s->count);
    return _mm256_mask_cmple_epi32_mask(_mm256_cmpgt_epi32_mask(count, _mm256_set1_epi32(above)), count,
                                        _mm256_set1_epi32(most));
#else
    unsigned bits = 0;
    for (int i = 0; i < SIDE; i++)
        bits |= (unsigned)(s->count[i] > above && s->count[i] <= most) << i;
    return bits;
#endif
}

INLINE void fill_piece(const slice_fill *f, const slice_piece *p, int32_t first, int32_t end, int32_t top,
                       slice_places *to)
{
    const i4 step = fixed(load4(p->across));
    const steps wide[3] = {steps_of(step[0]), steps_of(step[1]), steps_of(step[2])};
    const int32_t most = p->inside && f->all && !to->owner ? WIDE : 0;
    side s;
    for (int32_t r = first; r < end; r += SIDE) {
        const unsigned rows = end - r < SIDE ? (1U << (end - r)) - 1 : (1U << SIDE) - 1;
        const int64_t offset = (int64_t)(r - top) * to->stride;
        look(p, r, to->stride, &s);
        for (unsigned bits = which(&s, 0, HALF < most ? HALF : most) & rows; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            const int64_t at = offset + (int64_t)i * to->stride + s.from[i];
            for (int a = 0; a < 3; a++)
                put_half(to->at[a] + at, s.count[i], s.at[a][i], wide[a]);
        }
        for (unsigned bits = which(&s, HALF, most) & rows; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            const int64_t at = offset + (int64_t)i * to->stride + s.from[i];
            for (int a = 0; a < 3; a++)
                put(to->at[a] + at, s.count[i], s.at[a][i], wide[a]);
        }
        for (unsigned bits = which(&s, most, INT32_MAX) & rows; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            fill_shown(f, p, r + i, s.from[i], s.from[i] + s.count[i], offset + (int64_t)i * to->stride, to);
        }
    }
}

enum { AHEAD = 2, LINE = 64 };

/* Pieces come from anywhere in a list that no inner cache holds. */
INLINE void fetch(const slice_piece *p)
{
    for (size_t i = 0; i < sizeof *p; i += LINE)
        __builtin_prefetch((const char *)p + i);
}

static void fill(const slice_fill *f, const int32_t *list, int64_t count, int32_t first, int32_t end, slice_places *to)
{
    clear(f->black, (int64_t)(end - first) * to->stride, to);
    for (int64_t i = count - 1; i >= 0; i--) {
        const slice_piece *p = f->piece + list[i];
        if (i >= AHEAD)
            fetch(f->piece + list[i - AHEAD]);
        const int32_t from = p->first > first ? p->first : first;
        fill_piece(f, p, from, p->end < end ? p->end : end, first, to);
    }
}

#include "slice/image/slice_lanes_sample.h"

const slice_lanes VECTORS_OF(slice_lanes_) = {.name = VECTORS_NAME,
                                              .project = project,
                                              .meet = meet,
                                              .cut = cut,
                                              .clear = clear,
                                              .line = line,
                                              .fill = fill,
                                              .sample = sample};
