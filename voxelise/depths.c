#include "voxelise/depths.h"

#include "base/mem.h"
#include "surface/closest.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Cells along a side of what one thread takes at a time, and at least of a bin. */
enum { UNIT = 32, LEAST_BIN = 16 };

/* Corners within radius of the middle. */
typedef struct ball {
    double middle[3], radius;
} ball;

typedef struct box {
    int64_t low[3], high[3]; /* cells, low <= i < high */
} box;

struct depths {
    uint8_t *step;
    const double *depth;
    int64_t depths;
    const voxels *x;
    const voxels_layers *layer;
    int32_t volumes;
    const depths_surface *s;
    const grid *g;
    ball *ball;  /* triangles */
    box all;     /* cells that voxels are in */
    int64_t bin; /* cells along a side; a power of 2 */
    int64_t bins[3], units[3];
    int64_t *start; /* bins + 1 */
    uint32_t *triangle;
    atomic_bool failed;
    int samples; /* of a voxel, along a side; 0: cells are voxels, of which all of a centre's step are */
    double spread[DEPTHS_SAMPLES * DEPTHS_SAMPLES];
    double blur; /* how far from its centre's depth a sample's may be taken: a sample's diagonal */
};

typedef struct depths work;

/* No centre deeper than that is above the last depth. */
static double deepest(const work *w)
{
    return w->depth[w->depths - 1] + w->blur;
}

/* ---- triangles into bins: those that may be as near as the deepest to some centre in it */

static ball ball_of(const double *corner)
{
    ball b = {.radius = 0};
    for (int a = 0; a < 3; a++)
        b.middle[a] = (corner[a] + corner[3 + a] + corner[6 + a]) / 3;
    for (int i = 0; i < 3; i++) {
        double x = corner[3 * i] - b.middle[0], y = corner[3 * i + 1] - b.middle[1],
               z = corner[3 * i + 2] - b.middle[2];
        b.radius = fmax(b.radius, sqrt(x * x + y * y + z * z));
    }
    return b;
}

/* False where a triangle reaches no cell. */
static bool find_reach(const work *w, int64_t triangle, box *reach)
{
    const double *corner = &w->s->corner[9 * triangle];
    for (int a = 0; a < 3; a++) {
        double h = w->g->spacing[a], low = (double)w->all.low[a], high = (double)w->all.high[a];
        double from = fmin(corner[a], fmin(corner[3 + a], corner[6 + a])) - deepest(w);
        double to = fmax(corner[a], fmax(corner[3 + a], corner[6 + a])) + deepest(w);
        from = floor(from / h - 0.5), to = ceil(to / h - 0.5) + 1;
        reach->low[a] = (int64_t)fmin(fmax(from, low), high);
        reach->high[a] = (int64_t)fmax(fmin(to, high), low);
        if (reach->low[a] >= reach->high[a])
            return false;
    }
    return true;
}

static int64_t bin_at(const work *w, const int64_t *cell)
{
    int64_t at[3];
    for (int a = 0; a < 3; a++)
        at[a] = (cell[a] - w->all.low[a]) / w->bin;
    return (at[2] * w->bins[1] + at[1]) * w->bins[0] + at[0];
}

/* Counts a triangle in its bins, or stores it there. */
static void put_triangle(const work *w, int64_t triangle, bool store)
{
    box reach;
    if (!find_reach(w, triangle, &reach))
        return;
    for (int a = 0; a < 3; a++) {
        reach.low[a] = (reach.low[a] - w->all.low[a]) / w->bin;
        reach.high[a] = (reach.high[a] - 1 - w->all.low[a]) / w->bin + 1;
    }
    for (int64_t k = reach.low[2]; k < reach.high[2]; k++)
        for (int64_t j = reach.low[1]; j < reach.high[1]; j++)
            for (int64_t i = reach.low[0]; i < reach.high[0]; i++) {
                int64_t *start = &w->start[(k * w->bins[1] + j) * w->bins[0] + i];
                if (store)
                    w->triangle[start[1]++] = (uint32_t)triangle;
                else
                    start[2]++;
            }
}

/* As large as the deepest, so that a triangle is in few. */
static void choose_bins(work *w)
{
    double cells = LEAST_BIN;
    int64_t longest = 1;
    for (int a = 0; a < 3; a++) {
        int64_t size = w->all.high[a] - w->all.low[a];
        cells = fmax(cells, deepest(w) / w->g->spacing[a]);
        longest = size > longest ? size : longest;
    }
    for (w->bin = LEAST_BIN; (double)w->bin < cells && w->bin < longest; w->bin *= 2)
        ;
    for (int a = 0; a < 3; a++) {
        int64_t size = w->all.high[a] - w->all.low[a];
        w->bins[a] = pool_chunks(size, w->bin);
        w->units[a] = pool_chunks(size, w->bin < UNIT ? w->bin : UNIT);
    }
}

/* Counted two places up, so that filling leaves each bin's first in its place. */
static int fill_bins(work *w, err *e)
{
    int64_t bins = w->bins[0] * w->bins[1] * w->bins[2];
    w->ball = mem_array(w->s->triangles, sizeof *w->ball, "triangles", e);
    w->start = w->ball ? mem_array(bins + 2, sizeof *w->start, "triangles", e) : NULL;
    if (!w->start)
        return -1;
    for (int64_t t = 0; t < w->s->triangles; t++) {
        w->ball[t] = ball_of(&w->s->corner[9 * t]);
        put_triangle(w, t, false);
    }
    for (int64_t b = 0; b < bins; b++)
        w->start[b + 2] += w->start[b + 1];
    w->triangle = mem_array(w->start[bins + 1], sizeof *w->triangle, "triangles", e);
    for (int64_t t = 0; w->triangle && t < w->s->triangles; t++)
        put_triangle(w, t, true);
    return w->triangle ? 0 : -1;
}

/* ---- boxes */

/* One thread's, for a row of units. */
typedef struct search {
    const work *w;
    box row;
    uint8_t *step; /* cells of the row */
    /* The triangles of the boxes that are being looked at, one in another, and how near each is at least. */
    uint32_t *triangle;
    double *least;
    int64_t triangle_capacity, least_capacity;
} search;

static uint8_t *step_at(const search *s, int64_t i, int64_t j, int64_t k)
{
    const box *r = &s->row;
    return &s->step[((k - r->low[2]) * (r->high[1] - r->low[1]) + j - r->low[1]) * (r->high[0] - r->low[0]) + i -
                    r->low[0]];
}

static uint8_t step_of(const work *w, double depth)
{
    for (int64_t i = 0; i < w->depths; i++)
        if (depth < w->depth[i])
            return (uint8_t)(i + 1);
    return 0;
}

static bool any_wanted(const search *s, const box *b)
{
    for (int64_t k = b->low[2]; k < b->high[2]; k++)
        for (int64_t j = b->low[1]; j < b->high[1]; j++)
            for (int64_t i = b->low[0]; i < b->high[0]; i++)
                if (*step_at(s, i, j, k) != DEPTHS_UNWANTED)
                    return true;
    return false;
}

static void fill_box(const search *s, const box *b, uint8_t step)
{
    for (int64_t k = b->low[2]; k < b->high[2]; k++)
        for (int64_t j = b->low[1]; j < b->high[1]; j++)
            for (int64_t i = b->low[0]; i < b->high[0]; i++)
                if (*step_at(s, i, j, k) != DEPTHS_UNWANTED)
                    *step_at(s, i, j, k) = step;
}

/* The middle of a box's centres; radius: none is further from it. */
static ball ball_of_box(const grid *g, const box *b)
{
    ball c = {.radius = 0};
    double half[3];
    for (int a = 0; a < 3; a++) {
        double low = grid_centre(g, a, b->low[a]), high = grid_centre(g, a, b->high[a] - 1);
        c.middle[a] = (low + high) / 2;
        half[a] = (high - low) / 2;
    }
    c.radius = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    return c;
}

/* More than distances here are off by rounding. */
static double slack_of(const ball *c, double distance)
{
    double size = fabs(c->middle[0]) + fabs(c->middle[1]) + fabs(c->middle[2]);
    return 1e-9 * (c->radius + distance) + 1e-14 * size;
}

/* The triangle from <= n < to whose ball is nearest to the middle: few others can be nearer. */
static int64_t find_first(const search *s, const ball *c, int64_t from, int64_t to)
{
    int64_t first = from;
    for (int64_t n = from; n < to; n++) {
        const ball *t = &s->w->ball[s->triangle[n]];
        double x = t->middle[0] - c->middle[0], y = t->middle[1] - c->middle[1], z = t->middle[2] - c->middle[2];
        s->least[n] = sqrt(x * x + y * y + z * z) - t->radius;
        first = s->least[n] < s->least[first] ? n : first;
    }
    return first;
}

static double distance_of(const search *s, const ball *c, int64_t n)
{
    double p[3];
    const double *corner = &s->w->s->corner[9 * (int64_t)s->triangle[n]];
    return sqrt(closest_triangle(corner, corner + 3, corner + 6, c->middle, p));
}

/* The step of one centre: of other triangles only those matter that may be nearer than all of that step. */
static uint8_t find_step(const search *s, const ball *c, double distance, int64_t from, int64_t to)
{
    const work *w = s->w;
    uint8_t step = step_of(w, distance);
    for (int64_t n = from; n < to && step != 1; n++) {
        double less = w->depth[step ? step - 2 : w->depths - 1];
        if (s->least[n] <= less + slack_of(c, less) && (distance = distance_of(s, c, n)) < less)
            step = step_of(w, distance);
    }
    return step;
}

/* Numbers from 0 to 1 for the samples of a voxel: any layer of them, across any axis, has each of N^2 once, and next to
 * each other they differ much, as multiples of powers of the inverse root of x^3 = x + 1 do (Roberts's sequence). */
static void make_spread(work *w)
{
    const int n = w->samples, all = n * n;
    double of[DEPTHS_SAMPLES * DEPTHS_SAMPLES];
    for (int i = 0; i < all; i++) {
        const int u = i % n, v = i / n;
        const double sum = .7548776662466927 * u + .5698402909980532 * v;
        of[i] = sum - floor(sum);
    }
    for (int i = 0; i < all; i++) {
        int below = 0;
        for (int k = 0; k < all; k++)
            below += of[k] < of[i] || (k < i && of[k] == of[i]);
        w->spread[i] = (below + .5) / all;
    }
}

static double spread_at(const work *w, const int64_t *cell)
{
    const int64_t n = w->samples;
    int64_t in[3];
    for (int a = 0; a < 3; a++)
        in[a] = (cell[a] % n + n) % n;
    return w->spread[(in[1] + in[2]) % n * n + (in[0] + in[2]) % n];
}

/* The step of one sample. Samples begin at the surface as shares of voxels have it, which is off by up to half of
 * one: so the first from there reaches to the depth of a sample's width, the next to that of two. What lies between two
 * depths of steps in this is of both in parts: of such samples so many are of either. So a layer that is thinner than a
 * sample, or ends within one, has its own volume. */
static uint8_t find_sample(const search *s, const box *b, const ball *c, int64_t first, int64_t from, int64_t to)
{
    const work *w = s->w;
    static const double by[3] = {1e-7, 1e-9, 1e-11};
    const double *h = w->g->spacing;
    double p[3], nearest[3], width = 0, nudge = 0;
    const double *corner = &w->s->corner[9 * (int64_t)s->triangle[first]];
    double distance = sqrt(closest_triangle(corner, corner + 3, corner + 6, c->middle, nearest));
    for (int64_t n = from; n < to; n++) {
        if (s->least[n] > distance + slack_of(c, distance))
            continue;
        corner = &w->s->corner[9 * (int64_t)s->triangle[n]];
        const double other = sqrt(closest_triangle(corner, corner + 3, corner + 6, c->middle, p));
        if (other < distance) {
            distance = other;
            memcpy(nearest, p, sizeof nearest);
        }
    }
    for (int a = 0; a < 3; a++) {
        const double along = (c->middle[a] - nearest[a]) / distance;
        width += h[a] * fabs(along);
        nudge += along * by[a];
    }
    if (!(width > 0)) /* it lies on the surface */
        return step_of(w, (h[0] + h[1] + h[2]) * spread_at(w, b->low) / 3);
    distance = fmax(0, distance + width * nudge); /* as centres on the surface are taken for inside or not */
    return step_of(w, width * (floor(distance / width) + spread_at(w, b->low)));
}

/* The triangles that may be nearer than others to some centre in the box follow those of the box around it. */
static int keep_near(search *s, double most, int64_t from, int64_t to, int64_t *past, err *e)
{
    if (MEM_ROOM(&s->triangle, &s->triangle_capacity, 2 * to - from, "triangles", e) ||
        MEM_ROOM(&s->least, &s->least_capacity, 2 * to - from, "triangles", e))
        return -1;
    *past = to;
    for (int64_t n = from; n < to; n++)
        if (s->least[n] <= most)
            s->triangle[(*past)++] = s->triangle[n];
    return 0;
}

/* One of the eight parts of a box; false where there is none, as along a side of one cell. */
static bool part_of(const box *b, int number, box *part)
{
    for (int a = 0; a < 3; a++) {
        int64_t middle = b->low[a] + (b->high[a] - b->low[a] + 1) / 2;
        part->low[a] = number >> a & 1 ? middle : b->low[a];
        part->high[a] = number >> a & 1 ? b->high[a] : middle;
        if (part->low[a] >= part->high[a])
            return false;
    }
    return true;
}

/* Box b, of whose triangles those from <= n < to may be nearest. */
static int look(search *s, const box *b, int64_t from, int64_t to, err *e) // NOLINT(misc-no-recursion): 31 deep at most
{
    const work *w = s->w;
    ball c = ball_of_box(w->g, b);
    bool single = b->high[0] - b->low[0] == 1 && b->high[1] - b->low[1] == 1 && b->high[2] - b->low[2] == 1;
    box part;
    int64_t past;
    if (from == to || !any_wanted(s, b))
        return 0;
    int64_t first = find_first(s, &c, from, to);
    double near = distance_of(s, &c, first), slack = slack_of(&c, near);
    uint8_t step = step_of(w, near + c.radius + slack + w->blur);
    const bool alike = step == step_of(w, s->least[first] - c.radius - slack - w->blur);
    if (!alike && single)
        step = w->samples ? find_sample(s, b, &c, first, from, to) : find_step(s, &c, near, from, to);
    if (alike || single) {
        fill_box(s, b, step);
        return 0;
    }
    if (keep_near(s, fmin(near + 2 * c.radius, deepest(w) + c.radius) + slack, from, to, &past, e))
        return -1;
    for (int n = 0; n < 8; n++)
        if (part_of(b, n, &part) && look(s, &part, to, past, e))
            return -1;
    return 0;
}

/* ---- rows of units */

static int look_unit(search *s, const box *b, err *e)
{
    const work *w = s->w;
    int64_t bin = bin_at(w, b->low), count = w->start[bin + 1] - w->start[bin];
    if (count == 0)
        return 0;
    if (MEM_ROOM(&s->triangle, &s->triangle_capacity, count, "triangles", e) ||
        MEM_ROOM(&s->least, &s->least_capacity, count, "triangles", e) || !s->triangle || !s->least)
        return -1;
    memcpy(s->triangle, w->triangle + w->start[bin], (size_t)count * sizeof *s->triangle);
    return look(s, b, 0, count, e);
}

/* Of such volumes' voxels in the row: wants the step of each, or gives it what was found. */
static void each_run(const search *s, bool give)
{
    const work *w = s->w;
    for (int64_t k = s->row.low[2]; k < s->row.high[2]; k++) {
        int64_t layer = k - w->layer->low, voxel = w->layer->voxel[layer];
        for (int64_t r = w->layer->run[layer]; r < w->layer->run[layer + 1]; r++) {
            const climb_run *a = &w->x->run[r];
            size_t count = (size_t)(a->to - a->from);
            if (a->volume < w->volumes && a->j >= s->row.low[1] && a->j < s->row.high[1]) {
                uint8_t *cell = step_at(s, a->from, a->j, k);
                if (give)
                    memcpy(w->step + voxel, cell, count);
                else
                    memset(cell, 0, count);
            }
            voxel += (int64_t)count;
        }
    }
}

static int do_row(search *s, err *e)
{
    const work *w = s->w;
    int64_t unit = w->bin < UNIT ? w->bin : UNIT, cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= s->row.high[a] - s->row.low[a];
    s->step = mem_array(cells, 1, "depths", e);
    if (!s->step)
        return -1;
    memset(s->step, DEPTHS_UNWANTED, (size_t)cells);
    each_run(s, false);
    for (int64_t i = s->row.low[0]; i < s->row.high[0]; i += unit) {
        box b = s->row;
        b.low[0] = i;
        b.high[0] = i + unit < b.high[0] ? i + unit : b.high[0];
        if (look_unit(s, &b, e))
            return -1;
    }
    each_run(s, true);
    return 0;
}

static void do_rows(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    err e = {0};
    int64_t unit = w->bin < UNIT ? w->bin : UNIT;
    for (int64_t n = from; n < to; n++) {
        const int64_t at[3] = {0, n % w->units[1], n / w->units[1]};
        search s = {.w = w, .row = w->all};
        for (int a = 1; a < 3; a++) {
            s.row.low[a] = w->all.low[a] + at[a] * unit;
            s.row.high[a] = s.row.low[a] + unit < w->all.high[a] ? s.row.low[a] + unit : w->all.high[a];
        }
        if (do_row(&s, &e))
            atomic_store(&w->failed, true);
        free(s.step);
        free(s.triangle);
        free(s.least);
    }
}

/* The cells of all such voxels; false where there is none. */
static bool find_all(work *w)
{
    box *b = &w->all;
    for (int a = 0; a < 3; a++)
        b->low[a] = INT64_MAX, b->high[a] = INT64_MIN;
    for (int64_t r = 0; r < w->x->runs; r++) {
        const climb_run *run = &w->x->run[r];
        const int64_t low[3] = {run->from, run->j, run->k};
        const int64_t high[3] = {run->to, (int64_t)run->j + 1, (int64_t)run->k + 1};
        for (int a = 0; run->volume < w->volumes && a < 3; a++) {
            b->low[a] = low[a] < b->low[a] ? low[a] : b->low[a];
            b->high[a] = high[a] > b->high[a] ? high[a] : b->high[a];
        }
    }
    return b->low[0] < b->high[0];
}

static int make_bins(work *w, err *e)
{
    if (w->s->triangles > UINT32_MAX)
        return err_set(e, NULL, 0, "%lld triangles; at most %u are possible", (long long)w->s->triangles, UINT32_MAX);
    choose_bins(w);
    return fill_bins(w, e);
}

static void free_bins(work *w)
{
    free(w->ball);
    free(w->start);
    free(w->triangle);
}

// NOLINTNEXTLINE(readability-non-const-parameter): it is written to
int depths_find(uint8_t *step, const double *depth, int64_t count, const voxels *x, const voxels_layers *layer,
                int32_t volumes, const depths_surface *s, const grid *g, pool *threads, err *e)
{
    work w = {
        .step = step, .depth = depth, .depths = count, .x = x, .layer = layer, .volumes = volumes, .s = s, .g = g};
    if (!find_all(&w))
        return 0;
    int status = make_bins(&w, e);
    if (!status) {
        pool_run(threads, w.units[1] * w.units[2], 1, do_rows, &w);
        status = atomic_load(&w.failed) ? err_memory(e, "depths") : 0;
    }
    free_bins(&w);
    return status;
}

/* ---- some cells at a time */

depths *depths_create(const double *depth, int64_t count, const depths_surface *s, const grid *g, int samples, err *e)
{
    work *w = mem_array(1, sizeof *w, "depths", e);
    if (!w)
        return NULL;
    const double *h = g->spacing;
    *w = (work){.depth = depth, .depths = count, .s = s, .g = g, .samples = samples};
    w->blur = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int a = 0; a < 3; a++)
        w->all.low[a] = g->low[a], w->all.high[a] = g->high[a];
    make_spread(w);
    if (!make_bins(w, e))
        return w;
    depths_destroy(w);
    return NULL;
}

void depths_destroy(depths *d)
{
    if (d)
        free_bins(d);
    free(d);
}

/* Where a box that begins at `from` ends along an axis: with it, its bin, or a unit further. */
static int64_t end_of(const work *w, int a, int64_t from, int64_t high)
{
    const int64_t of_bin = w->all.low[a] + ((from - w->all.low[a]) / w->bin + 1) * w->bin, end = from + UNIT;
    const int64_t nearer = of_bin < end ? of_bin : end;
    return high < nearer ? high : nearer;
}

// NOLINTNEXTLINE(readability-non-const-parameter): it is written to
int depths_look(const depths *d, const int64_t low[3], const int64_t high[3], uint8_t *step, err *e)
{
    search s = {.w = d, .row = {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, .step = step};
    box b;
    int status = 0;
    for (b.low[2] = low[2]; b.low[2] < high[2]; b.low[2] = b.high[2]) {
        b.high[2] = end_of(d, 2, b.low[2], high[2]);
        for (b.low[1] = low[1]; b.low[1] < high[1]; b.low[1] = b.high[1]) {
            b.high[1] = end_of(d, 1, b.low[1], high[1]);
            for (b.low[0] = low[0]; b.low[0] < high[0] && !status; b.low[0] = b.high[0]) {
                b.high[0] = end_of(d, 0, b.low[0], high[0]);
                status = look_unit(&s, &b, e);
            }
        }
    }
    free(s.triangle);
    free(s.least);
    return status;
}
