#include "voxelise/shares.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int shares_create(shares *s, const grid *g, const shares_rule *rule, int32_t volumes, err *e)
{
    *s = (shares){.rule = *rule, .low = g->low[0] / rule->samples, .cells = grid_cells(g, 0) / rule->samples};
    s->from = s->cells;
    s->slot = mem_array(volumes, sizeof *s->slot, "volumes", e);
    return s->slot ? 0 : -1;
}

void shares_free(shares *s)
{
    free(s->slot);
    free(s->volume);
    free(s->sum);
    *s = (shares){0};
}

/* The sums of a volume: of whole voxels' samples, then of what is left over. NULL with e filled. */
static int32_t *sums_of(shares *s, int32_t volume, err *e)
{
    int64_t size = 2 * (s->cells + 1);
    if (!s->slot[volume]) {
        if (mem_grow(&s->volume, &s->volume_capacity, s->slots + 1, sizeof *s->volume, "volumes", e) ||
            mem_grow(&s->sum, &s->sum_capacity, (s->slots + 1) * size, sizeof *s->sum, "a row", e))
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
    s->slots = 0;
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
    return 0;
}

int shares_row(shares *s, int64_t j, int64_t k, climb_runs *to, shares_list *list, climb_count *kept, err *e)
{
    int64_t size = 2 * (s->cells + 1), first = to->runs;
    double all = pow(s->rule.samples, 3);
    for (int64_t n = 0; n < s->slots; n++)
        count_samples(s, &s->sum[n * size]);
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
