/* Spaces against closed forms: half a turn about z between LPS and RAS, quarter turns written out, the manual's line
 * for poses in RAS; matrices that are no rotations. */
#include "base/space.h"

#include "any_pose.h"
#include "tap.h"

#include <string.h>

static double most_apart(const double *a, const double *b, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* Of two poses as rows; q and -q are one turn. */
static double poses_apart(const pose *a, const pose *b)
{
    double x[7], y[7], less = 0, more = 0;
    pose_to_row(a, x);
    pose_to_row(b, y);
    for (int i = 3; i < 7; i++) {
        less = fmax(less, fabs(x[i] - y[i]));
        more = fmax(more, fabs(x[i] + y[i]));
    }
    return fmax(most_apart(x, y, 3), fmin(less, more));
}

/* A quarter turn about x, and a place, written out: the body's y is the space's z. */
static const double quarter[16] = {1, 0, 0, 10, 0, 0, -1, 20, 0, 1, 0, 30, 0, 0, 0, 1};

static void test_written_out(void)
{
    const double h = sqrt(.5);
    pose p = pose_none(), lps = {{.01, .02, .03}, {h, 0, 0, h}}, ras = {{-.01, -.02, .03}, {0, h, h, 0}};
    double m[16];
    err e = {0};
    ok(!space_pose_of_matrix(quarter, SPACE_LPS, &p, &e) && poses_apart(&p, &lps) < 1e-15, "a quarter turn in LPS");
    space_matrix_of_pose(&lps, SPACE_LPS, m);
    ok(most_apart(m, quarter, 16) < 1e-14, "and back");
    ok(!space_pose_of_matrix(quarter, SPACE_RAS, &p, &e) && poses_apart(&p, &ras) < 1e-15,
       "a quarter turn in RAS: the places and axes of the body turn, its own frame stays");
    space_matrix_of_pose(&ras, SPACE_RAS, m);
    ok(most_apart(m, quarter, 16) < 1e-14, "and back");
    const double none[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    pose turned = {{0, 0, 0}, {0, 0, 1, 0}};
    space_matrix_of_pose(&turned, SPACE_RAS, m);
    ok(!memcmp(m, none, sizeof m), "half a turn about z is nothing in RAS, to the byte: there is no -0");
}

/* The line of sinew(7): -tx -ty tz -qy qx qw -qz. */
static void test_the_manuals_line(void)
{
    double worst = 0, back = 0;
    for (int i = 0; i < 100; i++) {
        const pose ras = any_pose();
        const double *t = ras.position, *q = ras.quaternion;
        const pose lps = {{-t[0], -t[1], t[2]}, {-q[1], q[0], q[3], -q[2]}};
        pose p = pose_none();
        double m[16], again[16];
        err e = {0};
        space_matrix_of_pose(&ras, SPACE_LPS, m); /* the numbers of the pose as they are */
        if (space_pose_of_matrix(m, SPACE_RAS, &p, &e))
            worst = INFINITY;
        worst = fmax(worst, poses_apart(&p, &lps));
        space_matrix_of_pose(&p, SPACE_RAS, again);
        back = fmax(back, most_apart(m, again, 16));
    }
    ok(worst < 1e-14, "100 poses in RAS become those that the manual's line gives (%g)", worst);
    ok(back < 1e-12, "and back to the same matrices (%g mm)", back);
}

static void test_points_and_motions(void)
{
    const double mm[3] = {1, 2, 3};
    double x[3], worst = 0;
    space_point_of_mm(mm, SPACE_RAS, x);
    ok(most_apart(x, (const double[3]){-.001, -.002, .003}, 3) < 1e-18, "a point of RAS in LPS");
    space_point_to_mm(x, SPACE_RAS, x);
    ok(most_apart(x, mm, 3) < 1e-15, "and back, in place");
    space_point_of_mm(mm, SPACE_LPS, x);
    ok(most_apart(x, (const double[3]){.001, .002, .003}, 3) < 1e-18, "a point of LPS stays");
    for (int i = 0; i < 100; i++) {
        const pose ras = any_pose(), lps = space_motion(&ras);
        const double from[3] = {any(), any(), any()};
        double a[3], b[3];
        pose_apply(&ras, from, a);
        space_point_of_mm(a, SPACE_RAS, a);
        space_point_of_mm(from, SPACE_RAS, b);
        pose scaled = lps;
        for (int k = 0; k < 3; k++)
            scaled.position[k] = lps.position[k] / 1e3;
        pose_apply(&scaled, b, b);
        worst = fmax(worst, most_apart(a, b, 3));
    }
    ok(worst < 1e-17, "a motion in RAS does to points what its motion in LPS does (%g)", worst);
}

static void test_matrices(void)
{
    double worst = 0, own = 0;
    for (int i = 0; i < 100; i++) {
        const pose a = any_pose(), b = any_pose(), both = pose_compose(&a, &b);
        double m[16], n[16], mn[16], want[16], back[16], one[16];
        space_matrix_of_pose(&a, SPACE_LPS, m);
        space_matrix_of_pose(&b, SPACE_LPS, n);
        space_product(m, n, mn);
        space_matrix_of_pose(&both, SPACE_LPS, want);
        worst = fmax(worst, most_apart(mn, want, 16));
        if (space_inverse(m, back))
            own = INFINITY;
        space_product(m, back, one);
        own = fmax(own, most_apart(one, (const double[16]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 16));
    }
    ok(worst < 1e-11, "products are poses composed (%g mm)", worst);
    ok(own < 1e-11, "a matrix times its inverse is nothing (%g mm)", own);
    const double flat[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    double to[16];
    ok(space_inverse(flat, to) == -1, "a flat one has no inverse");
}

static void refused(const char *name, const double m[16], const char *said)
{
    const pose before = {{1, 2, 3}, {0, 0, 0, 1}};
    pose p = before;
    err e = {0};
    ok(space_pose_of_matrix(m, SPACE_LPS, &p, &e) == -1 && strstr(e.text, said) && !memcmp(&p, &before, sizeof p),
       "%s: %s", name, e.text);
}

static void test_refused(void)
{
    double m[16];
#define CHANGED(at, value) (memcpy(m, quarter, sizeof m), m[at] = (value), m)
    refused("scale", CHANGED(0, 1.002), "lengths 1.002, 1 and 1");
    refused("no axis", CHANGED(0, 0), "lengths 0, 1 and 1");
    const double sheared[16] = {1, .6, 0, 0, 0, .8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    refused("shear", sheared, "columns is 0.6");
    refused("a mirror", CHANGED(0, -1), "mirrors");
    refused("a last row", CHANGED(13, 1), "last row is 0 1 0 1");
    refused("nan", CHANGED(3, (double)NAN), "not finite");
    refused("inf", CHANGED(11, (double)INFINITY), "not finite");
    pose p = pose_none();
    err e = {0};
    ok(!space_pose_of_matrix(CHANGED(0, 1.0009), SPACE_LPS, &p, &e) && fabs(pose_unit(p.quaternion) - 1) < 1e-15,
       "what rounding to three digits does passes, and gives a unit quaternion");
}

int main(void)
{
    test_written_out();
    test_the_manuals_line();
    test_points_and_motions();
    test_matrices();
    test_refused();
    return done_testing();
}
