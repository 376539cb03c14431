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

/* Adds means over what so many samples are, from sums, and its faces. */
static int put_moments(moments_list *to, int64_t element, double count, const double of[CUT_MOMENTS],
                       const double faces[3], int samples, err *e)
{
    const double n = samples, factor[CUT_MOMENTS] = {n, n, n, n * n, n * n, n * n, n * n * n};
    if (mem_grow(&to->voxel, &to->capacity, to->count + 1, sizeof *to->voxel, "moments of voxels", e))
        return -1;
    moments_voxel *v = &to->voxel[to->count++];
    v->element = element;
    for (int i = 0; i < CUT_MOMENTS; i++)
        v->of[i] = (float)(of[i] / (count * factor[i]));
    for (int a = 0; a < 3; a++)
        v->faces[a] = (float)(faces[a] / (n * n));
    return 0;
}

int moments_list_add(moments_list *to, int64_t element, const moments_sums *s, int samples, err *e)
{
    const int64_t n = samples;
    double of[CUT_MOMENTS], faces[3];
    if (s->count == n * n * n)
        return 0;
    for (int i = 0; i < CUT_MOMENTS; i++)
        of[i] = (double)s->of[i];
    for (int a = 0; a < 3; a++)
        faces[a] = (double)s->faces[a];
    return put_moments(to, element, (double)s->count, of, faces, samples, e);
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

/* ---- borders */

/* Measures how far a part of a voxel is what lies beyond a plane: from 1 on it is. It goes by how far the part's middle
 * is from the voxel's across its border: for half a voxel that is half of a side; for a band through the middle, or two
 * corners, it is next to nothing. */
static double beyond_plane(const moments_sums *s, int samples)
{
    const double n = samples, share = (double)s->count / (n * n * n);
    double length = 0, way = 0;
    for (int a = 0; a < 3; a++) {
        length += (double)(s->faces[a] * s->faces[a]);
        way += (double)(s->faces[a] * s->of[a]) / (n * (double)s->count);
    }
    return length > 0 ? way / (.6 * (1 - share) * sqrt(length)) : 0;
}

/* The two volumes that a voxel is mixed of, as slots; second -1: one alone. */
typedef struct pair {
    int64_t first, second;
    double mixture;         /* the second's share */
    int64_t among;          /* beside a muscle: the slot whose samples those of all layers count as; else -1 */
    bool divided;           /* samples of others are divided between the two by moduli */
    double modulus, across; /* then: the first's, and what the second's is more */
} pair;

static int32_t samples_of(const shares *s, int64_t slot, int64_t i)
{
    return s->sum[slot * 2 * (s->cells + 1) + i];
}

/* How deep a volume's samples are among others of a voxel: those of layers by their numbers, those of level 0 below
 * all; -1: of neither. */
static int32_t depth_of(const shares *s, int64_t slot)
{
    const int32_t volume = s->volume[slot];
    if (!s->rule.modulus || isnan(s->rule.modulus[volume]))
        return -1;
    return volume < s->rule.lowest ? s->rule.layers : volume - s->rule.lowest;
}

/* The deepest of a voxel's volumes; -1: some is neither a layer nor below, or two are below. */
static int64_t deepest(const shares *s, int64_t i)
{
    int64_t best = -1;
    for (int64_t n = 0; n < s->slots; n++) {
        if (!samples_of(s, n, i))
            continue;
        if (depth_of(s, n) < 0 || (best >= 0 && depth_of(s, n) == depth_of(s, best)))
            return -1;
        best = best < 0 || depth_of(s, n) > depth_of(s, best) ? n : best;
    }
    return best;
}

/* The stiffest slot of a voxel (sign 1), or the softest (-1); of equal ones the first volume's. */
static int64_t extreme(const shares *s, int64_t i, double sign)
{
    int64_t best = -1;
    for (int64_t n = 0; n < s->slots; n++) {
        if (!samples_of(s, n, i))
            continue;
        const double more = best < 0 ? 1 : sign * (s->rule.modulus[s->volume[n]] - s->rule.modulus[s->volume[best]]);
        if (more > 0 || (more == 0 && s->volume[n] < s->volume[best]))
            best = n;
    }
    return best;
}

/* The part of a slot's samples that counts as the second volume's. */
static double part_of_second(const shares *s, const pair *p, int64_t slot)
{
    if (p->divided)
        return (s->rule.modulus[s->volume[slot]] - p->modulus) / p->across;
    return slot == p->second || (p->among >= 0 && p->among == p->second && depth_of(s, slot) >= 0);
}

/* Of three layers and more. False: the stiffest and the softest are alike. */
static bool divide(const shares *s, int64_t i, int64_t samples, pair *p)
{
    const int64_t stiff = extreme(s, i, 1), soft = extreme(s, i, -1);
    const double high = s->rule.modulus[s->volume[stiff]], low = s->rule.modulus[s->volume[soft]];
    double sum = 0;
    if (!(high > low))
        return false;
    *p = (pair){soft, stiff, 0, -1, true, low, high - low};
    for (int64_t n = 0; n < s->slots; n++)
        sum += samples_of(s, n, i) ? samples_of(s, n, i) * part_of_second(s, p, n) : 0;
    p->mixture = sum / (double)samples;
    if (p->mixture > .5 || (p->mixture == .5 && s->volume[stiff] < s->volume[soft]))
        *p = (pair){stiff, soft, 1 - p->mixture, -1, true, high, low - high};
    return true;
}

/* Where something that is no layer lies among layers, as a muscle: that and the largest layer, as which all count, or
 * what is below them. False: there are none of the one or the other, or a second muscle has more than all layers. */
static bool gather(const shares *s, int64_t i, pair *p)
{
    int64_t other = -1, layer = -1;
    double count = 0;
    if (!s->rule.modulus)
        return false;
    for (int64_t n = 0; n < s->slots; n++) {
        const int32_t samples = samples_of(s, n, i);
        int64_t *best = depth_of(s, n) < 0 ? &other : &layer;
        count += depth_of(s, n) < 0 ? 0 : samples;
        if (samples && (*best < 0 || samples > samples_of(s, *best, i) ||
                        (samples == samples_of(s, *best, i) && s->volume[n] < s->volume[*best])))
            *best = n;
    }
    if (other < 0 || layer < 0)
        return false;
    const double own = samples_of(s, other, i);
    if (depth_of(s, p->first) < 0 && depth_of(s, p->second) < 0 && samples_of(s, p->second, i) > count)
        return false;
    *p = own > count ? (pair){.first = other, .second = layer, .mixture = count / (own + count)}
                     : (pair){.first = layer, .second = other, .mixture = own / (own + count)};
    p->among = layer;
    return true;
}

static pair find_pair(const shares *s, int64_t i, int64_t samples)
{
    pair p = {.first = largest(s, i, -1), .among = -1}, better;
    p.second = largest(s, i, p.first);
    if (p.second < 0 || gather(s, i, &p))
        return p;
    const double own = samples_of(s, p.first, i), other = samples_of(s, p.second, i);
    p.mixture = other / (own + other);
    if (s->rule.borders && own + other < (double)samples && deepest(s, i) >= 0 && divide(s, i, samples, &better))
        return better;
    return p;
}

/* Whether all of a voxel's samples are of the two. */
static bool has_all(const shares *s, int64_t i, const pair *p)
{
    for (int64_t n = 0; n < s->slots; n++)
        if (samples_of(s, n, i) && !p->divided && n != p->first && n != p->second &&
            (p->among < 0 || depth_of(s, n) < 0))
            return false;
    return true;
}

/* The part that its border alone bounds, within the voxel: what lies among layers; the deeper one of these; else, where
 * the outer surface is in the voxel too, the one that is beyond a plane. */
static int64_t inner_part(const shares *s, int64_t i, const pair *p, bool whole)
{
    const int64_t deep = deepest(s, i);
    if (p->among >= 0)
        return p->among == p->first ? p->second : p->first;
    if (deep >= 0 || whole)
        return deep >= 0 ? deep : p->second;
    const moments_sums first = moments_at(&s->part[p->first], i, samples_of(s, p->first, i)),
                       second = moments_at(&s->part[p->second], i, samples_of(s, p->second, i));
    return beyond_plane(&first, s->rule.samples) > beyond_plane(&second, s->rule.samples) ? p->first : p->second;
}

/* Of a voxel of two volumes. The normal points to the second: of layers, as the inner part lies beside its border. */
static int add_border(const shares *s, int64_t i, const pair *p, int64_t samples, shares_list *list, err *e)
{
    const bool whole = (double)samples == pow(s->rule.samples, 3);
    if ((!whole && !s->rule.moments) || !has_all(s, i, p))
        return 0;
    const int64_t inner = inner_part(s, i, p, whole);
    const moments_sums beyond = moments_at(&s->part[inner], i, samples_of(s, inner, i));
    const bool to_second = p->divided ? depth_of(s, p->second) > depth_of(s, p->first) : inner == p->second;
    double count = 0, of[CUT_MOMENTS] = {0}, faces[3];
    if (!(beyond_plane(&beyond, s->rule.samples) > 1))
        return 0;
    for (int64_t n = 0; n < s->slots; n++) {
        const double part = samples_of(s, n, i) ? part_of_second(s, p, n) : 0;
        if (part == 0)
            continue;
        const moments_sums sums = moments_at(&s->part[n], i, samples_of(s, n, i));
        count += part * (double)sums.count;
        for (int k = 0; k < CUT_MOMENTS; k++)
            of[k] += part * (double)sums.of[k];
    }
    for (int a = 0; a < 3; a++)
        faces[a] = to_second ? (double)beyond.faces[a] : -(double)beyond.faces[a];
    return put_moments(&list->border, list->count - 1, count, of, faces, s->rule.samples, e);
}

/* ---- voxels */

/* Counts the volumes whose samples a voxel divides between two others. */
static void count_divided(const shares *s, int64_t i, const pair *p, climb_count *kept)
{
    for (int64_t n = 0; n < s->slots; n++)
        kept[s->volume[n]].divided += p->divided && samples_of(s, n, i) && n != p->first && n != p->second;
}

/* Voxel i of a row, in which so many samples are. */
static int add_share(shares *s, int64_t i, const pair *p, int64_t samples, shares_list *list, climb_count *kept, err *e)
{
    shares_voxel voxel = {(float)((double)samples / pow(s->rule.samples, 3)), 0, -1};
    if (p->second >= 0) {
        voxel.mix = s->volume[p->second];
        voxel.mixture = (float)p->mixture;
        kept[voxel.mix].mixed++;
        count_divided(s, i, p, kept);
    }
    if (mem_grow(&list->voxel, &list->capacity, list->count + 1, sizeof *list->voxel, "voxels", e))
        return -1;
    list->voxel[list->count++] = voxel;
    kept[s->volume[p->first]].kept++;
    if (s->rule.borders && p->second >= 0 && add_border(s, i, p, samples, list, e))
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
        const pair p = find_pair(s, i, samples);
        const int32_t at = (int32_t)(s->low + i);
        const climb_run voxel = {at, at + 1, (int32_t)j, (int32_t)k, s->volume[p.first]};
        if (add_share(s, i, &p, samples, list, kept, e) || add_voxel(to, first, voxel, e))
            return -1;
    }
    forget(s);
    return 0;
}
