#include "tled/contact/deformed_place.h"

#include "mesh/lattice.h"

#include <math.h>

enum { TURNS = 12 };

static const double near_enough = 1e-10, far = 2;

deformed_factors deformed_factors_of(const double v[8])
{
    return (deformed_factors){{v[0], v[1] - v[0], v[3] - v[0], v[4] - v[0], (v[2] - v[3]) - (v[1] - v[0]),
                               (v[7] - v[4]) - (v[3] - v[0]), (v[5] - v[1]) - (v[4] - v[0]),
                               ((v[6] - v[7]) - (v[5] - v[4])) - ((v[2] - v[3]) - (v[1] - v[0]))}};
}

deformed_map deformed_map_of(double corner[8][3])
{
    deformed_map d;
    for (int a = 0; a < 3; a++) {
        double value[8];
        for (int k = 0; k < 8; k++)
            value[k] = corner[k][a];
        d.at[a] = deformed_factors_of(value);
    }
    return d;
}

double deformed_value(const deformed_factors *v, const double xi[3])
{
    const double *f = v->of, x = xi[0], y = xi[1], z = xi[2];
    return (f[0] + f[1] * x) + (f[2] + f[4] * x) * y + ((f[3] + f[6] * x) + (f[5] + f[7] * x) * y) * z;
}

/* d/dx, d/dy, d/dz. */
static void slopes_of(const deformed_factors *v, const double xi[3], double slope[3])
{
    const double *f = v->of, x = xi[0], y = xi[1], z = xi[2];
    slope[0] = (f[1] + f[4] * y) + (f[6] + f[7] * y) * z;
    slope[1] = (f[2] + f[4] * x) + (f[5] + f[7] * x) * z;
    slope[2] = (f[3] + f[6] * x) + (f[5] + f[7] * x) * y;
}

void deformed_shares(const double xi[3], double share[8])
{
    for (int k = 0; k < 8; k++) {
        share[k] = 1;
        for (int a = 0; a < 3; a++)
            share[k] *= lattice_vtk[k][a] ? xi[a] : 1 - xi[a];
    }
}

void deformed_place_of_shares(const double share[8], double xi[3])
{
    for (int a = 0; a < 3; a++) {
        xi[a] = 0;
        for (int k = 0; k < 8; k++)
            xi[a] += lattice_vtk[k][a] ? share[k] : 0;
    }
}

double deformed_outside(const double xi[3])
{
    double most = -1;
    for (int a = 0; a < 3; a++) {
        most = -xi[a] > most ? -xi[a] : most;
        most = xi[a] - 1 > most ? xi[a] - 1 : most;
    }
    return most;
}

double deformed_from_middle(const deformed_map *d, const double x[3])
{
    static const double middle[3] = {.5, .5, .5};
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double way = x[a] - deformed_value(&d->at[a], middle);
        square += way * way;
    }
    return square;
}

/* The cofactors of j[row][column] = d x_row/d xi_column; returns its determinant. */
static double cofactors(const deformed_map *d, const double xi[3], double cofactor[3][3])
{
    double j[3][3];
    for (int r = 0; r < 3; r++)
        slopes_of(&d->at[r], xi, j[r]);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int p = (r + 1) % 3, q = (r + 2) % 3, s = (c + 1) % 3, t = (c + 2) % 3;
            cofactor[r][c] = j[p][s] * j[q][t] - j[p][t] * j[q][s];
        }
    return j[0][0] * cofactor[0][0] + j[0][1] * cofactor[0][1] + j[0][2] * cofactor[0][2];
}

bool deformed_go(const deformed_map *d, const double way[3], double xi[3])
{
    double c[3][3];
    const double det = cofactors(d, xi, c);
    for (int a = 0; a < 3 && det > 0; a++)
        xi[a] += (c[0][a] * way[0] + c[1][a] * way[1] + c[2][a] * way[2]) / det;
    return det > 0;
}

bool deformed_place(const deformed_map *d, const double x[3], double xi[3])
{
    xi[0] = xi[1] = xi[2] = .5;
    for (int turn = 0; turn < TURNS; turn++) {
        double c[3][3], off[3], way = 0;
        for (int a = 0; a < 3; a++)
            off[a] = x[a] - deformed_value(&d->at[a], xi);
        const double det = cofactors(d, xi, c);
        if (!(det > 0))
            return false;
        for (int a = 0; a < 3; a++) {
            const double step = (c[0][a] * off[0] + c[1][a] * off[1] + c[2][a] * off[2]) / det;
            xi[a] += step;
            way = fabs(step) > way ? fabs(step) : way;
        }
        if (!(deformed_outside(xi) < far))
            return false;
        if (way < near_enough)
            return true;
    }
    return false;
}

double deformed_slope(const deformed_map *d, const double xi[3], const deformed_factors *value, double direction[3])
{
    double c[3][3], local[3], square = 0;
    const double det = cofactors(d, xi, c);
    slopes_of(value, xi, local);
    for (int r = 0; r < 3; r++) {
        direction[r] = det > 0 ? (c[r][0] * local[0] + c[r][1] * local[1] + c[r][2] * local[2]) / det : 0;
        square += direction[r] * direction[r];
    }
    const double length = sqrt(square);
    for (int r = 0; r < 3; r++)
        direction[r] = length > 0 ? direction[r] / length : 0;
    return length;
}

double deformed_rest_slope(const double xi[3], const deformed_factors *value, const double side[3])
{
    double local[3], square = 0;
    slopes_of(value, xi, local);
    for (int a = 0; a < 3; a++)
        square += (local[a] / side[a]) * (local[a] / side[a]);
    return sqrt(square);
}
