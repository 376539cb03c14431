/* What tests see of a mesh of tetrahedra: its volume, its angles. Borrows the model.
 */
#ifndef SINEW_MESH_LOOK_H
#define SINEW_MESH_LOOK_H

#include "msds/mesh/mesh_tets.h"

#include <math.h>

static inline const double *place(const model *m, int64_t node)
{
    return &model_find(m, "node.position")->f64[3 * node];
}

static inline void less(const double *a, const double *b, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

static inline double dot(const double *u, const double *v)
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

static inline double longest_edge(const model *m, const int32_t *node)
{
    double longest = 0, edge[3];
    for (int i = 0; i < 16; i++) {
        less(place(m, node[i / 4]), place(m, node[i % 4]), edge);
        longest = fmax(longest, sqrt(dot(edge, edge)));
    }
    return longest;
}

/* Across the edge from p to q: the angle between what r and s are off it, degrees. */
static inline double angle(const model *m, int32_t p, int32_t q, int32_t r, int32_t s)
{
    double edge[3], u[3], v[3];
    less(place(m, q), place(m, p), edge);
    less(place(m, r), place(m, p), u);
    less(place(m, s), place(m, p), v);
    const double along = dot(u, edge) / dot(edge, edge), too = dot(v, edge) / dot(edge, edge);
    for (int i = 0; i < 3; i++) {
        u[i] -= along * edge[i];
        v[i] -= too * edge[i];
    }
    return acos(dot(u, v) / sqrt(dot(u, u) * dot(v, v))) * 180 / acos(-1);
}

typedef struct look {
    double least, most; /* dihedral angles, degrees */
    double room, thin;  /* m3: of all, of the smallest */
    double ratio;       /* of longest edges across a face, at most */
    int64_t outside, shared, torn;
} look;

static inline void look_at_angles(const model *m, look *l)
{
    const model_array *node = model_find(m, "element.node");
    *l = (look){.least = 180, .thin = INFINITY, .ratio = 1};
    for (int64_t t = 0; t < node->rows; t++) {
        const int32_t *n = &node->i32[4 * t];
        const double v = mesh_six_volumes(n, place(m, 0)) / 6;
        l->room += v;
        l->thin = fmin(l->thin, v);
        for (int p = 0; p < 4; p++)
            for (int q = p + 1; q < 4; q++) {
                const int r = p == 0 ? 1 + (q == 1) : 0, s = 6 - p - q - r;
                const double a = angle(m, n[p], n[q], n[r], n[s]);
                l->least = fmin(l->least, a);
                l->most = fmax(l->most, a);
            }
    }
}

#endif
