// needs: voxelise/depths.c voxelise/voxels.c voxelise/climb.c voxelise/shares.c voxelise/inside.c
// needs: voxelise/surfaces/crossing.c voxelise/surfaces/expansion.c voxelise/surfaces/grid.c voxelise/pieces.c
// needs: voxelise/cuts.c
/* How deep voxels lie below a surface: triangles of all sizes at random, and voxels too, each centre measured from each
 * triangle. Small lattices and long ones, flat voxels, depths from less than a voxel to more than the lattice.
 */
#include "tap.h"

#include "surface/closest.h"
#include "voxelise/depths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RUNS = 4000, MOST_VOXELS = 40000, MOST_TRIANGLES = 300, DEPTHS = 4 };

typedef struct scene {
    grid g;
    climb_run run[MOST_RUNS];
    voxels x;
    double corner[9 * MOST_TRIANGLES], depth[DEPTHS];
    depths_surface s;
    int64_t depths;
} scene;

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / (double)RAND_MAX;
}

/* Runs in order, of volumes 0 to 2, in a lattice of such sizes. */
static void add_runs(scene *s, const int *size)
{
    s->x = (voxels){.run = s->run};
    for (int k = 0; k < size[2]; k++)
        for (int j = 0; j < size[1]; j++)
            for (int i = rand() % size[0]; i < size[0] && s->x.runs < MOST_RUNS;) {
                int past = i + 1 + rand() % size[0];
                past = past < size[0] ? past : size[0];
                if (s->x.elements + past - i > MOST_VOXELS)
                    return;
                s->run[s->x.runs++] = (climb_run){i - 5, past - 5, j - 7, k - 9, rand() % 3};
                s->x.elements += past - i;
                i = past + rand() % 3;
            }
}

/* Some triangles are points, lines, many alike; some larger than the lattice. */
static void add_triangles(scene *s, const int *size)
{
    s->s = (depths_surface){s->corner, 1 + rand() % MOST_TRIANGLES};
    for (int64_t t = 0; t < s->s.triangles; t++) {
        double middle[3], length = rand() % 9 ? uniform(0, 3) : uniform(0, 100);
        for (int a = 0; a < 3; a++)
            middle[a] = (uniform(-4, size[a] + 4) - (5 + 2 * a)) * s->g.spacing[a];
        for (int c = 0; c < 9; c++)
            s->corner[9 * t + c] = t && rand() % 20 == 0 ? s->corner[9 * t + c - 9]
                                                         : middle[c % 3] + uniform(-1, 1) * length * s->g.spacing[0];
    }
}

static void make_scene(scene *s)
{
    int longest = rand() % 3, size[3];
    double scale = pow(10, uniform(-3, 3)), depth = 0;
    s->g = (grid){.low = {-1000, -1000, -1000}, .high = {1000, 1000, 1000}};
    for (int a = 0; a < 3; a++) {
        size[a] = 1 + rand() % (a == longest && rand() % 2 ? 150 : 20);
        s->g.spacing[a] = scale * (rand() % 2 ? 1 : uniform(0.3, 3));
    }
    add_runs(s, size);
    add_triangles(s, size);
    s->depths = 1 + rand() % DEPTHS;
    for (int64_t i = 0; i < s->depths; i++)
        s->depth[i] = depth += scale * (rand() % 6 ? uniform(0.05, 3) : uniform(0, 100));
}

static double depth_at(const scene *s, const int *cell)
{
    double q[3], p[3], nearest = INFINITY;
    for (int a = 0; a < 3; a++)
        q[a] = grid_centre(&s->g, a, cell[a]);
    for (int64_t t = 0; t < s->s.triangles; t++) {
        const double *c = &s->corner[9 * t];
        nearest = fmin(nearest, sqrt(closest_triangle(c, c + 3, c + 6, q, p)));
    }
    return nearest;
}

static uint8_t step_for(const scene *s, double depth)
{
    for (int64_t d = 0; d < s->depths; d++)
        if (depth < s->depth[d])
            return (uint8_t)(d + 1);
    return 0;
}

/* What find gives, on so many threads: of volume 2, what was there. */
static bool find(const scene *s, int count, uint8_t *step)
{
    err e = {0};
    voxels_layers layer;
    pool *threads = pool_create(count, &e);
    memset(step, 77, MOST_VOXELS);
    bool good = threads && !voxels_find_layers(&s->x, &layer, &e);
    if (good) {
        good = !depths_find(step, s->depth, s->depths, &s->x, &layer, 2, &s->s, &s->g, threads, &e);
        voxels_layers_free(&layer);
    }
    if (threads)
        pool_destroy(threads);
    return good;
}

/* ---- samples of voxels */

enum { SAMPLES = 8, SIDE = 3 * SAMPLES };

static int64_t sample_at(const int *at)
{
    return ((int64_t)at[2] * SIDE + at[1]) * SIDE + at[0];
}

/* All in two halves. False: it failed. */
static bool look(const depths *d, uint8_t *step)
{
    err e = {0};
    const int64_t low[3] = {0, 0, 0}, middle[3] = {0, 0, 11}, half[3] = {SIDE, SIDE, 11}, high[3] = {SIDE, SIDE, SIDE};
    return !depths_look(d, low, half, step, &e) && !depths_look(d, middle, high, step + 11 * SIDE * SIDE, &e);
}

/* Below a plane across an axis: a layer of a part of a sample, or of some and a part, has its own volume. */
static void test_plane(int axis)
{
    static const double depth[] = {.3, 1.7, 9.2};
    static uint8_t step[SIDE * SIDE * SIDE];
    double corner[9] = {0};
    const grid g = {.spacing = {1, 1, 1}, .high = {SIDE, SIDE, SIDE}};
    const depths_surface surface = {corner, 1};
    err e = {0};
    int64_t count[4] = {0};
    corner[(axis + 1) % 3] = corner[3 + (axis + 1) % 3] = -100, corner[6 + (axis + 1) % 3] = 200;
    corner[(axis + 2) % 3] = -100, corner[3 + (axis + 2) % 3] = 200, corner[6 + (axis + 2) % 3] = -100;
    depths *d = depths_create(depth, 3, &surface, &g, SAMPLES, &e);
    memset(step, 0, sizeof step);
    step[SIDE * SIDE * SIDE - 1] = DEPTHS_UNWANTED;
    const bool good = d && look(d, step);
    for (int64_t i = 0; good && i < SIDE * SIDE * SIDE - 1; i++)
        count[step[i]]++;
    depths_destroy(d);
    for (int i = 1; i < 4; i++)
        near_((double)count[i] / (SIDE * SIDE), depth[i - 1] - (i > 1 ? depth[i - 2] : 0), .01,
              "axis %d: the volume of layer %d", axis, i);
    ok(step[SIDE * SIDE * SIDE - 1] == DEPTHS_UNWANTED, "axis %d: what is not wanted stays", axis);
}

/* Deeper than all is last. */
static int order_of(uint8_t step)
{
    return step ? step : DEPTHS + 1;
}

/* Below any triangles a sample's step is that of a depth within a sample's width of its own. */
static void test_samples(scene *s)
{
    static uint8_t step[SIDE * SIDE * SIDE];
    int64_t wrong = 0, failed = 0;
    for (int n = 0; n < 6; n++) {
        err e = {0};
        make_scene(s);
        for (int a = 0; a < 3; a++)
            s->g.low[a] = 0, s->g.high[a] = SIDE;
        const double *h = s->g.spacing, width = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) * (1 + 1e-6);
        depths *d = depths_create(s->depth, s->depths, &s->s, &s->g, SAMPLES, &e);
        memset(step, 0, sizeof step);
        failed += !d || !look(d, step);
        depths_destroy(d);
        for (int at[3] = {0}; at[2] < SIDE; at[2] += 5)
            for (at[1] = 0; at[1] < SIDE; at[1] += 5)
                for (at[0] = 0; at[0] < SIDE; at[0] += 5) {
                    const double deep = depth_at(s, at);
                    const int first = order_of(step_for(s, deep - width)), last = order_of(step_for(s, deep + width)),
                              got = order_of(step[sample_at(at)]);
                    wrong += got < first || got > last;
                }
    }
    ok(!failed && !wrong, "%d samples are not about at their depth", (int)wrong);
}

int main(void)
{
    static scene s;
    static uint8_t one[MOST_VOXELS], three[MOST_VOXELS];
    int64_t wrong = 0, unlike = 0, failed = 0, seen[DEPTHS + 1] = {0};
    srand(5);
    for (int n = 0; n < 60; n++) {
        make_scene(&s);
        if (!find(&s, 1, one) || !find(&s, 3, three)) {
            failed++;
            continue;
        }
        unlike += memcmp(one, three, sizeof one) != 0;
        for (int64_t r = 0, voxel = 0; r < s.x.runs; r++)
            for (int32_t i = s.run[r].from; i < s.run[r].to; i++, voxel++) {
                uint8_t want =
                    s.run[r].volume < 2 ? step_for(&s, depth_at(&s, (int[3]){i, s.run[r].j, s.run[r].k})) : 77;
                wrong += one[voxel] != want;
                if (want <= DEPTHS)
                    seen[want]++;
            }
    }
    ok(!failed, "%d scenes could not be looked at", (int)failed);
    ok(!wrong, "%d voxels are not at their depth", (int)wrong);
    ok(!unlike, "%d scenes differ between one thread and three", (int)unlike);
    ok(seen[0] > 100 && seen[1] > 100 && seen[2] > 100, "voxels at many depths: %d %d %d", (int)seen[0], (int)seen[1],
       (int)seen[2]);
    for (int a = 0; a < 3; a++)
        test_plane(a);
    test_samples(&s);
    return done_testing();
}
