/* A box that a border parts into two materials: at small strain it has the moduli of a laminate, in series across and
 * side by side along (Backus 1962); forces are the derivative of the energy; turns give none, and turn what there is;
 * of one material on both sides it is the box that it was; and the bound of the stable step holds. So where a surface
 * cuts the box too. */
#include "mesh/lattice.h"
#include "physics/stability_laminate.h"

#include "box_square.h"
#include "cut_part.h"
#include "form_tried.h"
#include "tap.h"

static const double side[3] = {.01, .0125, .02}, mu = 1000, bulk = 9000;

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

static element_shape shape_of_box(void)
{
    return element_box(side[0], side[1], side[2]);
}

static double box_volume(void)
{
    return side[0] * side[1] * side[2];
}

/* A box of two materials, the second `ratio` times as stiff. */
typedef struct two {
    form f;
    hourglass_control control;
    element_laminate l;
    element_law law;
    double c[2][FORM_NUMBERS];
    double fraction; /* of the box that is tissue */
} two;

static void fill_laws(two *t, double ratio)
{
    const double s = t->l.share, share[2] = {1 - s, s}, times[2] = {1, ratio};
    for (int k = 0; k < 2; k++) {
        t->l.bulk[k] = bulk * times[k];
        form_tried(t->f, mu * times[k], t->l.bulk[k], t->c[k]);
        for (int i = 0; i < form_moduli(t->f); i++)
            t->c[k][i] *= share[k];
    }
    const double between = pow(ratio, s);
    form_tried(t->f, mu * between, bulk * between, t->law.c);
    hourglass_numbers(t->control, mu * between, bulk * between, side, t->law.hourglass);
}

/* A border n.x = d in the box's own coordinates: its part beyond, its kink. tissue: what of the box is, of so much of
 * it. False: the border does not pass through that. */
static bool part_by(const double n[3], double d, const part *tissue, double fraction, element_laminate *l)
{
    const double back[3] = {-n[0], -n[1], -n[2]};
    double of[7], length = 0, k[8], kink[4] = {0};
    const part p = part_clip(tissue, back, -d);
    l->share = p.faces >= 4 ? part_moments(&p, of) / fraction : 0;
    if (!(l->share > .01 && l->share < .99))
        return false;
    l->second = (element_cut){of[0], of[1], of[2], of[3], of[4], of[5]};
    for (int a = 0; a < 3; a++)
        length += n[a] * n[a] / (side[a] * side[a]);
    length = sqrt(length);
    l->normal = (element_vector){n[0] / side[0] / length, n[1] / side[1] / length, n[2] / side[2] / length};
    for (int c = 0; c < 8; c++) {
        const int x = 2 * lattice_vtk[c][0] - 1, y = 2 * lattice_vtk[c][1] - 1, z = 2 * lattice_vtk[c][2] - 1;
        k[c] = fmax(0, n[0] * x + n[1] * y + n[2] * z - d) / length / 2;
        kink[0] += x * y * k[c], kink[1] += y * z * k[c], kink[2] += z * x * k[c], kink[3] += x * y * z * k[c];
    }
    l->kink = (laminate_kink){kink[0], kink[1], kink[2], kink[3]};
    return true;
}

static void direction_by_chance(double n[3])
{
    double length = 0;
    for (int a = 0; a < 3; a++)
        n[a] = number(), length += n[a] * n[a];
    for (int a = 0; a < 3; a++)
        n[a] /= sqrt(length);
}

/* A box, or what a plane leaves of it: at least a twentieth. */
static part tissue_by_chance(bool cut, two *t)
{
    part to = part_box();
    t->fraction = 1;
    for (double n[3], of[7]; cut && !(t->fraction > .05 && t->fraction < .99);) {
        direction_by_chance(n);
        const part box = part_box();
        to = part_clip(&box, n, 1.2 * number());
        t->fraction = to.faces >= 4 ? part_moments(&to, of) : 0;
        t->l.whole = (element_cut){of[0], of[1], of[2], of[3], of[4], of[5]};
    }
    return to;
}

static two two_by_chance(form f, hourglass_control control, double ratio, bool cut)
{
    two t = {.f = f, .control = control};
    const part tissue = tissue_by_chance(cut, &t);
    double n[3];
    do
        direction_by_chance(n);
    while (!part_by(n, 1.5 * number(), &tissue, t.fraction, &t.l));
    fill_laws(&t, ratio);
    return t;
}

static element_field forces(const void *of, element_field u)
{
    const two *t = of;
    const element_fibre none = {.tension = 0};
    return element_force_laminate(t->f, t->control.kind, u, shape_of_box(), t->law, t->c[0], t->c[1], none,
                                  ELEMENT_NO_MUSCLE, none, ELEMENT_NO_MUSCLE, NULL, 0, &t->l);
}

static laminate_state state_of(const two *t, element_field u, element_law *law)
{
    *law = t->law;
    return laminate_held(t->f, t->control.kind, element_modes_of(u.x), element_modes_of(u.y), element_modes_of(u.z),
                         shape_of_box(), law, t->c[0], t->c[1], &t->l);
}

static double energy(const two *t, element_field u)
{
    element_law law;
    const laminate_state is = state_of(t, u, &law);
    return box_volume() * laminate_energy(t->f, &is, t->c[0], t->c[1]) + hourglass_dot(&is.held.f, &is.modes) / 2;
}

static element_field bent(double strain)
{
    element_field u;
    for (int i = 0; i < BOX_FREEDOMS; i++)
        *box_component(&u, i / 3, i % 3) = strain * side[i % 3] * number();
    return u;
}

/* H X at the corners. */
static element_field affine(double h[3][3])
{
    element_field u;
    for (int i = 0; i < BOX_FREEDOMS; i++) {
        double sum = 0;
        for (int a = 0; a < 3; a++)
            sum += h[i % 3][a] * side[a] * (lattice_vtk[i / 3][a] - .5);
        *box_component(&u, i / 3, i % 3) = sum;
    }
    return u;
}

/* ---- a laminate's moduli */

/* Twice the energy over the volume, over the square of a small strain: of n across x, a laminate's. */
static double modulus(const two *t, int row, int column, double sign)
{
    const double small = 1e-5;
    double h[3][3] = {{0}};
    h[row][column] += small;
    h[column][row] += sign * small;
    return 2 * energy(t, affine(h)) / box_volume() / (small * small) / (sign != 0 ? 4 : 1);
}

static double mean(const two *t, double first, double second)
{
    return (1 - t->l.share) * first + t->l.share * second;
}

/* Backus: with M = K + 4 mu/3 and lambda = K - 2 mu/3, c = 1/<1/M> across; along <M - lambda^2/M> + <lambda/M>^2 c;
 * shear 1/<1/mu> across and <mu> along. */
static void test_laminate(int axis)
{
    two t = {.f = FORM_NEO_HOOKEAN, .control = {HOURGLASS_PHYSICAL, 0}};
    double n[3] = {0};
    n[axis] = 1;
    const part box = part_box();
    part_by(n, .2, &box, 1, &t.l);
    fill_laws(&t, 7);
    const double m = bulk + 4 * mu / 3, lambda = bulk - 2 * mu / 3, tension = lambda / m;
    const double across = 1 / mean(&t, 1 / m, 1 / (7 * m)), k = mean(&t, tension, tension);
    const double along = mean(&t, m - lambda * tension, 7 * (m - lambda * tension)) + k * k * across;
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    near_(modulus(&t, axis, axis, 0) / across, 1, 1e-4, "axis %d: across the border in series", axis);
    near_(modulus(&t, b, b, 0) / along, 1, 1e-4, "axis %d: along it side by side", axis);
    near_(modulus(&t, axis, b, 1) * mean(&t, 1 / mu, 1 / (7 * mu)), 1, 1e-4, "axis %d: shear across in series", axis);
    near_(modulus(&t, b, c, 1) / mean(&t, mu, 7 * mu), 1, 1e-4, "axis %d: shear along side by side", axis);
}

/* ---- forces */

static double largest_of(element_field f)
{
    double most = 0;
    for (int i = 0; i < BOX_FREEDOMS; i++)
        most = fmax(most, fabs(*box_component(&f, i / 3, i % 3)));
    return most;
}

static double length_of(element_vector a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

static void test_energy(form f, hourglass_control control, double ratio, bool cut, double strain, double most)
{
    double worst = 0, left = 0;
    for (int i = 0; i < 30; i++) {
        const two t = two_by_chance(f, control, ratio, cut);
        const element_field u = bent(cut ? strain / 2 : strain); /* parts at corners are strained more */
        element_law law;
        const laminate_state is = state_of(&t, u, &law);
        element_field got = forces(&t, u);
        double off = 0;
        for (int k = 0; k < BOX_FREEDOMS; k++) {
            const double step = 1e-6 * side[0];
            element_field high = u, low = u;
            *box_component(&high, k / 3, k % 3) += step;
            *box_component(&low, k / 3, k % 3) -= step;
            off =
                fmax(off, fabs((energy(&t, high) - energy(&t, low)) / (2 * step) - *box_component(&got, k / 3, k % 3)));
        }
        worst = fmax(worst, off / largest_of(got));
        left = fmax(left, length_of(is.left) / length_of(is.jump));
    }
    ok(worst <= most && left <= most,
       "form %d, control %d, ratio %g%s, strains to %g: forces are the energy's derivative to %.2g, a is found to %.2g",
       f, control.kind, ratio, cut ? ", cut" : "", strain, worst, left);
}

/* Of one material: the box without the border, where the parts have the moments of the whole. */
static void test_one(bool cut)
{
    const element_fibre none = {.tension = 0};
    double worst = 0;
    for (int i = 0; i < 20; i++) {
        two t = two_by_chance(FORM_NEO_HOOKEAN, (hourglass_control){HOURGLASS_PHYSICAL, 0}, 1, cut);
        t.l.second = t.l.whole;
        t.l.kink = (laminate_kink){0, 0, 0, 0};
        const element_field u = bent(.1);
        element_field got = forces(&t, u);
        element_field want = element_force_cut(t.f, HOURGLASS_PHYSICAL, u, shape_of_box(), t.law, none,
                                               ELEMENT_NO_MUSCLE, none, ELEMENT_NO_MUSCLE, NULL, 0, t.l.whole);
        for (int k = 0; k < BOX_FREEDOMS; k++)
            worst = fmax(worst, fabs(*box_component(&got, k / 3, k % 3) - *box_component(&want, k / 3, k % 3)) /
                                    largest_of(want));
    }
    near_(worst, 0, 1e-12, "of one material%s the border is as if it were not there", cut ? ", cut," : "");
}

static void test_turn(hourglass_control control, bool cut)
{
    static const double turn[3][3] = {{.36, .48, -.8}, {-.8, .6, 0}, {.48, .64, .6}};
    double h[3][3], worst = 0;
    const two t = two_by_chance(FORM_NEO_HOOKEAN, control, 10, cut);
    for (int i = 0; i < 9; i++)
        h[i / 3][i % 3] = turn[i / 3][i % 3] - (i % 4 == 0);
    near_(largest_of(forces(&t, affine(h))) / (mu * side[0] * side[1]), 0, 1e-11, "a turn gives no forces");
    element_field u = bent(.1), turned = affine(h);
    for (int i = 0; i < BOX_FREEDOMS; i++)
        for (int a = 0; a < 3; a++)
            *box_component(&turned, i / 3, i % 3) += turn[i % 3][a] * *box_component(&u, i / 3, a);
    element_field f = forces(&t, u), g = forces(&t, turned);
    for (int i = 0; i < BOX_FREEDOMS; i++) {
        double want = 0;
        for (int a = 0; a < 3; a++)
            want += turn[i % 3][a] * *box_component(&f, i / 3, a);
        worst = fmax(worst, fabs(want - *box_component(&g, i / 3, i % 3)));
    }
    if (control.kind == HOURGLASS_PHYSICAL)
        near_(worst / largest_of(f), 0, 1e-11, "and turns what forces there are");
}

/* ---- the stable step */

static double bound_of(const two *t, element_field u, double density)
{
    const element_fibre none = {.tension = 0};
    const element_shape shape = shape_of_box();
    const double slope = fmax(shape.slope.x, fmax(shape.slope.y, shape.slope.z));
    element_law law;
    const laminate_state is = state_of(t, u, &law);
    const double twists = 64 * hourglass_stiffest(t->control.kind, t->law.hourglass, side) / (density * box_volume());
    const stability_stiffening s = stability_stiffening_of(t->f, t->control.kind, is.h, t->law.c);
    const stability_twists box = stability_twists_of(t->control.kind, twists, slope, is.h, &is.modes, s);
    const stability_twists w = t->fraction < 1 ? stability_cut_twists(t->l.whole, 1, box) : box;
    stability_laminate m;
    memcpy(law.c, t->law.c, sizeof law.c);
    for (int i = 0; i < form_moduli(t->f); i++)
        law.c[i] = 0;
    stability_stiffen(s, hourglass_dot(&is.held.f, &is.modes) / 2 / s.now / box_volume(), law.c);
    stability_laminate_matrices(t->f, &is, &t->l, t->c[0], t->c[1], law.c, density, side, none, none, NULL, 0, 1, &m);
    const double square = stability_laminate_square(&m, w);
    ok(square <= stability_laminate_bound(&m, w), "the quick bound is no less");
    return square;
}

static void test_bound(form f, hourglass_control control, double ratio, bool cut, double strain)
{
    int wrong = 0;
    double near = 0;
    for (int i = 0; i < 20; i++) {
        const two t = two_by_chance(f, control, ratio, cut);
        const element_field u = bent(cut ? strain / 2 : strain); /* parts at corners are strained more */
        const double is = box_square(forces, &t, u, 1e-5 * side[0], 1000 * box_volume() / 8);
        const double bound = bound_of(&t, u, 1000);
        wrong += !(is <= bound * (1 + 1e-6));
        near += is / bound / 20;
    }
    ok(!wrong, "form %d, control %d, ratio %g%s, strains to %g: the bound holds (%.3f of it in the mean)", f,
       control.kind, ratio, cut ? ", cut" : "", strain, near);
}

int main(void)
{
    const hourglass_control physical = {HOURGLASS_PHYSICAL, 0}, isotropic = {HOURGLASS_ISOTROPIC, .05};
    for (int a = 0; a < 3; a++)
        test_laminate(a);
    for (int cut = 0; cut < 2; cut++) {
        test_one(cut);
        test_turn(physical, cut);
        test_turn(isotropic, cut);
        for (int f = 0; f < FORM_STEPPED; f++) {
            const bool soon =
                form_stiffens((form)f); /* by 1 and more at strains of .5, as these coefficients have it */
            test_energy((form)f, physical, 10, cut, .05, soon ? 2e-3 : 1e-6);
            test_energy((form)f, physical, .1, cut, .15, soon ? .1 : 1e-4);
            test_energy((form)f, isotropic, 10, cut, .05, soon ? 2e-3 : 1e-6);
            test_bound((form)f, physical, 10, cut, 0);
            test_bound((form)f, physical, 10, cut, .1);
            test_bound((form)f, isotropic, .1, cut, .1);
        }
    }
    return done_testing();
}
