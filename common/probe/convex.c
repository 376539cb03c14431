#include "probe/convex.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* Shares of the shape's size: how far a corner may stand out of a face, how narrow a face may be that has no say, how
 * thin a body may be; and by how much normals of one plane may differ. */
static const double tolerance = 1e-5, narrow = 1e-7, flat = 1e-4, same = 1e-6;

typedef struct corner_place {
    double x[3];
    int32_t vertex;
} corner_place;

typedef struct convex {
    const obj *o;
    double scale;
    int32_t *own;  /* the OBJ's vertices: which corner, -1 where no face has it */
    int64_t *edge; /* corners' edges, (lesser corner, greater corner) as one number */
    int64_t edges;
    double extent; /* m: the longest side of the bounding box */
    double centre[3];
} convex;

static int bad(const convex *c, int64_t face, err *e, const char *what)
{
    int32_t v = c->o->corner_vertex[c->o->face_start[face]];
    return err_set(e, c->o->name, 0, "face %lld (its first vertex on line %lld) %s; expected a closed convex surface",
                   (long long)face + 1, (long long)obj_line_number(c->o, c->o->v[v].from), what);
}

static int by_place(const void *a, const void *b)
{
    const corner_place *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->x[i] < q->x[i] || p->x[i] > q->x[i])
            return p->x[i] < q->x[i] ? -1 : 1;
    return (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

/* The places of used vertices, in order. Returns how many, or -1. */
static int64_t list_places(convex *c, corner_place *list, err *e)
{
    int64_t count = 0;
    for (int64_t v = 0; v < c->o->vertices; v++)
        c->own[v] = -1;
    for (int64_t f = 0; f < c->o->faces; f++)
        if (c->o->face_start[f + 1] - c->o->face_start[f] < 3)
            return bad(c, f, e, "is a point or a line");
    for (int64_t i = 0; i < c->o->corners; i++) {
        int32_t v = c->o->corner_vertex[i];
        if (c->own[v] >= 0)
            continue;
        c->own[v] = 0;
        for (int a = 0; a < 3; a++)
            list[count].x[a] = c->o->position[3 * (int64_t)v + a] * c->scale + 0.; /* no -0 */
        list[count++].vertex = v;
    }
    qsort(list, (size_t)count, sizeof *list, by_place);
    return count;
}

/* One corner a place. */
static int weld(convex *c, probe *p, err *e)
{
    corner_place *list = mem_array(c->o->vertices, sizeof *list, "the probe", e);
    c->own = mem_array(c->o->vertices, sizeof *c->own, "the probe", e);
    int64_t count = list && c->own ? list_places(c, list, e) : -1;
    if (count >= 0)
        p->corner = mem_array(count, 3 * sizeof *p->corner, "the probe", e);
    for (int64_t i = 0; i < count && p->corner; i++) {
        if (!i || memcmp(list[i].x, list[i - 1].x, sizeof list[i].x) != 0)
            memcpy(p->corner + 3 * (int64_t)p->corners++, list[i].x, sizeof list[i].x);
        c->own[list[i].vertex] = p->corners - 1;
    }
    free(list);
    return count < 0 || !p->corner ? -1 : 0;
}

static void bound(convex *c, probe *p)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t i = 0; i < 3 * (int64_t)p->corners; i++) {
        low[i % 3] = fmin(low[i % 3], p->corner[i]);
        high[i % 3] = fmax(high[i % 3], p->corner[i]);
    }
    for (int a = 0; a < 3; a++) {
        p->middle[a] = low[a] + .5 * (high[a] - low[a]);
        c->extent = fmax(c->extent, high[a] - low[a]);
    }
    for (int32_t i = 0; i < p->corners; i++) {
        double square = 0;
        for (int a = 0; a < 3; a++) {
            double d = p->corner[3 * (int64_t)i + a] - p->middle[a];
            square += d * d;
            c->centre[a] += p->corner[3 * (int64_t)i + a] / p->corners;
        }
        p->reach = fmax(p->reach, sqrt(square));
    }
}

static int by_number(const void *a, const void *b)
{
    int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

/* Each edge has two faces. Welded corners may make edges of no length, which are none. */
static int check_edges(convex *c, err *e)
{
    c->edge = mem_array(c->o->corners, sizeof *c->edge, "the probe", e);
    if (!c->edge)
        return -1;
    for (int64_t f = 0; f < c->o->faces; f++)
        for (int64_t i = c->o->face_start[f]; i < c->o->face_start[f + 1]; i++) {
            int64_t next = i + 1 < c->o->face_start[f + 1] ? i + 1 : c->o->face_start[f];
            int64_t a = c->own[c->o->corner_vertex[i]], b = c->own[c->o->corner_vertex[next]];
            if (a != b)
                c->edge[c->edges++] = a < b ? a << 32 | b : b << 32 | a;
        }
    qsort(c->edge, (size_t)c->edges, sizeof *c->edge, by_number);
    int64_t open = 0, many = 0;
    for (int64_t i = 0, next; i < c->edges; i = next) {
        for (next = i; next < c->edges && c->edge[next] == c->edge[i];)
            next++;
        open += next - i == 1;
        many += next - i > 2;
    }
    if (!open && !many)
        return 0;
    return err_set(e, c->o->name, 0, "%lld open edges, %lld of more than two faces; expected a closed convex surface",
                   (long long)open, (long long)many);
}

/* Newell's normal, with the length of twice the area. */
static double normal_of(const convex *c, const probe *p, int64_t face, double n[3])
{
    n[0] = n[1] = n[2] = 0;
    for (int64_t i = c->o->face_start[face]; i < c->o->face_start[face + 1]; i++) {
        int64_t next = i + 1 < c->o->face_start[face + 1] ? i + 1 : c->o->face_start[face];
        const double *x = p->corner + 3 * (int64_t)c->own[c->o->corner_vertex[i]];
        const double *y = p->corner + 3 * (int64_t)c->own[c->o->corner_vertex[next]];
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, d = (a + 2) % 3;
            n[a] += (x[b] - y[b]) * (x[d] + y[d] - 2 * c->centre[d]);
        }
    }
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

static void add_plane(const convex *c, probe *p, const double n[3], double far)
{
    for (int32_t i = 0; i < p->planes; i++) {
        const double *q = p->plane + 4 * (int64_t)i;
        if (fabs(q[0] - n[0]) + fabs(q[1] - n[1]) + fabs(q[2] - n[2]) < same && fabs(q[3] - far) < same * c->extent)
            return;
    }
    double *to = p->plane + 4 * (int64_t)p->planes++;
    memcpy(to, n, 3 * sizeof *n);
    to[3] = far;
}

/* All corners are behind the face, or in it; or all before it, where it is turned in. */
static int take_face(const convex *c, probe *p, int64_t face, err *e)
{
    double n[3], low = INFINITY, high = -INFINITY, face_low = INFINITY, face_high = -INFINITY;
    double area = normal_of(c, p, face, n);
    if (area <= narrow * c->extent * c->extent)
        return 0;
    for (int a = 0; a < 3; a++)
        n[a] /= area;
    for (int32_t i = 0; i < p->corners; i++) {
        const double *x = p->corner + 3 * (int64_t)i;
        double d = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
        low = fmin(low, d);
        high = fmax(high, d);
    }
    for (int64_t i = c->o->face_start[face]; i < c->o->face_start[face + 1]; i++) {
        const double *x = p->corner + 3 * (int64_t)c->own[c->o->corner_vertex[i]];
        double d = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
        face_low = fmin(face_low, d);
        face_high = fmax(face_high, d);
    }
    bool outward = high - face_low <= tolerance * c->extent, inward = face_high - low <= tolerance * c->extent;
    if (!outward && !inward)
        return bad(c, face, e, "has vertices on both of its sides: not convex");
    if (outward && inward)
        return bad(c, face, e, "has all vertices in its plane: flat");
    for (int a = 0; a < 3 && inward; a++)
        n[a] = -n[a];
    add_plane(c, p, n, inward ? -low : high);
    return 0;
}

static int make_planes(convex *c, probe *p, err *e)
{
    p->plane = mem_array(c->o->faces, 4 * sizeof *p->plane, "the probe", e);
    if (!p->plane)
        return -1;
    for (int64_t f = 0; f < c->o->faces; f++)
        if (take_face(c, p, f, e))
            return -1;
    p->size = p->planes ? probe_at_own(p, c->centre).depth : 0;
    if (p->planes < 4 || !(p->size > flat * c->extent))
        return err_set(e, c->o->name, 0,
                       "a body of %g m, %g m from its middle to its surface: flat; expected a closed convex surface",
                       c->extent, p->size);
    return 0;
}

/* A triangle, turned out as its place says: a fan over a polygon that is not convex has some that lie the other way. */
static void add_face(const convex *c, probe *p, int32_t first, int32_t second, int32_t third)
{
    if (first == second || second == third || third == first)
        return;
    const double *x = p->corner + 3 * (int64_t)first, *y = p->corner + 3 * (int64_t)second,
                 *z = p->corner + 3 * (int64_t)third;
    double outward = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, d = (a + 2) % 3;
        outward += ((y[b] - x[b]) * (z[d] - x[d]) - (y[d] - x[d]) * (z[b] - x[b])) * (x[a] - c->centre[a]);
    }
    int32_t *to = p->face + 3 * (int64_t)p->faces++;
    to[0] = first;
    to[1] = outward < 0 ? third : second;
    to[2] = outward < 0 ? second : third;
}

/* A fan over each polygon, which covers it: what lies in its plane is a convex part of the surface. */
static int make_faces(const convex *c, probe *p, err *e)
{
    p->face = mem_array(c->o->corners - 2 * c->o->faces, 3 * sizeof *p->face, "the probe", e);
    for (int64_t f = 0; p->face && f < c->o->faces; f++) {
        const int32_t *v = c->o->corner_vertex + c->o->face_start[f];
        for (int64_t i = 1; i + 1 < c->o->face_start[f + 1] - c->o->face_start[f]; i++)
            add_face(c, p, c->own[v[0]], c->own[v[i]], c->own[v[i + 1]]);
    }
    return p->face ? 0 : -1;
}

int convex_of(probe *p, const obj *o, double scale, err *e)
{
    convex c = {.o = o, .scale = scale};
    int result = -1;
    if (o->faces < 4 || o->faces > CONVEX_FACES)
        return err_set(e, o->name, 0, "%lld faces; expected a closed convex surface of 4 to %d", (long long)o->faces,
                       CONVEX_FACES);
    if (weld(&c, p, e))
        goto out;
    bound(&c, p);
    result = check_edges(&c, e) || make_planes(&c, p, e) || make_faces(&c, p, e) ? -1 : 0;
out:
    free(c.own);
    free(c.edge);
    return result;
}

int probe_load(probe *p, double scale, err *e)
{
    obj o = {0};
    if (p->kind != PROBE_CONVEX)
        return 0;
    in *source = in_open(p->file, e);
    int result = source ? obj_read(&o, source, e) : -1;
    in_close(source);
    if (!result)
        result = convex_of(p, &o, scale, e);
    obj_free(&o);
    return result;
}
