/* What the element header must do in either precision: test_element.c and test_element_single.c include this once each,
 * after choosing `real`. Boxes here are anisotropic, so that no axis is taken for another.
 */
#ifndef SINEW_ELEMENT_CASES_H
#define SINEW_ELEMENT_CASES_H

#include "physics/element.h"

#include "tap.h"

#include <string.h>

static const double box_side[3] = {.01, .0125, .02};
static const int box_corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

static element_shape box_shape(void)
{
    return element_box(box_side[0], box_side[1], box_side[2]);
}

static double box_volume(void)
{
    return box_side[0] * box_side[1] * box_side[2];
}

/* E = 3000 Pa, nu = .45. */
static element_law tissue(double kappa)
{
    const hourglass_control control = {HOURGLASS_ISOTROPIC, kappa};
    const double mu = 3000 / 2.9, bulk = 10000;
    double numbers[HOURGLASS_NUMBERS];
    element_law law = {.c = {R(mu), R(bulk)}};
    hourglass_numbers(control, mu, bulk, box_side, numbers);
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law.hourglass[i] = R(numbers[i]);
    return law;
}

static void corner_place(const double origin[3], int c, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = origin[a] + box_side[a] * box_corner[c][a];
}

/* The displacement (F - 1) x at the corners of a box at `origin`. */
static element_field affine(double f[3][3], const double origin[3])
{
    element_field u;
    element_corners *component[3] = {&u.x, &u.y, &u.z};
    for (int c = 0; c < 8; c++) {
        double x[3];
        corner_place(origin, c, x);
        for (int k = 0; k < 3; k++)
            component[k]->at[c] = R(f[k][0] * x[0] + f[k][1] * x[1] + f[k][2] * x[2] - x[k]);
    }
    return u;
}

static element_field force_of(element_field u, double kappa, double tension, const double along[3])
{
    element_fibre fibre = {{R(along[0]), R(along[1]), R(along[2])}, R(tension), {R(0), R(0), R(0), R(0)}, {R(0), R(0)}};
    return element_force(FORM_NEO_HOOKEAN, HOURGLASS_ISOTROPIC, u, box_shape(), tissue(kappa), fibre, tension != 0);
}

/* The stress from the forces alone: V P = sum over corners of f (x) X. */
static void stress_from(element_field f, double p[3][3])
{
    const element_corners *component[3] = {&f.x, &f.y, &f.z};
    const double origin[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            p[k][j] = 0;
            for (int c = 0; c < 8; c++) {
                double x[3];
                corner_place(origin, c, x);
                p[k][j] += (double)component[k]->at[c] * x[j] / box_volume();
            }
        }
}

static double largest_force(element_field f)
{
    double most = 0;
    for (int c = 0; c < 8; c++)
        most = fmax(most, fmax(fabs((double)f.x.at[c]), fmax(fabs((double)f.y.at[c]), fabs((double)f.z.at[c]))));
    return most;
}

static const double no_fibre[3] = {0, 0, 0}, at_origin[3] = {0, 0, 0};

static void stress_at(double f[3][3], double p[3][3])
{
    stress_from(force_of(affine(f, at_origin), .0075, 0, no_fibre), p);
}

/* The law's figures, as they are printed: to 1e-4 of each and better, to 7 digits with doubles. */
static void test_homogeneous(double tolerance)
{
    double p[3][3];
    for (int a = 0; a < 3; a++) { /* along each axis in turn */
        double stretch[3][3] = {{0}}, confined[3][3] = {{0}};
        for (int b = 0; b < 3; b++) {
            stretch[b][b] = a == b ? 1.2 : .92181984;
            confined[b][b] = a == b ? .9 : 1;
        }
        stress_at(stretch, p);
        near_(p[a][a], 502.2590, tolerance * 502.259, "stretch of 1.2 along axis %d: nominal stress", a);
        near_(p[(a + 1) % 3][(a + 1) % 3], 0, tolerance * 502.259, "and nothing on its sides");
        stress_at(confined, p);
        near_(p[a][a], -1156.1882, tolerance * 1156.1882, "confined to 0.9 along axis %d", a);
    }
    double shear[3][3] = {{1, .2, 0}, {0, 1, 0}, {0, 0, 1}};
    stress_at(shear, p); /* Cauchy: P F^T / J, J = 1 */
    near_(p[0][1], 206.8966, tolerance * 206.8966, "shear of 0.2: s12");
    near_(p[0][0] + .2 * p[0][1], 27.5862, fmax(tolerance * 27.5862, 5e-5), "s11");
    near_(p[1][1], -13.7931, fmax(tolerance * 13.7931, 5e-5), "s22");
    near_(p[1][0] + .2 * p[1][1], p[0][1], tolerance * 206.8966, "s21 = s12");
}

/* A turn by 37 degrees about (1, 1, 1), the box off the origin by (ox, oy, oz). */
static void turn(double f[3][3])
{
    double angle = 37 * acos(-1) / 180, n = 1 / sqrt(3), c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            f[i][j] = (1 - c) * n * n;
            if (i == j)
                f[i][j] += c;
            else
                f[i][j] += (j - i + 3) % 3 == 1 ? -s * n : s * n;
        }
}

static void test_rotation(double limit)
{
    const double origin[3] = {.03, -.05, .04};
    double strain[3][3] = {{1.01, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double f[3][3], fibre[3] = {.6, 0, .8};
    turn(f);
    double strained = largest_force(force_of(affine(strain, at_origin), .0075, 0, no_fibre));
    double turned = largest_force(force_of(affine(f, origin), .0075, 0, no_fibre));
    ok(turned <= limit * strained, "a turn by 37 degrees off the origin: %.2g of a 1 %% strain's force, at most %g",
       turned / strained, limit);
    double p[3][3], pulled[3][3];
    double none[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    stress_from(force_of(affine(none, at_origin), .0075, 500, fibre), p);
    stress_from(force_of(affine(f, at_origin), .0075, 500, fibre), pulled);
    for (int i = 0; i < 3; i++) {
        double want = f[i][0] * p[0][2] + f[i][1] * p[1][2] + f[i][2] * p[2][2];
        near_(pulled[i][2], want, limit * 500, "the fibre's pull turns with the tissue, component %d", i);
    }
}

/* The four patterns of signs that the stress does not see: f = 8 k c gamma / 8 for u = c gamma; their sum with an
 * affine field adds nothing to its stress, and an affine field has none of them. */
static void test_hourglass(double tolerance)
{
    double f[3][3] = {{1.1, .05, -.02}, {.03, .9, .1}, {0, .07, 1.05}};
    double k = (double)tissue(.0075).hourglass[HOURGLASS_K];
    for (int mode = 0; mode < 4; mode++)
        for (int a = 0; a < 3; a++) {
            element_field u = {0};
            element_corners *component[3] = {&u.x, &u.y, &u.z};
            double gamma[8], gap = 0;
            for (int c = 0; c < 8; c++) {
                const int *at = box_corner[c];
                int s[3] = {2 * at[0] - 1, 2 * at[1] - 1, 2 * at[2] - 1};
                const int modes[4] = {s[0] * s[1], s[1] * s[2], s[2] * s[0], s[0] * s[1] * s[2]};
                gamma[c] = modes[mode];
                component[a]->at[c] = R(1e-4 * gamma[c]);
            }
            element_field force = force_of(u, .0075, 0, no_fibre);
            const element_corners *got[3] = {&force.x, &force.y, &force.z};
            for (int c = 0; c < 8; c++)
                for (int b = 0; b < 3; b++)
                    gap = fmax(gap, fabs((double)got[b]->at[c] - (a == b ? 8 * k * 1e-4 * gamma[c] : 0)));
            near_(gap, 0, tolerance * 8 * k * 1e-4, "hourglass mode %d of component %d is resisted by 8 k", mode, a);
        }
    element_field with = force_of(affine(f, at_origin), 1, 0, no_fibre),
                  without = force_of(affine(f, at_origin), 0, 0, no_fibre);
    double gap = 0;
    for (int c = 0; c < 8; c++)
        gap = fmax(gap, fabs((double)with.y.at[c] - (double)without.y.at[c]));
    near_(gap, 0, tolerance * largest_force(without), "a linear field has no hourglass force");
}

static void test_force_length(void)
{
    const double l[] = {.3, .4, .5, .6, .8, 1, 1.2, 1.4, 1.5, 1.6, 1.7};
    const double f[] = {0, 0, .09, .36, .84, 1, .84, .36, .09, 0, 0};
    for (int i = 0; i < 11; i++)
        near_((double)muscle_force_length(R(l[i])), f[i], 1e-6, "force-length factor at %g", l[i]);
}

static void test_cube_root(double tolerance)
{
    double worst = 0;
    for (int i = 0; i <= 4000; i++) {
        double x = pow(10, 6 * i / 4000. - 3);
        double y = (double)element_cube_root_inverse(R(x));
        worst = fmax(worst, fabs(y * y * y * (double)R(x) - 1));
    }
    near_(worst, 0, tolerance, "x^(-1/3) from 1e-3 to 1e3");
}

#endif
