#include "slice/contour/contour.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Samples have a border of one on every side, which is outside; cubes and edges are known by
 * the bordered sample of their low corner. */
typedef struct march {
    const float *value;
    const int64_t *size;
    int64_t wide, area; /* of a bordered layer */
    double level;
    const cubes *table;
    contour *to;
    uint8_t *inside[2]; /* bordered layers below and above the cubes: 1 = inside */
    uint8_t *four;      /* a row: the inside of four samples in bits 0, 2, 4, 6 */
    uint8_t *code;      /* a row: of eight */
    int32_t *edge[5];   /* vertices on edges of a layer: x below, x above, y below, y above, z between */
    int64_t at[3];      /* the cube */
} march;

static int open_march(march *m, err *e)
{
    m->wide = m->size[0] + 2;
    m->area = m->wide * (m->size[1] + 2);
    for (int i = 0; i < 5; i++) {
        m->edge[i] = mem_array(m->area, sizeof *m->edge[i], "edges", e);
        if (!m->edge[i])
            return -1;
    }
    for (int i = 0; i < 2; i++) {
        m->inside[i] = mem_array(m->area, 1, "a layer of samples", e);
        if (!m->inside[i])
            return -1;
    }
    m->four = mem_array(m->wide + 8, 1, "a row of cubes", e);
    m->code = m->four ? mem_array(m->wide + 8, 1, "a row of cubes", e) : NULL;
    return m->code ? 0 : -1;
}

static void close_march(march *m)
{
    for (int i = 0; i < 5; i++)
        free(m->edge[i]);
    free(m->inside[0]);
    free(m->inside[1]);
    free(m->four);
    free(m->code);
}

static float sample(const march *m, int64_t x, int64_t y, int64_t z)
{
    return m->value[(z * m->size[1] + y) * m->size[0] + x];
}

/* Corner of the cube, less the level; only for those within the box. */
static double corner_value(const march *m, int corner)
{
    return sample(m, m->at[0] - 1 + (corner & 1), m->at[1] - 1 + (corner >> 1 & 1), m->at[2] - 1 + (corner >> 2)) -
           m->level;
}

static void look_at_layer(const march *m, int64_t z, uint8_t *inside)
{
    if (z < 1 || z > m->size[2]) {
        memset(inside, 0, (size_t)m->area);
        return;
    }
    float level = (float)m->level;
    for (int64_t y = 0; y < m->size[1]; y++) {
        const float *row = m->value + ((z - 1) * m->size[1] + y) * m->size[0];
        uint8_t *to = inside + (y + 1) * m->wide + 1;
        for (int64_t x = 0; x < m->size[0]; x++)
            to[x] = row[x] >= level;
    }
}

static int32_t *edge_place(const march *m, int edge)
{
    int axis = edge / 4, b = edge % 2, c = edge % 4 / 2;
    int64_t at = m->at[1] * m->wide + m->at[0];
    switch (axis) {
    case 0: /* b is y, c is z */
        return m->edge[c] + at + b * m->wide;
    case 1: /* b is z, c is x */
        return m->edge[2 + b] + at + c;
    default: /* b is x, c is y */
        return m->edge[4] + at + b + c * m->wide;
    }
}

static int32_t add_vertex(contour *c, const double position[3], const double outward[3])
{
    int64_t v = c->vertices++;
    for (int i = 0; i < 3; i++) {
        c->position[3 * v + i] = position[i];
        c->outward[3 * v + i] = (float)outward[i];
    }
    return (int32_t)v;
}

/* The vertex on the edge that ends at corner 7 along an axis, between `from` (the other end) and 7. */
static void cross_edge(const march *m, int axis, unsigned code)
{
    int from = 7 & ~(1 << axis);
    bool low_inside = code >> from & 1;
    double position[3], outward[3] = {0}, share = .5;
    for (int i = 0; i < 3; i++)
        position[i] = (double)m->at[i];
    position[axis] -= 1;
    if (m->at[axis] > 0 && m->at[axis] < m->size[axis]) {
        double a = corner_value(m, from), b = corner_value(m, 7);
        share = a / (a - b);
        share = isnan(share) ? .5 : num_clamp(share, CONTOUR_NEAREST, 1 - CONTOUR_NEAREST);
    }
    position[axis] += share;
    outward[axis] = low_inside ? 1 : -1;
    *edge_place(m, 4 * axis + 3) = add_vertex(m->to, position, outward);
}

/* Which of the ambiguous faces join their inside corners, as cubes_of wants it. */
static unsigned join(const march *m, unsigned code, unsigned ambiguous)
{
    unsigned joined = 0, bit = 1;
    for (int face = 0; face < 6; face++) {
        if (!(ambiguous >> face & 1))
            continue;
        int corner[4];
        double v[4];
        cubes_face(face, corner);
        for (int i = 0; i < 4; i++)
            v[i] = corner_value(m, corner[i]);
        double even = v[0] * v[2], odd = v[1] * v[3];
        if (code >> corner[0] & 1 ? even > odd : odd > even)
            joined |= bit;
        bit <<= 1;
    }
    return joined;
}

static int32_t add_centre(contour *c, const cubes_case *k, const int32_t vertex[12])
{
    double position[3] = {0}, outward[3] = {0};
    for (int t = 0; t < k->triangles; t++) {
        if (k->vertex[3 * t + 2] != CUBES_CENTRE)
            continue;
        int64_t v = vertex[k->vertex[3 * t]];
        for (int i = 0; i < 3; i++) {
            position[i] += c->position[3 * v + i] / k->rim;
            outward[i] += c->outward[3 * v + i] / (double)k->rim;
        }
    }
    return add_vertex(c, position, outward);
}

static void cut_cube(march *m, unsigned code)
{
    contour *c = m->to;
    unsigned last = code >> 7;
    for (int axis = 0; axis < 3; axis++)
        if ((code >> (7 & ~(1 << axis)) & 1) != last)
            cross_edge(m, axis, code);
    unsigned ambiguous = m->table->ambiguous[code];
    const cubes_case *k = cubes_of(m->table, code, ambiguous ? join(m, code, ambiguous) : 0);
    int32_t vertex[13] = {0};
    for (int t = 0; t < 3 * k->triangles; t++)
        if (k->vertex[t] < CUBES_CENTRE)
            vertex[k->vertex[t]] = *edge_place(m, k->vertex[t]);
    if (k->rim)
        vertex[CUBES_CENTRE] = add_centre(c, k, vertex);
    int32_t *to = c->triangle + 3 * c->triangles;
    for (int t = 0; t < 3 * k->triangles; t++)
        to[t] = vertex[k->vertex[t]];
    c->triangles += k->triangles;
}

/* Room for a cube's worth of both. */
static int make_room(contour *c, err *e)
{
    int64_t vertices = c->vertex_room, triangles = c->triangle_room;
    if (c->vertices + 4 > INT32_MAX)
        return err_set(e, NULL, 0, "the surface has more than %d vertices", INT32_MAX);
    if (c->vertices + 4 > vertices) {
        int64_t room = vertices;
        if (mem_grow(&c->position, &room, c->vertices + 4, 3 * sizeof *c->position, "vertices", e))
            return -1;
        room = vertices;
        if (mem_grow(&c->outward, &room, c->vertices + 4, 3 * sizeof *c->outward, "vertices", e))
            return -1;
        c->vertex_room = room;
    }
    if (c->triangles + CUBES_TRIANGLES > triangles)
        return mem_grow(&c->triangle, &c->triangle_room, c->triangles + CUBES_TRIANGLES, 3 * sizeof *c->triangle,
                        "triangles", e);
    return 0;
}

/* Eight cubes at once that are wholly in or out. */
static bool all_same(const uint8_t *code)
{
    uint64_t eight;
    memcpy(&eight, code, sizeof eight);
    return !eight || !~eight;
}

static int march_row(march *m, err *e)
{
    const uint8_t *row[4];
    for (int i = 0; i < 4; i++)
        row[i] = m->inside[i / 2] + (m->at[1] + i % 2) * m->wide;
    for (int64_t x = 0; x < m->wide; x++)
        m->four[x] = (uint8_t)(row[0][x] | row[1][x] << 2 | row[2][x] << 4 | row[3][x] << 6);
    for (int64_t x = 0; x + 1 < m->wide; x++)
        m->code[x] = (uint8_t)(m->four[x] | m->four[x + 1] << 1);
    for (int64_t x = 0; x + 1 < m->wide; x++) {
        if (x + 8 < m->wide && all_same(m->code + x)) {
            x += 7;
            continue;
        }
        if (m->code[x] == 0 || m->code[x] == 255)
            continue;
        m->at[0] = x;
        if (make_room(m->to, e))
            return -1;
        cut_cube(m, m->code[x]);
    }
    return 0;
}

static void swap_edges(march *m, int i)
{
    int32_t *below = m->edge[i];
    m->edge[i] = m->edge[i + 1];
    m->edge[i + 1] = below;
}

int contour_make(contour *c, const float *value, const int64_t size[3], float level, const cubes *table, err *e)
{
    march m = {.value = value, .size = size, .level = (double)level, .table = table, .to = c};
    int code = open_march(&m, e);
    for (m.at[2] = 0; !code && m.at[2] <= size[2]; m.at[2]++) {
        uint8_t *below = m.inside[0];
        m.inside[0] = m.inside[1];
        m.inside[1] = below;
        look_at_layer(&m, m.at[2] + 1, m.inside[1]);
        swap_edges(&m, 0);
        swap_edges(&m, 2);
        for (m.at[1] = 0; !code && m.at[1] <= size[1]; m.at[1]++)
            code = march_row(&m, e);
    }
    close_march(&m);
    return code;
}

void contour_free(contour *c)
{
    free(c->position);
    free(c->outward);
    free(c->triangle);
    *c = (contour){0};
}
