#include "msds/run/skin.h"

#include "base/mem.h"
#include "surface/triangulate.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 512, TURNS = 50 };

/* Inertia is so large that a step is this share of a stable one, and the anchors damp this many times critically. */
static const double safe = .9, damped = 1.1;

static int cut(skin *s, const surface *shape, err *e)
{
    int64_t room = 0, capacity = 0;
    int32_t *part = NULL;
    int bad = 0;
    for (int64_t f = 0; f < shape->faces && !bad; f++) {
        const int32_t *vertex = shape->vertex + shape->start[f];
        int64_t corners = surface_end(shape, f) - shape->start[f];
        if (corners < 3)
            continue;
        bad = MEM_ROOM(&part, &capacity, 3 * corners, "the skin", e) ||
              MEM_ROOM(&s->triangle, &room, 3 * (s->triangles + corners - 2), "the skin", e) ||
              triangulate(shape->position, vertex, corners, part, e);
        for (int64_t i = 0; part && i < 3 * (corners - 2) && !bad; i++)
            s->triangle[3 * s->triangles + i] = vertex[part[i]];
        s->triangles += bad ? 0 : corners - 2;
    }
    free(part);
    if (!bad && !s->triangles)
        return err_set(e, NULL, 0, "surface %s has no polygons; expected triangles for a skin", shape->name);
    return bad ? -1 : 0;
}

static int by_number(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* The edges of the triangles, once each, as lesser << 32 | greater. */
static int64_t *list_edges(skin *s, err *e)
{
    int64_t *edge = mem_array(3 * s->triangles, sizeof *edge, "the skin", e), count = 0;
    for (int64_t i = 0; edge && i < 3 * s->triangles; i++) {
        int64_t a = s->triangle[i], b = s->triangle[i % 3 == 2 ? i - 2 : i + 1];
        if (a != b)
            edge[count++] = a < b ? a << 32 | b : b << 32 | a;
    }
    if (!edge)
        return NULL;
    qsort(edge, (size_t)count, sizeof *edge, by_number);
    for (int64_t i = 0; i < count; i++)
        if (!i || edge[i] != edge[i - 1])
            edge[s->edges++] = edge[i];
    return edge;
}

static double length_of(const skin *s, int64_t a, int64_t b)
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        double d = s->position[3 * b + c] - s->position[3 * a + c];
        square += d * d;
    }
    return sqrt(square);
}

/* Each edge at both of its ends, those of a vertex together. */
static int make_springs(skin *s, err *e)
{
    int64_t *edge = list_edges(s, e);
    s->start = mem_array(s->vertices + 1, sizeof *s->start, "the skin", e);
    s->spring = edge ? mem_array(2 * s->edges, sizeof *s->spring, "the skin", e) : NULL;
    int result = s->start && s->spring ? 0 : -1;
    for (int64_t i = 0; !result && i < s->edges; i++) {
        s->start[(edge[i] >> 32) + 1]++;
        s->start[(edge[i] & 0xffffffff) + 1]++;
    }
    for (int64_t v = 0; !result && v < s->vertices; v++)
        s->start[v + 1] += s->start[v];
    for (int64_t i = 0; !result && i < s->edges; i++) {
        int64_t end[2] = {edge[i] >> 32, edge[i] & 0xffffffff};
        double rest = length_of(s, end[0], end[1]);
        if (!(rest > 0))
            result = err_set(e, NULL, 0,
                             "surface %s: vertices %lld and %lld are at one place, with an edge between; "
                             "expected none of no length",
                             s->shape.name, (long long)end[0] + 1, (long long)end[1] + 1);
        for (int c = 0; c < 2; c++)
            s->spring[s->start[end[c]]++] = (skin_spring){(int32_t)end[1 - c], rest};
    }
    for (int64_t v = s->vertices; !result && v > 0; v--) /* filling moved each start to its end */
        s->start[v] = s->start[v - 1];
    if (!result)
        s->start[0] = 0;
    free(edge);
    return result;
}

/* Inertia and the anchor's damping of a vertex whose springs sum to k: dt^2 L + 2 dt C < 4 M with L and C from above,
 * row by row; the damping goes by the inertia, so this is done in turns. */
static void settle(skin *s, int64_t v, double k)
{
    const skin_options *o = &s->options;
    const double a = o->anchors * k, dt = o->dt, any = (1 + o->tension) * k;
    double m = 0, gamma = 0;
    for (int i = 0; i < TURNS; i++) {
        gamma = damped * fmax(2 * sqrt(m * a), o->damping > 0 ? 2 * m / o->damping : 0);
        m = (dt * dt * (2 * any + a) + 2 * dt * (2 * o->damping * any + gamma)) / (4 * safe);
    }
    s->inertia[v] = m;
    s->anchor[v] = a;
    s->held[v] = gamma;
    s->oscillates = fmin(s->oscillates, m > 0 ? gamma / (2 * sqrt(m * a)) : INFINITY);
}

static void settle_all(skin *s)
{
    s->oscillates = INFINITY;
    for (int64_t v = 0; v < s->vertices; v++)
        settle(s, v, s->options.stiffness * (double)(s->start[v + 1] - s->start[v]));
}

int skin_make(skin *s, const surface *shape, const skin_options *o, pool *threads, err *e)
{
    *s = (skin){
        .shape = *shape, .options = *o, .threads = threads, .position = shape->position, .vertices = shape->vertices};
    if (cut(s, shape, e) || make_springs(s, e))
        return -1;
    double **fields[] = {&s->u, &s->v, &s->next_u, &s->next_v};
    double **values[] = {&s->inertia, &s->anchor, &s->held};
    for (size_t i = 0; i < 4; i++)
        if (!(*fields[i] = mem_array(s->vertices, 3 * sizeof(double), "the skin", e)))
            return -1;
    for (size_t i = 0; i < 3; i++)
        if (!(*values[i] = mem_array(s->vertices, sizeof(double), "the skin", e)))
            return -1;
    settle_all(s);
    return 0;
}

void skin_free(skin *s)
{
    if (s->on_device)
        s->device->destroy(s->on_device);
    free(s->triangle);
    free(s->start);
    free(s->spring);
    free(s->inertia);
    free(s->anchor);
    free(s->held);
    free(s->u);
    free(s->v);
    free(s->next_u);
    free(s->next_v);
    *s = (skin){.vertices = 0};
}

/* ---- steps */

static skin_view view_of(const skin *s)
{
    return (skin_view){.vertices = s->vertices,
                       .edges = s->edges,
                       .options = s->options,
                       .position = s->position,
                       .start = s->start,
                       .spring = s->spring,
                       .inertia = s->inertia,
                       .anchor = s->anchor,
                       .held = s->held,
                       .u = s->u,
                       .v = s->v,
                       .next_u = s->next_u,
                       .next_v = s->next_v};
}

typedef struct stepping {
    skin_view view;
    const probe_placed *probe;
} stepping;

static void step_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const stepping *s = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++)
        skin_step_vertex(&s->view, s->probe, v);
}

static void swap(double **a, double **b)
{
    double *spare = *a;
    *a = *b;
    *b = spare;
}

/* The device has all that is here from its first step on. */
static int step_on_device(skin *s, const probe_placed *at, int64_t count, err *e)
{
    const skin_view view = view_of(s);
    if (!s->on_device)
        s->on_device = s->device->create(&view, e);
    return s->on_device ? s->device->step(s->on_device, at, count, e) : -1;
}

int skin_step(skin *s, const probe_placed *at, int64_t count, err *e)
{
    if (s->device)
        return step_on_device(s, at, count, e);
    for (int64_t i = 0; i < count; i++) {
        stepping by = {view_of(s), at};
        pool_run(s->threads, s->vertices, CHUNK, step_some, &by);
        swap(&s->u, &s->next_u);
        swap(&s->v, &s->next_v);
    }
    return 0;
}

int skin_change(skin *s, const skin_options *o, err *e)
{
    s->options = *o;
    settle_all(s);
    if (!s->on_device)
        return 0;
    const skin_view view = view_of(s);
    return s->device->change(s->on_device, &view, e);
}

int skin_reset(skin *s, err *e)
{
    memset(s->u, 0, 3 * (size_t)s->vertices * sizeof *s->u);
    memset(s->v, 0, 3 * (size_t)s->vertices * sizeof *s->v);
    return s->on_device ? s->device->reset(s->on_device, e) : 0;
}

int skin_fetch(skin *s, err *e)
{
    return s->on_device ? s->device->get(s->on_device, s->u, e) : 0;
}

void skin_normals(const skin *s, double *to)
{
    memset(to, 0, 3 * (size_t)s->vertices * sizeof *to);
    for (int64_t t = 0; t < s->triangles; t++) {
        const int32_t *c = s->triangle + 3 * t;
        double p[3][3];
        for (int i = 0; i < 3; i++)
            for (int a = 0; a < 3; a++)
                p[i][a] = s->position[3 * (int64_t)c[i] + a] + s->u[3 * (int64_t)c[i] + a];
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, d = (a + 2) % 3;
            double n = (p[1][b] - p[0][b]) * (p[2][d] - p[0][d]) - (p[1][d] - p[0][d]) * (p[2][b] - p[0][b]);
            for (int i = 0; i < 3; i++)
                to[3 * (int64_t)c[i] + a] += n;
        }
    }
    for (int64_t v = 0; v < s->vertices; v++) {
        double *n = to + 3 * v, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int a = 0; a < 3 && length > 0; a++)
            n[a] /= length;
    }
}

double skin_largest(const skin *s)
{
    double most = 0;
    for (int64_t v = 0; v < s->vertices; v++) {
        const double *u = s->u + 3 * v;
        double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
        if (!isfinite(square))
            return INFINITY;
        most = fmax(most, square);
    }
    return sqrt(most);
}
