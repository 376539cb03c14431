// needs: slice/contour/cubes.c slice/contour/contour.c slice/contour/contour_shape.c
/* Marching cubes over random samples and maps of labels: closed, with one ring about each
 * vertex, facing outward, of the right volume.
 */
#include "slice/contour/contour.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* xorshift64*, for the same samples everywhere. */
static uint64_t next_random(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return *state * 2685821657736338717ULL;
}

static float random_share(uint64_t *state)
{
    return (float)(next_random(state) >> 40) / (float)(1 << 24);
}

static int by_value(const void *a, const void *b)
{
    uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

/* Every side of a triangle is the side of one other that runs the other way. */
static bool is_closed(const contour *c)
{
    int64_t sides = 3 * c->triangles;
    uint64_t *there = malloc((size_t)sides * sizeof *there + 1), *back = malloc((size_t)sides * sizeof *back + 1);
    bool good = there && back;
    for (int64_t i = 0; good && i < sides; i++) {
        uint64_t p = (uint64_t)c->triangle[i], q = (uint64_t)c->triangle[i % 3 == 2 ? i - 2 : i + 1];
        there[i] = p << 32 | q;
        back[i] = q << 32 | p;
    }
    if (good) {
        qsort(there, (size_t)sides, sizeof *there, by_value);
        qsort(back, (size_t)sides, sizeof *back, by_value);
        good = !memcmp(there, back, (size_t)sides * sizeof *there);
        for (int64_t i = 1; i < sides; i++)
            good &= there[i] != there[i - 1];
    }
    free(there);
    free(back);
    return good;
}

/* Going from triangle to triangle about a vertex meets all of its triangles. */
static bool has_one_ring(const contour *c)
{
    int64_t sides = 3 * c->triangles;
    int32_t *count = calloc((size_t)c->vertices + 1, sizeof *count);
    int64_t *first = calloc((size_t)c->vertices + 1, sizeof *first);
    bool good = count && first;
    for (int64_t i = 0; good && i < sides; i++) {
        count[c->triangle[i]]++;
        first[c->triangle[i]] = i;
    }
    for (int64_t v = 0; good && v < c->vertices; v++) {
        /* few corners: the next one is looked for among all only in small meshes */
        int64_t at = first[v], met = 0;
        do {
            int32_t last = c->triangle[at % 3 == 0 ? at + 2 : at - 1];
            int64_t other = -1;
            for (int64_t i = 0; i < sides; i++)
                if (c->triangle[i] == v && c->triangle[i % 3 == 2 ? i - 2 : i + 1] == last)
                    other = i;
            at = other;
            met++;
        } while (at >= 0 && at != first[v] && met <= count[v]);
        good = at == first[v] && met == count[v];
    }
    free(count);
    free(first);
    return good;
}

static contour make(const float *value, const int64_t size[3], float level, const cubes *t)
{
    contour c = {0};
    err e = {0};
    ok(!contour_make(&c, value, size, level, t, &e), "a surface is made %s", e.text);
    return c;
}

/* A label image at random, each voxel in with this chance. */
static void test_labels(const cubes *t, int64_t nx, int64_t ny, int64_t nz, double chance, uint64_t seed)
{
    int64_t size[3] = {nx, ny, nz}, count = nx * ny * nz, voxels = 0;
    float *value = malloc((size_t)count * sizeof *value);
    uint64_t state = seed;
    if (!value)
        exit(1);
    for (int64_t i = 0; i < count; i++) {
        value[i] = (double)random_share(&state) < chance;
        voxels += value[i] > 0;
    }
    contour c = make(value, size, .5F, t);
    ok(is_closed(&c), "%g of %d x %d x %d voxels: closed", chance, (int)nx, (int)ny, (int)nz);
    if (count <= 512)
        ok(has_one_ring(&c), "and one ring about each vertex");
    double by = contour_fill(&c, (double)voxels, .49);
    near_(contour_volume(&c), (double)voxels, 1e-6 * (double)voxels, "and the label's volume, by sliding %g of a voxel",
          by);
    ok(fabs(by) < .45, "which is allowed");
    contour_free(&c);
    free(value);
}

static void test_samples(const cubes *t, uint64_t seed)
{
    int64_t size[3] = {8, 9, 7};
    float value[8 * 9 * 7];
    uint64_t state = seed;
    for (int i = 0; i < 8 * 9 * 7; i++)
        value[i] = floorf(random_share(&state) * 5); /* many equal to the level, and many ties */
    contour c = make(value, size, 2, t);
    ok(is_closed(&c) && has_one_ring(&c), "random intensities, many equal to the level");
    double least = 1;
    for (int64_t s = 0; s < c.triangles; s++) {
        double length = 0;
        for (int i = 0; i < 3; i++)
            length += pow(c.position[3 * c.triangle[3 * s] + i] - c.position[3 * c.triangle[3 * s + 1] + i], 2);
        least = fmin(least, sqrt(length));
    }
    ok(least >= .9 * CONTOUR_NEAREST, "no side is shorter than %g: %g", CONTOUR_NEAREST, least);
    contour_free(&c);
}

/* A ball: its volume, that it faces outward, and that smoothing keeps it. */
static void test_ball(const cubes *t)
{
    enum { SIDE = 40 };
    int64_t size[3] = {SIDE, SIDE, SIDE};
    static float value[SIDE * SIDE * SIDE];
    double radius = 15.3, ball = 4. / 3 * acos(-1) * pow(radius, 3);
    for (int z = 0; z < SIDE; z++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                value[(z * SIDE + y) * SIDE + x] =
                    (float)(radius - sqrt(pow(x - 19.2, 2) + pow(y - 19.7, 2) + pow(z - 20.1, 2)));
    contour c = make(value, size, 0, t);
    near_(contour_volume(&c), ball, .004 * ball, "a ball's volume");
    double most = 0;
    for (int64_t v = 0; v < c.vertices; v++) {
        const double *p = c.position + 3 * v;
        most = fmax(most, fabs(sqrt(pow(p[0] - 19.2, 2) + pow(p[1] - 19.7, 2) + pow(p[2] - 20.1, 2)) - radius));
    }
    ok(most < .02, "its vertices lie on it, to %g of a voxel", most);
    err e = {0};
    ok(!contour_smooth(&c, 10, &e), "Taubin's smoothing");
    near_(contour_volume(&c), ball, .004 * ball, "keeps the volume");
    contour_free(&c);
}

/* What reaches the border closes half a voxel beyond it. */
static void test_border(const cubes *t)
{
    int64_t size[3] = {4, 3, 2};
    float value[24];
    for (int i = 0; i < 24; i++)
        value[i] = 7;
    contour c = make(value, size, 1, t);
    ok(is_closed(&c), "a full box is closed");
    double low = 9, high = -9;
    for (int64_t v = 0; v < c.vertices; v++) {
        low = fmin(low, c.position[3 * v]);
        high = fmax(high, c.position[3 * v]);
    }
    near_(low, -.5, 1e-12, "half a voxel before the first");
    near_(high, 3.5, 1e-12, "and half after the last");
    contour_free(&c);
    int64_t one[3] = {1, 1, 1};
    c = make(value, one, 1, t);
    ok(c.triangles == 8 && is_closed(&c), "one voxel is an octahedron");
    contour_free(&c);
}

/* On a face of +a -b +c -d, bilinear interpolation joins the pluses where ac > bd: seen by how many parts there are. */
static void test_decider(const cubes *t)
{
    for (int i = 0; i < 3; i++) {
        int64_t size[3] = {2, 2, 1};
        float high = i == 0 ? 3 : 1, low = i == 1 ? -3 : -1; /* joined, apart, a tie */
        float value[4] = {high, low, low, high};
        contour c = make(value, size, 0, t);
        /* Euler: vertices - edges + faces is 2 a part */
        int64_t parts = (c.vertices - 3 * c.triangles / 2 + c.triangles) / 2;
        ok(is_closed(&c) && parts == (i == 0 ? 1 : 2), "%g %g: %d part%s", (double)high, (double)low, (int)parts,
           parts == 1 ? "" : "s");
        contour_free(&c);
    }
}

static void test_not_numbers(const cubes *t)
{
    int64_t size[3] = {3, 3, 3};
    float value[27];
    for (int i = 0; i < 27; i++)
        value[i] = i % 2 ? NAN : -INFINITY;
    value[13] = 5;
    contour c = make(value, size, 0, t);
    bool finite = true;
    for (int64_t i = 0; i < 3 * c.vertices; i++)
        finite &= isfinite(c.position[i]);
    ok(is_closed(&c) && finite && c.triangles == 8, "what is no number is outside, and places stay numbers");
    contour_free(&c);
}

int main(void)
{
    err e = {0};
    cubes *t = cubes_create(&e);
    if (!t)
        return 1;
    test_labels(t, 8, 8, 8, .5, 1);
    test_labels(t, 7, 8, 9, .1, 2);
    test_labels(t, 9, 7, 8, .9, 3);
    test_labels(t, 30, 25, 20, .3, 4);
    test_labels(t, 33, 2, 17, .6, 5);
    test_labels(t, 40, 40, 1, .5, 6);
    for (uint64_t seed = 7; seed < 12; seed++)
        test_samples(t, seed);
    test_ball(t);
    test_border(t);
    test_decider(t);
    test_not_numbers(t);
    free(t);
    return done_testing();
}
