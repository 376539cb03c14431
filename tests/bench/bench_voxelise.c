// needs: voxelise/build.c voxelise/surfaces/closed.c voxelise/surfaces/crossing.c voxelise/surfaces/expansion.c
// needs: voxelise/surfaces/grid.c voxelise/inside.c voxelise/pieces.c voxelise/cuts.c voxelise/solids.c
// needs: voxelise/surfaces/weld.c voxelise/volumes.c voxelise/voxels.c voxelise/climb.c voxelise/shares.c
// needs: voxelise/layers.c voxelise/surfaces/outward.c voxelise/depths.c tests/bench/scan.c tests/bench/bench.c
/* `make bench-voxelise`: how long voxelise takes on a closed scan, step by step, on one thread and on
 * two, beside a probe of the machine: CSV. Usage: bench_voxelise [TRIANGLES [FOLDER]]; the OBJ that
 * is read stands in FOLDER (here) meanwhile.
 */
#include "base/mem.h"
#include "model/materials.h"
#include "tests/bench/bench.h"
#include "tests/bench/scan.h"
#include "voxelise/build.h"
#include "voxelise/layers.h"
#include "voxelise/solids.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 7, LARGEST_MODEL = 256, NAMES = 64 };

/* What is measured, and on what. */
typedef struct subject {
    bench all;
    char name[NAMES][64];
    obj surface;
    model materials;
    volumes plan;
    solids solid;
} subject;

/* The name of a case, which lasts as the subject does. */
static const char *name_of(subject *s, const char *what, int cells, int threads)
{
    char name[sizeof *s->name];
    int i = 0;
    snprintf(name, sizeof name, "%s, %d cells a side, %d thread%s", what, cells, threads, threads > 1 ? "s" : "");
    while (i < NAMES - 1 && *s->name[i] && strcmp(s->name[i], name) != 0)
        i++;
    memcpy(s->name[i], name, sizeof name);
    return s->name[i];
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

static int read_scan(const char *path, subject *s, err *e)
{
    obj_free(&s->surface);
    double start = bench_clock();
    in *source = in_open(path, e);
    int status = source ? obj_read(&s->surface, source, e) : -1;
    in_close(source);
    bench_take(&s->all, "reading", (double)s->surface.size, "B", bench_clock() - start);
    return status;
}

static int check_surfaces(subject *s, err *e)
{
    solids_free(&s->solid);
    volumes_free(&s->plan);
    double start = bench_clock();
    int status = volumes_by_name(&s->plan, &s->surface, &s->materials, e) ||
                         solids_build(&s->solid, &s->surface, &s->plan, num_unit_of("mm"), false, false, NULL, e)
                     ? -1
                     : 0;
    bench_take(&s->all, "checking surfaces", (double)s->solid.triangles, "triangle", bench_clock() - start);
    return status;
}

static int find_inside(subject *s, const grid *g, int cells, pool *threads, voxels *x, err *e)
{
    const solids *of = &s->solid;
    const int32_t level = 0;
    inside test;
    inside_triangles t = {of->position, of->vertices, of->vertex, of->volume, of->triangles};
    double start = bench_clock();
    if (inside_create(&test, g, &t, CLIMB_RAY, 1, threads, e))
        return -1;
    int status = voxels_find(x, &test, &level, 1, NULL, NULL, NULL, threads, NULL, e);
    bench_take(&s->all, name_of(s, "inside mask", cells, pool_threads(threads)), grid_count(g), "cell",
               bench_clock() - start);
    inside_free(&test);
    return status;
}

static int build_model(subject *s, const voxels *x, int cells, pool *threads, err *e)
{
    lattice l = {{0, 0, 0}, {1, 1, 1}};
    model m = {0};
    double start = bench_clock();
    int status = model_axis_add(&m, "volume", 2, e) || build_elements(&m, x, &(slits){0}, &l, threads, e) ? -1 : 0;
    bench_take(&s->all, name_of(s, "building the model", cells, pool_threads(threads)), (double)x->elements, "element",
               bench_clock() - start);
    model_free(&m);
    return status;
}

/* One layer of 6 voxels. The plan gets a volume more. */
static int find_layers(subject *s, const grid *g, int cells, pool *threads, voxels *x, err *e)
{
    char name[] = "layer";
    layers_layer one = {.name = name, .depth = 6 * g->spacing[0]};
    layers l = {&one, 1, 1};
    double start = bench_clock();
    int status = layers_apply(&l, x, &s->plan, &s->surface, g, threads, e);
    bench_take(&s->all, name_of(s, "layer of 6 voxels", cells, pool_threads(threads)), (double)s->solid.triangles,
               "triangle", bench_clock() - start);
    return status;
}

/* A round at one size. */
static int go(subject *s, int cells, int count, err *e)
{
    double spacing[3];
    pool *threads = pool_create(count, e);
    grid g;
    voxels x = {0};
    for (int a = 0; a < 3; a++)
        spacing[a] = (s->solid.high[a] - s->solid.low[a]) / cells;
    int status = threads && !grid_cover(&g, s->solid.low, s->solid.high, spacing, e) ? 0 : -1;
    if (!status)
        status = find_inside(s, &g, cells, threads, &x, e);
    if (!status && cells <= LARGEST_MODEL)
        status = build_model(s, &x, cells, threads, e) || find_layers(s, &g, cells, threads, &x, e) ||
                         check_surfaces(s, e) /* the plan as it was */
                     ? -1
                     : 0;
    voxels_free(&x);
    if (threads)
        pool_destroy(threads);
    return status;
}

int main(int argc, char **argv)
{
    static const int cells[] = {64, 128, 256, 512};
    static subject s;
    err e = {0};
    int64_t triangles = argc > 1 ? atoll(argv[1]) : 100000;
    char path[1000];
    snprintf(path, sizeof path, "%s/bench_voxelise.obj", argc > 2 ? argv[2] : ".");
    if (triangles < 100)
        err_set(&e, NULL, 0, "%s triangles; expected 100 or more", argv[1]);
    bench_must(!e.status && !write_scan(path, triangles, &e) && !materials_default(&s.materials, &e), &e);
    for (int round = 0; round < ROUNDS; round++) {
        bench_probe(&s.all);
        int status = read_scan(path, &s, &e) || check_surfaces(&s, &e) ? -1 : 0;
        for (int threads = 1; !status && threads <= 2; threads++)
            for (size_t n = 0; !status && n < sizeof cells / sizeof *cells; n++)
                status = go(&s, cells[n], threads, &e);
        if (status)
            remove(path);
        bench_must(!status, &e);
    }
    remove(path);
    bench_print(&s.all);
    solids_free(&s.solid);
    volumes_free(&s.plan);
    model_free(&s.materials);
    obj_free(&s.surface);
    return 0;
}
