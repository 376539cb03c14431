#include "voxelise/shares.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- moments */

/* Of a row of samples at places b along y and c along z, a run adds to each voxel's sums
 *     n w and X w,   w = 1, b, c, b c,
 * n its samples there and X the sum of their places along x. Where a run fills a voxel's row from end to end, n is
 * constant and X is 0: so what begins and ends is enough. Rows of numbers: of each w but 1 (whose n is the share's)
 * what n begins to be, and what is left over of it in its first and last voxel; then of each w X. As w for the faces
 * across y and z: 1 at the high side, -1 at the low, else 0; last, of the faces across x the samples themselves. */
enum { WEIGHTS = 5, BEGINS = 0, LEFT = WEIGHTS, ALONG = 2 * WEIGHTS, ENDS = ALONG + 4, MOMENTS_ROWS };

static int64_t floor_mod(int64_t a, int64_t b)
{
    return (a % b + b) % b;
}

/* A sample's place, from -(samples - 1) to samples - 1. */
static int32_t place_of(int64_t at, int samples)
{
    return (int32_t)(2 * floor_mod(at, samples) + 1 - samples);
}

/* Of a place: whether it is at the high side of its voxel, less whether it is at the low. */
static int32_t face_of(int32_t place, int samples)
{
    return (place == samples - 1) - (place == 1 - samples);
}

int moments_create(moments *m, int samples, int64_t low, int64_t cells, err *e)
{
    *m = (moments){.samples = samples, .low = low, .cells = cells};
    m->sum = mem_array(cells + 1, MOMENTS_ROWS * sizeof *m->sum, "a row", e);
    return m->sum ? 0 : -1;
}

void moments_free(moments *m)
{
    free(m->sum);
    *m = (moments){0};
}

static int32_t *row_of(const moments *m, int row)
{
    return m->sum + row * (m->cells + 1);
}

void moments_add(moments *m, const climb_run *run)
{
    const int32_t n = m->samples, b = place_of(run->j, n), c = place_of(run->k, n), w[4] = {b, c, b * c, 1},
                  by[WEIGHTS] = {b, c, b * c, face_of(b, n), face_of(c, n)};
    const int64_t from = run->from - m->low * n, to = run->to - m->low * n;
    const int32_t in = (int32_t)(from % n), out = (int32_t)(to % n);
    for (int i = 0; i < WEIGHTS; i++) {
        row_of(m, BEGINS + i)[from / n] += n * by[i];
        row_of(m, LEFT + i)[from / n] -= in * by[i];
        row_of(m, BEGINS + i)[to / n] -= n * by[i];
        row_of(m, LEFT + i)[to / n] += out * by[i];
    }
    row_of(m, ENDS)[from / n] += in > 0;
    row_of(m, ENDS)[to / n] -= out > 0;
    for (int i = 0; i < 4;
         i++) { /* the places from `in` on have the sum in (n - in); those up to `out` -out (n - out) */
        row_of(m, ALONG + i)[from / n] += in * (n - in) * w[i];
        row_of(m, ALONG + i)[to / n] -= out * (n - out) * w[i];
    }
}

void moments_close(moments *m, int64_t from, int64_t past)
{
    for (int r = 0; r < WEIGHTS; r++) {
        int32_t *begins = row_of(m, BEGINS + r), running = 0;
        for (int64_t i = from; i < past; i++) {
            running += begins[i];
            begins[i] = running + row_of(m, LEFT + r)[i];
        }
    }
}

moments_sums moments_at(const moments *m, int64_t i, int64_t count)
{
    const moments_sums s = {count,
                            {row_of(m, ALONG + 3)[i], row_of(m, BEGINS)[i], row_of(m, BEGINS + 1)[i],
                             row_of(m, ALONG)[i], row_of(m, BEGINS + 2)[i], row_of(m, ALONG + 1)[i],
                             row_of(m, ALONG + 2)[i]},
                            {row_of(m, ENDS)[i], row_of(m, BEGINS + 3)[i], row_of(m, BEGINS + 4)[i]}};
    return s;
}

void moments_forget(moments *m, int64_t from, int64_t past)
{
    for (int r = 0; r < MOMENTS_ROWS && from <= past; r++)
        memset(row_of(m, r) + from, 0, (size_t)(past - from + 1) * sizeof *m->sum);
}

void moments_add_sample(moments_sums *s, int samples, int i, int j, int k)
{
    const int64_t x = place_of(i, samples), y = place_of(j, samples), z = place_of(k, samples);
    const int64_t of[CUT_MOMENTS] = {x, y, z, x * y, y * z, z * x, x * y * z};
    s->count++;
    for (int n = 0; n < CUT_MOMENTS; n++)
        s->of[n] += of[n];
}

int moments_list_add(moments_list *to, int64_t element, const moments_sums *s, int samples, err *e)
{
    static const int factors[CUT_MOMENTS] = {1, 1, 1, 2, 2, 2, 3};
    const int64_t n = samples;
    if (s->count == n * n * n)
        return 0;
    if (mem_grow(&to->voxel, &to->capacity, to->count + 1, sizeof *to->voxel, "moments of voxels", e))
        return -1;
    moments_voxel *v = &to->voxel[to->count++];
    v->element = element;
    for (int i = 0; i < CUT_MOMENTS; i++)
        v->of[i] =
            (float)((double)s->of[i] / (double)(s->count * n * (factors[i] > 1 ? n : 1) * (factors[i] > 2 ? n : 1)));
    for (int a = 0; a < 3; a++)
        v->faces[a] = (float)((double)s->faces[a] / (double)(n * n));
    return 0;
}

int moments_list_join(moments_list *to, const moments_list *from, int64_t element, err *e)
{
    if (!from->count)
        return 0;
    if (mem_grow(&to->voxel, &to->capacity, to->count + from->count, sizeof *to->voxel, "moments of voxels", e))
        return -1;
    for (int64_t i = 0; i < from->count; i++) {
        to->voxel[to->count] = from->voxel[i];
        to->voxel[to->count++].element += element;
    }
    return 0;
}

/* ---- shares */

int shares_create(shares *s, const grid *g, const shares_rule *rule, int32_t volumes, err *e)
{
    *s = (shares){.rule = *rule, .low = g->low[0] / rule->samples, .cells = grid_cells(g, 0) / rule->samples};
    s->from = s->cells;
    s->slot = mem_array(volumes, sizeof *s->slot, "volumes", e);
    return s->slot && !(rule->moments && moments_create(&s->moment, rule->samples, s->low, s->cells, e)) ? 0 : -1;
}

void shares_list_free(shares_list *l)
{
    free(l->voxel);
    free(l->cut.voxel);
    free(l->border.voxel);
    *l = (shares_list){0};
}

void shares_free(shares *s)
{
    free(s->slot);
    free(s->volume);
    free(s->sum);
    moments_free(&s->moment);
    for (int64_t n = 0; n < s->parts; n++)
        moments_free(&s->part[n]);
    free(s->part);
    *s = (shares){0};
}

/* What a further slot counts its samples' moments in. */
static int grow_parts(shares *s, err *e)
{
    if (!s->rule.borders || s->parts > s->slots)
        return 0;
    if (mem_grow(&s->part, &s->part_capacity, s->parts + 1, sizeof *s->part, "moments of voxels", e) ||
        moments_create(&s->part[s->parts], s->rule.samples, s->low, s->cells, e))
        return -1;
    s->parts++;
    return 0;
}

/* The sums of a volume: of whole voxels' samples, then of what is left over. NULL with e filled. */
static int32_t *sums_of(shares *s, int32_t volume, err *e)
{
    int64_t size = 2 * (s->cells + 1);
    if (!s->slot[volume]) {
        if (mem_grow(&s->volume, &s->volume_capacity, s->slots + 1, sizeof *s->volume, "volumes", e) ||
            mem_grow(&s->sum, &s->sum_capacity, (s->slots + 1) * size, sizeof *s->sum, "a row", e) || grow_parts(s, e))
            return NULL;
        memset(&s->sum[s->slots * size], 0, (size_t)size * sizeof *s->sum);
        s->volume[s->slots] = volume;
        s->slot[volume] = (int32_t)++s->slots;
    }
    return &s->sum[(s->slot[volume] - 1) * size];
}

int shares_add(shares *s, const climb_run *run, err *e)
{
    int32_t *whole = sums_of(s, run->volume, e), samples = s->rule.samples;
    if (!whole)
        return -1;
    int32_t *left = whole + s->cells + 1;
    int64_t from = run->from - s->low * samples, to = run->to - s->low * samples;
    whole[from / samples] += samples;
    left[from / samples] -= (int32_t)(from % samples);
    whole[to / samples] -= samples;
    left[to / samples] += (int32_t)(to % samples);
    if (s->rule.moments)
        moments_add(&s->moment, run);
    if (s->rule.borders)
        moments_add(&s->part[s->slot[run->volume] - 1], run);
    s->from = from / samples < s->from ? from / samples : s->from;
    s->past = (to - 1) / samples + 1 > s->past ? (to - 1) / samples + 1 : s->past;
    return 0;
}

/* Makes the sums of one volume counts: samples of it in each voxel. */
static void count_samples(const shares *s, int32_t *whole)
{
    int32_t *left = whole + s->cells + 1, running = 0;
    for (int64_t i = s->from; i < s->past; i++) {
        running += whole[i];
        whole[i] = running + left[i];
    }
}

static int add_voxel(climb_runs *to, int64_t first, climb_run voxel, err *e)
{
    climb_run *last = to->runs > first ? &to->run[to->runs - 1] : NULL;
    if (!last || last->to != voxel.from || last->volume != voxel.volume)
        return climb_add_run(to, voxel, e);
    last->to = voxel.to;
    return 0;
}

static void forget(shares *s)
{
    for (int64_t n = 0; n < s->slots; n++)
        s->slot[s->volume[n]] = 0;
    for (int64_t n = 0; s->rule.borders && n < s->slots; n++)
        moments_forget(&s->part[n], s->from, s->past);
    s->slots = 0;
    if (s->rule.moments)
        moments_forget(&s->moment, s->from, s->past);
    s->from = s->cells;
    s->past = 0;
}

/* The slot that has the most samples of voxel i, of two the first volume's; but for one. -1: none has any. */
static int64_t largest(const shares *s, int64_t i, int64_t but)
{
    int64_t size = 2 * (s->cells + 1), best = -1;
    for (int64_t n = 0; n < s->slots; n++) {
        int32_t here = s->sum[n * size + i], most = best < 0 ? 0 : s->sum[best * size + i];
        if (n != but && (here > most || (here > 0 && here == most && s->volume[n] < s->volume[best])))
            best = n;
    }
    return best;
}

static int64_t total(const shares *s, int64_t i)
{
    int64_t sum = 0;
    for (int64_t n = 0; n < s->slots; n++)
        sum += s->sum[n * 2 * (s->cells + 1) + i];
    return sum;
}

/* Whether a part of a voxel is what lies beyond a plane: by how far its middle is from the voxel's across its border,
 * which of half a voxel is half of a side; of a band through the middle, or two corners, it is next to nothing. */
static bool is_beyond_plane(const moments_sums *s, int samples)
{
    const double n = samples, share = (double)s->count / (n * n * n);
    double length = 0, way = 0;
    for (int a = 0; a < 3; a++) {
        length += (double)(s->faces[a] * s->faces[a]);
        way += (double)(s->faces[a] * s->of[a]) / (n * (double)s->count);
    }
    return way > .6 * (1 - share) * sqrt(length) && length > 0;
}

/* Of a voxel that two volumes fill. */
static int add_border(const shares *s, int64_t i, int64_t second, int64_t samples, shares_list *list, err *e)
{
    const moments_sums sums = moments_at(&s->part[second], i, samples);
    if (!is_beyond_plane(&sums, s->rule.samples))
        return 0;
    return moments_list_add(&list->border, list->count - 1, &sums, s->rule.samples, e);
}

/* Voxel i of a row, in which so many samples are. */
static int add_share(shares *s, int64_t i, climb_run at, int64_t samples, shares_list *list, climb_count *kept, err *e)
{
    int64_t size = 2 * (s->cells + 1), first = largest(s, i, -1), second = largest(s, i, first);
    shares_voxel voxel = {(float)((double)samples / pow(s->rule.samples, 3)), 0, -1};
    if (second >= 0) {
        double own = s->sum[first * size + i], other = s->sum[second * size + i];
        voxel.mix = s->volume[second];
        voxel.mixture = (float)(other / (own + other));
        kept[voxel.mix].mixed++;
    }
    if (mem_grow(&list->voxel, &list->capacity, list->count + 1, sizeof *list->voxel, "voxels", e))
        return -1;
    list->voxel[list->count++] = voxel;
    kept[at.volume].kept++;
    if (s->rule.borders && second >= 0 && (double)samples == pow(s->rule.samples, 3) &&
        s->sum[first * size + i] + s->sum[second * size + i] == samples &&
        add_border(s, i, second, s->sum[second * size + i], list, e))
        return -1;
    if (!s->rule.moments)
        return 0;
    const moments_sums sums = moments_at(&s->moment, i, samples);
    return moments_list_add(&list->cut, list->count - 1, &sums, s->rule.samples, e);
}

int shares_row(shares *s, int64_t j, int64_t k, climb_runs *to, shares_list *list, climb_count *kept, err *e)
{
    int64_t size = 2 * (s->cells + 1), first = to->runs;
    double all = pow(s->rule.samples, 3);
    for (int64_t n = 0; n < s->slots; n++)
        count_samples(s, &s->sum[n * size]);
    if (s->rule.moments)
        moments_close(&s->moment, s->from, s->past);
    for (int64_t n = 0; s->rule.borders && n < s->slots; n++)
        moments_close(&s->part[n], s->from, s->past);
    for (int64_t i = s->from; i < s->past; i++) {
        int64_t samples = total(s, i);
        if (samples == 0 || (double)samples < s->rule.least * all)
            continue;
        int32_t at = (int32_t)(s->low + i);
        climb_run voxel = {at, at + 1, (int32_t)j, (int32_t)k, s->volume[largest(s, i, -1)]};
        if (add_share(s, i, voxel, samples, list, kept, e) || add_voxel(to, first, voxel, e))
            return -1;
    }
    forget(s);
    return 0;
}
