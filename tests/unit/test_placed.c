/* Images that say where they lie: what of them is a fan, against the area of a sector. */
#include "render/placed.h"

#include "tap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 400 };

static const double pi = 3.14159265358979323846;

/* An image of SIDE x SIDE pixels over all of a fan from radius r to s that opens by `angle` degrees, and `cut` of its
 * width. */
static void test_fan(double r, double s, double angle, double cut)
{
    static char text[SIDE * SIDE + 400];
    const double half = angle * pi / 360, top = r * (cos(half) - 1), wide = 2 * s * sin(half) * cut, high = s - r - top;
    const double column = wide / SIDE, row = high / SIDE;
    err e = {0};
    placed p;
    int64_t shown = 0, above = 0, below = 0;
    const int n =
        snprintf(text, 400, "P5\n# us-slice: %.9g 0 %.9g %.9g 0 0 0 0 %.9g fan %.9g %.9g %.9g %.9g\n%d %d\n255\n",
                 -.5 * (wide - column), top + .5 * row, column, row, r + top + .5 * row, r, s, angle, SIDE, SIDE);
    memset(text + n, 'x', SIDE * SIDE);
    in *source = in_memory(text, (size_t)n + SIDE * SIDE, "image", &e);
    const bool read = source && !placed_read(&p, source, &e);
    in_close(source);
    ok(read && p.fan, "a fan of %g degrees from %g to %g %s", angle, r, s, e.text);
    if (!read)
        return;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            shown += placed_shows(&p, x, y);
    const int face = (int)(-top / row);
    for (int y = 0; y < SIDE; y++) {
        above += y < face - 1 && placed_shows(&p, SIDE / 2, y);
        below += y > face + 1 && placed_shows(&p, SIDE / 2, y);
    }
    const double want = half * (s * s - r * r) / (column * row);
    if (cut >= 1)
        ok(fabs((double)shown - want) < .005 * want, "has as many pixels as its sector: %lld of %.0f", (long long)shown,
           want);
    else
        ok((double)shown < want * .9, "is cut at its sides: %lld of %.0f", (long long)shown, want);
    ok(!above && below == SIDE - face - 2, "along the middle from the face to the end");
    placed_free(&p);
}

static void test_plain(void)
{
    static const char text[] = "P5\n# us-slice: 0 0 0 1 0 0 0 0 1\n2 2\n255\nabcd";
    err e = {0};
    placed p;
    in *source = in_memory(text, sizeof text - 1, "image", &e);
    const bool read = source && !placed_read(&p, source, &e);
    in_close(source);
    ok(read && !p.fan && placed_shows(&p, 0, 0) && placed_shows(&p, 1, 1), "an image that is no fan is all shown");
    if (read)
        placed_free(&p);
}

int main(void)
{
    test_fan(.03, .07, 60, 1);
    test_fan(.01, .05, 120, 1);
    test_fan(0, .1, 90, 1);
    test_fan(.02, .06, 180, 1);
    test_fan(.03, .07, 60, .5);
    test_plain();
    return done_testing();
}
