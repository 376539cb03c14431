#include "base/mem.h"
#include "base/near.h"
#include "mesh/bound.h"
#include "surface/triangulate.h"
#include "tled/problem/script.h"
#include "tled/problem/triangle.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The name */

enum { SURFACES_TOLD = 100 };

/* The bound surfaces' names that somebody could mean. */
static int unknown_surface(const model *m, const keyfile *k, const char *word, err *e)
{
    char name[MODEL_NAME], *list[SURFACES_TOLD];
    int count = 0, status = 0;
    for (int at = 0; !status && count < SURFACES_TOLD && model_surface(m, &at, name, sizeof name);)
        if (surface_part(m, name, "vertex.element") && !(list[count++] = mem_text(name, e)))
            status = -1;
    if (!status && !count)
        status = keyfile_error(k, e, "'%.200s': the model has no bound surface; expected one from sinew bind", word);
    if (!status)
        status = near_unknown(e, k->name, k->line, "bound surface", word, (const char *const *)list, count);
    while (count)
        free(list[--count]);
    return status;
}

/* The model's surface of this name (n bytes), or else one that differs in upper and lower case only. */
static bool find_surface(const model *m, const char *word, size_t n, char *name)
{
    char other[MODEL_NAME];
    bool found = false;
    for (int at = 0; model_surface(m, &at, other, sizeof other);) {
        if (strlen(other) != n || strncasecmp(other, word, n) != 0)
            continue;
        const bool exact = !strncmp(other, word, n);
        if (!found || exact)
            memcpy(name, other, n + 1);
        found = true;
        if (exact)
            break;
    }
    return found;
}

int script_take_surface(script_curve *c, const model *m, const keyfile *k, char *name, err *e)
{
    char word[201] = "";
    bound b;
    const size_t n = strcspn(c->target, ":");
    memcpy(word, c->target, n < sizeof word ? n : sizeof word - 1);
    if (!find_surface(m, c->target, n, name))
        return unknown_surface(m, k, word, e);
    const int is_bound = bound_of(&b, m, name, e);
    if (is_bound < 0)
        return -1;
    if (!is_bound)
        return keyfile_error(k, e, "surface '%.200s' is not bound; expected one that sinew bind put into the model",
                             name);
    if (b.corners != 8)
        return keyfile_error(k, e, "surface '%.200s' is bound to tetrahedra; expected hexahedra", name);
    c->surface = name;
    return 0;
}

/* Its triangles: of faces with three corners and more, in their order */

typedef struct picker {
    script *s;
    const script_curve *c;
    surface from;
    const char *group; /* that faces must be of; NULL: any */
    const double *box; /* that triangles must be in; NULL: anywhere */
    double near;       /* m: how far outside of it a vertex may be */
    int32_t *cut;      /* corners of the face's triangles */
    int64_t room;
} picker;

static bool is_in_box(const picker *p, const int32_t *vertex, const int32_t *triangle)
{
    for (int i = 0; p->box && i < 9; i++) {
        const double x = p->from.position[3 * (int64_t)vertex[triangle[i / 3]] + i % 3];
        if (x < p->box[i % 3] - p->near || x > p->box[3 + i % 3] + p->near)
            return false;
    }
    return true;
}

static int add_triangle(script *s, const int32_t *vertex, const int32_t *triangle, double part, err *e)
{
    if (s->triangles >= INT32_MAX / 8)
        return err_set(e, NULL, 0, "the script's targets have more than %d triangles in all", INT32_MAX / 8);
    if (mem_grow(&s->corner, &s->corner_capacity, s->triangles + 1, 3 * sizeof *s->corner, "the script's triangles",
                 e) ||
        mem_grow(&s->part, &s->part_capacity, s->triangles + 1, sizeof *s->part, "the script's triangles", e))
        return -1;
    s->part[s->triangles] = part;
    for (int i = 0; i < 3; i++)
        s->corner[3 * s->triangles + i] = vertex[triangle[i]];
    s->triangles++;
    s->curve[s->curves - 1].triangle_count++;
    return 0;
}

static int add_triangles(picker *p, const int32_t *vertex, const int32_t *cut, int64_t count, double part, err *e)
{
    for (int64_t t = 0; t < count; t++)
        if (is_in_box(p, vertex, cut + 3 * t) && add_triangle(p->s, vertex, cut + 3 * t, part, e))
            return -1;
    return 0;
}

/* A quadrilateral cut by one diagonal and by the other. */
static const int32_t both_ways[12] = {0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3};

/* Whether its corners all turn one way. */
static bool is_convex(const surface *from, const int32_t *vertex)
{
    double first[3] = {0}, other[3] = {0};
    bool convex = true;
    for (int i = 0; i < 4; i++) {
        const int32_t *corner = both_ways + 3 * i;
        triangle_normal(from->position + 3 * (int64_t)vertex[corner[0]],
                        from->position + 3 * (int64_t)vertex[corner[1]],
                        from->position + 3 * (int64_t)vertex[corner[2]], i ? other : first);
        convex &= !i || first[0] * other[0] + first[1] * other[1] + first[2] * other[2] > 0;
    }
    return convex;
}

static int add_face(picker *p, int64_t face, err *e)
{
    const surface *from = &p->from;
    const int64_t count = surface_end(from, face) - from->start[face];
    const int32_t *vertex = from->vertex + from->start[face];
    if (count < 3 || (p->group && !surface_in_group(from->group_name[from->group[face]], p->group)))
        return 0;
    if (count == 4 && is_convex(from, vertex))
        return add_triangles(p, vertex, both_ways, 4, .5, e);
    if (3 * count > p->room && mem_grow(&p->cut, &p->room, 3 * count, sizeof *p->cut, "a polygon", e))
        return -1;
    if (triangulate(from->position, vertex, count, p->cut, e))
        return -1;
    return add_triangles(p, vertex, p->cut, count - 2, 1, e);
}

/* Coordinates are products and sums with roundings. */
static double rounding_of(const surface *s)
{
    double largest = 0;
    for (int64_t i = 0; i < 3 * s->vertices; i++)
        largest = fmax(largest, fabs(s->position[i]));
    return 1e-12 * largest;
}

static int no_triangle(const picker *p, const keyfile *k, err *e)
{
    const char *name = p->c->surface;
    if (p->box)
        return keyfile_error(k, e,
                             "no triangle of '%.100s' lies in the box %.200s; expected X0,Y0,Z0,X1,Y1,Z1 around some, "
                             "in metres or with suffixes",
                             name, script_region(p->c));
    if (p->group)
        return near_unknown(e, k->name, k->line, "group of polygons", p->group, (const char *const *)p->from.group_name,
                            p->from.groups < INT32_MAX ? (int)p->from.groups : INT32_MAX);
    return keyfile_error(k, e, "surface '%.200s' has no triangle; expected some", name);
}

/* Whether it is closed: each edge goes one way round as often as the other. Vertices at one place count as one. */

typedef struct edge {
    int32_t low, high; /* the first of the vertices at each place */
    int32_t sense;     /* 2: from low to high, 1 in a triangle that counts by half; -2, -1: back */
} edge;

typedef struct place {
    double x[3];
    int32_t vertex;
} place;

static int compare_places(const void *left, const void *right)
{
    const place *a = left, *b = right;
    for (int i = 0; i < 3; i++)
        if (a->x[i] != b->x[i])
            return a->x[i] < b->x[i] ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static int compare_edges(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return (a->high > b->high) - (a->high < b->high);
}

/* weld: of each vertex, the first at its place. */
static int weld_vertices(const surface *s, int32_t *weld, err *e)
{
    place *list = mem_array(s->vertices, sizeof *list, "the vertices", e);
    if (!list)
        return -1;
    for (int64_t i = 0; i < s->vertices; i++) {
        memcpy(list[i].x, s->position + 3 * i, sizeof list[i].x);
        list[i].vertex = (int32_t)i;
    }
    qsort(list, (size_t)s->vertices, sizeof *list, compare_places);
    for (int64_t i = 0, first = 0; i < s->vertices; i++) {
        for (int a = 0; a < 3; a++)
            if (list[i].x[a] != list[first].x[a])
                first = i;
        weld[list[i].vertex] = list[first].vertex;
    }
    free(list);
    return 0;
}

static int64_t list_edges(const int32_t *corner, const double *part, int64_t triangles, const int32_t *weld, edge *list)
{
    int64_t count = 0;
    for (int64_t i = 0; i < 3 * triangles; i++) {
        const int32_t sense = (int32_t)(2 * part[i / 3]);
        const int32_t from = weld[corner[i]], to = weld[corner[i % 3 == 2 ? i - 2 : i + 1]];
        if (from < to)
            list[count++] = (edge){from, to, sense};
        else if (from > to)
            list[count++] = (edge){to, from, -sense};
    }
    return count;
}

static int64_t count_open(const edge *list, int64_t count)
{
    int64_t open = 0, sum = 0;
    for (int64_t i = 0; i < count; i++) {
        sum += list[i].sense;
        if (i + 1 == count || compare_edges(&list[i], &list[i + 1]) != 0) {
            open += sum != 0;
            sum = 0;
        }
    }
    return open;
}

/* How many edges of these triangles are open, or -1 with e filled. */
static int64_t find_open(const surface *s, const int32_t *corner, const double *part, int64_t triangles, err *e)
{
    int64_t open = -1;
    int32_t *weld = mem_array(s->vertices, sizeof *weld, "the vertices", e);
    edge *list = weld ? mem_array(3 * triangles, sizeof *list, "the edges", e) : NULL;
    if (list && !weld_vertices(s, weld, e)) {
        const int64_t count = list_edges(corner, part, triangles, weld, list);
        qsort(list, (size_t)count, sizeof *list, compare_edges);
        open = count_open(list, count);
    }
    free(weld);
    free(list);
    return open;
}

static int check_closed(const script *s, const script_curve *c, const surface *from, const keyfile *k, err *e)
{
    const int64_t open =
        find_open(from, s->corner + 3 * (int64_t)c->triangle_first, s->part + c->triangle_first, c->triangle_count, e);
    if (open > 0)
        return keyfile_error(k, e,
                             "surface '%.200s' is not closed: %" PRId64 " open edge%s; expected each edge between two "
                             "triangles that face the same way, or a region: SURFACE:GROUP or "
                             "SURFACE:X0,Y0,Z0,X1,Y1,Z1",
                             c->surface, open, open == 1 ? "" : "s");
    return open < 0 ? -1 : 0;
}

int script_take_triangles(script *s, const model *m, const keyfile *k, err *e)
{
    const script_curve *c = &s->curve[s->curves - 1];
    const char *region = script_region(c);
    const bool by_box = region && strchr(region, ',');
    picker p = {.s = s, .c = c, .group = by_box ? NULL : region, .box = by_box ? c->box : NULL};
    int status = surface_of(m, c->surface, &p.from, e);
    if (!status)
        p.near = rounding_of(&p.from);
    for (int64_t i = 0; i < p.from.faces && !status; i++)
        status = add_face(&p, i, e);
    free(p.cut);
    if (!status && !c->triangle_count)
        status = no_triangle(&p, k, e);
    if (!status && c->verb == SCRIPT_PRESSURE && !c->is_region)
        status = check_closed(s, c, &p.from, k, e);
    return status;
}
