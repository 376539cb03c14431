/* A box of which only a part is tissue: constant stress is in equilibrium with tractions on the part's faces, which a
 * share alone does not do (the patch test); forces are the derivative of the energy; turns give none; and the bound of
 * the stable step holds, and is at least .6 of a whole box's. */
#include "mesh/lattice.h"
#include "physics/stability_cut.h"

#include "box_square.h"
#include "cut_part.h"
#include "form_tried.h"
#include "tap.h"

static const double box_side[3] = {.01, .0125, .02}, mu = 3000 / 2.9, bulk = 10000;

static element_shape box_shape(void)
{
    return element_box(box_side[0], box_side[1], box_side[2]);
}

static double box_volume(void)
{
    return box_side[0] * box_side[1] * box_side[2];
}

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

/* A box cut by up to `planes` planes, with some of it left; its moments and its share. */
static part part_by_chance(int planes, float moments[7], double *share)
{
    part p = part_box();
    double of[7] = {0};
    *share = 0;
    while (!(*share > 1e-6 && *share < 1 - 1e-6)) {
        p = part_box();
        for (int i = 0; i < planes; i++) {
            double n[3] = {number(), number(), number()};
            const double length = sqrt(part_dot(n, n));
            for (int a = 0; a < 3; a++)
                n[a] /= length;
            p = part_clip(&p, n, 1.5 * number());
        }
        *share = p.faces >= 4 ? part_moments(&p, of) : 0;
    }
    for (int i = 0; i < 7; i++)
        moments[i] = (float)of[i];
    return p;
}

static element_law law_of(double share, hourglass_control control, form f)
{
    element_law law = {{0}, {0}};
    form_tried(f, mu, bulk, law.c);
    hourglass_numbers(control, mu, bulk, box_side, law.hourglass);
    for (int i = 0; i < form_moduli(f); i++)
        law.c[i] *= share;
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law.hourglass[i] *= share;
    return law;
}

static element_field forces(form f, hourglass_control control, element_field u, double share, element_cut c)
{
    const element_fibre none = {.tension = 0};
    return element_force_cut(f, control.kind, u, box_shape(), law_of(share, control, f), none, ELEMENT_NO_MUSCLE, none,
                             ELEMENT_NO_MUSCLE, NULL, 0, c);
}

/* (F - 1) x at the corners of a box at `origin`. */
static element_field affine(double f[3][3], const double origin[3])
{
    element_field u;
    for (int i = 0; i < BOX_FREEDOMS; i++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = origin[a] + box_side[a] * lattice_vtk[i / 3][a];
        *box_component(&u, i / 3, i % 3) = part_dot(f[i % 3], x) - x[i % 3];
    }
    return u;
}

/* ---- the patch test */

static void find_signs(int sign[8][3])
{
    for (int i = 0; i < 24; i++)
        sign[i / 3][i % 3] = 2 * lattice_vtk[i / 3][i % 3] - 1;
}

/* P n on all faces of the part, by exact weights. */
static void tractions(const part *p, element_tensor t, double to[8][3])
{
    double s[3][3] = {{t.xx, t.xy, t.xz}, {t.yx, t.yy, t.yz}, {t.zx, t.zy, t.zz}};
    double area[8][3] = {{0}};
    int sign[8][3];
    find_signs(sign);
    for (int f = 0; f < p->faces; f++)
        part_add_face(&p->face[f], box_side, sign, area);
    for (int i = 0; i < 24; i++)
        to[i / 3][i % 3] = part_dot(s[i % 3], area[i / 3]);
}

/* How far the forces are from the tractions, over the largest traction. */
static double out_of_balance(const part *p, double f[3][3], double share, element_cut c)
{
    const hourglass_control control = {HOURGLASS_PHYSICAL, 0};
    const element_tensor h = {f[0][0] - 1, f[0][1], f[0][2], f[1][0],    f[1][1] - 1,
                              f[1][2],     f[2][0], f[2][1], f[2][2] - 1};
    double want[8][3], worst = 0, scale = 0;
    const double origin[3] = {.3, -.2, .1};
    element_field got = forces(FORM_NEO_HOOKEAN, control, affine(f, origin), share, c);
    tractions(p, form_stress(FORM_NEO_HOOKEAN, h, law_of(1, control, FORM_NEO_HOOKEAN).c), want);
    for (int i = 0; i < 24; i++) {
        worst = fmax(worst, fabs(*box_component(&got, i / 3, i % 3) - want[i / 3][i % 3]));
        scale = fmax(scale, fabs(want[i / 3][i % 3]));
    }
    return worst / scale;
}

static void test_patch(void)
{
    const element_cut centre = {0, 0, 0, 0, 0, 0};
    double by_moments = 0, by_shares = 0;
    for (int i = 0; i < 300; i++) {
        float moments[7];
        double f[3][3], share, of[7];
        const part p = part_by_chance(1 + i % 3, moments, &share);
        for (int k = 0; k < 9; k++)
            f[k / 3][k % 3] = (k % 4 == 0) + .2 * number();
        part_moments(&p, of);
        const element_cut exact = {of[0], of[1], of[2], of[3], of[4], of[5]};
        by_moments = fmax(by_moments, out_of_balance(&p, f, share, exact));
        by_shares += out_of_balance(&p, f, share, centre) / 300;
    }
    near_(by_moments, 0, 1e-11, "constant stress is in balance with tractions on any faces of the part");
    ok(by_shares > .1, "by the share alone it is not: out by %.3g in the mean", by_shares);
}

/* ---- energy */

/* Any displacements, of corners too. */
static element_field bent(double strain)
{
    element_field u;
    for (int i = 0; i < 24; i++)
        *box_component(&u, i / 3, i % 3) = strain * box_side[i % 3] * number();
    return u;
}

static double energy(form f, hourglass_control control, element_field u, double share, element_cut c)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    const element_shape shape = box_shape();
    const element_tensor h = element_cut_gradient(x, y, z, shape.slope, c);
    const element_law law = law_of(1, control, f);
    const hourglass_modes m = element_hourglass_modes(x, y, z);
    const hourglass_force held = hourglass_of(control.kind, m, h, shape, law.hourglass);
    const double stiffer = stability_stiffening_of(f, control.kind, h, law.c).now;
    return share * (box_volume() * form_energy(f, h, law.c) + stiffer * hourglass_dot(&held.f, &m) / 2);
}

static void test_energy(form f, hourglass_control control)
{
    double worst = 0;
    for (int i = 0; i < 40; i++) {
        float moments[7];
        double share, scale = 0, off = 0;
        part_by_chance(1 + i % 3, moments, &share);
        const element_cut c = element_cut_of(moments);
        const element_field u = bent(.15);
        element_field got = forces(f, control, u, share, c);
        for (int k = 0; k < BOX_FREEDOMS; k++) {
            const double step = 1e-6 * box_side[0];
            element_field high = u, low = u;
            *box_component(&high, k / 3, k % 3) += step;
            *box_component(&low, k / 3, k % 3) -= step;
            const double slope = (energy(f, control, high, share, c) - energy(f, control, low, share, c)) / (2 * step);
            off = fmax(off, fabs(slope - *box_component(&got, k / 3, k % 3)));
            scale = fmax(scale, fabs(slope));
        }
        worst = fmax(worst, off / scale);
    }
    near_(worst, 0, 2e-6, "form %d, control %d: forces are the energy's derivative", f, control.kind);
}

static void test_turn(hourglass_control control)
{
    double turn[3][3] = {{.36, .48, -.8}, {-.8, .6, 0}, {.48, .64, .6}}, worst = 0;
    float moments[7];
    double share;
    part_by_chance(2, moments, &share);
    element_field got = forces(FORM_NEO_HOOKEAN, control, affine(turn, box_side), share, element_cut_of(moments));
    for (int k = 0; k < BOX_FREEDOMS; k++)
        worst = fmax(worst, fabs(*box_component(&got, k / 3, k % 3)));
    near_(worst / (mu * box_side[0] * box_side[1]), 0, 1e-12, "a turn gives no forces");
}

/* Without moments the same bytes as a whole box. */
static void test_whole(hourglass_control control)
{
    const element_cut whole = {0, 0, 0, 0, 0, 0};
    const element_fibre none = {.tension = 0};
    int same = 1;
    for (int i = 0; i < 50; i++) {
        const element_field u = bent(.1);
        const element_field got = forces(FORM_NEO_HOOKEAN, control, u, 1, whole),
                            want = element_force(FORM_NEO_HOOKEAN, control.kind, u, box_shape(),
                                                 law_of(1, control, FORM_NEO_HOOKEAN), none, ELEMENT_NO_MUSCLE);
        same = same && !memcmp(&got, &want, sizeof got);
    }
    ok(same, "control %d: a whole box has the same bytes", control.kind);
}

/* ---- the stable step */

typedef struct cut_box {
    form f;
    hourglass_control control;
    element_cut c;
} cut_box;

static element_field box_forces(const void *of, element_field u)
{
    const cut_box *b = of;
    return forces(b->f, b->control, u, 1, b->c);
}

/* Of the box alone, all of its corners of the same mass: differences of its forces. */
static double true_square(form f, hourglass_control control, element_field u, element_cut c, double density)
{
    const cut_box of = {f, control, c};
    return box_square(box_forces, &of, u, 1e-5 * box_side[0], density * box_volume() / 8);
}

/* As monitors find it. */
static double bound_of(form f, hourglass_control control, element_field u, element_cut c, double density, double by)
{
    const element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    const element_shape shape = box_shape();
    const element_tensor h = element_cut_gradient(x, y, z, shape.slope, c);
    const hourglass_modes m = element_hourglass_modes(x, y, z);
    const element_fibre none = {.tension = 0};
    element_law law = law_of(1, control, f);
    const hourglass_force held = hourglass_of(control.kind, m, h, shape, law.hourglass);
    const double twists = 64 * hourglass_stiffest(control.kind, law.hourglass, box_side) / (density * box_volume());
    const stability_stiffening s = stability_stiffening_of(f, control.kind, h, law.c);
    const double slope = fmax(shape.slope.x, fmax(shape.slope.y, shape.slope.z));
    const stability_twists t = stability_cut_twists(c, by, stability_twists_of(control.kind, twists, slope, h, &m, s));
    step_matrix a;
    stability_stiffen(s, hourglass_dot(&held.f, &m) / 2 / box_volume(), law.c);
    stability_matrix(f, law.c, density, box_side, h, none, none, &a);
    stability_cut_matrix(c, by, &a);
    return stability_square(t, stability_largest(&a));
}

static void test_bound(form f, hourglass_control control, double strain)
{
    int wrong = 0;
    double near = 0;
    for (int i = 0; i < 60; i++) {
        float moments[7];
        double share;
        part_by_chance(1 + i % 3, moments, &share);
        const element_cut c = element_cut_of(moments);
        const element_field u = bent(strain);
        const double is = true_square(f, control, u, c, 1000), bound = bound_of(f, control, u, c, 1000, 1);
        wrong += !(is <= bound * (1 + 1e-6));
        near += is / bound / 60;
    }
    ok(!wrong, "form %d, control %d, strains to %g: the bound holds (%.3f of it in the mean)", f, control.kind, strain,
       near);
    if (strain == 0)
        ok(near > .95, "and is near");
}

/* A corner of the box cut off by a plane across x = y = z; `d` from the middle to the plane. */
static void corner_part(double d, float moments[7], double *share)
{
    const double n[3] = {-sqrt(1. / 3), -sqrt(1. / 3), -sqrt(1. / 3)};
    const part whole = part_box(), p = part_clip(&whole, n, -d);
    double of[7];
    *share = part_moments(&p, of);
    for (int i = 0; i < 7; i++)
        moments[i] = (float)of[i];
}

/* At rest, of parts of any share, what has less than CUT_LEAST of a box with the mass of so much; and of corners, the
 * worst of all shapes. */
static void test_least_step(double poisson, double want)
{
    const double own_mu = 1000, own_bulk = own_mu * 2 * (1 + poisson) / (3 * (1 - 2 * poisson)),
                 cube[3] = {.01, .01, .01};
    const element_tensor rest = {0};
    const element_fibre none = {.tension = 0};
    const double c[FORM_NUMBERS] = {own_mu, own_bulk};
    double numbers[HOURGLASS_NUMBERS], least = 1;
    step_matrix whole;
    hourglass_numbers((hourglass_control){HOURGLASS_PHYSICAL, 0}, own_mu, own_bulk, cube, numbers);
    const double twists = 64 * hourglass_stiffest(HOURGLASS_PHYSICAL, numbers, cube) / 1e-3;
    stability_matrix(FORM_NEO_HOOKEAN, c, 1000, cube, rest, none, none, &whole);
    for (int i = 0; i < 3000; i++) {
        float moments[7];
        double share;
        if (i < 100)
            corner_part(.017 * (i + 1), moments, &share);
        else
            part_by_chance(1 + i % 3, moments, &share);
        step_matrix a = whole;
        const element_cut cut = element_cut_of(moments);
        const double by = share / fmax(share, CUT_LEAST);
        const stability_twists at_rest = {twists, 0}, t = stability_cut_twists(cut, by, at_rest);
        stability_cut_matrix(cut, by, &a);
        least = fmin(least, sqrt(stability_largest(&whole) / stability_square(t, stability_largest(&a))));
    }
    ok(least >= want, "nu %g: the stable step is at least %.3f of a whole box's", poisson, least);
}

int main(void)
{
    const hourglass_control physical = {HOURGLASS_PHYSICAL, 0}, isotropic = {HOURGLASS_ISOTROPIC, .05};
    test_patch();
    for (int f = 0; f < FORM_STEPPED; f++) {
        test_energy((form)f, physical);
        test_energy((form)f, isotropic);
        test_bound((form)f, physical, 0);
        test_bound((form)f, physical, .1);
        test_bound((form)f, isotropic, .1);
    }
    test_turn(physical);
    test_turn(isotropic);
    test_whole(physical);
    test_whole(isotropic);
    test_least_step(.3, .6);
    test_least_step(.4, .6);
    test_least_step(.45, .6);
    test_least_step(.499, .6);
    return done_testing();
}
