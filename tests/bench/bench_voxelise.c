// needs: voxelise/build.c voxelise/closed.c voxelise/crossing.c voxelise/expansion.c voxelise/grid.c voxelise/inside.c
// needs: voxelise/solids.c voxelise/weld.c voxelise/volumes.c voxelise/voxels.c voxelise/climb.c
// needs: voxelise/shares.c tests/bench/scan.c
/* How long voxelise takes on a closed scan, step by step, beside two probes of the machine: CSV on stdout. Each figure is the
 * least of several runs. Usage: bench_voxelise [TRIANGLES [FOLDER]]; the OBJ that is read stands in FOLDER (here) meanwhile.
 */
#include "base/mem.h"
#include "base/progress.h"
#include "model/materials.h"
#include "tests/bench/scan.h"
#include "voxelise/build.h"
#include "voxelise/solids.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RUNS = 7, LARGEST_MODEL = 256 };

static void say(const char *what, int64_t triangles, int cells, int threads, double value, const char *unit)
{
    printf("%s,%lld,%d,%d,%.4g,%s\n", what, (long long)triangles, cells, threads, value, unit);
    fflush(stdout);
}

/* ---- the machine */

static int probe_copy(err *e)
{
    enum { BYTES = 256 << 20 };
    char *from = mem_array(BYTES, 1, "a probe", e), *to = from ? mem_array(BYTES, 1, "a probe", e) : NULL;
    double best = INFINITY;
    for (int r = 0; to && r < RUNS; r++) {
        memset(from, r + 1, BYTES);
        double start = progress_clock();
        memcpy(to, from, BYTES);
        best = fmin(best, progress_clock() - start);
    }
    if (to)
        say("probe copy", 0, 0, 1, BYTES / best / 1e9, to[BYTES - 1] == RUNS ? "GB/s" : "?");
    free(from);
    free(to);
    return to ? 0 : -1;
}

static void probe_multiply_add(void)
{
    enum { LANES = 32, STEPS = 4000000 };
    double x[LANES], best = INFINITY, sum = 0;
    for (int r = 0; r < RUNS; r++) {
        for (int i = 0; i < LANES; i++)
            x[i] = i;
        double start = progress_clock();
        for (int s = 0; s < STEPS; s++)
            for (int i = 0; i < LANES; i++)
                x[i] = x[i] * 0.999 + 0.5;
        best = fmin(best, progress_clock() - start);
        for (int i = 0; i < LANES; i++)
            sum += x[i];
    }
    say("probe multiply-add", 0, 0, 1, (double)LANES * STEPS / best / 1e9, sum > 0 ? "G/s" : "?");
}

/* ---- the scan as an OBJ: stretched to a cube, so that a lattice of n cells a side is n^3 */

static int write_scan(const char *path, int64_t triangles, err *e)
{
    scan s;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (scan_make(&s, triangles, e))
        return -1;
    out *o = out_open(path, false, e);
    for (int64_t i = 0; i < 3 * s.vertices; i++) {
        low[i % 3] = fmin(low[i % 3], s.position[i]);
        high[i % 3] = fmax(high[i % 3], s.position[i]);
    }
    if (o)
        out_text(o, "g skin\n");
    for (int64_t v = 0; o && v < s.vertices; v++) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = 200 * (s.position[3 * v + a] - low[a]) / (high[a] - low[a]);
        out_format(o, "v %.6f %.6f %.6f\n", p[0], p[1], p[2]);
    }
    for (int64_t t = 0; o && t < s.triangles; t++)
        out_format(o, "f %d %d %d\n", s.vertex[3 * t] + 1, s.vertex[3 * t + 1] + 1, s.vertex[3 * t + 2] + 1);
    scan_free(&s);
    return o ? out_close(o, e) : -1;
}

/* ---- the steps */

typedef struct bench {
    obj surface;
    model materials;
    volumes plan;
    solids solid;
} bench;

static int bench_reading(const char *path, bench *b, err *e)
{
    double best = INFINITY;
    for (int r = 0; r < RUNS; r++) {
        obj_free(&b->surface);
        double start = progress_clock();
        in *source = in_open(path, e);
        int status = source ? obj_read(&b->surface, source, e) : -1;
        in_close(source);
        if (status)
            return -1;
        best = fmin(best, progress_clock() - start);
    }
    say("reading", b->surface.faces, 0, 1, 1e3 * best, "ms");
    say("reading", b->surface.faces, 0, 1, (double)b->surface.size / best / 1e6, "MB/s");
    return 0;
}

static int bench_checking(bench *b, err *e)
{
    double best = INFINITY;
    if (materials_default(&b->materials, e))
        return -1;
    for (int r = 0; r < RUNS; r++) {
        solids_free(&b->solid);
        volumes_free(&b->plan);
        double start = progress_clock();
        if (volumes_by_name(&b->plan, &b->surface, &b->materials, e) ||
            solids_build(&b->solid, &b->surface, &b->plan, false, NULL, e))
            return -1;
        best = fmin(best, progress_clock() - start);
    }
    say("checking", b->solid.triangles, 0, 1, 1e3 * best, "ms");
    return 0;
}

static int find(const bench *b, const grid *g, pool *threads, inside *test, voxels *x, double *seconds, err *e)
{
    const solids *s = &b->solid;
    const int32_t level = 0;
    inside_triangles t = {s->position, s->vertices, s->vertex, s->volume, s->triangles};
    double start = progress_clock();
    if (inside_create(test, g, &t, CLIMB_RAY, 1, threads, e))
        return -1;
    int status = voxels_find(x, test, &level, 1, NULL, threads, NULL, e);
    *seconds = progress_clock() - start;
    inside_free(test);
    return status;
}

static int bench_model(const voxels *x, int64_t triangles, int cells, pool *threads, err *e)
{
    lattice l = {{0, 0, 0}, {1, 1, 1}};
    double best = INFINITY;
    for (int r = 0; r < 3; r++) {
        model m = {0};
        double start = progress_clock();
        int status = model_axis_add(&m, "volume", 1, e) || build_elements(&m, x, &l, threads, e) ? -1 : 0;
        best = fmin(best, progress_clock() - start);
        model_free(&m);
        if (status)
            return -1;
    }
    say("building", triangles, cells, pool_threads(threads), 1e3 * best, "ms");
    return 0;
}

static int bench_inside(const bench *b, int cells, int count, err *e)
{
    const solids *s = &b->solid;
    double best = INFINITY, spacing[3];
    pool *threads = pool_create(count, e);
    grid g;
    voxels x = {0};
    for (int a = 0; a < 3; a++)
        spacing[a] = (s->high[a] - s->low[a]) / cells;
    int status = threads ? grid_cover(&g, s->low, s->high, spacing, e) : -1;
    for (int r = 0; !status && r < RUNS; r++) {
        inside test;
        double seconds = 0;
        voxels_free(&x);
        status = find(b, &g, threads, &test, &x, &seconds, e);
        best = fmin(best, seconds);
    }
    if (!status) {
        say("inside", s->triangles, cells, count, 1e3 * best, "ms");
        if (cells <= LARGEST_MODEL)
            status = bench_model(&x, s->triangles, cells, threads, e);
    }
    voxels_free(&x);
    pool_destroy(threads);
    return status;
}

int main(int argc, char **argv)
{
    static const int cells[] = {64, 128, 256, 512};
    err e = {0};
    bench b = {0};
    int64_t triangles = argc > 1 ? atoll(argv[1]) : 100000;
    char path[1000];
    snprintf(path, sizeof path, "%s/bench_voxelise.obj", argc > 2 ? argv[2] : ".");
    puts("what,triangles,cells,threads,value,unit");
    if (triangles < 100)
        err_set(&e, NULL, 0, "%s triangles; expected 100 or more", argv[1]);
    int status = e.status || probe_copy(&e) ? -1 : 0;
    if (!status) {
        probe_multiply_add();
        status = write_scan(path, triangles, &e) || bench_reading(path, &b, &e) || bench_checking(&b, &e) ? -1 : 0;
    }
    for (int threads = 1; !status && threads <= 2; threads++)
        for (size_t n = 0; !status && n < sizeof cells / sizeof *cells; n++)
            status = bench_inside(&b, cells[n], threads, &e);
    remove(path);
    solids_free(&b.solid);
    volumes_free(&b.plan);
    model_free(&b.materials);
    obj_free(&b.surface);
    if (status)
        fprintf(stderr, "bench_voxelise: %s\n", e.text);
    return status ? 1 : 0;
}
