/* `make bench-slice` (work in progress) */
// needs: tests/bench/bench.c msds/mesh_tets.c slice/slice_cells.c slice/slice_mesh.c slice/slice_cutter.c slice/slice_paper.c slice/slice_lanes.c slice/slice_lanes_plain.c slice/slice_lanes_avx2.c slice/slice_lanes_avx512.c
#include "../unit/msds_block.h"

#include "bench.h"
#include "slice/slice_cutter.h"

int main(int argc, char **argv)
{
    err e = {0};
    int threads = argc > 1 ? atoi(argv[1]) : 1;
    int regions = argc > 2 ? atoi(argv[2]) : 32;
    double tilt = argc > 3 ? atof(argv[3]) : .1;
    int method = argc > 4 ? atoi(argv[4]) : 0;
    volume v = {.type = VOLUME_U8, .size = {256, 256, 256}};
    const double size[3] = {.16, .08, .08};
    bench_must(!volume_make(&v, &e), &e);
    uint8_t *b = v.data;
    uint32_t seed = 1;
    for (int64_t i = 0; i < volume_count(&v); i++) {
        seed = seed * 1664525u + 1013904223u;
        b[i] = (uint8_t)(seed >> 24);
    }
    for (int a = 0; a < 3; a++) {
        v.axis[a][a] = 1e3 * size[a] / 256;
        v.origin[a] = .5 * v.axis[a][a];
    }
    tets t = {{32, 16, 16}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
    model m = {0};
    tets_make(&t, &m);
    slice_cells cells;
    slice_mesh mesh;
    pool *p = pool_create(threads, &e);
    bench_must(!slice_cells_make(&cells, &v, slice_window_of(&v), p, &e), &e);
    bench_must(!slice_mesh_of(&mesh, &m, &cells, "bench", &e), &e);
    double *u = calloc((size_t)mesh.nodes * 3, sizeof *u);
    for (int64_t n = 0; n < mesh.nodes; n++) {
        const double *x = mesh.rest + 3 * n;
        double r2 = (x[0] - .08) * (x[0] - .08) + (x[1] - .04) * (x[1] - .04);
        u[3 * n + 2] = -.02 * x[2] / .08 * exp(-r2 / (2 * .02 * .02));
        u[3 * n] = .3 * (x[0] - .08) * exp(-r2 / (2 * .02 * .02)) * x[2] / .08;
    }
    slice_shown *shown = calloc(512, sizeof *shown);
    for (int i = 0; i < 512; i++)
        shown[i].to[0] = 512;
    const slice_lanes *l = slice_lanes_choose(&e);
    bench_must(l != NULL, &e);
    slice_setup s = {&cells, &mesh, {512, 512}, shown, l, method, regions, p};
    slice_cutter *c = slice_cutter_make(&s, &e);
    bench_must(c != NULL, &e);
    uint8_t *image = malloc(512 * 512);
    slice_plane at = {{.0001, .04 - tilt * .04, .0799}, {.16 / 512, 0, 0}, {0, 0, 0}};
    double len = sqrt(1 + tilt * tilt);
    at.row[1] = tilt / len * .08 / 512;
    at.row[2] = -1 / len * .08 / 512;
    double best = 1;
    for (int i = 0; i < (getenv("N") ? atoi(getenv("N")) : 300); i++) {
        double start = bench_clock();
        bench_must(!slice_cutter_image(c, &at, u, image, NULL, &e), &e);
        double took = bench_clock() - start;
        best = took < best ? took : best;
    }
    const int32_t *list;
    int64_t lit = 0;
    for (int i = 0; i < 512 * 512; i++)
        lit += image[i] > 0;
    printf("%s %d threads R %d: %.4f ms, %lld tets, %lld lit\n", l->name, threads, regions, 1e3 * best, (long long)slice_cutter_list(c, &list), (long long)lit);
    /* bare samples */
    s.mesh = NULL;
    slice_cutter *rigid = slice_cutter_make(&s, &e);
    best = 1;
    for (int i = 0; i < 300; i++) {
        double start = bench_clock();
        bench_must(!slice_cutter_image(rigid, &at, NULL, image, NULL, &e), &e);
        double took = bench_clock() - start;
        best = took < best ? took : best;
    }
    printf("rigid %.4f ms\n", 1e3 * best);
    FILE *f = fopen("/tmp/h9.pgm", "wb");
    bench_must(!slice_cutter_image(c, &at, u, image, NULL, &e), &e);
    fprintf(f, "P5\n512 512\n255\n");
    fwrite(image, 1, 512 * 512, f);
    fclose(f);
    return 0;
}
