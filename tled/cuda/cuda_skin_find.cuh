/* Which samples of skin touch, on a card (cuda_skin.cuh): where nodes are, the table of elements, and samples, of which
 * a warp has one at a time. Included by cuda_skin.cuh alone.
 */
#ifndef SINEW_CUDA_SKIN_FIND_CUH
#define SINEW_CUDA_SKIN_FIND_CUH

#include "tled/cuda/cuda_skin_room.cuh"

/* Calls f with each of 0 to count - 1, in one thread of all blocks. */
template <class F> static __device__ void for_all(int64_t count, F f)
{
    for (int64_t i = blockIdx.x * SKIN_THREADS + threadIdx.x; i < count; i += gridDim.x * SKIN_THREADS)
        f(i);
}

/* ---- where nodes are */

static __device__ void move_solids(const cuda_touch &k, int odd)
{
    const cuda_skin &s = k.skin;
    const int32_t i = (int32_t)threadIdx.x;
    if (blockIdx.x || i >= s.c.solids)
        return;
    const sliding_field *f = &s.ground.field[s.c.solid[i]];
    const sliding_bone is = sliding_bone_of(f, k.next),
                       was = k.anew ? sliding_bone_of(f, k.now) : s.all->solid_was[odd][i];
    s.all->solid_drift[!odd][i] =
        (k.anew ? 0 : s.all->solid_drift[odd][i]) + contact_bone_way(f, s.ground.spacing, &was, &is);
    s.all->solid_was[!odd][i] = is;
}

static __device__ void gather(const cuda_touch &k, int odd)
{
    const cuda_skin &s = k.skin;
    double most = 0, listed = 0;
    for_all(s.c.nodes, [&](int64_t i) {
        real u[3];
        double square = 0, way = 0;
        cuda_three<false>(k.view, k.to, s.node[i].stand, u);
        for (int a = 0; a < 3; a++) {
            const double to = s.node[i].position[a] + (double)u[a], was = s.x[3 * i + a], then = s.listed[3 * i + a];
            square += (to - was) * (to - was);
            way += (to - then) * (to - then);
            s.x[3 * i + a] = to;
        }
        most = fmax(most, square);
        listed = fmax(listed, way == way ? way : INFINITY);
    });
    if (k.anew) {
        for_all(s.c.samples, [&](int64_t i) { s.until[i] = 0; });
        for_all(s.c.solids * s.c.samples, [&](int64_t i) { s.bone_until[i] = 0; });
    }
    raise_most(most, &s.all->most[odd]);
    raise_most(listed, &s.all->listed[odd]);
    move_solids(k, odd);
}

/* ---- the table */

/* Calls f with each of 0 to count - 1: each warp with one, and then that which is free first; ticket: 0 at first. */
template <class F> static __device__ void for_warps(int32_t count, int32_t *ticket, skin_desk *desk, F f)
{
    const int lane = (int)threadIdx.x % 32;
    const int32_t warps = (int32_t)gridDim.x * SKIN_WARPS;
    for (int32_t i = warp_number(gridDim.x); i < count;) {
        f(i, lane);
        i = count > warps ? warps + warp_slots(ticket, 1, lane, desk) : count;
    }
}

static __device__ void warp_place(const cuda_skin &s, int64_t sample, int lane, double *x)
{
    const int32_t first = s.c.lever_start[sample], end = s.c.lever_start[sample + 1];
    x[0] = x[1] = x[2] = 0;
#pragma unroll
    for (int j = 0; j < BLEND_MOST / 32; j++) {
        const int32_t i = first + lane + 32 * j, node = i < end ? s.c.lever_node[i] : 0;
        const double share = i < end ? s.c.lever_share[i] : 0;
        for (int a = 0; a < 3; a++)
            x[a] += share * s.x[3 * (int64_t)node + a];
    }
    warp_sums(x, 3);
}

static __device__ void list_boxes(const cuda_skin &s)
{
    double longest = 0, widest = 0;
    for_all(s.c.elements, [&](int64_t i) {
        contact_box(&s.c, s.x, &s.table, i);
        const double length = contact_longest(s.table.low + 3 * i, s.table.high + 3 * i);
        longest = fmax(longest, length);
        widest = fmax(widest, contact_longest(s.table.sampled + 6 * i, s.table.sampled + 6 * i + 3));
        for (int k = 0; k < CONTACT_SIZES && length > contact_size(&s.c, k); k++)
            atomicAdd(&s.all->longer[k], 1);
    });
    raise_most(longest, &s.all->longest);
    raise_most(widest, &s.all->widest);
}

/* The cells about the samples of element i, and then the large elements, as a warp goes through them: where those of
 * each begin, and how many are in those before. Returns how many there are. */
static __device__ int warp_cells(const cuda_skin &s, double side, int64_t i, int lane, skin_desk *desk)
{
    const contact_table *t = &s.table;
    const double *box = t->sampled + 6 * i;
    const int32_t cell = lane < CONTACT_CELLS ? contact_cell(t, side, box, box + 3, lane) : -1;
    __syncwarp();
    desk->cell[lane] = cell;
    __syncwarp();
    const int32_t large = s.all->large;
    int filled = cell >= 0 ? t->filled[cell] : 0, start = filled ? t->start[cell] : 0, before = 0;
    for (int n = 0; n < lane && cell >= 0; n++)
        filled = desk->cell[n] == cell ? 0 : filled;
    if (lane == CONTACT_CELLS)
        filled = large, start = (int32_t)s.c.elements - large;
    desk->filled[lane] = filled;
    desk->start[lane] = start;
    if (lane == 0)
        desk->count = 0;
    __syncwarp();
    for (int n = 0; n < lane; n++)
        before += desk->filled[n];
    __syncwarp();
    desk->filled[lane] = before;
    __syncwarp();
    return desk->filled[31];
}

/* Adds what samples of element i may be in to the warp's list, in any order. */
static __device__ void warp_candidates(const cuda_skin &s, int64_t i, int all, int lane, skin_desk *desk)
{
    enum { AHEAD = 4 }; /* asked for at once */
    const contact_table *t = &s.table;
    double box[6];
    for (int a = 0; a < 6; a++)
        box[a] = t->sampled[6 * i + a];
    for (int first = lane, n = 0; first < all; first += 32 * AHEAD) {
        int32_t other[AHEAD];
        bool near[AHEAD];
#pragma unroll
        for (int k = 0; k < AHEAD; k++) {
            const int j = first + 32 * k;
            while (j < all && desk->filled[n + 1] <= j)
                n++;
            other[k] = j < all ? t->of[desk->start[n] + j - desk->filled[n]] : -1;
        }
#pragma unroll
        for (int k = 0; k < AHEAD; k++)
            near[k] = other[k] >= 0 && contact_meets(t, box, other[k]);
#pragma unroll
        for (int k = 0; k < AHEAD; k++)
            if (near[k] && contact_may_touch(&s.c, t, (int32_t)i, other[k])) {
                const int at = atomicAdd(&desk->count, 1);
                if (at < SKIN_LISTED)
                    desk->list[at] = other[k];
            }
    }
}

/* As contact_list: an element goes to its place among all. */
static __device__ void warp_list(const cuda_skin &s, double side, int64_t i, int lane, skin_desk *desk)
{
    const contact_table *t = &s.table;
    warp_candidates(s, i, warp_cells(s, side, i, lane, desk), lane, desk);
    __syncwarp();
    const int count = desk->count;
    for (int j = lane; j < count && count <= SKIN_LISTED; j += 32) {
        const int32_t own = desk->list[j];
        int before = 0;
        for (int k = 0; k < count; k++)
            before += desk->list[k] < own;
        if (before < CONTACT_CANDIDATES)
            t->candidate[CONTACT_CANDIDATES * i + before] = own;
    }
    if (lane == 0 && count <= SKIN_LISTED) {
        t->count[i] = count < CONTACT_CANDIDATES ? count : CONTACT_CANDIDATES;
        if (count > CONTACT_CANDIDATES)
            t->crowded[i] = 1;
    }
    if (lane == 0 && count > SKIN_LISTED)
        contact_list(&s.c, t, side, s.all->large, i);
}

static __device__ void list_elements(const cuda_touch &k, uint32_t *phase, skin_desk *desk)
{
    const cuda_skin &s = k.skin;
    const contact_table *t = &s.table;
    for_all(t->cells, [&](int64_t i) { t->filled[i] = s.taken[i] = 0; });
    for_all(3 * s.c.nodes, [&](int64_t i) { s.listed[i] = s.x[i]; });
    for (int64_t i = warp_number(gridDim.x); i < s.c.samples; i += (int64_t)gridDim.x * SKIN_WARPS) {
        double x[3];
        warp_place(s, i, (int)threadIdx.x % 32, x);
        if (threadIdx.x % 32 < 3)
            t->at[3 * i + threadIdx.x % 32] = x[threadIdx.x % 32];
    }
    all_wait(k, phase, gridDim.x);
    list_boxes(s);
    all_wait(k, phase, gridDim.x);
    const double largest = contact_largest(&s.c, of_bits(s.all->longest), s.all->longer);
    const double side = contact_side(&s.c, largest, of_bits(s.all->widest));
    for_all(s.c.elements, [&](int64_t i) {
        const double *low = t->low + 3 * i, *high = t->high + 3 * i;
        const int32_t cell = contact_longest(low, high) > largest ? -1 : contact_cell(t, side, low, high, CONTACT_HERE);
        t->cell[i] = cell;
        t->count[i] = 0;
        if (cell >= 0)
            atomicAdd(&t->filled[cell], 1);
        else
            t->of[s.c.elements - 1 - atomicAdd(&s.all->large, 1)] = (int32_t)i;
    });
    all_wait(k, phase, gridDim.x);
    for_all(t->cells, [&](int64_t i) {
        if (t->filled[i])
            t->start[i] = atomicAdd(&s.all->filled, t->filled[i]);
    });
    all_wait(k, phase, gridDim.x);
    for_all(s.c.elements, [&](int64_t i) {
        const int32_t cell = t->cell[i];
        if (cell >= 0)
            t->of[t->start[cell] + atomicAdd(&s.taken[cell], 1)] = (int32_t)i;
    });
    all_wait(k, phase, gridDim.x);
    for_warps(s.owners, &s.all->listing, desk,
              [&](int32_t i, int lane) { warp_list(s, side, s.owner[i], lane, desk); });
    all_wait(k, phase, gridDim.x);
}

/* ---- a sample, by a warp */

/* How good an element is for a sample: one that holds it, whose middle is nearest; or else what it is least outside
 * of. The lower, the better; of the same, the one that is listed first. */
typedef struct skin_rank {
    double first, second;
    int at; /* in the list, or -1 */
} skin_rank;

static __device__ bool is_better(const skin_rank &one, const skin_rank &other)
{
    if (one.at < 0 || other.at < 0)
        return one.at >= 0;
    if (one.first != other.first)
        return one.first < other.first;
    if (one.second != other.second)
        return one.second < other.second;
    return one.at < other.at;
}

/* Which of a list's elements have x in their boxes: to desk->list. Returns how many. */
static __device__ int warp_in_boxes(const cuda_skin &s, const int32_t *list, int count, int lane, const double *x,
                                    skin_desk *desk)
{
    enum { EACH = CONTACT_CANDIDATES / 32 };
    const double spare = s.all->spare;
    bool is[EACH];
    int found = 0;
    __syncwarp();
#pragma unroll
    for (int k = 0; k < EACH; k++) {
        const int i = lane + 32 * k;
        is[k] = contact_in_box(&s.table, list[i < count ? i : 0], x, spare) & (i < count);
    }
#pragma unroll
    for (int k = 0; k < EACH; k++) {
        const unsigned which = __ballot_sync(~0u, is[k]);
        if (is[k])
            desk->list[found + warp_before(which, lane)] = lane + 32 * k;
        found += __popc(which);
    }
    __syncwarp();
    return found;
}

/* As find_element of contact_touch.c: the element, or -1. */
static __device__ int32_t warp_element(const cuda_skin &s, int64_t sample, int lane, const double *x, skin_desk *desk)
{
    const int32_t own = s.c.sample_element[sample];
    const int32_t *list = s.table.candidate + CONTACT_CANDIDATES * (int64_t)own;
    const int count = warp_in_boxes(s, list, s.table.count[own], lane, x, desk);
    skin_rank best = {0, 0, -1};
    double place[3] = {0, 0, 0};
    for (int i = lane; i < count; i += 32) {
        const int at = desk->list[i];
        const deformed_map d = contact_map(&s.c, s.x, list[at]);
        double xi[3];
        if (!deformed_place(&d, x, xi))
            continue;
        const double outside = deformed_outside(xi);
        const skin_rank rank = {fmax(outside, 0.), deformed_from_middle(&d, x), at};
        if (outside < CONTACT_BEYOND && is_better(rank, best)) {
            best = rank;
            for (int a = 0; a < 3; a++)
                place[a] = xi[a];
        }
    }
    const int mine = best.at;
    for (int with = 16; with; with /= 2) {
        const skin_rank other = {__shfl_xor_sync(~0u, best.first, with), __shfl_xor_sync(~0u, best.second, with),
                                 __shfl_xor_sync(~0u, best.at, with)};
        best = is_better(other, best) ? other : best;
    }
    __syncwarp();
    if (mine >= 0 && mine == best.at)
        for (int a = 0; a < 3; a++)
            desk->place[a] = place[a];
    __syncwarp();
    return best.at < 0 ? -1 : list[best.at];
}

/* As contact_blend_shares, into desk->share. What is read is asked for before any of it is used. */
static __device__ void warp_shares(const cuda_skin &s, int64_t element, int lane, const double *xi, skin_desk *desk)
{
    const contact_blend &b = s.blend;
    double part[8];
    contact_blend_parts(xi, part);
    __syncwarp();
    for (int i = lane; i < b.count[element]; i += 32) {
        int32_t row[8];
        double of[8][4], share = 0;
#pragma unroll
        for (int c = 0; c < 8; c++)
            row[c] = s.entry[(8 * element + c) * BLEND_MOST + i];
#pragma unroll
        for (int c = 0; c < 8; c++)
            for (int a = 0; a < 4; a++)
                of[c][a] = row[c] >= 0 && row[c] < SKIN_OWN ? b.coefficient[4 * (int64_t)row[c] + a] : 0;
#pragma unroll
        for (int c = 0; c < 8; c++) {
            double from[3];
            contact_blend_from(b.side, c, row[c] >= SKIN_OWN, xi, from);
            const double own = row[c] >= SKIN_OWN ? contact_blend_own(b.side, row[c] - SKIN_OWN, from)
                                                  : contact_blend_share(of[c], from);
            share += part[c] != 0 && row[c] >= 0 ? part[c] * own : 0;
        }
        desk->share[i] = share;
    }
    __syncwarp();
}

/* As blend_place of contact_touch.c. */
static __device__ bool warp_blend_place(const cuda_skin &s, int32_t element, int lane, const double *x, double *xi,
                                        skin_desk *desk)
{
    const int32_t *node = s.blend.node + BLEND_MOST * (int64_t)element;
    const deformed_map d = contact_map(&s.c, s.x, element);
    for (int turn = 0; turn < CONTACT_TURNS; turn++) {
        double way[3] = {0, 0, 0};
        warp_shares(s, element, lane, xi, desk);
        for (int i = lane; i < s.blend.count[element]; i += 32)
            for (int a = 0; a < 3; a++)
                way[a] -= desk->share[i] * s.x[3 * (int64_t)node[i] + a];
        warp_sums(way, 3);
        for (int a = 0; a < 3; a++)
            way[a] += x[a];
        if (!deformed_go(&d, way, xi))
            return false;
    }
    return deformed_outside(xi) < CONTACT_BEYOND;
}

/* The nodes that move a place, and their shares: to t's. */
static __device__ void warp_take_shares(const cuda_skin &s, const double *place, int lane, touch *t, skin_desk *desk)
{
    if (!s.blend.elements) {
        double share[8];
        deformed_shares(place, share);
        t->count = 8;
        if (lane < 8) {
            t->node[lane] = s.c.element[8 * (int64_t)t->element + lane];
            t->share[lane] = share[lane];
        }
        return;
    }
    const int32_t *node = s.blend.node + BLEND_MOST * (int64_t)t->element;
    warp_shares(s, t->element, lane, place, desk);
    t->count = 0;
    for (int i = 0; i < s.blend.count[t->element]; i += 32) {
        const double share = i + lane < s.blend.count[t->element] ? desk->share[i + lane] : 0;
        const bool is = fabs(share) > BLEND_LEAST;
        const unsigned which = __ballot_sync(~0u, is);
        const int at = t->count + warp_before(which, lane);
        if (is) {
            t->node[at] = node[i + lane];
            t->share[at] = share;
        }
        t->count += __popc(which);
    }
}

/* ---- contacts */

/* Puts nodes that had no contact before on the list of those that have. */
static __device__ void warp_about(const cuda_skin &s, int odd, int lane, const skin_lever &l, const skin_whole *was,
                                  skin_desk *desk)
{
    unsigned which[SKIN_EACH];
    int count = 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        which[j] = __ballot_sync(~0u, was[j] == 0);
        count += __popc(which[j]);
    }
    int32_t at = count ? warp_slots(&s.all->abouts[odd], count, lane, desk) : 0;
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        if (was[j] == 0)
            s.about[at + warp_before(which[j], lane)] = l.node[j];
        at += __popc(which[j]);
    }
}

/* Adds a contact to those that are found, with the parts of its sides, and its shares to its nodes; t: the same in all
 * threads of the warp. */
static __device__ void warp_add(const cuda_skin &s, int odd, int lane, touch *t, skin_desk *desk)
{
    const int32_t slot = warp_slots(&s.all->touches[odd], 1, lane, desk);
    const skin_lever l = lever_of(s, *t, lane);
    double mass[2] = {0, 0};
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        const double part = l.share[j] * s.node[l.node[j]].mass;
        mass[0] += l.place >> j & 1 ? 0 : part;
        mass[1] -= l.place >> j & 1 ? part : 0;
    }
    warp_sums(mass, 2);
    contact_part(t, mass);
    skin_whole was[SKIN_EACH];
#pragma unroll
    for (int j = 0; j < SKIN_EACH; j++) {
        const double part = t->part[l.place >> j & 1] * fabs(l.share[j]);
        was[j] = l.share[j] != 0 ? atomicAdd(&s.sum[l.node[j]], whole_of(part, 1 / SKIN_SHARE_UNIT) + 1) : 1;
    }
    warp_about(s, odd, lane, l, was, desk);
    if (lane == 0)
        s.found[slot] = *t;
}

/* As have_neighbour of contact_touch.c. */
static __device__ bool warp_have_neighbour(const cuda_skin &s, int32_t one, int32_t other, int lane)
{
    int32_t node[8];
    bool is = false;
    for (int k = 0; k < 8; k++)
        node[k] = s.c.element[8 * (int64_t)other + k];
    for (int32_t i = s.c.ring_start[one] + lane; i < s.c.ring_start[one + 1]; i += 32) {
        const int32_t of = s.c.ring[i];
        for (int k = 0; k < 8; k++)
            is |= node[k] == of;
    }
    return __any_sync(~0u, is);
}

/* Whether it touches other skin; as find_touch of contact_touch.c. */
static __device__ void warp_skin(const cuda_touch &k, int64_t sample, int lane, const double *x, double drift, int odd,
                                 skin_desk *desk)
{
    const cuda_skin &s = k.skin;
    touch t = {};
    double place[3] = {0, 0, 0}, clear = CONTACT_MARGIN * s.c.shortest;
    t.sample = (int32_t)sample;
    t.sides = 2;
    t.element = warp_element(s, sample, lane, x, desk);
    for (int a = 0; a < 3 && t.element >= 0; a++)
        place[a] = desk->place[a];
    bool is = t.element >= 0 && (!s.blend.elements || warp_blend_place(s, t.element, lane, x, place, desk)) &&
              contact_is_in(&s.c, s.x, place, &t, &clear);
    if (is)
        is = contact_faces(&s.c, s.x, place, warp_have_neighbour(s, s.c.sample_element[sample], t.element, lane), &t);
    if (lane == 0 && clear > 0)
        s.until[sample] = drift + CONTACT_SPARE * clear;
    if (!is)
        return;
    t.node = s.place_node + (int64_t)s.place_most * sample;
    t.share = s.place_share + (int64_t)s.place_most * sample;
    warp_take_shares(s, place, lane, &t, desk);
    warp_add(s, odd, lane, &t, desk);
}

/* Whether it touches bone; as find_deepest of contact_bone.c. */
static __device__ void warp_bone(const cuda_touch &k, int64_t sample, int lane, const double *x, double drift, int odd,
                                 skin_desk *desk)
{
    const cuda_skin &s = k.skin;
    touch deepest = {};
    for (int32_t i = 0; i < s.c.solids; i++) {
        double *until = &s.bone_until[i * s.c.samples + sample], clear;
        const double come = drift + s.all->solid_drift[!odd][i];
        const sliding_field *f = &s.ground.field[s.c.solid[i]];
        if (come < *until)
            continue;
        const sliding_bone was = sliding_bone_of(f, k.now), is = sliding_bone_of(f, k.next);
        touch t = {};
        t.sample = (int32_t)sample;
        t.element = -1;
        t.sides = 1;
        if (contact_touches_bone(&s.c, s.x, x, &s.ground, s.c.solid[i], &was, &is,
                                 s.c.bone_rest[i * s.c.samples + sample], &t, &clear) &&
            (!deepest.sides || t.off < deepest.off))
            deepest = t;
        __syncwarp();
        if (lane == 0)
            *until = clear > 0 ? come + CONTACT_SPARE * clear : 0;
    }
    if (deepest.sides)
        warp_add(s, odd, lane, &deepest, desk);
}

/* Whether a sample may touch skin, and bone. */
static __device__ bool may_skin(const cuda_skin &s, int64_t sample, double drift)
{
    return s.table.count[s.c.sample_element[sample]] && !(drift < s.until[sample]);
}

static __device__ bool may_bone(const cuda_skin &s, int64_t sample, double drift, int odd)
{
    bool may = false;
    for (int32_t i = 0; i < s.c.solids; i++)
        may |= !(drift + s.all->solid_drift[!odd][i] < s.bone_until[i * s.c.samples + sample]);
    return may;
}

/* Puts samples that may touch on the list. */
static __device__ void find_active(const cuda_skin &s, double drift, int odd)
{
    for_all(s.c.samples, [&](int64_t i) {
        if (may_skin(s, i, drift) || may_bone(s, i, drift, odd))
            s.active[atomicAdd(&s.all->actives[odd], 1)] = (int32_t)i;
    });
}

static __device__ void find_touches(const cuda_touch &k, double drift, int odd, skin_desk *desk)
{
    const cuda_skin &s = k.skin;
    for_warps(s.all->actives[odd], &s.all->finding[odd], desk, [&](int32_t i, int lane) {
        const int64_t sample = s.active[i];
        double x[3];
        warp_place(s, sample, lane, x);
        if (may_skin(s, sample, drift))
            warp_skin(k, sample, lane, x, drift, odd, desk);
        if (s.c.solids)
            warp_bone(k, sample, lane, x, drift, odd, desk);
    });
}

#endif
