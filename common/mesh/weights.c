#include "mesh/weights.h"

#include "mesh/lattice.h"
#include "surface/closest.h"

#include <math.h>
#include <string.h>

weights_box weights_box_of(const int32_t *node, const double *position)
{
    weights_box box;
    const double *first = &position[3 * (int64_t)node[0]], *last = &position[3 * (int64_t)node[6]];
    for (int a = 0; a < 3; a++) {
        box.first[a] = first[a];
        box.side[a] = last[a] - first[a];
    }
    return box;
}

void weights_of(const weights_box *box, const double *point, double *weight)
{
    for (int a = 0; a < 3; a++)
        weight[a] = 1 - (point[a] - box->first[a]) / box->side[a];
}

/* One axis's factor of a node's share: w on the first node's side, 1 - w on the other. */
static double factor(double weight, int32_t far)
{
    return far ? 1 - weight : weight;
}

void weights_shares(const double *weight, double *share)
{
    for (int n = 0; n < 8; n++) {
        const int32_t *far = lattice_vtk[n];
        share[n] = factor(weight[0], far[0]) * factor(weight[1], far[1]) * factor(weight[2], far[2]);
    }
}

void weights_displacement(const int32_t *node, int32_t columns, const double *weight, const double *u, double *d)
{
    double hexahedron[8], sum[3] = {0};
    const double *share = columns == 8 ? hexahedron : weight;
    if (columns == 8)
        weights_shares(weight, hexahedron);
    for (int32_t n = 0; n < columns; n++)
        for (int a = 0; a < 3; a++)
            sum[a] += share[n] * u[3 * (int64_t)node[n] + a];
    memcpy(d, sum, sizeof sum);
}

/* dw_i / dp_i = -1 / v_i. */
void weights_gradients(const weights_box *box, const double *weight, double *gradient)
{
    for (int n = 0; n < 8; n++) {
        const int32_t *far = lattice_vtk[n];
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            double slope = (far[a] ? 1 : -1) / box->side[a];
            gradient[3 * n + a] = slope * factor(weight[b], far[b]) * factor(weight[c], far[c]);
        }
    }
}

double weights_outside(const weights_box *box, const double *weight)
{
    double d[3];
    for (int a = 0; a < 3; a++)
        d[a] = fmax(fmax(weight[a] - 1, -weight[a]), 0) * box->side[a];
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* The three sides that leave a tetrahedron's first node, and each's cross product of the other two; their product. */
static double sides_of(const int32_t *node, const double *position, double side[3][3], double across[3][3])
{
    const double *first = &position[3 * (int64_t)node[0]];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            side[i][a] = position[3 * (int64_t)node[i + 1] + a] - first[a];
    for (int i = 0; i < 3; i++) {
        const double *p = side[(i + 1) % 3], *q = side[(i + 2) % 3];
        for (int a = 0; a < 3; a++)
            across[i][a] = p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3];
    }
    return side[0][0] * across[0][0] + side[0][1] * across[0][1] + side[0][2] * across[0][2];
}

void weights_tetrahedron_gradients(const int32_t *node, const double *position, double *gradient)
{
    double side[3][3], across[3][3], product = sides_of(node, position, side, across);
    for (int a = 0; a < 3; a++) {
        gradient[a] = 0;
        for (int i = 0; i < 3; i++) {
            gradient[3 * (i + 1) + a] = across[i][a] / product;
            gradient[a] -= across[i][a] / product;
        }
    }
}

void weights_tetrahedron(const int32_t *node, const double *position, const double *point, double *weight)
{
    double side[3][3], across[3][3], product = sides_of(node, position, side, across);
    const double *first = &position[3 * (int64_t)node[0]];
    weight[0] = 1;
    for (int i = 0; i < 3; i++) {
        weight[i + 1] = 0;
        for (int a = 0; a < 3; a++)
            weight[i + 1] += (point[a] - first[a]) * across[i][a];
        weight[i + 1] /= product;
        weight[0] -= weight[i + 1];
    }
}

double weights_tetrahedron_volume(const int32_t *node, const double *position)
{
    double side[3][3], across[3][3], product = fabs(sides_of(node, position, side, across)), longest2 = 0;
    for (int i = 0; i < 3; i++)
        for (int j = -1; j < i; j++) {
            double square = 0;
            for (int a = 0; a < 3; a++) {
                double d = side[i][a] - (j < 0 ? 0 : side[j][a]);
                square += d * d;
            }
            longest2 = fmax(longest2, square);
        }
    return product > 1e-9 * longest2 * sqrt(longest2) ? product / 6 : 0;
}

double weights_tetrahedron_outside(const int32_t *node, const double *position, const double *point)
{
    double weight[4], least = INFINITY, near[3];
    const double *x[4];
    bool inside = true;
    weights_tetrahedron(node, position, point, weight);
    for (int n = 0; n < 4; n++) {
        x[n] = &position[3 * (int64_t)node[n]];
        inside = inside && weight[n] >= 0;
    }
    for (int n = 0; n < 4 && !inside; n++) /* the face across from node n */
        if (weight[n] < 0)
            least = fmin(least, closest_triangle(x[(n + 1) % 4], x[(n + 2) % 4], x[(n + 3) % 4], point, near));
    return inside ? 0 : sqrt(least);
}
