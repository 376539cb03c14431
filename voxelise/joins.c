#include "voxelise/joins.h"

#include "base/mem.h"
#include "surface/hash.h"

#include <math.h>
#include <stdlib.h>

int joins_create(joins *j, const voxels *x, const cuts *cut, const inside_triangles *t, const grid *g, int samples,
                 err *e)
{
    *j = (joins){.x = x, .cut = cut, .samples = samples};
    if (voxels_find_layers(x, &j->layer, e))
        return -1;
    j->first = mem_array(x->runs + 1, sizeof *j->first, "runs of voxels", e);
    for (int64_t r = 0; j->first && r < x->runs; r++)
        j->first[r + 1] = j->first[r] + x->run[r].to - x->run[r].from;
    j->sight = j->first ? sight_create(t, g, samples, e) : NULL;
    if (j->sight)
        return 0;
    joins_free(j);
    return -1;
}

void joins_free(joins *j)
{
    voxels_layers_free(&j->layer);
    free(j->first);
    sight_destroy(j->sight);
    free(j->table);
    *j = (joins){0};
}

int64_t joins_element(const joins *j, const int32_t *cell)
{
    const int64_t layer = cell[2] - j->layer.low;
    if (layer < 0 || layer >= j->layer.count)
        return -1;
    int64_t low = j->layer.run[layer], high = j->layer.run[layer + 1];
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        const climb_run *r = &j->x->run[middle];
        if (r->j < cell[1] || (r->j == cell[1] && r->to <= cell[0]))
            low = middle + 1;
        else
            high = middle;
    }
    const climb_run *r = &j->x->run[low];
    if (low == j->layer.run[layer + 1] || r->j != cell[1] || r->from > cell[0])
        return -1;
    return j->first[low] + cell[0] - r->from;
}

/* ---- samples */

static bool has_sample(const joins *j, const joins_part *p, const int32_t *at)
{
    const int64_t n = j->samples, bit = (at[2] * n + at[1]) * n + at[0];
    if (!p->cell)
        return true;
    return j->x->part.bits[p->cell->bits + p->part * pieces_words(j->samples) + bit / 64] >> (bit % 64) & 1;
}

static double distance2(const int32_t *a, const double *b)
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* The sample of a part that is nearest to a place, in samples from the voxel's first; the first of several. */
static void nearest_sample(const joins *j, const joins_part *p, const double *place, int32_t *to)
{
    const int32_t n = j->samples;
    double least = INFINITY;
    int32_t at[3];
    for (at[2] = 0; at[2] < n; at[2]++)
        for (at[1] = 0; at[1] < n; at[1]++)
            for (at[0] = 0; at[0] < n; at[0]++)
                if (has_sample(j, p, at) && distance2(at, place) < least) {
                    least = distance2(at, place);
                    to[0] = at[0], to[1] = at[1], to[2] = at[2];
                }
}

double joins_distance2(const joins *j, const joins_part *p, const double *place)
{
    int32_t at[3] = {0};
    nearest_sample(j, p, place, at);
    return distance2(at, place);
}

void joins_middle(const joins *j, const joins_part *p, int32_t *to)
{
    const int32_t n = j->samples;
    double sum[3] = {0}, count = 0;
    int32_t at[3];
    for (at[2] = 0; at[2] < n; at[2]++)
        for (at[1] = 0; at[1] < n; at[1]++)
            for (at[0] = 0; at[0] < n; at[0]++)
                if (has_sample(j, p, at)) {
                    sum[0] += at[0], sum[1] += at[1], sum[2] += at[2];
                    count++;
                }
    for (int a = 0; a < 3; a++)
        sum[a] /= count;
    nearest_sample(j, p, sum, to);
}

/* The nearest sample of `other` to one of `one`. */
static void nearest_to(const joins *j, const joins_part *one, const int32_t *from, const joins_part *other, int32_t *to)
{
    double place[3];
    for (int a = 0; a < 3; a++)
        place[a] = from[a] + (double)(one->at[a] - other->at[a]) * j->samples;
    nearest_sample(j, other, place, to);
}

/* Whether two near samples of two parts see each other: those that are found by going from what both voxels share to
 * one part, from there to the other, and back. */
static bool see_each_other(const joins *j, const joins_part *one, const joins_part *other)
{
    double middle[3];
    int32_t from[3] = {0}, to[3] = {0};
    int64_t a[3], b[3];
    for (int i = 0; i < 3; i++)
        middle[i] = ((other->at[i] - one->at[i] + 1) * (double)j->samples - 1) / 2;
    nearest_sample(j, one, middle, from);
    nearest_to(j, one, from, other, to);
    nearest_to(j, other, to, one, from);
    for (int i = 0; i < 3; i++) {
        a[i] = (int64_t)one->at[i] * j->samples + from[i];
        b[i] = (int64_t)other->at[i] * j->samples + to[i];
    }
    return !sight_blocked(j->sight, a, b);
}

/* ---- faces */

/* The cuts through the face on the high side of a voxel along an axis: the first, and how many. */
static int64_t face_cuts(const joins *j, const int32_t *cell, int axis, int64_t *from)
{
    const cuts *c = j->cut;
    int64_t i = cuts_from(c, cell);
    while (i < c->count && !cuts_order(c->cut[i].cell, cell) && c->cut[i].axis < axis)
        i++;
    *from = i;
    while (i < c->count && !cuts_order(c->cut[i].cell, cell) && c->cut[i].axis == axis)
        i++;
    return i - *from;
}

static bool is_cut(const joins *j, int64_t from, int64_t count, const int32_t *at)
{
    const int32_t n = j->samples, sample = (at[2] * n + at[1]) * n + at[0];
    for (int64_t i = from; i < from + count; i++)
        if (j->cut->cut[i].sample == sample)
            return true;
    return false;
}

/* Whether samples next to each other join two voxels, the second after the first along the axis. */
static bool joined_by_samples(const joins *j, const joins_part *one, const joins_part *other, int axis)
{
    const int32_t n = j->samples;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int64_t from;
    const int64_t count = face_cuts(j, one->at, axis, &from);
    if (!count && !one->cell && !other->cell)
        return true;
    for (int32_t r = 0; r < n * n; r++) {
        int32_t a[3], b[3];
        a[u] = b[u] = r % n, a[v] = b[v] = r / n;
        a[axis] = n - 1, b[axis] = 0;
        if (!has_sample(j, one, a) || !has_sample(j, other, b))
            continue;
        if (!is_cut(j, from, count, a))
            return true;
    }
    return false;
}

/* Whether voxels share a face, and samples on either side of it join them: most do. */
static bool joined_by_face(const joins *j, const joins_part *one, const joins_part *other)
{
    int axis = -1, apart = 0;
    for (int a = 0; a < 3; a++)
        if (one->at[a] != other->at[a]) {
            axis = a;
            apart++;
        }
    if (apart != 1)
        return false;
    return one->at[axis] < other->at[axis] ? joined_by_samples(j, one, other, axis)
                                           : joined_by_samples(j, other, one, axis);
}

/* ---- what has been looked at */

static uint64_t hash_of(const joins_known *k)
{
    uint64_t h = hash_next(0, (uint64_t)k->one);
    h = hash_next(h, (uint64_t)k->other);
    return hash_next(h, (uint64_t)k->part << 32 | (uint64_t)k->other_part);
}

/* Where a pair is in the table, or may be put. */
static joins_known *slot_of(joins_known *table, int64_t size, const joins_known *k)
{
    uint64_t at = hash_of(k) & (uint64_t)(size - 1);
    while (table[at].one && (table[at].one != k->one || table[at].other != k->other || table[at].part != k->part ||
                             table[at].other_part != k->other_part))
        at = (at + 1) & (uint64_t)(size - 1);
    return &table[at];
}

/* Makes the table so large that at most half of it is filled. Where there is no memory it stays, and less is known. */
static bool make_room(joins *j)
{
    enum { LEAST = 1024 };
    err ignored = {0};
    const int64_t size = j->size ? 2 * j->size : LEAST;
    if (2 * (j->known + 1) <= j->size)
        return true;
    joins_known *table = mem_array(size, sizeof *table, "slits", &ignored);
    if (!table)
        return false;
    for (int64_t i = 0; i < j->size; i++)
        if (j->table[i].one)
            *slot_of(table, size, &j->table[i]) = j->table[i];
    free(j->table);
    j->table = table;
    j->size = size;
    return true;
}

/* Each pair is asked for at several points. Only what has to be seen is kept: the rest is found as quickly. */
bool joins_are_joined(joins *j, const joins_part *one, const joins_part *other)
{
    if (one->element > other->element || (one->element == other->element && one->part > other->part)) {
        const joins_part *swap = one;
        one = other, other = swap;
    }
    if (joined_by_face(j, one, other))
        return true;
    joins_known k = {one->element + 1, other->element + 1, one->part, other->part, false};
    if (!make_room(j))
        return see_each_other(j, one, other);
    joins_known *slot = slot_of(j->table, j->size, &k);
    if (!slot->one) {
        k.joined = see_each_other(j, one, other);
        *slot = k;
        j->known++;
    }
    return slot->joined;
}
