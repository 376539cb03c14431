/* Places in a deformed element of eight nodes, whose map from (0, 1)^3 to space is trilinear: which place a point is,
 * the nodes' shares there, and the slope in space of what is trilinear between nodes. One source for every executor, in
 * double. Keeps nothing.
 */
#ifndef SINEW_DEFORMED_PLACE_H
#define SINEW_DEFORMED_PLACE_H

#include "tled/problem/moves.h"

#include <math.h>
#include <stdbool.h>

#define DEFORMED_FUNCTION MOVES_FUNCTION

/* A place is found in so many turns, to so much of a side, within so many sides. */
enum { DEFORMED_TURNS = 12 };
#define DEFORMED_NEAR 1e-10
#define DEFORMED_FAR  2.

/* What is trilinear, as the factors of 1, x, y, z, xy, yz, zx and xyz. */
typedef struct deformed_factors {
    double of[8];
} deformed_factors;

/* Where an element is: of each component of space, m. */
typedef struct deformed_map {
    deformed_factors at[3];
} deformed_map;

/* Of corner k, in VTK order, 0 or 1 along an axis. */
DEFORMED_FUNCTION int deformed_corner(int k, int axis)
{
    if (axis == 0)
        return (k ^ k >> 1) & 1;
    return axis == 1 ? k >> 1 & 1 : k >> 2;
}

/* v: at the nodes, in VTK order. */
DEFORMED_FUNCTION deformed_factors deformed_factors_of(const double *v)
{
    const deformed_factors f = {{v[0], v[1] - v[0], v[3] - v[0], v[4] - v[0], (v[2] - v[3]) - (v[1] - v[0]),
                                 (v[7] - v[4]) - (v[3] - v[0]), (v[5] - v[1]) - (v[4] - v[0]),
                                 ((v[6] - v[7]) - (v[5] - v[4])) - ((v[2] - v[3]) - (v[1] - v[0]))}};
    return f;
}

DEFORMED_FUNCTION double deformed_value(const deformed_factors *v, const double *xi)
{
    const double *f = v->of, x = xi[0], y = xi[1], z = xi[2];
    return (f[0] + f[1] * x) + (f[2] + f[4] * x) * y + ((f[3] + f[6] * x) + (f[5] + f[7] * x) * y) * z;
}

/* d/dx, d/dy, d/dz. */
DEFORMED_FUNCTION void deformed_slopes(const deformed_factors *v, const double *xi, double *slope)
{
    const double *f = v->of, x = xi[0], y = xi[1], z = xi[2];
    slope[0] = (f[1] + f[4] * y) + (f[6] + f[7] * y) * z;
    slope[1] = (f[2] + f[4] * x) + (f[5] + f[7] * x) * z;
    slope[2] = (f[3] + f[6] * x) + (f[5] + f[7] * x) * y;
}

DEFORMED_FUNCTION void deformed_shares(const double *xi, double *share)
{
    for (int k = 0; k < 8; k++) {
        share[k] = 1;
        for (int a = 0; a < 3; a++)
            share[k] *= deformed_corner(k, a) ? xi[a] : 1 - xi[a];
    }
}

/* The place that has these shares. */
DEFORMED_FUNCTION void deformed_place_of_shares(const double *share, double *xi)
{
    for (int a = 0; a < 3; a++) {
        xi[a] = 0;
        for (int k = 0; k < 8; k++)
            xi[a] += deformed_corner(k, a) ? share[k] : 0;
    }
}

/* The most that a place is out of (0, 1), along an axis. */
DEFORMED_FUNCTION double deformed_outside(const double *xi)
{
    double most = -1;
    for (int a = 0; a < 3; a++) {
        most = -xi[a] > most ? -xi[a] : most;
        most = xi[a] - 1 > most ? xi[a] - 1 : most;
    }
    return most;
}

/* How far x is from the middle, squared, m2. */
DEFORMED_FUNCTION double deformed_from_middle(const deformed_map *d, const double *x)
{
    const double middle[3] = {.5, .5, .5};
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double way = x[a] - deformed_value(&d->at[a], middle);
        square += way * way;
    }
    return square;
}

/* The cofactors of j[row][column] = d x_row/d xi_column; returns its determinant. */
DEFORMED_FUNCTION double deformed_cofactors(const deformed_map *d, const double *xi, double cofactor[3][3])
{
    double j[3][3];
    for (int r = 0; r < 3; r++)
        deformed_slopes(&d->at[r], xi, j[r]);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int p = (r + 1) % 3, q = (r + 2) % 3, s = (c + 1) % 3, t = (c + 2) % 3;
            cofactor[r][c] = j[p][s] * j[q][t] - j[p][t] * j[q][s];
        }
    return j[0][0] * cofactor[0][0] + j[0][1] * cofactor[0][1] + j[0][2] * cofactor[0][2];
}

/* Moves a place on by what takes it `way` (m) on in space, to first order. false: the element is folded there. */
DEFORMED_FUNCTION bool deformed_go(const deformed_map *d, const double *way, double *xi)
{
    double c[3][3];
    const double det = deformed_cofactors(d, xi, c), per = 1 / det;
    for (int a = 0; a < 3 && det > 0; a++)
        xi[a] += (c[0][a] * way[0] + c[1][a] * way[1] + c[2][a] * way[2]) * per;
    return det > 0;
}

/* By Newton's method from the middle. false where the element has no place for it within DEFORMED_FAR of its sides. */
DEFORMED_FUNCTION bool deformed_place(const deformed_map *d, const double *x, double *xi)
{
    xi[0] = xi[1] = xi[2] = .5;
    for (int turn = 0; turn < DEFORMED_TURNS; turn++) {
        double c[3][3], off[3], way = 0;
        for (int a = 0; a < 3; a++)
            off[a] = x[a] - deformed_value(&d->at[a], xi);
        const double det = deformed_cofactors(d, xi, c);
        if (!(det > 0))
            return false;
        const double per = 1 / det; /* a card takes long to divide */
        for (int a = 0; a < 3; a++) {
            const double step = (c[0][a] * off[0] + c[1][a] * off[1] + c[2][a] * off[2]) * per;
            xi[a] += step;
            way = fabs(step) > way ? fabs(step) : way;
        }
        if (!(deformed_outside(xi) < DEFORMED_FAR))
            return false;
        if (way < DEFORMED_NEAR)
            return true;
    }
    return false;
}

/* The direction in space in which what is trilinear grows, of length 1; returns how much, per m; 0, and no direction,
 * where it does not grow or the element is folded there. */
DEFORMED_FUNCTION double deformed_slope(const deformed_map *d, const double *xi, const deformed_factors *value,
                                        double *direction)
{
    double c[3][3], local[3], square = 0;
    const double det = deformed_cofactors(d, xi, c), per = 1 / det;
    deformed_slopes(value, xi, local);
    for (int r = 0; r < 3; r++) {
        direction[r] = det > 0 ? (c[r][0] * local[0] + c[r][1] * local[1] + c[r][2] * local[2]) * per : 0;
        square += direction[r] * direction[r];
    }
    const double length = sqrt(square);
    for (int r = 0; r < 3; r++)
        direction[r] *= length > 0 ? 1 / length : 0;
    return length;
}

/* How much it grows per m at rest, where the element is a box of these sides (m). */
DEFORMED_FUNCTION double deformed_rest_slope(const double *xi, const deformed_factors *value, const double *side)
{
    double local[3], square = 0;
    deformed_slopes(value, xi, local);
    for (int a = 0; a < 3; a++)
        square += (local[a] / side[a]) * (local[a] / side[a]);
    return sqrt(square);
}

#endif
