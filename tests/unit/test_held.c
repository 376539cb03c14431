/* The nearest node that an anchor holds, against a search through all: lattices full of ties, and nodes anywhere. */
#include "mesh/held.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = 3000, ANCHORS = 5, PLACES = 3000 };

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

static int32_t through_all(const double *x, const int32_t *anchor, int32_t which, const double *p)
{
    int32_t best = -1;
    double least = INFINITY;
    for (int32_t n = 0; n < NODES; n++) {
        double a = p[0] - x[3 * n], b = p[1] - x[3 * n + 1], c = p[2] - x[3 * n + 2], d = a * a + b * b + c * c;
        if (anchor[n] == which && d < least) {
            best = n;
            least = d;
        }
    }
    return best;
}

/* cells: nodes and places on a lattice of so many cells and on its half cells; 0: anywhere. */
static void test_places(int cells, const char *what)
{
    static double x[3 * NODES];
    static int32_t anchor[NODES];
    for (int i = 0; i < 3 * NODES; i++)
        x[i] = cells ? rand() % (cells + 1) : uniform(-1, 1);
    for (int n = 0; n < NODES; n++) {
        int r = rand() % 100; /* of anchor 3 a few nodes, of 4 none */
        anchor[n] = (r >= 30) + (r >= 60) + (r >= 80) + (r >= 99) - 1;
    }
    held h;
    err e = {0};
    ok(!held_build(&h, x, anchor, NODES, ANCHORS, &e), "%s: trees %s", what, e.text);
    int wrong = 0, found = 0;
    for (int i = 0; i < PLACES; i++) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = cells ? (rand() % (4 * cells) - cells) / 2. : uniform(-2, 2);
        int32_t near = held_nearest(&h, i % ANCHORS, p);
        wrong += near != through_all(x, anchor, i % ANCHORS, p);
        found += near >= 0;
    }
    ok(!wrong && found == PLACES / ANCHORS * 4, "%s: %d of %d differ", what, wrong, found);
    held_free(&h);
}

int main(void)
{
    srand(5);
    test_places(12, "a lattice");
    test_places(2, "many nodes in one place");
    test_places(0, "anywhere");
    held h;
    err e = {0};
    ok(!held_build(&h, NULL, NULL, 0, 1, &e) && held_nearest(&h, 0, (double[3]){0}) == -1, "no nodes");
    held_free(&h);
    return done_testing();
}
