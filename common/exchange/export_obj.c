#include "exchange/export_obj.h"

#include "base/chars.h"
#include "base/mem.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct writer {
    const export_shape *x;
    bool deformed;
    num_unit unit;
    out *to;
} writer;

/* A side of an element. */
typedef struct side {
    int32_t low[4];  /* its nodes in rising order; a triangle's last is -1, and comes first */
    int32_t node[4]; /* in order around it, seen from outside; a triangle's last is -1 */
    int32_t group;
    int64_t place; /* element x 6 + side: keeps the model's order */
} side;

/* The sides of cells in VTK order, their normals outward. */
static const int8_t hexahedron[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
static const int8_t tetrahedron[4][4] = {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}};

static void put_vertex(const writer *w, int64_t point)
{
    double at[3];
    export_shape_point(w->x, point, w->deformed, at);
    for (int a = 0; a < 3; a++)
        at[a] = num_length_in((num_length){at[a], num_unit_of("m")}, w->unit, w->unit);
    out_format(w->to, "v %.9g %.9g %.9g\n", at[0], at[1], at[2]);
}

/* Whether a byte would end a name, or the line. */
static bool ends_name(int byte)
{
    return byte == 0 || byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r';
}

/* A group's name in the bytes of the OBJ that it came from. Blanks and control characters of names that came from
 * elsewhere would end it, and a backslash at its end would join the next line to it. */
static void put_group(const char *name, bool several, out *to)
{
    out_text(to, "g ");
    for (const char *p = *name ? name : "unnamed"; *p; p++) {
        const int byte = chars_escaped(p);
        const char own = (char)byte;
        bool blank = (unsigned char)*p <= ' ' && !(several && *p == ' ');
        if (byte >= 0 && !ends_name(byte)) {
            out_write(to, &own, 1);
            p += 3;
        } else {
            out_write(to, blank || *p == 0x7f || (*p == '\\' && !p[1]) ? "_" : p, 1);
        }
    }
    out_text(to, "\n");
}

static void put_surface(const writer *w)
{
    const surface *s = &w->x->s;
    int32_t group = -1;
    for (int64_t v = 0; v < s->vertices; v++)
        put_vertex(w, v);
    for (int64_t f = 0; f < s->faces; f++) {
        int64_t corners;
        const int32_t *vertex = export_shape_cell(w->x, f, &corners);
        if (s->group[f] != group) {
            group = s->group[f];
            put_group(s->group_name[group], true, w->to);
        }
        if (!corners)
            continue;
        static const char *const kind[] = {"", "p", "l", "f"};
        out_text(w->to, kind[corners < 3 ? corners : 3]);
        for (int64_t c = 0; c < corners; c++)
            out_format(w->to, " %" PRId64, (int64_t)vertex[c] + 1);
        out_text(w->to, "\n");
    }
}

static int by_number(const void *a, const void *b)
{
    int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int by_nodes(const void *a, const void *b)
{
    const side *p = a, *q = b;
    for (int i = 0; i < 4; i++)
        if (p->low[i] != q->low[i])
            return p->low[i] < q->low[i] ? -1 : 1;
    return (p->place > q->place) - (p->place < q->place);
}

static int by_group(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->group != q->group)
        return p->group < q->group ? -1 : 1;
    return (p->place > q->place) - (p->place < q->place);
}

static side side_of(const int32_t *node, const int8_t *corner, int32_t group, int64_t place)
{
    side s = {.group = group, .place = place};
    for (int i = 0; i < 4; i++)
        s.low[i] = s.node[i] = corner[i] < 0 ? -1 : node[corner[i]];
    qsort(s.low, 4, sizeof *s.low, by_number);
    return s;
}

/* All sides of all elements, sorted so that the same ones meet. */
static side *all_sides(const export_shape *x, int64_t *count, err *e)
{
    const model_array *volume = model_find(x->m, "element.volume");
    int sides = x->node->columns == 8 ? 6 : 4;
    int64_t corners;
    *count = x->cells * sides;
    side *list = mem_array(*count, sizeof *list, "sides of elements", e);
    for (int64_t i = 0; list && i < *count; i++) {
        const int32_t *node = export_shape_cell(x, i / sides, &corners);
        const int8_t *corner = sides == 6 ? hexahedron[i % sides] : tetrahedron[i % sides];
        list[i] = side_of(node, corner, volume ? volume->i32[i / sides] : 0, i);
    }
    if (list)
        qsort(list, (size_t)*count, sizeof *list, by_nodes);
    return list;
}

/* Keeps those that no other element has, by group. Returns how many. */
static int64_t keep_outer(side *list, int64_t count)
{
    int64_t kept = 0, same;
    for (int64_t i = 0; i < count; i += same) {
        for (same = 1; i + same < count && !memcmp(list[i].low, list[i + same].low, sizeof list->low); same++)
            ;
        if (same == 1)
            list[kept++] = list[i];
    }
    qsort(list, (size_t)kept, sizeof *list, by_group);
    return kept;
}

/* Writes the nodes in use, and leaves in number[] what an OBJ calls them, from 1. */
static void put_used(const writer *w, const side *list, int64_t count, int64_t *number)
{
    int64_t used = 0;
    for (int64_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++)
            if (list[i].node[c] >= 0)
                number[list[i].node[c]] = 1;
    for (int64_t p = 0; p < w->x->points; p++)
        if (number[p]) {
            number[p] = ++used;
            put_vertex(w, p);
        }
}

static void put_sides(const writer *w, const side *list, int64_t count, const int64_t *number)
{
    const model_array *name = model_find(w->x->m, "volume.name");
    bool named = name && model_find(w->x->m, "element.volume");
    for (int64_t i = 0; i < count; i++) {
        if (!i || list[i].group != list[i - 1].group)
            put_group(named ? name->str[list[i].group] : "elements", false, w->to);
        out_text(w->to, "f");
        for (int c = 0; c < 4 && list[i].node[c] >= 0; c++)
            out_format(w->to, " %" PRId64, number[list[i].node[c]]);
        out_text(w->to, "\n");
    }
}

static int put_boundary(const writer *w, err *e)
{
    int64_t count;
    side *list = all_sides(w->x, &count, e);
    int64_t *number = list ? mem_array(w->x->points, sizeof *number, "nodes", e) : NULL;
    if (number) {
        count = keep_outer(list, count);
        put_used(w, list, count, number);
        put_sides(w, list, count, number);
    }
    const bool made = number;
    free(list);
    free(number);
    return made ? 0 : -1;
}

int export_obj(const export_shape *x, bool deformed, num_unit unit, out *to, err *e)
{
    writer w = {.x = x, .deformed = deformed, .unit = unit, .to = to};
    if (!x->is_surface)
        return put_boundary(&w, e);
    put_surface(&w);
    return 0;
}
