#include "surface/candidates.h"

#include "base/mem.h"
#include "base/num.h"
#include "surface/embree.h"

#include <math.h>
#include <stdlib.h>

/* Boxes are floats: a conversion errs by 2^-24 of the number. */
static const double float_slack = 0x1p-21, least_slack = 1e-3;
/* Embree would not take a box beyond this. */
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
    x = num_clamp(x, -farthest, farthest);
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
