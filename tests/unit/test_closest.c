/* Closest points, judged by what makes a point the closest: p is in the triangle, and no corner lies farther toward q
 * than p does.
 */
#include "surface/closest.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* A repeatable random number in [-1, 1]. */
static double random_in(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / (double)(1ull << 52) - 1;
}

static double dot_to(const double *from, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += (a[i] - from[i]) * (b[i] - from[i]);
    return sum;
}

static double distance(const double *a, const double *b)
{
    return sqrt(dot_to(a, b, b));
}

/* How far p is from being the point of `corners` corners nearest to q: 0 where it is. */
static double fault(const double (*corner)[3], int corners, const double *q, const double *p)
{
    double worst = 0;
    for (int i = 0; i < corners; i++)
        worst = fmax(worst, dot_to(p, q, corner[i]));
    return worst;
}

/* The distance of p from triangle abc's plane and outside its sides, by signed areas. */
static double outside(const double (*t)[3], const double *p)
{
    double n[3], ab[3], ac[3], worst;
    for (int i = 0; i < 3; i++) {
        ab[i] = t[1][i] - t[0][i];
        ac[i] = t[2][i] - t[0][i];
    }
    for (int i = 0; i < 3; i++)
        n[i] = ab[(i + 1) % 3] * ac[(i + 2) % 3] - ab[(i + 2) % 3] * ac[(i + 1) % 3];
    double nn = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), plane = 0;
    for (int i = 0; i < 3; i++)
        plane += (p[i] - t[0][i]) * n[i] / nn;
    worst = fabs(plane);
    for (int s = 0; s < 3; s++) {
        double side = 0;
        const double *a = t[s], *b = t[(s + 1) % 3];
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            side += n[i] * ((b[j] - a[j]) * (p[k] - a[k]) - (b[k] - a[k]) * (p[j] - a[j]));
        }
        worst = fmax(worst, -side / nn);
    }
    return worst;
}

static void random_triangles(void)
{
    uint64_t seed = 1;
    double off = 0, out = 0, wrong = 0;
    for (int n = 0; n < 20000; n++) {
        double t[3][3], q[3], p[3];
        for (int i = 0; i < 9; i++)
            t[i / 3][i % 3] = random_in(&seed);
        for (int i = 0; i < 3; i++)
            q[i] = 2 * random_in(&seed);
        double d = closest_triangle(t[0], t[1], t[2], q, p);
        off = fmax(off, fault((const double(*)[3])t, 3, q, p));
        out = fmax(out, outside((const double(*)[3])t, p));
        wrong = fmax(wrong, fabs(d - dot_to(p, q, q)));
        d = closest_segment(t[0], t[1], q, p);
        off = fmax(off, fault((const double(*)[3])t, 2, q, p));
        out = fmax(out, fabs(distance(t[0], p) + distance(p, t[1]) - distance(t[0], t[1])));
        wrong = fmax(wrong, fabs(d - dot_to(p, q, q)));
    }
    near_(off, 0, 1e-11, "20000 triangles and segments: nothing is nearer");
    near_(out, 0, 1e-11, "and the point is in them");
    near_(wrong, 0, 1e-14, "and the squared distance is its own");
}

static void thin_triangles(void)
{
    double p[3], q[3] = {0.5, 1, 0};
    double d = closest_triangle((double[]){0, 0, 0}, (double[]){2, 0, 0}, (double[]){1, 0, 0}, q, p);
    near_(d, 1, 1e-15, "three corners in a line: distance");
    near_(p[0], 0.5, 1e-15, "three corners in a line: place");
    d = closest_triangle((double[]){1, 1, 1}, (double[]){1, 1, 1}, (double[]){1, 1, 1}, q, p);
    near_(d, 1.25, 1e-15, "three corners in one place");
    d = closest_triangle((double[]){0, 0, 0}, (double[]){1, 1e-170, 0}, (double[]){1, 0, 1e-170}, q, p);
    near_(d, 1, 1e-15, "an area that underflows");
    near_(closest_segment(q, q, (double[]){0.5, 0, 0}, p), 1, 1e-15, "a segment of one point");
}

static void polygons(void)
{
    err e = {0};
    closest_shape s = {0};
    /* A U in the plane z = 0, open to +y: its notch is x in (1, 2), y in (1, 3). */
    static const double at[][3] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0},
                                   {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    static const int32_t order[] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
    static const struct {
        double q[3], distance;
    } want[] = {{{1.5, 2.75, 0}, 0.5}, {{1.25, 2, 0}, 0.25}, {{1.5, 1.25, 0}, 0.25},
                {{0.5, 2, 1}, 1},      {{2.5, 2.5, -3}, 3},  {{1.5, 0.5, 0}, 0},
                {{6, 7, 0}, 5},        {{-3, -4, 0}, 5},     {{1.4, 2, 0.3}, 0.5}};
    for (int first = 0; first < 8; first++) {
        double worst = 0;
        ok(!closest_shape_of(&s, &at[0][0], &order[first], 8, &e) && s.parts == 6, "a U from corner %d", first);
        for (size_t i = 0; i < sizeof want / sizeof *want; i++)
            worst = fmax(worst, fabs(closest_distance(&s, want[i].q) - want[i].distance));
        near_(worst, 0, 1e-12, "distances from it");
        ok(s.normal[0] == 0 && s.normal[1] == 0 && s.normal[2] == 1, "its normal");
    }
    ok(s.low[0] == 0 && s.high[0] == 3 && s.low[2] == 0 && s.high[1] == 3, "its bounding box");
    static const int32_t back[] = {3, 2, 1, 0}, line[] = {4, 1}, twice[] = {4, 1, 4, 1};
    ok(!closest_shape_of(&s, &at[0][0], back, 4, &e) && s.normal[2] == -1, "turned round, so is the normal");
    ok(!closest_shape_of(&s, &at[0][0], twice, 4, &e) && s.normal[2] == 0, "no area, no normal");
    near_(closest_distance(&s, (double[]){3, 1, 0}), sqrt(0.5), 1e-12, "and the distance of its line");
    ok(!closest_shape_of(&s, &at[0][0], line, 2, &e) && s.parts == 1 && s.corners == 2, "a line");
    near_(closest_distance(&s, (double[]){3, 1, 0}), sqrt(0.5), 1e-12, "its distance");
    ok(!closest_shape_of(&s, &at[0][0], line, 1, &e) && s.parts == 1 && s.corners == 1, "a point");
    near_(closest_distance(&s, (double[]){2, 1, 5}), 5, 0, "its distance");
    closest_shape_free(&s);
}

int main(void)
{
    random_triangles();
    thin_triangles();
    polygons();
    return done_testing();
}
