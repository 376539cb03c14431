#include "attachment.h"

#include "base/mem.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* A rigid node of the muscle: what it belongs to, and whose it is. */
typedef struct holder {
    int32_t part, anchor, node;
    float held; /* the muscle's part of an element there */
} holder;

typedef struct holders {
    holder *of;
    int64_t count, capacity;
} holders;

/* One that is sorted: where it stood. */
typedef struct ranked {
    attachment a;
    int32_t was;
} ranked;

typedef void node_work(const body *b, int64_t element, void *context);

static void each_element(const body *b, int32_t volume, node_work *work, void *context)
{
    for (int64_t at = b->start[volume]; at < b->start[volume + 1]; at++)
        work(b, b->element[at], context);
}

static void forget(const body *b, int64_t element, void *context)
{
    (void)context;
    for (int n = 0; n < b->columns; n++)
        b->part[b->node[b->columns * element + n]] = -1;
}

/* b->part is a forest of nodes here. */
static void connect(const body *b, int64_t element, void *context)
{
    const int32_t *node = &b->node[b->columns * element];
    int32_t before = -1;
    (void)context;
    for (int n = 0; n < b->columns; n++) {
        if (!b->rigid[node[n]])
            continue;
        if (b->part[node[n]] < 0)
            b->part[node[n]] = node[n];
        if (before >= 0)
            body_join(b->part, before, node[n]);
        before = node[n];
    }
}

static int by_part(const void *a, const void *b)
{
    const holder *p = a, *q = b;
    if (p->part != q->part)
        return p->part < q->part ? -1 : 1;
    if (p->anchor != q->anchor)
        return p->anchor < q->anchor ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* The muscle's rigid nodes, each once, part after part. */
static int collect(holders *h, const body *b, int32_t volume, err *e)
{
    int64_t kept = 0;
    for (int64_t at = b->start[volume]; at < b->start[volume + 1]; at++)
        for (int n = 0; n < b->columns; n++) {
            int32_t node = b->node[b->columns * b->element[at] + n];
            if (!b->rigid[node])
                continue;
            if (mem_grow(&h->of, &h->capacity, h->count + 1, sizeof *h->of, "attachments", e))
                return -1;
            h->of[h->count++] = (holder){body_root(b->part, node), b->anchor ? b->anchor[node] : -1, node,
                                         fmaxf((float)body_part(b, b->element[at], volume), FLT_EPSILON)};
        }
    if (h->count)
        qsort(h->of, (size_t)h->count, sizeof *h->of, by_part);
    for (int64_t i = 0; i < h->count; i++)
        if (!kept || h->of[kept - 1].node != h->of[i].node)
            h->of[kept++] = h->of[i];
        else
            h->of[kept - 1].held = fmaxf(h->of[kept - 1].held, h->of[i].held);
    h->count = kept;
    return 0;
}

static int by_size(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    if (p->a.nodes != q->a.nodes)
        return p->a.nodes > q->a.nodes ? -1 : 1;
    return (p->was > q->was) - (p->was < q->was);
}

/* The attachment of holders first to last - 1, which are of one part, sorted by anchor. */
static attachment make(const body *b, const holder *first, const holder *last, int32_t muscle)
{
    attachment a = {.muscle = muscle, .nodes = last - first, .anchor = first->anchor};
    int64_t most = 0, run = 0;
    double held = 0;
    for (const holder *h = first; h < last; h++) {
        run = h > first && h->anchor == h[-1].anchor ? run + 1 : 1;
        if (run > most) {
            most = run;
            a.anchor = h->anchor;
        }
        held += (double)h->held;
        for (int k = 0; k < 3; k++)
            a.centre[k] += (double)h->held * b->position[3 * (int64_t)h->node + k];
    }
    for (int k = 0; k < 3; k++)
        a.centre[k] /= held;
    return a;
}

static int64_t parts_of(const holders *h)
{
    int64_t parts = 0;
    for (int64_t i = 0; i < h->count; i++)
        parts += !i || h->of[i].part != h->of[i - 1].part;
    return parts;
}

/* Adds the parts to the list, the largest first; number: where each went. */
static int add(attachments *list, const body *b, const holders *h, int32_t muscle, err *e)
{
    int rc = -1;
    int64_t parts = parts_of(h), part = 0;
    ranked *sorted = mem_array(parts, sizeof *sorted, "attachments", e);
    int32_t *number = sorted ? mem_array(parts, sizeof *number, "attachments", e) : NULL;
    if (!number || mem_grow(&list->of, &list->capacity, list->count + parts, sizeof *list->of, "attachments", e))
        goto out;
    for (int64_t from = 0, to; from < h->count; from = to) {
        for (to = from + 1; to < h->count && h->of[to].part == h->of[from].part; to++)
            ;
        sorted[part] = (ranked){make(b, &h->of[from], &h->of[to], muscle), (int32_t)part};
        for (int64_t i = from; i < to; i++)
            b->part[h->of[i].node] = (int32_t)part;
        part++;
    }
    if (parts)
        qsort(sorted, (size_t)parts, sizeof *sorted, by_size);
    for (int64_t i = 0; i < parts; i++) {
        list->of[list->count++] = sorted[i].a;
        number[sorted[i].was] = (int32_t)i;
    }
    for (int64_t i = 0; i < h->count; i++)
        b->part[h->of[i].node] = number[b->part[h->of[i].node]];
    rc = 0;
out:
    free(sorted);
    free(number);
    return rc;
}

int attachments_find(attachments *list, const body *b, int32_t muscle, int32_t volume, err *e)
{
    holders h = {0};
    each_element(b, volume, forget, NULL);
    each_element(b, volume, connect, NULL);
    int rc = collect(&h, b, volume, e) || add(list, b, &h, muscle, e) ? -1 : 0;
    free(h.of);
    return rc;
}
