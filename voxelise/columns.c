#include "voxelise/columns.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* A crossing is kept as one number, to be sorted: its volume, then its cell counted from the grid's first. */
enum { CELL_BITS = 32 };

static double in_frame(const columns *c, int axis, double local)
{
    return local / c->g->spacing[axis] - c->middle[axis];
}

static void triangle_box(const void *context, int64_t item, double *low, double *high)
{
    const columns *c = context;
    for (int a = 0; a < 3; a++) {
        double least = INFINITY, most = -INFINITY;
        for (int i = 0; i < 3; i++) {
            double x = c->local[3 * (int64_t)c->t.vertex[3 * item + i] + a];
            least = fmin(least, x);
            most = fmax(most, x);
        }
        low[a] = in_frame(c, a, least - 4 * c->mesh.error[a]);
        high[a] = in_frame(c, a, most + 4 * c->mesh.error[a]);
    }
}

/* Local coordinates of all vertices, and the bounds on their error. */
static void make_local(columns *c)
{
    double local[3] = {0}, far[3] = {0};
    for (int64_t i = 0; i < 3 * c->t.vertices; i++) {
        int a = (int)(i % 3);
        double x = c->t.position[i];
        c->local[i] = grid_local(c->g, a, x);
        local[a] = fmax(local[a], fabs(c->local[i]));
        far[a] = fmax(far[a], fabs(x - c->g->origin[a]));
    }
    c->mesh = (crossing_mesh){.g = c->g, .position = c->t.position, .local = c->local};
    for (int a = 0; a < 3; a++)
        c->mesh.error[a] = crossing_error(c->g, a, local[a], far[a]);
}

int columns_create(columns *c, const grid *g, const columns_triangles *t, int threads, err *e)
{
    *c = (columns){.g = g, .t = *t};
    c->local = mem_array(3 * t->vertices, sizeof *c->local, "vertices", e);
    if (!c->local)
        return -1;
    make_local(c);
    for (int a = 0; a < 3; a++) {
        c->middle[a] = 0.5 * (double)(g->low[a] + g->high[a]);
        c->reach = fmax(c->reach, 0.5 * (double)grid_cells(g, a) + 2);
    }
    c->near = candidates_create(t->triangles, triangle_box, c, c->reach, threads, e);
    if (c->near)
        return 0;
    columns_destroy(c);
    return -1;
}

void columns_destroy(columns *c)
{
    candidates_destroy(c->near);
    free(c->local);
    *c = (columns){0};
}

static int add_crossing(const columns *c, const crossing_ray *r, int64_t triangle, columns_scratch *s, err *e)
{
    const int32_t *corner = &c->t.vertex[3 * triangle];
    int direction = crossing_of(r, corner);
    if (!direction)
        return 0;
    if (mem_grow(&s->crossing, &s->crossing_capacity, s->crossings + 1, sizeof *s->crossing, "crossings", e))
        return -1;
    uint64_t cell = (uint64_t)(crossing_cell(r, corner, direction) - c->g->low[r->axis]);
    s->crossing[s->crossings++] = (uint64_t)c->t.volume[triangle] << CELL_BITS | cell;
    return 0;
}

static int compare_crossings(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Most columns have a handful. */
static void sort_crossings(uint64_t *v, int64_t count)
{
    if (count > 24) {
        qsort(v, (size_t)count, sizeof *v, compare_crossings);
        return;
    }
    for (int64_t i = 1; i < count; i++) {
        uint64_t x = v[i];
        int64_t at = i;
        for (; at > 0 && v[at - 1] > x; at--)
            v[at] = v[at - 1];
        v[at] = x;
    }
}

static int add_span(columns_scratch *s, int32_t volume, int64_t from, int64_t to, err *e)
{
    if (from == to)
        return 0;
    columns_span *last = s->spans ? &s->span[s->spans - 1] : NULL;
    if (last && last->volume == volume && last->to == from) {
        last->to = to;
        return 0;
    }
    if (mem_grow(&s->span, &s->span_capacity, s->spans + 1, sizeof *s->span, "runs of voxels", e))
        return -1;
    s->span[s->spans++] = (columns_span){volume, from, to};
    return 0;
}

/* Each crossing of a volume turns inside to outside or back; inside to the grid's end where the last turns in (an open
 * surface, or one that reaches past the grid). */
static int make_spans(columns_scratch *s, int64_t low, int64_t high, err *e)
{
    s->spans = 0;
    for (int64_t i = 0; i < s->crossings;) {
        int32_t volume = (int32_t)(s->crossing[i] >> CELL_BITS);
        int64_t from = low + (int64_t)(s->crossing[i] & UINT32_MAX), to = high;
        bool closed = i + 1 < s->crossings && (int32_t)(s->crossing[i + 1] >> CELL_BITS) == volume;
        if (closed)
            to = low + (int64_t)(s->crossing[i + 1] & UINT32_MAX);
        if (add_span(s, volume, from, to, e))
            return -1;
        i += 1 + closed;
    }
    return 0;
}

/* The ray starts behind the grid's last cell and runs back: what lies further on turns nothing inside the grid. */
int columns_look(const columns *c, int axis, int64_t iu, int64_t iv, columns_scratch *s, err *e)
{
    crossing_ray r = crossing_ray_at(&c->mesh, axis, iu, iv);
    double from[3], direction[3] = {0};
    from[r.axis] = c->reach;
    from[r.u] = in_frame(c, r.u, r.cu);
    from[r.v] = in_frame(c, r.v, r.cv);
    direction[r.axis] = -1;
    if (candidates_ray(c->near, from, direction, &s->hits, e))
        return -1;
    s->crossings = 0;
    for (int64_t i = 0; i < s->hits.count; i++)
        if (add_crossing(c, &r, s->hits.item[i], s, e))
            return -1;
    sort_crossings(s->crossing, s->crossings);
    return make_spans(s, c->g->low[axis], c->g->high[axis], e);
}

void columns_scratch_free(columns_scratch *s)
{
    candidates_list_free(&s->hits);
    free(s->span);
    free(s->crossing);
    *s = (columns_scratch){0};
}
