#include "mesh/held.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* Nodes first to last - 1 of a tree, divided along an axis. */
typedef struct range {
    int64_t first, last;
    int axis;
    double d2; /* no node of it is nearer to the place looked for, squared */
} range;

enum { WAITING = 64 }; /* ranges: of the two halves one waits, and there are fewer than 2^63 nodes */

static int64_t middle_of(const range *r)
{
    return r->first + (r->last - r->first) / 2;
}

static range half(const range *r, bool upper)
{
    int64_t middle = middle_of(r);
    const int axis = (r->axis + 1) % 3;
    return upper ? (range){middle + 1, r->last, axis, r->d2} : (range){r->first, middle, axis, r->d2};
}

/* Moves nodes so that the middle one has none above it before, none below it after. (Hoare's selection: many nodes of a
 * lattice are equal along an axis, and it halves those too.) */
static void divide(const held *h, const range *r)
{
    const double *x = h->position + r->axis;
    int32_t *node = h->node;
    int64_t low = r->first, high = r->last - 1, middle = middle_of(r);
    while (low < high) {
        double pivot = x[3 * (int64_t)node[low + (high - low) / 2]];
        int64_t i = low, j = high;
        while (i <= j) {
            while (x[3 * (int64_t)node[i]] < pivot)
                i++;
            while (x[3 * (int64_t)node[j]] > pivot)
                j--;
            if (i <= j) {
                int32_t keep = node[i];
                node[i++] = node[j];
                node[j--] = keep;
            }
        }
        if (middle > j)
            low = i;
        if (middle < i)
            high = j;
    }
}

static void grow_tree(const held *h, int32_t anchor)
{
    range waiting[WAITING] = {{.first = h->start[anchor], .last = h->start[anchor + 1]}};
    for (int count = 1; count;) {
        range r = waiting[--count];
        if (r.last - r.first < 2)
            continue;
        divide(h, &r);
        waiting[count++] = half(&r, false);
        waiting[count++] = half(&r, true);
    }
}

int held_build(held *h, const double *position, const int32_t *anchor, int64_t nodes, int32_t anchors, err *e)
{
    *h = (held){.position = position, .anchors = anchors};
    /* Counted two places up, so that filling leaves each anchor's first in its place. */
    h->start = mem_array((int64_t)anchors + 2, sizeof *h->start, "anchors", e);
    if (!h->start)
        return -1;
    for (int64_t n = 0; n < nodes; n++)
        if (anchor[n] >= 0)
            h->start[anchor[n] + 2]++;
    for (int32_t a = 0; a < anchors; a++)
        h->start[a + 2] += h->start[a + 1];
    h->node = mem_array(h->start[anchors + 1], sizeof *h->node, "nodes that anchors hold", e);
    if (!h->node) {
        held_free(h);
        return -1;
    }
    for (int64_t n = 0; n < nodes; n++)
        if (anchor[n] >= 0)
            h->node[h->start[anchor[n] + 1]++] = (int32_t)n;
    for (int32_t a = 0; a < anchors; a++)
        grow_tree(h, a);
    return 0;
}

void held_free(held *h)
{
    free(h->start);
    free(h->node);
    *h = (held){0};
}

static double distance2(const double *p, const double *q)
{
    double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
    return x * x + y * y + z * z;
}

int32_t held_nearest(const held *h, int32_t anchor, const double *p)
{
    range waiting[WAITING] = {{.first = h->start[anchor], .last = h->start[anchor + 1]}};
    int32_t best = -1;
    double least = INFINITY;
    for (int count = 1; count;) {
        range r = waiting[--count];
        if (r.first == r.last || r.d2 > least)
            continue;
        int32_t n = h->node[middle_of(&r)];
        const double *x = &h->position[3 * (int64_t)n];
        double d2 = distance2(p, x), along = p[r.axis] - x[r.axis];
        if (d2 < least || (d2 == least && n < best)) {
            best = n;
            least = d2;
        }
        range across = half(&r, along < 0);
        across.d2 = fmax(r.d2, along * along);
        waiting[count++] = across;
        waiting[count++] = half(&r, along >= 0);
    }
    return best;
}
