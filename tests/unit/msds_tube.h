/* A tube about z of tetrahedra, and its lumen, as a model for msds: rings of nodes about an axis, cells between them
 * split into six along their diagonals, those at the axis into three. The nodes of the axis
 * are rigid, which holds the lumen's mesh alone.
 */
#ifndef SINEW_MSDS_TUBE_H
#define SINEW_MSDS_TUBE_H

#include "msds_block.h"

enum { TUBE_WALL, TUBE_LUMEN };

#define TUBE_PI 3.14159265358979

typedef struct tube {
    int around, lumen, wall, along; /* cells: about the axis, from it to the wall, through the wall, along z */
    double radius, thickness, length;
    double oval; /* the radius is more by this share of itself times cos 2 theta */
    double young, poisson;
} tube;

static inline int32_t tube_node(const tube *t, int ring, int at, int level)
{
    const int each = 1 + (t->lumen + t->wall) * t->around;
    return level * each + (ring ? 1 + (ring - 1) * t->around + at % t->around : 0);
}

static inline double tube_radius(const tube *t, int ring)
{
    return ring <= t->lumen ? t->radius * ring / t->lumen : t->radius + t->thickness * (ring - t->lumen) / t->wall;
}

static inline void tube_cell(const tube *t, int ring, int at, int level, int32_t *to, int64_t *count)
{
    static const int path[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    for (int k = 0; k < 6; k++) {
        int step[3] = {0, 0, 0};
        int32_t n[4] = {tube_node(t, ring, at, level), 0, 0, 0};
        step[path[k][0]] = 1;
        n[1] = tube_node(t, ring + step[0], at + step[1], level + step[2]);
        step[path[k][1]] = 1;
        n[2] = tube_node(t, ring + step[0], at + step[1], level + step[2]);
        n[3] = tube_node(t, ring + 1, at + 1, level + 1);
        if (n[0] == n[1] || n[1] == n[2] || n[0] == n[2]) /* a ring of one node, the axis */
            continue;
        memcpy(to + 4 * (*count)++, n, sizeof n);
    }
}

/* Nodes in VTK order. */
static inline void tube_turn(int32_t *node, const double *x)
{
    simplex s;
    simplex_shape(x + 3 * (int64_t)node[0], x + 3 * (int64_t)node[1], x + 3 * (int64_t)node[2],
                  x + 3 * (int64_t)node[3], &s);
    if (s.volume < 0) {
        const int32_t spare = node[0];
        node[0] = node[1];
        node[1] = spare;
    }
}

static inline void tube_make(const tube *t, model *m)
{
    err e = {0};
    const int rings = t->lumen + t->wall;
    const int64_t nodes = (int64_t)(1 + rings * t->around) * (t->along + 1);
    const int64_t elements = (int64_t)t->around * t->along * (6 * (rings - 1) + 3);
    int64_t count = 0;
    tets_must(!model_axis_add(m, "node", nodes, &e) && !model_axis_add(m, "element", elements, &e), &e);
    tets_array(m, "node.position");
    tets_array(m, "node.rigid");
    tets_must(model_add_as(m, "element.node", MODEL_I32, "@node", "element", 4, &e) != NULL, &e);
    const tets b = {.young = t->young, .poisson = t->poisson, .density = 1000};
    tets_volumes(&b, 2, m);
    double *x = model_find(m, "node.position")->f64;
    int32_t *node = model_find(m, "element.node")->i32, *volume = model_find(m, "element.volume")->i32;
    for (int level = 0; level <= t->along; level++)
        for (int ring = 0; ring <= rings; ring++)
            for (int at = 0; at < (ring ? t->around : 1); at++) {
                double *to = x + 3 * (int64_t)tube_node(t, ring, at, level);
                const double angle = 2 * TUBE_PI * at / t->around;
                const double r = tube_radius(t, ring) * (1 + t->oval * cos(2 * angle));
                to[0] = r * cos(angle);
                to[1] = r * sin(angle);
                to[2] = t->length * level / t->along;
            }
    for (int level = 0; level < t->along; level++)
        for (int ring = 0; ring < rings; ring++)
            for (int at = 0; at < t->around; at++) {
                const int64_t from = count;
                tube_cell(t, ring, at, level, node, &count);
                for (int64_t i = from; i < count; i++)
                    volume[i] = ring < t->lumen ? TUBE_LUMEN : TUBE_WALL;
            }
    for (int64_t i = 0; i < count; i++)
        tube_turn(node + 4 * i, x);
    uint8_t *rigid = model_find(m, "node.rigid")->u8;
    for (int level = 0; level <= t->along; level++)
        rigid[tube_node(t, 0, 0, level)] = 1;
}

#endif
