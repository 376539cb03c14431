/* Which points lie inside of closed surfaces: of a box on a lattice, of a ring by its equation, of a shell with a
 * hollow; on faces, edges and corners; whichever way the triangles turn. */
#include "surface/winding.h"

#include "tap.h"

#include <stdlib.h>

/* Corner i of a box: bit 0 is x, bit 1 y, bit 2 z. Triangles turn out. */
static const int32_t box_corner[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

static void make_box(double low, double high, double *position)
{
    for (int i = 0; i < 24; i++)
        position[i] = i / 3 >> i % 3 & 1 ? high : low;
}

/* Of the points of a lattice of spacing h about the origin, -n to n along each axis. */
static int count(const winding *s, int n, double h)
{
    int held = 0;
    for (int i = -n; i <= n; i++)
        for (int j = -n; j <= n; j++)
            for (int k = -n; k <= n; k++) {
                const double point[3] = {h * i, h * j, h * k};
                held += winding_holds(s, point);
            }
    return held;
}

static void boxes(void)
{
    double position[48];
    int32_t corner[72];
    make_box(-.3, .3, position);
    winding s = winding_of(position, box_corner, 12);
    ok(count(&s, 6, .1) == 7 * 7 * 7,
       "a box holds what lies on its faces, edges and corners, which h i misses by roundings");
    make_box(-.35, .35, position);
    s = winding_of(position, box_corner, 12);
    ok(count(&s, 6, .1) == 7 * 7 * 7, "and nothing outside, in line with its edges or not");
    for (int i = 0; i < 36; i++)
        corner[i] = box_corner[i / 3 * 3 + 2 - i % 3];
    s = winding_of(position, corner, 12);
    ok(count(&s, 6, .1) == 7 * 7 * 7, "turned in: the same");
    make_box(-.15, .15, position + 24);
    for (int i = 0; i < 36; i++) {
        corner[36 + i] = corner[i] + 8;
        corner[i] = box_corner[i];
    }
    s = winding_of(position, corner, 24);
    ok(count(&s, 6, .1) == 7 * 7 * 7 - 3 * 3 * 3, "a box in a box, turned the other way: the hollow is outside");
    const double none[3] = {NAN, 0, 0};
    ok(!winding_holds(&s, none), "what is no point is outside");
    s = winding_of(position, corner, 0);
    ok(count(&s, 6, .1) == 0, "no triangles hold nothing");
}

enum { ROUND = 96, ACROSS = 48 };

/* A ring about z: radius 1, .4 thick either way. */
static void make_ring(double *position, int32_t *corner)
{
    for (int i = 0; i < ROUND; i++)
        for (int j = 0; j < ACROSS; j++) {
            const double a = 2 * 3.14159265358979323846 * i / ROUND, b = 2 * 3.14159265358979323846 * j / ACROSS;
            double *at = position + 3 * (i * ACROSS + j);
            at[0] = (1 + .4 * cos(b)) * cos(a);
            at[1] = (1 + .4 * cos(b)) * sin(a);
            at[2] = .4 * sin(b);
            const int next = (i + 1) % ROUND * ACROSS, up = (j + 1) % ACROSS;
            const int32_t quad[4] = {i * ACROSS + j, next + j, next + up, i * ACROSS + up};
            const int32_t cut[6] = {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]};
            for (int k = 0; k < 6; k++)
                corner[6 * (i * ACROSS + j) + k] = cut[k];
        }
}

static void ring(void)
{
    static double position[3 * ROUND * ACROSS];
    static int32_t corner[6 * ROUND * ACROSS];
    int wrong = 0, tried = 0, held = 0;
    make_ring(position, corner);
    const winding s = winding_of(position, corner, 2 * ROUND * ACROSS);
    srand(1);
    for (int i = 0; i < 2000; i++) {
        double point[3];
        for (int a = 0; a < 3; a++)
            point[a] = (a < 2 ? 3. : 1.) * ((double)rand() / RAND_MAX - .5);
        const double from = hypot(hypot(point[0], point[1]) - 1, point[2]);
        if (fabs(from - .4) < .005) /* between the triangles and the ring */
            continue;
        tried++;
        held += from < .4;
        wrong += winding_holds(&s, point) != (from < .4);
    }
    ok(wrong == 0 && held > 200, "of %d points in and about a ring, %d of them inside, %d are wrong", tried, held,
       wrong);
}

int main(void)
{
    boxes();
    ring();
    return done_testing();
}
