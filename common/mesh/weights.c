#include "mesh/weights.h"

#include "mesh/lattice.h"

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
