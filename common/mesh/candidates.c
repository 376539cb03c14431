#include "mesh/candidates.h"

#include "base/mem.h"
#include "mesh/embree.h"

#include <math.h>
#include <stdlib.h>

/* Boxes and rays are floats: a conversion errs by 2^-24 of the number, Embree's slab test by little more. */
static const double float_slack = 0x1p-21, least_slack = 1e-3;
/* Beyond this no ray starts, and Embree would not take the box. */
static const double farthest = 1e12;

struct candidates {
    embree *tree;
};

/* What the tree calls back with while it is built. */
typedef struct boxes {
    candidates_box *box;
    const void *context;
    double slack;
} boxes;

static float outward(double x, double slack, float toward)
{
    x += (double)toward * (slack + fabs(x) * float_slack);
    x = x > farthest ? farthest : x < -farthest ? -farthest : x;
    return nextafterf((float)x, toward * INFINITY);
}

static void give_box(const void *context, uint32_t item, float *low, float *high)
{
    const boxes *b = context;
    double from[3], to[3];
    b->box(b->context, item, from, to);
    for (int i = 0; i < 3; i++) {
        low[i] = outward(from[i], b->slack, -1);
        high[i] = outward(to[i], b->slack, 1);
    }
}

static void take_item(void *context, uint32_t item)
{
    candidates_list *list = context;
    err ignored = {0};
    if (list->count == list->capacity &&
        mem_grow(&list->item, &list->capacity, list->count + 1, sizeof *list->item, "candidates", &ignored)) {
        list->lost = true;
        return;
    }
    list->item[list->count++] = item;
}

candidates *candidates_create(int64_t count, candidates_box *box, const void *context, double reach, int threads,
                              err *e)
{
    if (count < 0 || count >= UINT32_MAX) {
        err_set(e, NULL, 0, "%lld polygons; at most %u can be searched", (long long)count, UINT32_MAX - 1);
        return NULL;
    }
    candidates *c = mem_array(1, sizeof *c, "the tree of boxes", e);
    if (!c)
        return NULL;
    boxes b = {box, context, least_slack + reach * float_slack};
    c->tree = embree_create(threads, e);
    if (!c->tree || embree_add_boxes(c->tree, count, give_box, &b, e) || embree_commit(c->tree, e)) {
        candidates_destroy(c);
        return NULL;
    }
    return c;
}

void candidates_destroy(candidates *c)
{
    if (!c)
        return;
    embree_destroy(c->tree);
    free(c);
}

static int by_number(const void *a, const void *b)
{
    const uint32_t *i = a, *j = b;
    return (*i > *j) - (*i < *j);
}

/* Ascending, each once: Embree promises neither, and an item met twice would turn inside out for the caller. */
static void sort_items(candidates_list *list)
{
    int64_t kept = 0;
    if (list->count)
        qsort(list->item, (size_t)list->count, sizeof *list->item, by_number);
    for (int64_t i = 0; i < list->count; i++)
        if (!kept || list->item[kept - 1] != list->item[i])
            list->item[kept++] = list->item[i];
    list->count = kept;
}

int candidates_ray(const candidates *c, const double *from, const double *direction, candidates_list *list, err *e)
{
    const float start[3] = {(float)from[0], (float)from[1], (float)from[2]};
    const float along[3] = {(float)direction[0], (float)direction[1], (float)direction[2]};
    list->count = 0;
    list->lost = false;
    embree_list(c->tree, start, along, take_item, list);
    if (list->lost)
        return err_memory(e, "candidates");
    sort_items(list);
    return 0;
}

typedef struct pairs {
    candidates_pair *take;
    void *context;
} pairs;

static void take_pair(void *context, uint32_t one, uint32_t other)
{
    const pairs *p = context;
    p->take(p->context, one, other);
}

void candidates_pairs(const candidates *c, candidates_pair *take, void *context)
{
    pairs p = {take, context};
    embree_pairs(c->tree, take_pair, &p);
}

void candidates_list_free(candidates_list *list)
{
    free(list->item);
    *list = (candidates_list){0};
}
