/* Polygons cut into triangles: stars, combs, flat and crossed ones; large ones in no time. */
#include "surface/triangulate.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST = 8000 };

typedef struct polygon {
    double point[3 * MOST];
    int32_t corner[MOST], triangle[3 * MOST];
    int64_t count;
} polygon;

static void add(polygon *p, double x, double y)
{
    double *at = &p->point[3 * p->count];
    at[0] = x, at[1] = y, at[2] = 0;
    p->corner[p->count] = (int32_t)p->count;
    p->count++;
}

/* A turn about (1, 2, 3) / |.| and a shift: no longer in a plane of the axes. */
static void tilt(polygon *p, double angle, double shift)
{
    double l = sqrt(14), k[3] = {1 / l, 2 / l, 3 / l}, c = cos(angle), s = sin(angle);
    for (int64_t i = 0; i < p->count; i++) {
        double *x = &p->point[3 * i], y[3], along = k[0] * x[0] + k[1] * x[1] + k[2] * x[2];
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, d = (a + 2) % 3;
            y[a] = c * x[a] + s * (k[b] * x[d] - k[d] * x[b]) + (1 - c) * along * k[a] + shift * (a + 1);
        }
        memcpy(x, y, sizeof y);
    }
}

static void cross_add(const polygon *p, int32_t a, int32_t b, int32_t c, double *sum)
{
    const double *x = &p->point[3 * a], *y = &p->point[3 * b], *z = &p->point[3 * c];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        sum[i] += (y[j] - x[j]) * (z[k] - x[k]) - (y[k] - x[k]) * (z[j] - x[j]);
    }
}

/* Every triangle's edges: the polygon's own once, in its direction; each other one in both directions. */
static bool is_disc(const polygon *p)
{
    int64_t n = p->count;
    int8_t *edge = calloc((size_t)(n * n), 1);
    bool good = true;
    for (int64_t t = 0; t < n - 2; t++)
        for (int k = 0; k < 3; k++) {
            int32_t a = p->triangle[3 * t + k], b = p->triangle[3 * t + (k + 1) % 3];
            if (a < 0 || b < 0 || a >= n || b >= n || a == b || edge[a * n + b]++)
                good = false;
        }
    for (int64_t a = 0; good && a < n; a++)
        for (int64_t b = 0; b < n; b++)
            good &= (b == (a + 1) % n) ? edge[a * n + b] && !edge[b * n + a]
                                       : (a == (b + 1) % n) || edge[a * n + b] == edge[b * n + a];
    free(edge);
    return good;
}

/* The triangles' areas, all along the polygon's normal, sum to its own: they overlap nowhere. Returns how far from
 * that they are, relative. */
static double overlap(const polygon *p)
{
    double whole[3] = {0}, sum = 0, l = 0;
    for (int32_t i = 1; i + 1 < p->count; i++)
        cross_add(p, 0, i, i + 1, whole);
    for (int a = 0; a < 3; a++)
        l += whole[a] * whole[a];
    l = sqrt(l);
    for (int64_t t = 0; t < p->count - 2; t++) {
        double one[3] = {0}, along = 0;
        cross_add(p, p->triangle[3 * t], p->triangle[3 * t + 1], p->triangle[3 * t + 2], one);
        for (int a = 0; a < 3; a++)
            along += one[a] * whole[a] / l;
        sum += fabs(along);
    }
    return fabs(sum - l) / l;
}

static void cut(polygon *p)
{
    err e = {0};
    memset(p->triangle, -1, sizeof p->triangle);
    if (triangulate(p->point, p->corner, p->count, p->triangle, &e))
        ok(false, "cut: %s", e.text);
}

/* Cuts the polygon as it is, tilted, upside down and far away. */
static void check(const polygon *p, double tolerance, const char *name)
{
    static const double angles[] = {0, .3, 1.1, 2.5, 3.7}, shifts[] = {0, 1e4};
    double worst = 0;
    bool discs = true;
    for (int i = 0; i < 10; i++)
        for (int backwards = 0; backwards < 2; backwards++) {
            polygon q = *p;
            tilt(&q, angles[i % 5], shifts[i / 5]);
            for (int64_t c = 0; backwards && c < q.count; c++)
                memcpy(&q.point[3 * c], &p->point[3 * (q.count - 1 - c)], 3 * sizeof(double));
            if (backwards)
                tilt(&q, angles[i % 5], shifts[i / 5]);
            cut(&q);
            discs &= is_disc(&q);
            worst = fmax(worst, overlap(&q));
        }
    ok(discs && worst <= tolerance, "%s (%d corners): all of it, once (%.2g)", name, (int)p->count, worst);
}

/* For polygons that no cut makes good: still a disc of count - 2 triangles. */
static void check_disc(polygon *p, const char *name)
{
    cut(p);
    ok(is_disc(p), "%s (%d corners): a disc all the same", name, (int)p->count);
}

static void test_simple(void)
{
    polygon p = {0};
    add(&p, 0, 0), add(&p, 2, 0), add(&p, 0, 1);
    check(&p, 1e-9, "triangle");
    add(&p, .5, .2);
    check(&p, 1e-9, "dart");
    p.count = 0;
    for (int i = 0; i < 40; i++)
        add(&p, cos(i * M_PI / 20), sin(i * M_PI / 20));
    check(&p, 1e-9, "convex");
    cut(&p);
    bool fan = true;
    for (int i = 0; i < 38; i++)
        fan &= p.triangle[3 * i] == 0 && p.triangle[3 * i + 1] == i + 1 && p.triangle[3 * i + 2] == i + 2;
    ok(fan, "convex: a fan");
}

static void test_concave(void)
{
    polygon p = {0};
    for (int i = 0; i < 100; i++)
        add(&p, (i % 2 ? 1 : .05) * cos(i * M_PI / 50), (i % 2 ? 1 : .05) * sin(i * M_PI / 50));
    check(&p, 1e-9, "star");
    p.count = 0;
    for (int i = 0; i < 60; i++)
        add(&p, .5 * (i + .5), i % 2 ? 10 : .01);
    add(&p, 40, -1), add(&p, -1, -1);
    check(&p, 1e-9, "comb");
    p.count = 0;
    for (int i = 0; i <= 60; i++)
        add(&p, (1 + .1 * i) * cos(.3 * i), (1 + .1 * i) * sin(.3 * i));
    for (int i = 60; i >= 0; i--)
        add(&p, (1.3 + .1 * i) * cos(.3 * i), (1.3 + .1 * i) * sin(.3 * i));
    check(&p, 1e-9, "spiral");
    p.count = 0;
    add(&p, 0, 0), add(&p, 9, 0), add(&p, 9, 9), add(&p, 0, 9), add(&p, 0, 0);
    add(&p, 3, 3), add(&p, 3, 6), add(&p, 6, 6), add(&p, 6, 3), add(&p, 3, 3);
    check(&p, 1e-9, "ring with a seam");
    p.count = 0;
    for (int i = 0; i < 100; i++)
        add(&p, cos(i * M_PI / 50), i % 2 ? 1e-7 * sin(i * M_PI / 50) : sin(i * M_PI / 50));
    check(&p, 1e-2, "slivers");
}

static void test_collinear(void)
{
    polygon p = {0};
    for (int side = 0; side < 4; side++)
        for (int i = 0; i < 10; i++) {
            static const double x[] = {0, 1, 1, 0}, y[] = {0, 0, 1, 1};
            int next = (side + 1) % 4;
            add(&p, x[side] + .125 * i * (x[next] - x[side]), y[side] + .125 * i * (y[next] - y[side]));
            p.count -= i > 7;
        }
    check(&p, 1e-9, "square with points along its sides");
    p.count = 0;
    for (int i = 0; i < 20; i++)
        add(&p, i / 2, (i + 1) / 2 % 2);
    add(&p, 10, -1), add(&p, 0, -1);
    check(&p, 1e-9, "battlements");
}

static void test_hopeless(void)
{
    polygon p = {0};
    for (int i = 0; i < 9; i++)
        add(&p, 1, 1);
    check_disc(&p, "one place");
    p.count = 0;
    for (int i = 0; i < 9; i++)
        add(&p, i * i % 7, 0);
    check_disc(&p, "a line, to and fro");
    p.count = 0;
    for (int i = 0; i < 5; i++)
        add(&p, cos(i * .8 * M_PI), sin(i * .8 * M_PI));
    check_disc(&p, "pentagram");
    p.count = 0;
    for (int i = 0; i < 300; i++)
        add(&p, rand() % 1000, rand() % 1000);
    check_disc(&p, "scribble");
    for (int i = 0; i < 300; i++)
        p.point[3 * i + 2] = rand() % 1000;
    check_disc(&p, "scribble in space");
    p.count = 0;
    for (int i = 0; i < 40; i++) {
        add(&p, cos(i * M_PI / 20), sin(i * M_PI / 20));
        p.point[3 * i + 2] = sin(i * .7);
    }
    check_disc(&p, "saddle");
}

static void test_random(void)
{
    int wrong = 0;
    srand(7);
    for (int round = 0; round < 500; round++) {
        polygon p = {0};
        int n = 4 + rand() % 30;
        for (int i = 0; i < n; i++) {
            double r = .1 + rand() / (double)RAND_MAX;
            add(&p, r * cos(2 * M_PI * i / n), r * sin(2 * M_PI * i / n));
        }
        tilt(&p, round, round % 3);
        cut(&p);
        wrong += !is_disc(&p) || overlap(&p) > 1e-9;
    }
    ok(!wrong, "500 random stars: %d wrong", wrong);
}

/* Two arms that run side by side for `turns` turns. */
static void add_spiral(polygon *p, int corners, double turns)
{
    p->count = 0;
    for (int i = 0; i < corners; i++) {
        int along = i < corners / 2 ? i : corners - 1 - i;
        double a = 4 * M_PI * turns * along / corners, r = (i < corners / 2 ? 2 : 1.5) + a / 7;
        add(p, r * cos(a), r * sin(a));
    }
}

/* Seconds of a processor; what sanitizers add does not count. */
static double cut_time(polygon *p)
{
    clock_t start = clock();
    cut(p);
    return (double)(clock() - start) / CLOCKS_PER_SEC / (getenv("SINEW_SANITIZED") ? 10 : 1);
}

static void test_large(void)
{
    static polygon p;
    static const double turns[] = {1, 7, 20, 40};
    for (int i = 0; i < 4; i++) {
        add_spiral(&p, MOST, turns[i]);
        double t = cut_time(&p), o = overlap(&p);
        ok(t < 1 && o < 1e-9, "a spiral of %d corners, %g turns: %.2f s, all of it, once (%.2g)", MOST, turns[i], t, o);
    }
    add_spiral(&p, 1000, 20);
    check(&p, 1e-9, "spiral of many turns");
    p.count = 0;
    srand(3);
    for (int i = 0; i < MOST; i++)
        add(&p, rand() % 1000, rand() % 1000);
    double t = cut_time(&p);
    ok(t < 2, "a scribble of %d corners: %.2f s", MOST, t);
    p.count = 1500;
    check_disc(&p, "scribble");
}

/* ---- the definition, at its plainest: every question looks at every corner that is left */

typedef struct plain {
    const double (*at)[2];
    int32_t left[MOST]; /* corners, in order */
    bool maybe[MOST];   /* by place in left */
    int count, doubted;
} plain;

static double plain_area(const plain *p, int a, int b, int c)
{
    const double *x = p->at[p->left[a]], *y = p->at[p->left[b]], *z = p->at[p->left[c]];
    return (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
}

static bool plain_same(const plain *p, int a, int b)
{
    return !memcmp(p->at[p->left[a]], p->at[p->left[b]], sizeof *p->at);
}

static bool plain_ear(const plain *p, int b)
{
    int a = (b + p->count - 1) % p->count, c = (b + 1) % p->count;
    bool ear = plain_area(p, a, b, c) > 0;
    for (int d = 0; d < p->count && ear; d++)
        ear = d == a || d == b || d == c || plain_same(p, a, d) || plain_same(p, b, d) || plain_same(p, c, d) ||
              !(plain_area(p, a, b, d) >= 0 && plain_area(p, b, c, d) >= 0 && plain_area(p, c, a, d) >= 0);
    return ear;
}

static int plain_least(const plain *p)
{
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < p->count; i++) {
        double s = fabs(plain_area(p, (i + p->count - 1) % p->count, i, (i + 1) % p->count));
        if (s < least)
            best = i, least = s;
    }
    return best;
}

static int plain_next(plain *p, int i)
{
    for (;;) {
        for (int k = 0; k < p->count; k++, i = (i + 1) % p->count) {
            if (p->maybe[i] && plain_ear(p, i))
                return i;
            p->maybe[i] = false;
        }
        if (p->count >= p->doubted - p->doubted / 16)
            return plain_least(p);
        memset(p->maybe, true, sizeof p->maybe);
        p->doubted = p->count;
    }
}

/* Of a polygon that runs anticlockwise in the plane of x and y. */
static void plain_cut(const double (*at)[2], int count, int32_t *triangle)
{
    static plain p;
    p.at = at;
    p.count = p.doubted = count;
    memset(p.maybe, true, sizeof p.maybe);
    for (int i = 0; i < count; i++)
        p.left[i] = i;
    for (int i = 1; p.count > 2; triangle += 3) {
        i = p.count > 3 ? plain_next(&p, i % p.count) : 1;
        int before = (i + p.count - 1) % p.count, next = (i + 1) % p.count;
        triangle[0] = p.left[before], triangle[1] = p.left[i], triangle[2] = p.left[next];
        p.maybe[before] = p.maybe[next] = true;
        memmove(&p.left[i], &p.left[i + 1], (size_t)(p.count - i - 1) * sizeof *p.left);
        memmove(&p.maybe[i], &p.maybe[i + 1], (size_t)(p.count - i - 1));
        p.count--;
    }
}

/* A corner of the sort of polygon that round tells: stars, scribbles, on a grid, through one place, far apart by
 * turns. */
static void place_plain(int round, int i, int count, double *at)
{
    double angle = 2 * M_PI * i / count, r = .1 + rand() / (double)RAND_MAX;
    double x[] = {r * cos(angle), rand() % 1000, rand() % 9, i % 3 ? cos(angle) : 0, ldexp(r, -(rand() % 60)), i / 2};
    double y[] = {r * sin(angle),           rand() % 1000, rand() % 9, i % 3 ? sin(angle) : 0,
                  ldexp(r, -(rand() % 60)), i * i % 5};
    at[0] = x[round % 6], at[1] = y[round % 6];
}

static void test_plain(void)
{
    static polygon p;
    static double at[MOST][2];
    static int32_t want[3 * MOST];
    int wrong = 0, rounds = 240;
    srand(11);
    for (int round = 0; round < rounds; round++) {
        int count = round % 4 ? 4 + rand() % 120 : 257 + rand() % 300;
        double area = 0;
        p.count = 0;
        for (int i = 0; i < count; i++)
            place_plain(round, i, count, at[i]);
        for (int i = 1; i + 1 < count; i++)
            area +=
                (at[i][0] - at[0][0]) * (at[i + 1][1] - at[0][1]) - (at[i][1] - at[0][1]) * (at[i + 1][0] - at[0][0]);
        for (int i = 0; i < count; i++) {
            double x = at[i][0];
            at[i][0] = area < 0 ? at[i][1] : x; /* as triangulate() looks from the other side */
            at[i][1] = area < 0 ? x : at[i][1];
            add(&p, area < 0 ? at[i][1] : at[i][0], area < 0 ? at[i][0] : at[i][1]);
        }
        cut(&p);
        plain_cut((const double(*)[2])at, count, want);
        wrong += memcmp(p.triangle, want, 3 * (size_t)(count - 2) * sizeof *want) != 0;
    }
    ok(!wrong, "%d polygons, crossed ones too: the very triangles of the plain algorithm; %d wrong", rounds, wrong);
}

int main(void)
{
    test_simple();
    test_concave();
    test_collinear();
    test_hopeless();
    test_random();
    test_plain();
    test_large();
    return done_testing();
}
