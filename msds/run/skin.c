#include "msds/run/skin.h"

#include "base/mem.h"
#include "surface/triangulate.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 512, TURNS = 50 };

/* Of what is stable; over what is critical. And a spring that has collapsed counts
 * as this share of its length, at least. */
static const double safe = .9, damped = 1.1, least = 1e-5;

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
    skin_change(s, o);
    return 0;
}

void skin_change(skin *s, const skin_options *o)
{
    s->options = *o;
    s->oscillates = INFINITY;
    for (int64_t v = 0; v < s->vertices; v++)
        settle(s, v, o->stiffness * (double)(s->start[v + 1] - s->start[v]));
}

void skin_reset(skin *s)
{
    memset(s->u, 0, 3 * (size_t)s->vertices * sizeof *s->u);
    memset(s->v, 0, 3 * (size_t)s->vertices * sizeof *s->v);
}

void skin_free(skin *s)
{
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

static void pull(const skin *s, int64_t v, const skin_spring *spring, double force[3])
{
    const double *x = s->position, *u = s->u, *w = s->v, k = s->options.stiffness;
    const int64_t o = spring->other;
    double d[3], length = 0, speed = 0;
    for (int a = 0; a < 3; a++) {
        d[a] = (x[3 * o + a] - x[3 * v + a]) + (u[3 * o + a] - u[3 * v + a]);
        length += d[a] * d[a];
        speed += d[a] * (w[3 * o + a] - w[3 * v + a]);
    }
    length = fmax(sqrt(length), least * spring->rest);
    const double across = s->options.tension * k;
    double by = (k * (length - spring->rest) + s->options.damping * k * speed / length) / length;
    for (int a = 0; a < 3; a++)
        force[a] +=
            by * d[a] + across * ((u[3 * o + a] - u[3 * v + a]) + s->options.damping * (w[3 * o + a] - w[3 * v + a]));
}

/* A vertex that the step would leave in the probe comes to its surface. */
static void push(const skin *s, int64_t v)
{
    double *u = s->next_u + 3 * v, *speed = s->next_v + 3 * v, x[3], away = 0, along = 0;
    for (int a = 0; a < 3; a++) {
        x[a] = s->position[3 * v + a] + u[a];
        away += (x[a] - s->probe->centre[a]) * (x[a] - s->probe->centre[a]);
    }
    if (away > s->probe->reach * s->probe->reach)
        return;
    probe_touch t = probe_at(s->probe, x);
    if (!(t.depth > 0))
        return;
    for (int a = 0; a < 3; a++)
        along += t.way[a] * speed[a];
    for (int a = 0; a < 3; a++) {
        u[a] += t.depth * t.way[a];
        speed[a] -= fmin(0, along) * t.way[a];
    }
}

/* PST equations 3 to 5. A vertex of no triangle stays. */
static void step_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const skin *s = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        double force[3];
        for (int a = 0; a < 3; a++)
            force[a] = -s->anchor[v] * s->u[3 * v + a] - s->held[v] * s->v[3 * v + a];
        for (int64_t i = s->start[v]; i < s->start[v + 1]; i++)
            pull(s, v, &s->spring[i], force);
        for (int a = 0; a < 3; a++) {
            double speed = s->inertia[v] > 0 ? s->v[3 * v + a] + s->options.dt / s->inertia[v] * force[a] : 0;
            s->next_v[3 * v + a] = speed;
            s->next_u[3 * v + a] = s->u[3 * v + a] + s->options.dt * speed;
        }
        if (s->probe && s->inertia[v] > 0)
            push(s, v);
    }
}

static void swap(double **a, double **b)
{
    double *spare = *a;
    *a = *b;
    *b = spare;
}

void skin_step(skin *s, const probe_placed *at, int64_t count)
{
    s->probe = at;
    for (int64_t i = 0; i < count; i++) {
        pool_run(s->threads, s->vertices, CHUNK, step_some, s);
        swap(&s->u, &s->next_u);
        swap(&s->v, &s->next_v);
    }
    s->probe = NULL;
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
