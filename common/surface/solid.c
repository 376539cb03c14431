#include "surface/solid.h"

#include "base/mem.h"
#include "surface/coincident.h"
#include "surface/triangulate.h"

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
        const int32_t sense = (int32_t)(2 * part[i / 3]);
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

/* Triangles of an OBJ */

void solid_free(solid *b)
{
    obj_free(&b->file);
    free(b->metres);
    free(b->corner);
    free(b->part);
}

static int cut_face(solid *b, int64_t face, err *e)
{
    const int64_t first = b->file.face_start[face], count = b->file.face_start[face + 1] - first;
    const int32_t *vertex = b->file.corner_vertex + first;
    if (count < 3)
        return 0;
    if (mem_grow(&b->corner, &b->room, b->triangles + count - 2, 3 * sizeof *b->corner, "a region", e))
        return -1;
    int32_t *cut = b->corner + 3 * b->triangles;
    if (triangulate(b->metres, vertex, count, cut, e))
        return -1;
    for (int64_t i = 0; i < 3 * (count - 2); i++)
        cut[i] = vertex[cut[i]];
    b->triangles += count - 2;
    return 0;
}

static int solid_cut(solid *b, double scale, err *e)
{
    int status = 0;
    b->metres = mem_array(b->file.vertices, 3 * sizeof *b->metres, "a region", e);
    if (!b->metres)
        return -1;
    for (int64_t i = 0; i < 3 * b->file.vertices; i++)
        b->metres[i] = surface_metres(b->file.position[i], scale);
    b->shape = (surface){.position = b->metres, .vertices = b->file.vertices};
    for (int64_t f = 0; f < b->file.faces && !status; f++)
        status = cut_face(b, f, e);
    if (status || !(b->part = mem_array(b->triangles, sizeof *b->part, "a region", e)))
        return -1;
    for (int64_t t = 0; t < b->triangles; t++)
        b->part[t] = 1;
    return 0;
}

/* Whether it is a region of space. */
static int check(const solid *b, const char *file, err *e)
{
    char open[SOLID_OPEN];
    if (!b->triangles)
        return err_set(e, NULL, 0, "%.200s has no polygons; expected a closed surface", file);
    if (solid_open(&b->shape, b->corner, b->part, b->triangles, open, e))
        return -1;
    if (*open)
        return err_set(e, NULL, 0,
                       "%.200s is not closed: %s; expected each edge between two triangles that face the same way",
                       file, open);
    return 0;
}

int solid_read(solid *b, const char *file, double scale, err *e)
{
    in *source = in_open(file, e);
    const int failed = !source || obj_read(&b->file, source, e) || solid_cut(b, scale, e) || check(b, file, e);
    in_close(source);
    return failed ? -1 : 0;
}
