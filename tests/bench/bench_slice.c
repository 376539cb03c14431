/* `make bench-slice`: images of 512 x 512 pixels through a deformed mesh over a volume of 256^3, at the four sizes
 * of PST's Tables I and II, whose figures stand beside: both of us-slice's methods, on one thread and on all,
 * beside bare samples of the same image (the volume rigid) and a probe of the machine in the same run, rounds
 * interleaved; then what R costs, swept as the paper did; then whole frames (msds-run's solver by springs and by 20
 * conjugate gradients, then the image), as Table II counts them. `bench_slice [THREADS [ROUNDS [PLOT.dat]]]`:
 * PLOT.dat gets R and ms, for tests/bench/regions.plot.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c tests/bench/bench.c msds/run/msds_executors.c
// needs: slice/image/slice_cells.c slice/image/slice_mesh.c slice/image/slice_cutter.c slice/image/slice_paper.c
// needs: slice/image/slice_lanes.c slice/image/slice_lanes_loops.c
#include "../unit/msds_block.h"

#include "bench.h"

#include "base/mem.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/largest.h"
#include "slice/image/slice_cutter.h"

enum { SIZES = 4, SIDE = 512, VOXELS = 256, IMAGES = 20, SWEEP = 10, FRAMES = 12, WAYS = 2 };

typedef struct paper {
    int32_t nodes[3];
    double sampling, fps[2]; /* Table I, ms; Table II without visualisation: MSDS, FEM */
} paper;

static const paper papers[SIZES] = {{{20, 10, 10}, 14, {20, 15}},
                                    {{24, 12, 12}, 16, {16, 10}},
                                    {{28, 14, 14}, 20, {15, 6.8}},
                                    {{32, 16, 16}, 23, {12, 5}}};

static const double box[3] = {.16, .08, .08};

/* The shortest and all times of something. */
typedef struct times {
    double took[BENCH_ROUNDS * IMAGES];
    int count;
} times;

typedef struct subject {
    model m;
    slice_mesh mesh;
    msds_problem p;
    double *u;
    slice_cutter *spans[WAYS], *printed[WAYS]; /* by one thread, by all */
    times by_spans[WAYS], by_paper[WAYS], frame[2];
    int64_t cut;
    msds_state *state[2];
} subject;

typedef struct stage {
    volume v;
    slice_cells cells;
    slice_shown shown[SIDE];
    slice_plane plane;
    slice_cutter *rigid[WAYS];
    times bare[WAYS];
    pool *threads[WAYS];
    uint8_t *image;
    const slice_lanes *lanes;
} stage;

static void take(times *t, double took)
{
    if (t->count < BENCH_ROUNDS * IMAGES)
        t->took[t->count++] = took;
}

static void print_times(times *t, double reference, double ours_per_paper)
{
    bench_sort(t->took, t->count);
    printf("%d,%.4g,%.4g,%.4g,", t->count, 1e3 * t->took[0], 1e3 * t->took[t->count / 2],
           1e3 * t->took[t->count - 1 - t->count / 20]);
    if (reference > 0)
        printf("%.3g", t->took[0] / reference);
    printf(",");
    if (ours_per_paper > 0)
        printf("%g", ours_per_paper);
    printf("\n");
}

static slice_cutter *cutter(const stage *s, const slice_mesh *mesh, slice_method method, int regions, int way)
{
    err e = {0};
    const slice_setup setup = {&s->cells, mesh, {SIDE, SIDE}, s->shown, s->lanes, method, regions, s->threads[way]};
    slice_cutter *c = slice_cutter_make(&setup, &e);
    bench_must(c != NULL, &e);
    return c;
}

/* Noise; the slice lies along x and down, turned by a tenth. */
static void make_stage(stage *s, int threads)
{
    err e = {0};
    uint32_t seed = 1;
    const double tilt = .1, length = sqrt(1 + tilt * tilt), row = box[2] / SIDE / length;
    s->v = (volume){.type = VOLUME_U8, .size = {VOXELS, VOXELS, VOXELS}};
    bench_must(!volume_make(&s->v, &e), &e);
    for (int64_t i = 0; i < volume_count(&s->v); i++) {
        seed = seed * 1664525U + 1013904223U;
        ((uint8_t *)s->v.data)[i] = (uint8_t)(seed >> 24);
    }
    for (int a = 0; a < 3; a++) {
        s->v.axis[a][a] = 1e3 * box[a] / VOXELS;
        s->v.origin[a] = .5 * s->v.axis[a][a];
    }
    s->plane = (slice_plane){{.0001, .04 - tilt * .04, .0799}, {box[0] / SIDE, 0, 0}, {0, tilt * row, -row}};
    for (int r = 0; r < SIDE; r++)
        s->shown[r] = (slice_shown){.to = {SIDE, 0}};
    for (int way = 0; way < WAYS; way++)
        s->threads[way] = pool_create(way ? threads : 1, &e);
    s->image = mem_array(SIDE * SIDE, 1, "an image", &e);
    s->lanes = slice_lanes_choose(&e);
    bench_must(s->image && s->lanes && s->threads[0] && s->threads[1], &e);
    bench_must(!slice_cells_make(&s->cells, &s->v, slice_window_of(&s->v), s->threads[1], &e), &e);
    for (int way = 0; way < WAYS; way++)
        s->rigid[way] = cutter(s, NULL, SLICE_SPANS, SLICE_REGIONS, way);
}

/* A smooth press from above, 2 cm deep of 8. */
static void bend(subject *s)
{
    for (int64_t n = 0; n < s->mesh.nodes; n++) {
        const double *x = s->mesh.rest + 3 * n;
        const double r2 = (x[0] - .08) * (x[0] - .08) + (x[1] - .04) * (x[1] - .04), hat = exp(-r2 / 8e-4) * x[2] / .08;
        s->u[3 * n] = .3 * (x[0] - .08) * hat;
        s->u[3 * n + 2] = -.02 * hat;
    }
}

static void make_subject(subject *s, const stage *on, const paper *from)
{
    err e = {0};
    tets b = {{from->nodes[0], from->nodes[1], from->nodes[2]}, {box[0], box[1], box[2]}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    largest l;
    tets_make(&b, &s->m);
    bench_must(!slice_mesh_of(&s->mesh, &s->m, &on->cells, "bench", &e), &e);
    bench_must(!msds_problem_make(&s->p, &s->m, &o, &e) && !largest_of(&s->p, &l, &e), &e);
    s->p.mass_factor = fmax(1, largest_factor(l.bound, o.damping, .01));
    s->u = mem_array(3 * s->mesh.nodes, sizeof *s->u, "displacements", &e);
    bench_must(s->u != NULL, &e);
    bend(s);
    for (int way = 0; way < WAYS; way++) {
        s->spans[way] = cutter(on, &s->mesh, SLICE_SPANS, SLICE_REGIONS, way);
        s->printed[way] = cutter(on, &s->mesh, SLICE_PAPER, SLICE_REGIONS, way);
        s->state[way] = msds_cpu.create(&s->p, on->threads[1], &e);
        bench_must(s->state[way] != NULL, &e);
    }
}

static double one_image(const stage *s, slice_cutter *c, const double *u)
{
    err e = {0};
    const double start = bench_clock();
    bench_must(!slice_cutter_image(c, &s->plane, u, s->image, NULL, &e), &e);
    return bench_clock() - start;
}

/* Table II's frame: 20 iterations, then the image; all threads. */
static double one_frame(subject *s, const stage *on, bool fem, int number)
{
    err e = {0};
    msds_plan plan = tets_plan(fem ? MSDS_FEM : MSDS_SPRINGS);
    tets_press(&plan, .02, .08 + .0003 * number, .04, .08 - .0005 * number);
    const double start = bench_clock();
    bench_must(
        !msds_cpu.step(s->state[fem], &plan, 20, &e) && !msds_cpu.get(s->state[fem], MSDS_DISPLACEMENT, s->u, &e), &e);
    one_image(on, s->spans[1], s->u);
    return bench_clock() - start;
}

static void measure(subject *s, stage *on)
{
    const int32_t *list;
    for (int way = 0; way < WAYS; way++) {
        for (int i = 0; i < IMAGES; i++) {
            take(&on->bare[way], one_image(on, on->rigid[way], NULL));
            take(&s->by_spans[way], one_image(on, s->spans[way], s->u));
        }
        take(&s->by_paper[way], one_image(on, s->printed[way], s->u));
    }
    s->cut = slice_cutter_list(s->spans[0], &list);
    for (int fem = 0; fem < 2; fem++)
        for (int i = 0; i < FRAMES; i++)
            take(&s->frame[fem], one_frame(s, on, fem, i));
    bend(s);
}

/* R from 1 to 512 on the largest mesh; on one thread, as the paper. */
static void sweep(const stage *on, const subject *s, const char *path)
{
    FILE *plot = path ? fopen(path, "w") : NULL;
    printf("regions,spans_ms,paper_ms\n");
    for (int i = 0; i < SWEEP; i++) {
        const int regions = 1 << i;
        double best[2] = {1, 1};
        for (int method = 0; method < 2; method++) {
            slice_cutter *c = cutter(on, &s->mesh, method ? SLICE_PAPER : SLICE_SPANS, regions, 0);
            for (int k = 0; k < (method ? 3 : IMAGES); k++)
                best[method] = fmin(best[method], one_image(on, c, s->u));
            slice_cutter_free(c);
        }
        printf("%d,%.4g,%.4g\n", regions, 1e3 * best[0], 1e3 * best[1]);
        if (plot)
            fprintf(plot, "%d %.4g %.4g\n", regions, 1e3 * best[0], 1e3 * best[1]);
    }
    if (plot)
        fclose(plot);
}

static void print_subject(subject *s, stage *on, const paper *from, int threads)
{
    const char *const frames[2] = {"frame: msds and image", "frame: fem 20 cg and image"};
    for (int row = 0; row < 2 * WAYS + 2; row++) {
        const int way = row % 2;
        times *const of_rows[3] = {&s->by_spans[way], &s->by_paper[way], &s->frame[way]};
        const char *const names[3] = {"spans", "paper's steps", frames[way]};
        const int kind = row < 4 ? row / 2 : 2;
        times *t = of_rows[kind];
        printf("%dx%dx%d,%lld,%lld,%s,%d,", (int)from->nodes[0], (int)from->nodes[1], (int)from->nodes[2],
               (long long)s->mesh.tets, (long long)s->cut, names[kind], row < 4 && !way ? 1 : threads);
        print_times(t, row < 4 ? on->bare[way].took[0] : 0, row < 4 ? from->sampling : 1e3 / from->fps[way]);
    }
    printf("# Table II, %dx%dx%d: %.0f (%.0f) frames a second, the paper %g (%g)\n", (int)from->nodes[0],
           (int)from->nodes[1], (int)from->nodes[2], 1 / s->frame[0].took[s->frame[0].count / 2],
           1 / s->frame[1].took[s->frame[1].count / 2], from->fps[0], from->fps[1]);
}

int main(int argc, char **argv)
{
    static subject subjects[SIZES];
    static stage on;
    static bench probes;
    const int threads = argc > 1 ? atoi(argv[1]) : 2, rounds = argc > 2 ? atoi(argv[2]) : 5;
    if (threads < 1 || rounds < 1 || rounds > BENCH_ROUNDS) {
        fprintf(stderr, "usage: bench_slice [THREADS [ROUNDS [PLOT.dat]]]\n");
        return 2;
    }
    make_stage(&on, threads);
    for (int i = 0; i < SIZES; i++)
        make_subject(&subjects[i], &on, &papers[i]);
    for (int round = 0; round < rounds; round++) {
        bench_probe(&probes);
        for (int i = 0; i < SIZES; i++)
            measure(&subjects[i], &on);
    }
    printf("# %s; 512 x 512 pixels, 256^3 voxels; against_bare: best time over the best of bare samples\n",
           on.lanes->name);
    printf("mesh,tetrahedra,in_the_image,what,threads,images,best_ms,median_ms,p95_ms,against_bare,paper_ms\n");
    for (int way = 0; way < WAYS; way++) {
        printf("none,0,0,bare samples,%d,", way ? threads : 1);
        print_times(&on.bare[way], 0, 0);
    }
    for (int i = 0; i < SIZES; i++)
        print_subject(&subjects[i], &on, &papers[i], threads);
    sweep(&on, &subjects[SIZES - 1], argc > 3 ? argv[3] : NULL);
    bench_print(&probes);
    return 0;
}
