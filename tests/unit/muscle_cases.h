/* What a muscle must do in either precision: test_muscle_curves.c and test_muscle_curves_single.c include this once
 * each, after choosing `real`. The figures are of a script of its own, by complex steps of the energies.
 */
#ifndef SINEW_MUSCLE_CASES_H
#define SINEW_MUSCLE_CASES_H

#include "physics/element.h"

#include "tap.h"

static const double peak = 3e5;

/* Blemker's: passive .05, stiffening 6.6, straight 1.4. */
static element_fibre muscle_of(double level, double optimum)
{
    const element_fibre fibre = {
        .along = {R(1), R(0), R(0)},
        .tension = R(level * peak / optimum),
        .curves = {
            .less = R(1 / optimum - 1), .passive = R(.05 * peak / optimum), .stiffening = R(6.6), .straight = R(.4)}};
    return fibre;
}

/* Of a fibre along x. */
static double pulls(element_fibre fibre, double stretch)
{
    const element_tensor h = {.xx = R(stretch - 1)};
    return (double)element_curved(h, fibre).xx;
}

/* To 1e-5 of each figure and better with doubles, 1e-4 with floats; the last digit printed counts half. */
static void test_muscle_alone(double tolerance)
{
    static const double row[][3] = {{.5, 0, 27000},         {.7, 0, 192000},       {1, 0, 300000},
                                    {1.2, 41151.3, 293151}, {1.4, 195198, 303198}, {1.5, 333929, 360929}};
    for (int i = 0; i < (int)(sizeof row / sizeof *row); i++) {
        near_(pulls(muscle_of(0, 1), row[i][0]), row[i][1], tolerance * row[i][1], "passive stress at %g", row[i][0]);
        near_(pulls(muscle_of(1, 1), row[i][0]), row[i][2], tolerance * row[i][2], "and at full activation");
    }
}

/* A bar along its fibres, mu 5e3, K 2.5e5, with free sides: they are found by bisection. */
static double bar(double level, double stretch, double *lateral)
{
    const real c[FORM_NUMBERS] = {R(5e3), R(2.5e5)};
    double low = .5, high = 2, stress = NAN;
    for (int i = 0; i < 60; i++) {
        *lateral = (low + high) / 2;
        const element_tensor h = {.xx = R(stretch - 1), .yy = R(*lateral - 1), .zz = R(*lateral - 1)};
        const element_tensor p =
            element_sum(form_stress(FORM_NEO_HOOKEAN, h, c), element_curved(h, muscle_of(level, 1)));
        stress = (double)p.xx;
        *(p.yy < 0 ? &low : &high) = *lateral;
    }
    return stress;
}

static void test_muscle_in_tissue(double tolerance)
{
    static const double row[][3] = {{0, 1.2, 43658.6}, {0, .8, -3791.05}, {.5, 1.2, 169659}, {.5, .8, 122209}};
    for (int i = 0; i < 4; i++) {
        double lateral;
        near_(bar(row[i][0], row[i][1], &lateral), row[i][2], tolerance * fabs(row[i][2]),
              "in tissue, level %g, stretch %g", row[i][0], row[i][1]);
        if (row[i][1] > 1)
            near_(lateral, .914693, fmax(tolerance, 5e-7), "and its lateral stretch");
    }
}

static bool is_none(element_tensor p)
{
    return p.xx == 0 && p.xy == 0 && p.xz == 0 && p.yx == 0 && p.yy == 0 && p.yz == 0 && p.zx == 0 && p.zy == 0 &&
           p.zz == 0;
}

static bool is_same(element_tensor a, element_tensor b)
{
    return !memcmp(&a, &b, sizeof a);
}

/* At rest nothing; no fibre, nothing; curves of 0 have the bits of those that are not looked at. */
static void test_muscle_at_rest(void)
{
    const element_tensor rest = {.xx = R(0)}, h = {R(.2), R(.1), R(-.3), R(.04), R(-.1), R(.2), R(.1), R(.3), R(.15)};
    element_fibre bent = muscle_of(0, 1), lost = muscle_of(1, .8), plain = {.tension = R(12345)};
    bent.along.x = R(2. / 7), bent.along.y = R(3. / 7), bent.along.z = R(6. / 7);
    lost.along.x = R(0);
    plain.along = bent.along;
    ok(is_none(element_curved(rest, bent)), "no stress at rest");
    ok(is_none(element_curved(h, lost)), "and none without a fibre, whatever the optimum");
    ok(is_same(element_curved(h, plain), element_active(h, plain)), "curves of 0 leave the bits of an active stress");
}

/* The stretch at which a muscle is strongest, and from which it is stretched. */
static void test_muscle_optimum(double tolerance)
{
    near_(pulls(muscle_of(1, 1.25), 1.25), peak / 1.25, tolerance * peak, "at the optimum: the peak, over the optimum");
    near_(pulls(muscle_of(0, 1.25), 1.2), 0, tolerance, "below it nothing passive");
    near_(pulls(muscle_of(0, .8), .96), 41151.3 / .8, tolerance * 41151.3 / .8, "1.2 times an optimum of .8");
}

static void test_all_muscles(double tolerance)
{
    test_muscle_alone(tolerance);
    test_muscle_in_tissue(tolerance);
    test_muscle_at_rest();
    test_muscle_optimum(tolerance);
}

#endif
