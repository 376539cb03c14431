#include "slice/image/slice_cut.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

typedef struct corner {
    double u, v;
    int64_t number; /* 4 times its piece, and which of its corners */
} corner;

static int by_place(const void *a, const void *b)
{
    const corner *x = a, *y = b;
    if (x->u != y->u)
        return x->u < y->u ? -1 : 1;
    return (x->v > y->v) - (x->v < y->v);
}

static void put_vertex(const slice_plane *at, const corner *c, out *to)
{
    double mm[3];
    for (int a = 0; a < 3; a++)
        mm[a] = 1e3 * (at->origin[a] + at->column[a] * c->u + at->row[a] * c->v);
    out_format(to, "v %.9g %.9g %.9g\n", mm[0], mm[1], mm[2]);
}

/* Equal corners are one vertex; the vertex of each corner of each piece: *vertex, which the caller frees. */
static int put_vertices(const slice_piece *piece, int64_t count, const slice_plane *at, out *to, int64_t **vertex,
                        err *e)
{
    int64_t corners = 0, vertices = 0;
    corner *list = mem_array(4 * count, sizeof *list, "corners", e);
    *vertex = list ? mem_array(4 * count, sizeof **vertex, "corners", e) : NULL;
    if (!*vertex) {
        free(list);
        return -1;
    }
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < piece[i].corners; k++)
            list[corners++] = (corner){piece[i].u[k], piece[i].v[k], 4 * i + k};
    qsort(list, (size_t)corners, sizeof *list, by_place);
    for (int64_t i = 0; i < corners; i++) {
        if (!i || by_place(&list[i - 1], &list[i])) {
            put_vertex(at, &list[i], to);
            vertices++;
        }
        (*vertex)[list[i].number] = vertices;
    }
    free(list);
    return 0;
}

/* Twice the area; below 0 where the corners go around the other way. */
static double area_of(const slice_piece *p)
{
    double sum = 0;
    for (int k = 0; k < p->corners; k++) {
        const int next = k + 1 < p->corners ? k + 1 : 0;
        sum += (p->u[k] - p->u[0]) * (p->v[next] - p->v[0]) - (p->u[next] - p->u[0]) * (p->v[k] - p->v[0]);
    }
    return sum;
}

/* Corners that fell together are one; fewer than three are no polygon. All go around the same way: to whom
 * looks along columns x rows, clockwise. */
static int64_t put_face(const slice_piece *p, const int64_t *vertex, out *to)
{
    int64_t list[4];
    int count = 0;
    const bool back = area_of(p) < 0;
    for (int k = 0; k < p->corners; k++) {
        const int64_t at = vertex[back ? p->corners - 1 - k : k];
        if (!count || (list[count - 1] != at && list[0] != at))
            list[count++] = at;
    }
    if (count < 3)
        return 0;
    out_text(to, "f");
    for (int k = 0; k < count; k++)
        out_format(to, " %lld", (long long)list[k]);
    out_text(to, "\n");
    return 1;
}

static void put_group(const model *m, int32_t group, out *to)
{
    const model_array *names = model_find(m, "volume.name");
    char name[MODEL_NAME] = "tissue";
    if (names && names->type == MODEL_STR && group >= 0 && group < names->rows && *names->str[group])
        memccpy(name, names->str[group], 0, sizeof name - 1);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '#' || *c == '\\')
            *c = '_';
    out_format(to, "g %s\n", name);
}

int slice_cut_write(const slice_cutter *c, const slice_plane *at, const model *m, out *to, int64_t *count, err *e)
{
    const model_array *volumes = model_find(m, "element.volume");
    int64_t *vertex = NULL, pieces = 0;
    int32_t last = -2;
    slice_piece *piece = slice_cutter_pieces(c, &pieces, e);
    const int failed = piece ? put_vertices(piece, pieces, at, to, &vertex, e) : -1;
    *count = 0;
    for (int64_t i = 0; !failed && i < pieces; i++) {
        const int32_t group = volumes ? volumes->i32[piece[i].tet] : -1;
        if (group != last)
            put_group(m, group, to);
        last = group;
        *count += put_face(&piece[i], vertex + 4 * i, to);
    }
    free(vertex);
    free(piece);
    return failed;
}
