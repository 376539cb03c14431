/* Vectors, and the quality of tetrahedra, for what moves nodes. */
#ifndef SINEW_MESH_SHAPE_H
#define SINEW_MESH_SHAPE_H

#include "msds/mesh/mesh_tets.h"

#include <math.h>
#include <string.h>

static inline void shape_less(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[i] - b[i];
}

static inline void shape_cross(const double u[3], const double v[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

static inline double shape_dot(const double u[3], const double v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

static inline double shape_length(const double v[3])
{
    return sqrt(shape_dot(v, v));
}

/* To a length of 1; nothing stays nothing. */
static inline void shape_unit(double v[3])
{
    const double length = shape_length(v);
    for (int i = 0; i < 3; i++)
        v[i] = length > 0 ? v[i] / length : 0;
}

/* corner: 4 x 3, in order. Six times the volume, over the cube of the edges' root mean square: 1.414 of a regular
 * one. */
static inline double shape_quality(const double *corner)
{
    static const int32_t order[4] = {0, 1, 2, 3};
    double square = 0, edge[3];
    for (int p = 0; p < 4; p++)
        for (int q = p + 1; q < 4; q++) {
            shape_less(corner + 3 * p, corner + 3 * q, edge);
            square += shape_dot(edge, edge) / 6;
        }
    return mesh_six_volumes(order, corner) / (square * sqrt(square));
}

#endif
