/* Points at one place: against a comparison of all with all. */
#include "surface/coincident.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum { POINTS = 500 };

/* Few coordinates, so that many points are at one place; 0 of both signs. */
static void make(double position[3 * POINTS])
{
    static const double coordinate[] = {0, -0., 1e-300, 1, -1, .1, 1e300};
    uint32_t seed = 3;
    for (int i = 0; i < 3 * POINTS; i++) {
        seed = seed * 1664525 + 1013904223;
        position[i] = coordinate[(seed >> 8) % 7];
    }
}

static void test_all(void)
{
    static double position[3 * POINTS];
    int32_t place[POINTS], want[POINTS], wanted = 0;
    err e = {0};
    make(position);
    for (int i = 0; i < POINTS; i++) {
        want[i] = -1;
        for (int k = 0; k < i && want[i] < 0; k++) {
            const double *a = position + 3 * i, *b = position + 3 * k;
            if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
                want[i] = want[k];
        }
        if (want[i] < 0)
            want[i] = wanted++;
    }
    ok(coincident_places(position, POINTS, place, &e) == wanted, "as many places as by comparison of all with all");
    ok(!memcmp(place, want, sizeof want), "numbered in the order of the first point at each");
    ok(coincident_places(position, 0, place, &e) == 0, "no point, no place");
}

int main(void)
{
    test_all();
    return done_testing();
}
