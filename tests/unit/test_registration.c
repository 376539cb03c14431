/* Registration against theory and closed forms: motions that are found again; a thousand trials with noise, whose
 * residuals and errors at a target are those of Fitzpatrick et al. 1998; what is refused. And files of points. */
#include "place/points.h"
#include "place/registration.h"

#include "any_pose.h"
#include "tap.h"

#include <string.h>

enum { N = 6 };

#define PI 3.14159265358979323846

/* As fiducials may be on a head: m. Along no axis alike, and not in a plane. */
static const double head[3 * N] = {.07, 0,    .01, -.07, .01, .02, .01,  .09, -.03,
                                   0,   -.08, .05, .03,  .02, .11, -.04, .05, -.06};

/* Normal, of variance 1 (Box and Muller). */
static double normal(void)
{
    const double u = (any() + 1) / 2, v = any();
    return sqrt(-2 * log(1 - u)) * cos(PI * v);
}

static void move(const pose *p, const double *from, int64_t count, double noise, double *to)
{
    for (int64_t i = 0; i < count; i++) {
        pose_apply(p, from + 3 * i, to + 3 * i);
        for (int a = 0; a < 3; a++)
            to[3 * i + a] += noise * normal();
    }
}

static void test_found_again(void)
{
    double worst = 0, rest = 0, left[3 * N], to[3 * N];
    for (int i = 0; i < 200; i++) {
        const pose p = any_pose();
        const int count = 3 + i % 4;
        registration r;
        err e = {0};
        move(&p, head, count, 0, to);
        if (registration_fit(head, to, count, "test", &r, left, &e))
            worst = 1e9;
        const pose none = pose_relative(&p, &r.at);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fmax(fabs(none.position[k]), fabs(none.quaternion[k])));
        rest = fmax(rest, r.largest);
    }
    ok(worst < 1e-13, "200 motions of three to six points are found again (%g)", worst);
    ok(rest < 1e-14, "and nothing is left (%g m)", rest);
}

/* Fitzpatrick's f: of points at +-a, +-b, +-c on the axes, sums by hand. */
static void test_expected(void)
{
    const double a = .03, b = .02, c = .01;
    const double x[18] = {a, 0, 0, -a, 0, 0, 0, b, 0, 0, -b, 0, 0, 0, c, 0, 0, -c};
    double y[18], left[18];
    registration r;
    err e = {0};
    for (int i = 0; i < 6; i++) /* each pair of them is stretched by 1 mm a side */
        for (int k = 0; k < 3; k++)
            y[3 * i + k] = x[3 * i + k] + (x[3 * i + k] > 0 ? .001 : 0) - (x[3 * i + k] < 0 ? .001 : 0);
    ok(!registration_fit(x, y, 6, "test", &r, left, &e), "points on three axes%s", e.text);
    near_(r.fre, .001, 1e-15, "FRE is 1 mm");
    near_(r.fle, .001 * sqrt(6. / 4), 1e-15, "FLE by it");
    near_(registration_tre(&r, (const double[3]){0, 0, 0}), .001 * sqrt(6. / 4 / 6), 1e-15, "TRE in the middle");
    /* At (0 0 d): from the axes x and y by d. f^2 of x: (b^2 + c^2) / 3, of y: (a^2 + c^2) / 3. */
    const double d = .1, sum = d * d * 3 / (b * b + c * c) + d * d * 3 / (a * a + c * c);
    near_(registration_tre(&r, (const double[3]){0, 0, d}), .001 * sqrt(6. / 4 / 6 * (1 + sum / 3)), 1e-14,
          "and 10 cm along the shortest axis");
    near_(left[0], .001, 1e-15, "what is left of the first");
    near_(left[1], 0, 1e-15, "to one side only");
}

static void test_noise(void)
{
    enum { TRIALS = 1000 };
    const double sigma = 5e-4, fle = 3 * sigma * sigma, target[3] = {.02, -.03, .15};
    double fre = 0, tre = 0, told = 0, theory = 0, middle = 0, to[3 * N], left[3 * N];
    for (int i = 0; i < TRIALS; i++) {
        const pose p = any_pose();
        registration r;
        err e = {0};
        double x[3], y[3];
        move(&p, head, N, sigma, to);
        if (registration_fit(head, to, N, "test", &r, left, &e))
            fre = 1e9;
        fre += r.fre * r.fre / TRIALS;
        pose_apply(&p, target, x);
        pose_apply(&r.at, target, y);
        for (int k = 0; k < 3; k++)
            tre += (x[k] - y[k]) * (x[k] - y[k]) / TRIALS;
        pose_apply(&p, r.middle, x);
        pose_apply(&r.at, r.middle, y);
        for (int k = 0; k < 3; k++)
            middle += (x[k] - y[k]) * (x[k] - y[k]) / TRIALS;
        const double one = registration_tre(&r, target);
        told += one * one / TRIALS;
        theory = one * one / (r.fle * r.fle) * fle; /* by the points alone */
    }
    /* Deviations of these means: 1.3 %, 2 to 3 %. */
    near_(fre / fle, 1 - 2. / N, .04 * (1 - 2. / N), "mean FRE^2 is (1 - 2/N) FLE^2");
    near_(middle / fle, 1. / N, .08 / N, "mean TRE^2 in the middle is FLE^2 / N");
    near_(tre / theory, 1, .08, "mean TRE^2 at a target outside of the points, as theory says");
    near_(told / theory, 1, .04, "and as is told from what is left");
    ok(theory / fle > 2. / N, "where it is more than in the middle: %.3g mm, not %.3g", 1e3 * sqrt(theory),
       1e3 * sqrt(fle / N));
}

static void refused(const char *name, const double *from, const double *to, int64_t count, const char *said)
{
    registration r;
    double left[3 * N];
    err e = {0};
    ok(registration_fit(from, to, count, "test", &r, left, &e) == -1 && e.status == 1 && strstr(e.text, said), "%s: %s",
       name, e.text);
}

static void test_refused(void)
{
    double x[3 * N], y[3 * N];
    const pose p = any_pose();
    move(&p, head, N, 0, y);
    refused("two pairs", head, y, 2, "2 pairs of points; expected three");
    refused("none", head, y, 0, "0 pairs");
    for (int i = 0; i < N; i++)
        for (int a = 0; a < 3; a++)
            x[3 * i + a] = i * .01 * (a + 1) + (i == 1 && a == 0 ? 1e-4 : 0);
    refused("a line", x, y, N, "the first points are on a line");
    refused("a line of the second", head, x, N, "the second points are on a line");
    memset(x, 0, sizeof x);
    refused("one point", x, y, N, "the first points are on a line");
    for (int i = 0; i < 3 * N; i++)
        x[i] = head[i] * (i % 3 == 2 ? -1 : 1);
    refused("a mirror", x, y, N, "fit their partners better mirrored");
    for (int i = 0; i < 3 * N; i++)
        x[i] = head[(i + 9) % (3 * N)];
    refused("another order", x, y, N, "do not fit their partners");
    for (int i = 0; i < 3 * N; i++)
        x[i] = head[i] * 1000;
    refused("another unit", x, y, N, "do not fit their partners");
    x[0] = 1e200;
    refused("too far", x, y, N, "a point of the first is 1e+200 m away");
    registration r;
    double left[3 * N];
    err e = {0};
    for (int i = 0; i < 3 * N; i++)
        x[i] = i % 3 == 2 ? 0 : head[i];
    move(&p, x, N, 0, y);
    ok(!registration_fit(x, y, N, "test", &r, left, &e), "points in a plane have no mirror that fits better%s", e.text);
    move(&p, x, N, 1e-3, y);
    ok(!registration_fit(x, y, N, "test", &r, left, &e), "nor with noise%s", e.text);
}

/* ---- files */

static int read_text(points *p, const char *text, num_unit unit, bool shown, err *e)
{
    const points_wish wish = {unit, shown};
    in *s = in_memory(text, strlen(text), "file", e);
    *p = (points){.count = 0};
    const int failed = s ? points_read(p, s, &wish, e) : -1;
    in_close(s);
    return failed;
}

static bool is_at(const points_one *one, double x, double y, double z)
{
    return fabs(one->at[0] - x) < 1e-15 && fabs(one->at[1] - y) < 1e-15 && fabs(one->at[2] - z) < 1e-15;
}

#define FCSV(space)                                                                                                    \
    "# Markups fiducial file version = 4.11\n# CoordinateSystem = " space                                              \
    "\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"
#define ROW(x, y, z, label) "vtkMRMLMarkupsFiducialNode_0," x "," y "," z ",0,0,0,1,1,1,0," label ",,\n"

static void test_files(void)
{
    const num_unit mm = num_unit_of("mm");
    points p;
    err e = {0};
    ok(!read_text(&p, "# two\n1 2 3\n\n-4 5e0 6 # here\n", mm, false, &e) && p.count == 2 && !p.named &&
           is_at(p.one, .001, .002, .003) && is_at(p.one + 1, -.004, .005, .006),
       "text, in mm%s", e.text);
    points_free(&p);
    ok(!read_text(&p, "nasion 1 2 3\nchin .5 0 0\n", num_unit_of("m"), false, &e) && p.named &&
           !strcmp(p.one[1].name, "chin") && is_at(p.one, 1, 2, 3),
       "with names, in m");
    points_free(&p);
    ok(!read_text(&p, FCSV("LPS") ROW("1", "2", "3", "\"F,1\"") ROW("4", "5", "6", "F-2"), 0, false, &e) &&
           p.count == 2 && p.named && !strcmp(p.one[0].name, "F,1") && is_at(p.one, .001, .002, .003),
       ".fcsv in LPS%s", e.text);
    points_free(&p);
    ok(!read_text(&p, FCSV("0") ROW("1", "2", "3", "a"), mm, false, &e) && is_at(p.one, -.001, -.002, .003),
       "in RAS, as old ones say it");
    points_free(&p);
    ok(!read_text(&p, FCSV("LPS") ROW("1", "2", "3", "a"), 0, true, &e) && is_at(p.one, -.001, -.002, .003),
       "as Slicer shows it");
    points_free(&p);
    ok(!read_text(&p, FCSV("RAS") ROW("1", "2", "3", "a"), 0, true, &e) && is_at(p.one, .001, .002, .003),
       "and so where it has that itself");
    points_free(&p);
}

static void bad_file(const char *name, const char *text, const char *said)
{
    points p;
    err e = {0};
    ok(read_text(&p, text, num_unit_of("mm"), false, &e) == -1 && strstr(e.text, said), "%s: %s", name, e.text);
    points_free(&p);
}

static void test_bad_files(void)
{
    points p;
    err e = {0};
    bad_file("two numbers", "1 2\n", "file:1: 2 words; expected x y z");
    bad_file("no number", "1 2 z\n", "file:1: 'z' is not a finite number");
    bad_file("not finite", "1 2 inf\n", "file:1: 'inf' is not a finite number");
    bad_file("a name twice", "a 1 2 3\na 4 5 6\n", "file:2: a second point 'a'");
    bad_file("some names", "a 1 2 3\n4 5 6\n", "file:2: a point without a name, after others with one");
    bad_file("JSON", "{\"markups\": []}", "save the points as .fcsv");
    bad_file("voxels", FCSV("2"), "file:2: CoordinateSystem; expected LPS");
    bad_file("no axes", "# Markups fiducial file version = 4.3\n1,2,3,4\n",
             "file:2: a point before the axes are known");
    bad_file("a short row", FCSV("LPS") "id,1,2\n", "file:4: a point; expected finite numbers");
    bad_file("a quote without an end", FCSV("LPS") ROW("1", "2", "3", "\"a"), "file:4: a point");
    bad_file("other columns", "# Markups fiducial file\n# columns = id,a,b\n", "file:2: columns; expected x, y and z");
    ok(read_text(&p, "1 2 3\n", 0, false, &e) == -1 && strstr(e.text, "expected --unit"), "no unit: %s", e.text);
    points_free(&p);
}

static void test_pairs(void)
{
    const num_unit mm = num_unit_of("mm");
    points a, b, c;
    int64_t pair[3];
    err e = {0};
    ok(!read_text(&a, "x 1 0 0\ny 0 1 0\nz 0 0 1\n", mm, false, &e) &&
           !read_text(&b, "z 0 0 1\nx 1 0 0\ny 0 1 0\n", mm, false, &e) &&
           !read_text(&c, "z 0 0 1\nx 1 0 0\nw 0 1 0\n", mm, false, &e),
       "three files");
    ok(!points_pair(&a, &b, "a", "b", false, pair, &e) && pair[0] == 1 && pair[1] == 2 && pair[2] == 0, "by name");
    ok(!points_pair(&a, &c, "a", "c", true, pair, &e) && pair[0] == 0 && pair[2] == 2, "by order");
    ok(points_pair(&a, &c, "a", "c", false, pair, &e) == -1 && strstr(e.text, "a:2: 'y' has no partner in c"), "%s",
       e.text);
    points_free(&c);
    e = (err){0};
    ok(!read_text(&c, "1 0 0\n0 1 0\n", mm, false, &e) && points_pair(&a, &c, "a", "c", false, pair, &e) == -1 &&
           strstr(e.text, "c: has 2 points, but a has 3"),
       "%s", e.text);
    points_free(&a);
    points_free(&b);
    points_free(&c);
}

int main(void)
{
    test_found_again();
    test_expected();
    test_noise();
    test_refused();
    test_files();
    test_bad_files();
    test_pairs();
    return done_testing();
}
