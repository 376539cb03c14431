#include "msds/cpu/dissect.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF = 24 /* nodes that are not cut any more */ };

typedef struct cut {
    int axis;
    double at;
    int64_t between; /* nodes: what is left between, the fewest that a side has next to the other */
    bool low;        /* they are of the low side */
} cut;

typedef struct cutter {
    dissection *d;
    const msds_problem *p;
    int32_t *set;   /* free nodes: those of each part stand together */
    int32_t *spare; /* as long */
    int32_t *part;  /* nodes: which part each is in */
    double *x;      /* as long: coordinates, sorted */
    int32_t parts;
    int64_t done; /* nodes in the order */
} cutter;

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static int ascending_place(const void *a, const void *b)
{
    const int32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static int32_t other_end(const msds_problem *p, int32_t spring, int32_t node)
{
    const int32_t *ends = p->spring[spring].node;
    return ends[0] == node ? ends[1] : ends[0];
}

static double coordinate(const cutter *c, int32_t node, int axis)
{
    return c->p->position[3 * (int64_t)node + axis];
}

/* The plane nearest to the middle node that passes between layers; or nan. */
static double plane(cutter *c, int64_t from, int64_t to, int axis)
{
    const int64_t count = to - from, middle = count / 2;
    for (int64_t i = 0; i < count; i++)
        c->x[i] = coordinate(c, c->set[from + i], axis);
    qsort(c->x, (size_t)count, sizeof *c->x, ascending);
    const double gap = 1e-9 * (c->x[count - 1] - c->x[0]);
    for (int64_t off = 0; off < middle; off++)
        for (int side = -1; side <= 1; side += 2) {
            int64_t i = middle + side * off;
            if (i > 0 && i < count && c->x[i] - c->x[i - 1] > gap)
                return .5 * (c->x[i] + c->x[i - 1]);
        }
    return NAN;
}

static bool touches(const cutter *c, int32_t node, int32_t part, int axis, double at)
{
    bool low = coordinate(c, node, axis) < at;
    for (int64_t i = c->d->start[node]; i < c->d->start[node + 1]; i++) {
        int32_t other = other_end(c->p, c->d->link[i], node);
        if (c->part[other] == part && (coordinate(c, other, axis) < at) != low)
            return true;
    }
    return false;
}

static void try_axis(cutter *c, int64_t from, int64_t to, int axis, cut *best)
{
    double at = plane(c, from, to, axis);
    int64_t count[2] = {0};
    if (isnan(at))
        return;
    for (int64_t i = from; i < to; i++)
        count[coordinate(c, c->set[i], axis) < at] += touches(c, c->set[i], c->part[c->set[i]], axis, at);
    bool low = count[1] < count[0];
    if (count[low] < best->between)
        *best = (cut){axis, at, count[low], low};
}

/* Stably: the low side, the high side, what lies between. Returns where the second and third begin. */
static void divide(cutter *c, int64_t from, int64_t to, const cut *by, int64_t at[2])
{
    int64_t count[3] = {0};
    const int32_t part = c->part[c->set[from]];
    memcpy(c->spare + from, c->set + from, (size_t)(to - from) * sizeof *c->spare);
    for (int pass = 0; pass < 2; pass++) {
        if (pass) {
            at[0] = from + count[0];
            at[1] = at[0] + count[1];
            count[2] = at[1], count[1] = at[0], count[0] = from;
        }
        for (int64_t i = from; i < to; i++) {
            int32_t node = c->spare[i];
            bool low = coordinate(c, node, by->axis) < by->at;
            int where = low ? 0 : 1;
            if (low == by->low && touches(c, node, part, by->axis, by->at))
                where = 2;
            if (pass)
                c->set[count[where]] = node;
            count[where]++;
        }
    }
    for (int side = 0; side < 3; side++) {
        int32_t name = ++c->parts;
        const int64_t end = side == 2 ? to : at[side];
        for (int64_t i = side == 0 ? from : at[side - 1]; i < end; i++)
            c->part[c->set[i]] = name;
    }
}

/* A front of these nodes, eliminated next. Returns its number, or -1. */
static int64_t add_front(cutter *c, int64_t from, int64_t to, err *e)
{
    dissection *d = c->d;
    if (MEM_ROOM(&d->front, &d->room, d->fronts + 1, "the factor", e))
        return -1;
    d->front[d->fronts] = (front){.first = c->done, .columns = to - from, .parent = -1};
    for (int64_t i = from; i < to; i++) {
        d->place[c->set[i]] = (int32_t)c->done;
        d->order[c->done++] = c->set[i];
    }
    return d->fronts++;
}

/* Returns the front that comes last of these nodes, or -1. As deep as the nodes can be halved. */
static int64_t cut_part(cutter *c, int64_t from, int64_t to, err *e) // NOLINT(misc-no-recursion)
{
    cut best = {.between = to - from};
    int64_t at[2], low, high;
    for (int axis = 0; axis < 3 && to - from > LEAF; axis++)
        try_axis(c, from, to, axis, &best);
    if (best.between >= (to - from) / 2)
        return add_front(c, from, to, e);
    divide(c, from, to, &best, at);
    low = cut_part(c, from, at[0], e);
    high = low < 0 ? -1 : cut_part(c, at[0], at[1], e);
    int64_t last = high < 0 ? -1 : add_front(c, at[1], to, e);
    if (last >= 0)
        c->d->front[low].parent = c->d->front[high].parent = last;
    return last;
}

static int link_nodes(dissection *d, const msds_problem *p, err *e)
{
    d->start = mem_array(p->nodes + 2, sizeof *d->start, "the factor", e);
    d->link = mem_array(2 * p->springs, sizeof *d->link, "the factor", e);
    if (!d->start || !d->link)
        return -1;
    for (int64_t i = 0; i < p->springs; i++)
        for (int c = 0; c < 2; c++)
            d->start[p->spring[i].node[c] + 2]++;
    for (int64_t n = 2; n <= p->nodes + 1; n++)
        d->start[n] += d->start[n - 1];
    for (int64_t i = 0; i < p->springs; i++)
        for (int c = 0; c < 2; c++)
            d->link[d->start[p->spring[i].node[c] + 1]++] = (int32_t)i;
    return 0;
}

/* The rows of front f, whose children's are known: mark[place] == f + 1 where noted. */
static int find_rows(dissection *d, const msds_problem *p, int64_t f, const int64_t *child, int32_t *mark,
                     int32_t *list, err *e)
{
    front *at = &d->front[f];
    const int64_t end = at->first + at->columns;
    int64_t count = 0;
    for (int64_t i = at->first; i < end; i++)
        for (int64_t k = d->start[d->order[i]]; k < d->start[d->order[i] + 1]; k++) {
            int32_t place = d->place[other_end(p, d->link[k], d->order[i])];
            if (place >= end && mark[place] != f + 1) {
                mark[place] = (int32_t)f + 1;
                list[count++] = place;
            }
        }
    for (int c = 0; c < 2; c++)
        for (int64_t i = 0; child[c] >= 0 && i < d->front[child[c]].rows; i++) {
            int32_t place = d->front[child[c]].row[i];
            if (place >= end && mark[place] != f + 1) {
                mark[place] = (int32_t)f + 1;
                list[count++] = place;
            }
        }
    at->rows = count;
    at->row = mem_array(count, sizeof *at->row, "the factor", e);
    at->above = mem_array(count, sizeof *at->above, "the factor", e);
    if (!at->row || !at->above)
        return -1;
    memcpy(at->row, list, (size_t)count * sizeof *list);
    qsort(at->row, (size_t)count, sizeof *at->row, ascending_place);
    return 0;
}

/* Where a front's rows stand in its parent: both ascend. */
static void find_above(dissection *d, front *f)
{
    const front *up = &d->front[f->parent];
    int64_t at = 0;
    for (int64_t i = 0; i < f->rows; i++) {
        if (f->row[i] < up->first + up->columns) {
            f->above[i] = (int32_t)(f->row[i] - up->first);
            continue;
        }
        while (up->row[at] < f->row[i])
            at++;
        f->above[i] = (int32_t)(up->columns + at);
    }
}

static int find_all_rows(cutter *c, err *e)
{
    dissection *d = c->d;
    int64_t *child = mem_array(d->fronts, 2 * sizeof *child, "the factor", e);
    int32_t *mark = mem_array(d->nodes, sizeof *mark, "the factor", e);
    int result = child && mark ? 0 : -1;
    for (int64_t f = 0; !result && f < 2 * d->fronts; f++)
        child[f] = -1;
    for (int64_t f = 0; !result && f < d->fronts; f++) {
        result = find_rows(d, c->p, f, child + 2 * f, mark, c->spare, e);
        int64_t *of_parent = d->front[f].parent < 0 ? NULL : child + 2 * d->front[f].parent;
        if (of_parent)
            of_parent[of_parent[0] >= 0] = f;
    }
    for (int64_t f = d->fronts - 1; !result && f >= 0; f--)
        if (d->front[f].parent >= 0) {
            d->front[f].depth = d->front[d->front[f].parent].depth + 1;
            find_above(d, &d->front[f]);
        }
    free(child);
    free(mark);
    return result;
}

int dissect(dissection *d, const msds_problem *p, err *e)
{
    cutter c = {.d = d, .p = p};
    int result = -1;
    d->order = mem_array(p->nodes, sizeof *d->order, "the factor", e);
    d->place = mem_array(p->nodes, sizeof *d->place, "the factor", e);
    c.set = mem_array(p->nodes, sizeof *c.set, "the factor", e);
    c.spare = mem_array(p->nodes, sizeof *c.spare, "the factor", e);
    c.part = mem_array(p->nodes, sizeof *c.part, "the factor", e);
    c.x = mem_array(p->nodes, sizeof *c.x, "the factor", e);
    if (!d->order || !d->place || !c.set || !c.spare || !c.part || !c.x || link_nodes(d, p, e))
        goto out;
    for (int64_t n = 0; n < p->nodes; n++) {
        d->place[n] = -1;
        c.part[n] = p->fixed[n] ? -1 : 0;
        if (!p->fixed[n])
            c.set[d->nodes++] = (int32_t)n;
    }
    if (cut_part(&c, 0, d->nodes, e) >= 0)
        result = find_all_rows(&c, e);
out:
    free(c.set);
    free(c.spare);
    free(c.part);
    free(c.x);
    return result;
}

void dissect_free(dissection *d)
{
    for (int64_t f = 0; f < d->fronts; f++) {
        free(d->front[f].row);
        free(d->front[f].above);
    }
    free(d->front);
    free(d->order);
    free(d->place);
    free(d->start);
    free(d->link);
    *d = (dissection){0};
}
