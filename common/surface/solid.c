#include "surface/solid.h"

#include "base/mem.h"
#include "surface/coincident.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

/* Edges */

typedef struct edge {
    int32_t low, high; /* numbers of places */
    int32_t sense;     /* 2: from low to high, 1 in a triangle that counts by half; -2, -1: back */
} edge;

static int compare_edges(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    return (a->high > b->high) - (a->high < b->high);
}

static int64_t list_edges(const int32_t *corner, const double *part, int64_t triangles, const int32_t *place,
                          edge *list)
{
    int64_t count = 0;
    for (int64_t i = 0; i < 3 * triangles; i++) {
        const int32_t sense = part ? (int32_t)(2 * part[i / 3]) : 2;
        const int32_t from = place[corner[i]], to = place[corner[i % 3 == 2 ? i - 2 : i + 1]];
        if (from < to)
            list[count++] = (edge){from, to, sense};
        else if (from > to)
            list[count++] = (edge){to, from, -sense};
    }
    return count;
}

/* How many edges are open, and the first of them. */
static int64_t count_open(const edge *list, int64_t count, edge *first)
{
    int64_t open = 0, sum = 0;
    for (int64_t i = 0; i < count; i++) {
        sum += list[i].sense;
        if (i + 1 < count && compare_edges(&list[i], &list[i + 1]) == 0)
            continue;
        if (sum && !open++)
            *first = list[i];
        sum = 0;
    }
    return open;
}

/* A vertex at that place. */
static const double *vertex_at(const surface *s, const int32_t *place, int32_t number)
{
    int64_t v = 0;
    while (place[v] != number)
        v++;
    return s->position + 3 * v;
}

/* Says how many edges of these triangles are open, and where the first one is; nothing where none is. */
int solid_open(const surface *s, const int32_t *corner, const double *part, int64_t triangles, char text[SOLID_OPEN],
               err *e)
{
    int status = -1;
    edge first = {0, 0, 0};
    int32_t *place = mem_array(s->vertices, sizeof *place, "the vertices", e);
    edge *list = place ? mem_array(3 * triangles, sizeof *list, "the edges", e) : NULL;
    *text = '\0';
    if (list && coincident_places(s->position, s->vertices, place, e) >= 0) {
        const int64_t count = list_edges(corner, part, triangles, place, list);
        qsort(list, (size_t)count, sizeof *list, compare_edges);
        const int64_t open = count_open(list, count, &first);
        const double *a = vertex_at(s, place, first.low), *b = vertex_at(s, place, first.high);
        if (open)
            snprintf(text, SOLID_OPEN, "%" PRId64 " open edge%s at %.4gmm,%.4gmm,%.4gmm", open,
                     open == 1 ? "" : "s, the first", 500 * (a[0] + b[0]), 500 * (a[1] + b[1]), 500 * (a[2] + b[2]));
        status = 0;
    }
    free(place);
    free(list);
    return status;
}

/* Whether it is a region of space. */
static int check(const trimesh *t, const char *file, err *e)
{
    const surface shape = {.position = t->position, .vertices = t->vertices};
    char open[SOLID_OPEN];
    if (!t->triangles)
        return err_set(e, NULL, 0, "%.200s has no polygons; expected a closed surface", file);
    if (solid_open(&shape, t->corner, NULL, t->triangles, open, e))
        return -1;
    if (*open)
        return err_set(e, NULL, 0,
                       "%.200s is not closed: %s; expected each edge between two triangles that face the same way",
                       file, open);
    return 0;
}

int solid_read(trimesh *t, const char *file, double scale, err *e)
{
    obj o = {0};
    in *source = in_open(file, e);
    const int failed = !source || obj_read(&o, source, e) || trimesh_of(t, &o, scale, e) || check(t, file, e);
    in_close(source);
    obj_free(&o);
    return failed ? -1 : 0;
}
