#include "mesh/hexahedron.h"

#include "mesh/lattice.h"
#include "mesh/weights.h"

#include <math.h>
#include <string.h>

static const double *corner(const int32_t *node, const double *position, int c)
{
    return &position[3 * (int64_t)node[c]];
}

bool hexahedron_is_box(const int32_t *node, const double *position)
{
    const double *first = corner(node, position, 0), *last = corner(node, position, 6);
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++) {
            const double want = lattice_vtk[c][a] ? last[a] : first[a];
            if (fabs(corner(node, position, c)[a] - want) > 1e-9 * fabs(last[a] - first[a]))
                return false;
        }
    return true;
}

/* The slope of each node's share along each weight: 8 x 3. */
static void slopes(const double *weight, double slope[8][3])
{
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++) {
            slope[c][a] = lattice_vtk[c][a] ? -1 : 1;
            for (int b = 0; b < 3; b++)
                if (b != a)
                    slope[c][a] *= lattice_vtk[c][b] ? 1 - weight[b] : weight[b];
        }
}

/* Where the weights are. */
static void place_of(const int32_t *node, const double *position, const double *weight, double *at)
{
    double share[8];
    memset(at, 0, 3 * sizeof *at);
    weights_shares(weight, share);
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++)
            at[a] += share[c] * corner(node, position, c)[a];
}

/* The inverse of J_ij = dx_i / dw_j, rows by w. False: it has none. */
static bool inverse_of(const int32_t *node, const double *position, const double *weight, double inverse[3][3])
{
    double slope[8][3], j[3][3] = {{0}}, det;
    slopes(weight, slope);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 3; i++)
            for (int a = 0; a < 3; a++)
                j[i][a] += corner(node, position, c)[i] * slope[c][a];
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 3; i++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, a1 = (a + 1) % 3, a2 = (a + 2) % 3;
            inverse[a][i] = j[i1][a1] * j[i2][a2] - j[i1][a2] * j[i2][a1];
        }
    det = j[0][0] * inverse[0][0] + j[1][0] * inverse[0][1] + j[2][0] * inverse[0][2];
    for (int k = 0; k < 9; k++)
        inverse[k / 3][k % 3] /= det;
    return isfinite(1 / det);
}

/* One step of Newton's, kept within `out` of the element. Returns how far the weights went, or -1. */
static double step(const int32_t *node, const double *position, const double *point, double out, double *weight)
{
    double at[3], inverse[3][3], gone = 0;
    place_of(node, position, weight, at);
    if (!inverse_of(node, position, weight, inverse))
        return -1;
    for (int a = 0; a < 3; a++) {
        const double before = weight[a];
        for (int i = 0; i < 3; i++)
            weight[a] += inverse[a][i] * (point[i] - at[i]);
        weight[a] = fmin(1 + out, fmax(-out, weight[a]));
        gone = fmax(gone, fabs(weight[a] - before));
    }
    return gone;
}

void hexahedron_weights(const int32_t *node, const double *position, const double *point, double *weight)
{
    double gone = 1, kept[3] = {0}, at[3], best = INFINITY;
    weight[0] = weight[1] = weight[2] = .5;
    for (int i = 0; i < 30 && gone > 1e-14; i++) {
        gone = step(node, position, point, .5, weight);
        place_of(node, position, weight, at);
        double away = hypot(hypot(at[0] - point[0], at[1] - point[1]), at[2] - point[2]);
        if (away < best) {
            best = away;
            memcpy(kept, weight, sizeof kept);
        }
        if (gone < 0)
            break;
    }
    if (best < INFINITY)
        memcpy(weight, kept, sizeof kept);
}

double hexahedron_outside(const int32_t *node, const double *position, const double *point)
{
    double weight[3], at[3];
    const double *first = corner(node, position, 0), *last = corner(node, position, 6);
    hexahedron_weights(node, position, point, weight);
    place_of(node, position, weight, at);
    bool inside = hypot(hypot(at[0] - point[0], at[1] - point[1]), at[2] - point[2]) <=
                  1e-9 * hypot(hypot(last[0] - first[0], last[1] - first[1]), last[2] - first[2]);
    for (int a = 0; a < 3; a++) {
        inside = inside && weight[a] >= 0 && weight[a] <= 1;
        weight[a] = fmin(1, fmax(0, weight[a]));
    }
    if (inside)
        return 0;
    /* From the nearest face, along it too. */
    for (int i = 0; i < 10; i++)
        if (step(node, position, point, 0, weight) <= 1e-12)
            break;
    place_of(node, position, weight, at);
    return hypot(hypot(at[0] - point[0], at[1] - point[1]), at[2] - point[2]);
}

void hexahedron_gradients(const int32_t *node, const double *position, const double *weight, double *gradient)
{
    double slope[8][3], inverse[3][3] = {{0}};
    slopes(weight, slope);
    inverse_of(node, position, weight, inverse);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 3; i++) {
            gradient[3 * c + i] = 0;
            for (int a = 0; a < 3; a++)
                gradient[3 * c + i] += slope[c][a] * inverse[a][i];
        }
}

/* Adds one Gauss point's part of V and V B. The derivatives times det J are cofactors of J: nothing is divided. */
static void add_point(const double *at, const double point[3], double *b, double *volume)
{
    double slope[8][3], j[3][3] = {{0}}, cofactor[3][3];
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++) {
            slope[c][a] = (lattice_vtk[c][a] ? 1. : -1.) / 8;
            for (int k = 0; k < 3; k++)
                if (k != a)
                    slope[c][a] *= 1 + (lattice_vtk[c][k] ? 1 : -1) * point[k];
            for (int i = 0; i < 3; i++)
                j[i][a] += at[3 * c + i] * slope[c][a];
        }
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, a1 = (a + 1) % 3, a2 = (a + 2) % 3;
            cofactor[i][a] = j[i1][a1] * j[i2][a2] - j[i1][a2] * j[i2][a1];
        }
    for (int a = 0; a < 3; a++)
        *volume += j[0][a] * cofactor[0][a];
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 3; i++)
            for (int a = 0; a < 3; a++)
                b[3 * c + i] += slope[c][a] * cofactor[i][a];
}

/* Two points a direction integrate them exactly. */
double hexahedron_mean(const double *at, double *b)
{
    const double off = 1 / sqrt(3);
    double volume = 0;
    memset(b, 0, 24 * sizeof *b);
    for (int c = 0; c < 8; c++) {
        double point[3];
        for (int a = 0; a < 3; a++)
            point[a] = lattice_vtk[c][a] ? off : -off;
        add_point(at, point, b, &volume);
    }
    for (int i = 0; i < 24; i++)
        b[i] /= volume;
    return volume;
}

double hexahedron_sign(int mode, int corner)
{
    static const int factors[7] = {1, 2, 4, 3, 6, 5, 7};
    double s = 1;
    for (int a = 0; a < 3; a++)
        if (factors[mode] & 1 << a)
            s *= lattice_vtk[corner][a] ? 1 : -1;
    return s;
}

void hexahedron_modes(const double *at, const double *b, double *slope, double *twist)
{
    for (int m = 0; m < 7; m++)
        for (int i = 0; i < 3; i++) {
            double sum = 0, turn = 0;
            for (int c = 0; c < 8; c++) {
                sum += hexahedron_sign(m, c) * b[3 * c + i];
                turn += hexahedron_sign(m, c) * at[3 * c + i];
            }
            slope[3 * m + i] = sum / 8;
            if (m >= 3)
                twist[3 * (m - 3) + i] = turn;
        }
}

void hexahedron_basis(const double *at, double basis[9])
{
    for (int i = 0; i < 9; i++) {
        double sum = 0;
        for (int c = 0; c < 8; c++)
            sum += hexahedron_sign(i % 3, c) * at[3 * c + i / 3];
        basis[i] = sum / 8;
    }
}
