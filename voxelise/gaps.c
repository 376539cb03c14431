#include "voxelise/gaps.h"

#include "base/mem.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Of a unit normal, the least share along the line: surfaces face each other across it at 60 degrees at most from
 * upright. A gap of any direction is met so along one axis at least (1/sqrt(3) is more than a half), and one that a
 * line grazes is none. */
static const double facing = .5;

/* In voxels: what is wider has one that is no element, and what is narrower is surfaces that touch, which facets that
 * are cut differently, and places that are rounded, keep from being the same. */
static const double widest = 8, narrowest = .05;

/* Widths nearer to each other than this are one. */
static const double same_width = 1e-6;

/* Where a line crosses a surface of the lowest level. */
typedef struct meeting {
    int32_t row, column;
    double at; /* along the line, in cells */
    int32_t volume;
    float normal[3]; /* of length 1, or none */
    bool rigid;
} meeting;

/* A gap on one line. */
typedef struct crossed {
    int32_t row, column;
    double from, to; /* in cells */
    bool filled;     /* by elements */
} crossed;

/* By row, column and place. */
typedef struct crossed_list {
    crossed *v;
    int64_t count, capacity;
} crossed_list;

typedef struct work {
    const solids *s;
    const voxels *x;
    const grid *g;
    inside test;
    int32_t volumes; /* of the lowest level */
    voxels_layers layer;
    crossed_list *of; /* slabs */
    atomic_bool failed;
} work;

/* One slab's. */
typedef struct scratch {
    work *w;
    crossed_list *to;
    meeting *list;
    int64_t count, capacity;
    bool *in;         /* volumes: whether the line is in each */
    int64_t triangle; /* whose normal this is */
    float normal[3];
    err e;
} scratch;

/* ---- crossings */

static void find_normal(scratch *s, int64_t triangle)
{
    const int32_t *v = &s->w->s->vertex[3 * triangle];
    const double *p = s->w->s->position, *a = &p[3 * (int64_t)v[0]], *b = &p[3 * (int64_t)v[1]],
                 *c = &p[3 * (int64_t)v[2]];
    double n[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        s->normal[i] = length > 0 ? (float)(n[i] / length) : 0;
    s->triangle = triangle;
}

/* The place is kept within the cell that exact arithmetic says, so that crossings stay in order. */
static void take_crossing(void *context, int64_t triangle, const crossing_plane *plane, int32_t row, int32_t from,
                          int32_t to)
{
    scratch *s = context;
    if (s->e.status || mem_grow(&s->list, &s->capacity, s->count + to - from, sizeof *s->list, "crossings", &s->e))
        return;
    if (triangle != s->triangle)
        find_normal(s, triangle);
    for (int32_t i = from; i < to; i++) {
        double past = crossing_plane_at(plane, row, i);
        double at = plane->ray + ((row - plane->row) * plane->by_row + (i - plane->column) * plane->by_column);
        s->list[s->count++] = (meeting){.row = row,
                                        .column = i,
                                        .at = crossing_within(at, past - 1, past),
                                        .volume = s->w->s->volume[triangle],
                                        .normal = {s->normal[0], s->normal[1], s->normal[2]},
                                        .rigid = s->w->s->rigid[triangle]};
    }
}

/* Of those at one place leaving comes first or last as it will: such a gap has no width. */
static int by_place(const void *a, const void *b)
{
    const meeting *p = a, *q = b;
    if (p->row != q->row)
        return p->row < q->row ? -1 : 1;
    if (p->column != q->column)
        return p->column < q->column ? -1 : 1;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    if (p->volume != q->volume)
        return p->volume < q->volume ? -1 : 1;
    for (int i = 0; i < 3; i++)
        if (p->normal[i] != q->normal[i])
            return p->normal[i] < q->normal[i] ? -1 : 1;
    return 0;
}

/* ---- elements */

static bool is_element(const work *w, const int32_t *cell)
{
    int64_t layer = cell[2] - w->layer.low;
    if (layer < 0 || layer >= w->layer.count)
        return false;
    int64_t low = w->layer.run[layer], high = w->layer.run[layer + 1];
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        const climb_run *r = &w->x->run[middle];
        if (r->j < cell[1] || (r->j == cell[1] && r->to <= cell[0]))
            low = middle + 1;
        else
            high = middle;
    }
    return low < w->layer.run[layer + 1] && w->x->run[low].j == cell[1] && w->x->run[low].from <= cell[0];
}

/* Whether all cells on the line are elements, from the one before the first place to the one after the second. */
static bool is_filled(const work *w, const meeting *from, const meeting *to)
{
    const crossing_mesh *m = &w->test.mesh;
    int32_t cell[3];
    cell[m->row] = from->row;
    cell[m->column] = from->column;
    for (int64_t i = (int64_t)ceil(from->at + .5) - 1; i <= (int64_t)floor(to->at + .5); i++) {
        cell[m->ray] = (int32_t)i;
        if (!is_element(w, cell))
            return false;
    }
    return true;
}

/* ---- lines */

/* Whether two surfaces face each other across the line, and more so than across a line along another axis: so a gap is
 * met once. */
static bool face_each_other(const meeting *a, const meeting *b, int ray)
{
    for (int i = 0; i < 3; i++) {
        float here = fabsf(a->normal[ray]) + fabsf(b->normal[ray]), there = fabsf(a->normal[i]) + fabsf(b->normal[i]);
        if (there > here || (there == here && i < ray))
            return false;
    }
    return fabsf(a->normal[ray]) >= (float)facing && fabsf(b->normal[ray]) >= (float)facing;
}

/* Whether the line, which came in at `entered`, leaves and enters again across a gap. Where it seems to leave by a
 * surface that faces as the one it came in by, it is inside of two. */
static bool is_gap(const meeting *entered, const meeting *leaves, const meeting *enters, int ray)
{
    double width = enters->at - leaves->at;
    bool back = entered->normal[ray] < 0;
    return width > narrowest && width <= widest && !(leaves->rigid && enters->rigid) &&
           (leaves->normal[ray] < 0) != back && (enters->normal[ray] < 0) == back &&
           face_each_other(leaves, enters, ray);
}

static void add_gap(scratch *s, const meeting *leaves, const meeting *enters)
{
    crossed_list *to = s->to;
    if (mem_grow(&to->v, &to->capacity, to->count + 1, sizeof *to->v, "gaps", &s->e))
        return;
    to->v[to->count++] =
        (crossed){leaves->row, leaves->column, leaves->at, enters->at, is_filled(s->w, leaves, enters)};
}

/* The crossings of one line, in order. */
static void look_along(scratch *s, const meeting *list, int64_t count)
{
    const meeting *entered = NULL, *leaves = NULL;
    int32_t around = 0; /* volumes that the line is in */
    for (int64_t i = 0; i < count; i++) {
        const meeting *at = &list[i];
        bool was = around > 0;
        s->in[at->volume] = !s->in[at->volume];
        around += s->in[at->volume] ? 1 : -1;
        if (was && !around)
            leaves = at;
        if (was || !around)
            continue;
        if (leaves && is_gap(entered, leaves, at, s->w->test.mesh.ray))
            add_gap(s, leaves, at);
        entered = at;
    }
    for (int64_t i = 0; i < count; i++)
        s->in[list[i].volume] = false;
}

static void do_slab(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    work *w = context;
    for (int64_t number = from; number < to; number++) {
        scratch s = {.w = w, .to = &w->of[number], .triangle = -1};
        inside_cross(&w->test, number, take_crossing, &s);
        s.in = s.count ? mem_array(w->volumes, sizeof *s.in, "volumes", &s.e) : NULL;
        if (s.in)
            qsort(s.list, (size_t)s.count, sizeof *s.list, by_place);
        for (int64_t i = 0, end = 0; s.in && i < s.count; i = end) {
            while (end < s.count && s.list[end].row == s.list[i].row && s.list[end].column == s.list[i].column)
                end++;
            look_along(&s, s.list + i, end - i);
        }
        if (s.e.status)
            atomic_store(&w->failed, true); /* for want of memory */
        free(s.list);
        free(s.in);
    }
}

/* ---- all */

static int by_width(const void *a, const void *b)
{
    const gap *p = a, *q = b;
    if (p->width != q->width)
        return p->width < q->width ? -1 : 1;
    if (p->axis != q->axis)
        return p->axis < q->axis ? -1 : 1;
    for (int i = 2; i >= 0; i--)
        if (p->middle[i] != q->middle[i])
            return p->middle[i] < q->middle[i] ? -1 : 1;
    return 0;
}

enum { NONE, OPEN, FILLED };

/* Whether a gap lies before the place on the line of this row and column. Those of one line are in order and apart. */
static bool is_before(const crossed *c, int64_t row, int64_t column, double place)
{
    if (c->row != row)
        return c->row < row;
    return c->column != column ? c->column < column : c->to <= place;
}

/* What the gap is on a line beside. */
static int beside(const crossed_list *all, const crossed *g, int rows, int columns)
{
    const int64_t row = (int64_t)g->row + rows, column = (int64_t)g->column + columns;
    int64_t low = 0, high = all->count;
    int what = NONE;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (is_before(&all->v[middle], row, column, g->from))
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < all->count && what != OPEN; low++) {
        const crossed *c = &all->v[low];
        if (c->row != row || c->column != column || c->from >= g->to)
            break;
        what = c->filled ? FILLED : OPEN;
    }
    return what;
}

/* Whether a gap that is open on one side ends here: within a voxel, however small voxels are. */
static bool is_end(const crossed_list *all, const crossed *g)
{
    for (int across = 0; across < 2; across++) {
        int before = beside(all, g, -across, across - 1), after = beside(all, g, across, 1 - across);
        if ((before == OPEN && after == NONE) || (before == NONE && after == OPEN))
            return true;
    }
    return false;
}

/* The list of all slabs, which are emptied. */
static int join_slabs(const work *w, crossed_list *all, err *e)
{
    int status = 0;
    for (int64_t i = 0; i < w->test.slabs; i++) {
        crossed_list *of = &w->of[i];
        if (!status && of->count)
            status = mem_grow(&all->v, &all->capacity, all->count + of->count, sizeof *all->v, "gaps", e);
        for (int64_t n = 0; !status && n < of->count; n++)
            all->v[all->count++] = of->v[n];
        free(of->v);
    }
    return status;
}

static int keep(const work *w, const crossed_list *all, gaps *found, int64_t *capacity, err *e)
{
    const crossing_mesh *m = &w->test.mesh;
    for (int64_t i = 0; i < all->count; i++) {
        const crossed *c = &all->v[i];
        if (!c->filled || is_end(all, c))
            continue;
        if (mem_grow(&found->gap, capacity, found->count + 1, sizeof *found->gap, "gaps", e))
            return -1;
        gap *g = &found->gap[found->count++];
        g->axis = m->ray;
        g->width = rint((c->to - c->from) / same_width) * same_width;
        g->middle[m->ray] = (c->from + c->to) / 2;
        g->middle[m->row] = c->row;
        g->middle[m->column] = c->column;
    }
    return 0;
}

/* Those along one axis. */
static int look(work *w, gaps *found, int64_t *capacity, int axis, const inside_triangles *t, pool *threads, err *e)
{
    crossed_list all = {0};
    int status = inside_create(&w->test, w->g, t, axis, 1, threads, e);
    if (status)
        return -1;
    w->of = mem_array(w->test.slabs, sizeof *w->of, "slabs", e);
    if (w->of) {
        pool_run(threads, w->test.slabs, 1, do_slab, w);
        status = join_slabs(w, &all, e);
    }
    if (!status && !w->of)
        status = -1;
    if (!status && atomic_load(&w->failed))
        status = err_memory(e, "crossings");
    if (!status)
        status = keep(w, &all, found, capacity, e);
    free(all.v);
    free(w->of);
    inside_free(&w->test);
    return status;
}

int gaps_find(gaps *found, const solids *s, const volumes *plan, const voxels *x, const grid *g, pool *threads, err *e)
{
    *found = (gaps){0};
    work w = {.s = s, .x = x, .g = g};
    int64_t capacity = 0, triangles = 0;
    while (w.volumes < plan->volumes && plan->volume[w.volumes].level == 0)
        w.volumes++;
    while (triangles < s->triangles && s->volume[triangles] < w.volumes)
        triangles++;
    if (voxels_find_layers(x, &w.layer, e))
        return -1;
    inside_triangles t = {s->position, s->vertices, s->vertex, s->volume, triangles};
    int status = 0;
    for (int axis = 0; !status && axis < 3; axis++)
        status = look(&w, found, &capacity, axis, &t, threads, e);
    voxels_layers_free(&w.layer);
    if (!status && found->count)
        qsort(found->gap, (size_t)found->count, sizeof *found->gap, by_width);
    if (status)
        gaps_free(found);
    return status;
}

void gaps_free(gaps *found)
{
    free(found->gap);
    *found = (gaps){0};
}
