/* Physical hourglass control at rest against incompatible modes (Taylor, Beresford & Wilson 1976), written anew: what
 * eight integration points make of the hourglass modes, once the element's three quadratic modes a component have
 * taken what energy they can. Of a parallelepiped, bending and torsion are the same to rounding.
 */
#include "mesh/hexahedron.h"
#include "physics/element_any.h"

#include "corners.h"
#include "tap.h"

#include <string.h>

enum { MODES = 12, FIELDS = 7, ALL = 3 * FIELDS };

/* a^-1, with its determinant. */
static double invert(double a[3][3], double to[3][3])
{
    double det = 0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int i = (c + 1) % 3, j = (c + 2) % 3, p = (r + 1) % 3, q = (r + 2) % 3;
            to[r][c] = a[i][p] * a[j][q] - a[i][q] * a[j][p];
            det += r ? 0 : a[c][0] * to[0][c];
        }
    for (int i = 0; i < 9; i++)
        to[i / 3][i % 3] /= det;
    return det;
}

/* x = a^-1 x, 4 x 4. */
static void solve(double a[4][4], double x[4][4])
{
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 4; i++) {
            const double by = a[i][k] / a[k][k];
            for (int c = 0; c < 4 && i != k; c++) {
                a[i][c] -= by * a[k][c];
                x[i][c] -= by * x[k][c];
            }
        }
    for (int k = 0; k < 16; k++)
        x[k / 4][k % 4] /= a[k / 4][k / 4];
}

/* Scalar fields with no mean gradient whose hourglass modes (gamma . u) are 1 each in turn: their corners' values. */
static void fields_of(const double at[24], double field[4][8])
{
    double b[24], slope[7][3], twist[4][3], gamma_of[4][4], to[4][4] = {{0}};
    hexahedron_mean(at, b);
    hexahedron_modes(at, b, &slope[0][0], &twist[0][0]);
    for (int g = 0; g < 4; g++)
        for (int h = 0; h < 4; h++) {
            to[g][h] = gamma_of[g][h] = g == h;
            for (int i = 0; i < 3; i++)
                gamma_of[g][h] -= twist[g][i] * slope[3 + h][i];
        }
    solve(gamma_of, to);
    for (int f = 0; f < 4; f++)
        for (int a = 0; a < 8; a++) {
            field[f][a] = 0;
            for (int h = 0; h < 4; h++) {
                double value = hexahedron_sign(3 + h, a) / 8;
                for (int i = 0; i < 3; i++)
                    value -= slope[3 + h][i] * at[3 * a + i];
                field[f][a] += value * to[h][f];
            }
        }
}

/* The gradients of the four fields and of the three quadratic modes at xi, and det J there. */
static double gradients(const double at[24], double field[4][8], const double xi[3], double to[FIELDS][3])
{
    double row[9], basis[3][3], j[3][3] = {{0}}, inverse[3][3], centre[3][3], slope[8][3];
    for (int c = 0; c < 8; c++)
        for (int a = 0; a < 3; a++) {
            slope[c][a] = (corner_of[c][a] ? 1. : -1.) / 8;
            for (int k = 0; k < 3; k++)
                slope[c][a] *= k == a ? 1 : 1 + (corner_of[c][k] ? 1 : -1) * xi[k];
            for (int i = 0; i < 3; i++)
                j[i][a] += at[3 * c + i] * slope[c][a];
        }
    hexahedron_basis(at, row);
    memcpy(basis, row, sizeof basis);
    const double det = invert(j, inverse), ratio = invert(basis, centre) / det;
    for (int i = 0; i < 3; i++) {
        for (int f = 0; f < 4; f++) {
            to[f][i] = 0;
            for (int c = 0; c < 8; c++)
                for (int a = 0; a < 3; a++)
                    to[f][i] += field[f][c] * slope[c][a] * inverse[a][i];
        }
        for (int k = 0; k < 3; k++)
            to[4 + k][i] = -2 * xi[k] * centre[k][i] * ratio;
    }
    return det;
}

/* The stiffness of the hourglass modes, by their components. */
static void incompatible(const double at[24], double lambda, double mu, double to[MODES][MODES])
{
    double field[4][8], all[ALL][ALL] = {{0}}, g[FIELDS][3];
    fields_of(at, field);
    for (int point = 0; point < 8; point++) {
        double xi[3];
        for (int a = 0; a < 3; a++)
            xi[a] = (corner_of[point][a] ? 1 : -1) / sqrt(3);
        const double det = gradients(at, field, xi, g);
        for (int r = 0; r < ALL; r++)
            for (int s = 0; s < ALL; s++) {
                const double *a = g[r / 3], *b = g[s / 3], same = r % 3 == s % 3;
                all[r][s] += det * (lambda * a[r % 3] * b[s % 3] + mu * a[s % 3] * b[r % 3] +
                                    same * mu * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
            }
    }
    for (int k = ALL - 1; k >= MODES; k--)
        for (int r = 0; r < k; r++)
            for (int s = 0; s < k; s++)
                all[r][s] -= all[r][k] * all[k][s] / all[k][k];
    for (int i = 0; i < MODES; i++)
        memcpy(to[i], all[i], sizeof to[i]);
}

/* The same by the code under test. */
static void held(const double at[24], double lambda, double mu, double to[MODES][MODES])
{
    double b[24], basis[9], law[HOURGLASS_NUMBERS];
    const double volume = hexahedron_mean(at, b);
    hourglass_modes modes;
    hexahedron_basis(at, basis);
    hourglass_moduli(mu, lambda + 2 * mu / 3, law);
    const element_tensor j = element_tensor_of(basis);
    for (int i = 0; i < MODES; i++) {
        double one[MODES] = {0};
        one[i] = 1;
        memcpy(&modes, one, sizeof modes);
        const hourglass_modes w = hourglass_all_by_columns(j, modes), t = hourglass_hexahedron(&w, j, law, volume / 64);
        modes = hourglass_all_by_rows(j, t);
        memcpy(to[i], &modes, sizeof to[i]);
    }
}

/* A parallelepiped of random edges, its corners moved by a share of them. */
static void make(double skew, double by, double at[24])
{
    double edge[3][3];
    for (int i = 0; i < 9; i++)
        edge[i / 3][i % 3] = .01 * ((i / 3 == i % 3) * (1 + i / 3) + skew * chance());
    for (int i = 0; i < 24; i++) {
        at[i] = .01 * by * chance();
        for (int a = 0; a < 3; a++)
            at[i] += corner_of[i / 3][a] * edge[a][i % 3];
    }
}

static void test_parallelepipeds(double nu, double skew)
{
    const double mu = 1000, lambda = 2 * mu * nu / (1 - 2 * nu);
    double worst = 0, scale = 0, at[24], ours[MODES][MODES], theirs[MODES][MODES];
    for (int round = 0; round < 20; round++) {
        make(skew, 0, at);
        held(at, lambda, mu, ours);
        incompatible(at, lambda, mu, theirs);
        for (int i = 0; i < 81; i++) {
            worst = fmax(worst, fabs(ours[i / 9][i % 9] - theirs[i / 9][i % 9]));
            scale = fmax(scale, fabs(theirs[i / 9][i % 9]));
        }
    }
    near_(worst / scale, 0, 1e-11 / (1 - 2 * nu), "nu %g, parallelepipeds, skewed by %g: as incompatible modes", nu,
          skew);
}

/* Distorted: energies of random bending and torsion, over those by incompatible modes. */
static void test_distorted(double nu, double by, double limit)
{
    const double mu = 1000, lambda = 2 * mu * nu / (1 - 2 * nu);
    double low = INFINITY, high = 0, at[24], ours[MODES][MODES], theirs[MODES][MODES];
    for (int round = 0; round < 400; round++) {
        double m[9], a = 0, b = 0;
        make(.2, by, at);
        held(at, lambda, mu, ours);
        incompatible(at, lambda, mu, theirs);
        for (int i = 0; i < 9; i++)
            m[i] = chance();
        for (int i = 0; i < 81; i++) {
            a += ours[i / 9][i % 9] * m[i / 9] * m[i % 9];
            b += theirs[i / 9][i % 9] * m[i / 9] * m[i % 9];
        }
        low = fmin(low, a / b);
        high = fmax(high, a / b);
    }
    ok(low > 1 - limit && high < 1 + limit, "nu %g, corners moved by %g: energies are %.3f to %.3f of theirs", nu, by,
       low, high);
}

int main(void)
{
    test_parallelepipeds(.3, 0);
    test_parallelepipeds(.3, .3);
    test_parallelepipeds(.4999, .3);
    test_distorted(.3, .1, .04);
    test_distorted(.45, .2, .1);
    return done_testing();
}
