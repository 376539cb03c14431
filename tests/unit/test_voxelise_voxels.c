// needs: voxelise/surfaces/expansion.c voxelise/surfaces/grid.c voxelise/surfaces/crossing.c voxelise/inside.c
// needs: voxelise/voxels.c voxelise/climb.c voxelise/shares.c voxelise/build.c voxelise/pieces.c voxelise/cuts.c
// needs: voxelise/depths.c
/* Algorithm 1 as it is printed, voxel by voxel over boxes at random, against columns and runs; and the nodes of the
 * elements against a plain table of all corners.
 */
#include "tap.h"

#include "voxelise/build.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 9, CELLS = SIDE * SIDE * SIDE, BOXES = 7, CORNERS = (SIDE + 1) * (SIDE + 1) * (SIDE + 1) };

static uint64_t state = 88172645463325252u;

static int draw(int low, int high)
{
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return low + (int)(state % (uint64_t)(high - low + 1));
}

/* Boxes of whole cells, one a volume; level by level. */
typedef struct scene {
    int low[BOXES][3], high[BOXES][3];
    int32_t level[BOXES];
    double position[BOXES * 8 * 3];
    int32_t vertex[BOXES * 12 * 3], volume[BOXES * 12];
    grid g;
} scene;

static void make_box(scene *s, int b)
{
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++)
        for (int a = 0; a < 3; a++)
            s->position[3 * (8 * b + i) + a] = i >> a & 1 ? s->high[b][a] : s->low[b][a];
    for (int f = 0; f < 12; f++) {
        const int *q = quad[f / 2];
        int32_t *t = &s->vertex[3 * (12 * b + f)];
        t[0] = 8 * b + q[0], t[1] = 8 * b + q[1 + f % 2], t[2] = 8 * b + q[2 + f % 2];
        s->volume[12 * b + f] = b;
    }
}

static void make_scene(scene *s)
{
    *s = (scene){.g = {.spacing = {1, 1, 1}}};
    for (int b = 0; b < BOXES; b++) {
        s->level[b] = b == 0 ? 0 : s->level[b - 1] + (draw(0, 2) == 0);
        for (int a = 0; a < 3; a++) {
            s->low[b][a] = draw(-2, SIDE - 4);
            s->high[b][a] = s->low[b][a] + draw(1, SIDE - 1);
        }
        make_box(s, b);
    }
    for (int a = 0; a < 3; a++)
        s->g.low[a] = -1, s->g.high[a] = SIDE - 1;
}

static bool is_inside(const scene *s, int b, const int *cell)
{
    for (int a = 0; a < 3; a++)
        if (cell[a] < s->low[b][a] || cell[a] >= s->high[b][a])
            return false;
    return true;
}

/* Algorithm 1, line by line. */
static int printed(const scene *s, const int *cell)
{
    int volume = -1, first = 0;
    bool level_changed = true;
    while (first < BOXES && level_changed) {
        int level = s->level[first], past = first;
        while (past < BOXES && s->level[past] == level)
            past++;
        level_changed = false;
        for (int priority = first; priority < past && !level_changed; priority++)
            if (is_inside(s, priority, cell)) {
                volume = priority;
                level_changed = true;
            }
        first = past;
    }
    return volume;
}

static bool find_on(const scene *s, const grid *g, const shares_rule *rule, int threads, voxels *x)
{
    inside_triangles t = {s->position, BOXES * 8, s->vertex, s->volume, BOXES * 12};
    inside test;
    err e = {0};
    pool *p = pool_create(threads, &e);
    bool good = p && !inside_create(&test, g, &t, CLIMB_RAY, rule ? rule->samples : 1, p, &e);
    if (good) {
        good = !voxels_find(x, &test, s->level, BOXES, rule, NULL, NULL, p, NULL, &e);
        inside_free(&test);
    }
    pool_destroy(p);
    return good;
}

static bool find(const scene *s, int threads, voxels *x)
{
    return find_on(s, &s->g, NULL, threads, x);
}

static int cell_index(int i, int j, int k)
{
    return ((k + 1) * SIDE + j + 1) * SIDE + i + 1;
}

/* The volume of each cell, from runs; false where runs are out of order or overlap. */
static bool unroll(const voxels *x, int *volume)
{
    int last = -1;
    for (int i = 0; i < CELLS; i++)
        volume[i] = -1;
    for (int64_t r = 0; r < x->runs; r++)
        for (int i = x->run[r].from; i < x->run[r].to; i++) {
            int at = cell_index(i, x->run[r].j, x->run[r].k);
            if (at <= last)
                return false;
            volume[last = at] = x->run[r].volume;
        }
    return true;
}

static bool same_as_printed(const scene *s, const voxels *x)
{
    int volume[CELLS];
    int64_t kept[BOXES] = {0}, within[BOXES] = {0}, elements = 0;
    if (!unroll(x, volume))
        return false;
    for (int k = -1; k < SIDE - 1; k++)
        for (int j = -1; j < SIDE - 1; j++)
            for (int i = -1; i < SIDE - 1; i++) {
                int cell[3] = {i, j, k}, want = printed(s, cell);
                if (volume[cell_index(i, j, k)] != want)
                    return false;
                for (int b = 0; b < BOXES; b++)
                    within[b] += is_inside(s, b, cell);
                if (want >= 0)
                    kept[want]++, elements++;
            }
    for (int b = 0; b < BOXES; b++)
        if (x->count[b].kept != kept[b] || x->count[b].inside != within[b] || x->count[b].reached < kept[b])
            return false;
    return x->elements == elements;
}

static int corner_index(const int32_t *ijk)
{
    return ((ijk[2] + 1) * (SIDE + 1) + ijk[1] + 1) * (SIDE + 1) + ijk[0] + 1;
}

/* Every element has its 8 corners, every node is a corner of one, nodes and elements are in k, j, i order. */
static bool good_nodes(const model *m)
{
    const int32_t *node = model_find(m, "element.node")->i32, *place = model_find(m, "node.lattice")->i32;
    const int32_t *cell = model_find(m, "element.lattice")->i32;
    const double *position = model_find(m, "node.position")->f64;
    int64_t nodes = model_count(m, "node"), elements = model_count(m, "element");
    bool used[CORNERS] = {0};
    for (int64_t n = 0; n < 8 * elements; n++) {
        int32_t want[3];
        for (int a = 0; a < 3; a++)
            want[a] = cell[3 * (n / 8) + a] + lattice_vtk[n % 8][a];
        if (node[n] < 0 || node[n] >= nodes || memcmp(&place[3 * node[n]], want, sizeof want) != 0)
            return false;
        used[corner_index(want)] = true;
    }
    int64_t corners = 0;
    for (int i = 0; i < CORNERS; i++)
        corners += used[i];
    for (int64_t n = 0; n < nodes; n++)
        for (int a = 0; a < 3; a++)
            if (position[3 * n + a] != 10 + 0.5 * place[3 * n + a])
                return false;
    for (int64_t n = 1; n < nodes; n++)
        if (corner_index(&place[3 * n]) <= corner_index(&place[3 * (n - 1)]))
            return false;
    return corners == nodes;
}

static bool builds(const voxels *x)
{
    model m = {0};
    err e = {0};
    lattice l = {{10, 10, 10}, {0.5, 0.5, 0.5}};
    pool *threads = pool_create(2, &e);
    bool good = threads && model_axis_add(&m, "volume", BOXES, &e) == 0 &&
                build_elements(&m, x, &(slits){0}, &l, threads, &e) == 0 && good_nodes(&m);
    model_free(&m);
    if (threads)
        pool_destroy(threads);
    return good;
}

static void test_scenes(void)
{
    int scenes = 400, wrong = 0, unlike = 0, bad_nodes = 0;
    for (int n = 0; n < scenes; n++) {
        scene s;
        voxels one = {0}, three = {0};
        make_scene(&s);
        if (!find(&s, 1, &one) || !find(&s, 3, &three)) {
            wrong++;
            continue;
        }
        wrong += !same_as_printed(&s, &one);
        unlike += one.runs != three.runs || memcmp(one.run, three.run, (size_t)one.runs * sizeof *one.run) != 0 ||
                  memcmp(one.count, three.count, BOXES * sizeof *one.count) != 0;
        bad_nodes += !builds(&one);
        voxels_free(&one);
        voxels_free(&three);
    }
    ok(wrong == 0, "%d of %d scenes differ from algorithm 1 as printed", wrong, scenes);
    ok(unlike == 0, "%d of %d scenes differ between one and three threads", unlike, scenes);
    ok(bad_nodes == 0, "%d of %d scenes have wrong nodes", bad_nodes, scenes);
}

/* Of a voxel: its samples of each volume, from runs of samples. */
static int64_t owner_of(const voxels *samples, int n, const int *cell, int64_t *total)
{
    int64_t count[BOXES] = {0}, best = 0;
    for (int64_t r = 0; r < samples->runs; r++) {
        const climb_run *a = &samples->run[r];
        int from = n * cell[0], to = from + n;
        if (a->j < n * cell[1] || a->j >= n * (cell[1] + 1) || a->k < n * cell[2] || a->k >= n * (cell[2] + 1))
            continue;
        from = a->from > from ? a->from : from;
        to = a->to < to ? a->to : to;
        count[a->volume] += to > from ? to - from : 0;
    }
    *total = 0;
    for (int v = 0; v < BOXES; v++) {
        *total += count[v];
        best = count[v] > count[best] ? v : best;
    }
    return *total ? best : -1;
}

/* The means of all products of places in a cell, over its samples. */
static void means_of(const voxels *samples, int n, const int *cell, int64_t total, double mean[CUT_MOMENTS])
{
    memset(mean, 0, CUT_MOMENTS * sizeof *mean);
    for (int64_t r = 0; r < samples->runs; r++) {
        const climb_run *a = &samples->run[r];
        for (int i = a->from; i < a->to; i++) {
            const int at[3] = {i - n * cell[0], a->j - n * cell[1], a->k - n * cell[2]};
            double x[3];
            if (at[0] < 0 || at[0] >= n || at[1] < 0 || at[1] >= n || at[2] < 0 || at[2] >= n)
                continue;
            for (int k = 0; k < 3; k++)
                x[k] = (2 * at[k] + 1) / (double)n - 1;
            const double all[CUT_MOMENTS] = {
                x[0], x[1], x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0], x[0] * x[1] * x[2]};
            for (int k = 0; k < CUT_MOMENTS; k++)
                mean[k] += all[k] / (double)total;
        }
    }
}

/* Returns whether an element has the next row of moments if it is enclosed in part, and has none if it is not. */
static bool has_moments(const voxels *x, int64_t element, int64_t *next, bool in_part, const double mean[CUT_MOMENTS])
{
    const bool has = *next < x->cut.count && x->cut.voxel[*next].element == element;
    bool good = has == in_part;
    for (int k = 0; good && has && k < CUT_MOMENTS; k++)
        good = fabs((double)x->cut.voxel[*next].of[k] - mean[k]) < 1e-6;
    *next += has;
    return good;
}

/* Voxels of 2 cells by shares, against the samples one by one. */
static bool same_as_samples(const scene *s, const shares_rule *rule)
{
    scene coarse = *s;
    grid fine;
    err e = {0};
    voxels got = {0}, samples = {0}, again = {0};
    int volume[CELLS];
    for (int a = 0; a < 3; a++) {
        coarse.g.spacing[a] = 2;
        coarse.g.origin[a] = 0.3 * (a - 1);
    }
    bool good = !grid_divide(&fine, &coarse.g, rule->samples, &e) && find_on(&coarse, &fine, rule, 1, &got) &&
                find_on(&coarse, &fine, rule, 3, &again) && find_on(&coarse, &fine, NULL, 1, &samples) &&
                unroll(&got, volume);
    good = good && got.elements == again.elements && got.runs == again.runs &&
           memcmp(got.fraction, again.fraction, (size_t)got.elements * sizeof *got.fraction) == 0;
    int64_t at = 0, next = 0, all = (int64_t)rule->samples * rule->samples * rule->samples;
    for (int c = 0; good && c < CELLS; c++) {
        int cell[3] = {c % SIDE - 1, c / SIDE % SIDE - 1, c / SIDE / SIDE - 1};
        int64_t total, owner = owner_of(&samples, rule->samples, cell, &total);
        bool is_element = total > 0 && (double)total >= rule->least * (double)all;
        good = volume[c] == (is_element ? owner : -1);
        double mean[CUT_MOMENTS];
        if (!good || !is_element)
            continue;
        means_of(&samples, rule->samples, cell, total, mean);
        good = has_moments(&got, at, &next, rule->moments && total < all, mean) &&
               got.fraction[at] == (float)((double)total / (double)all);
        at++;
    }
    voxels_free(&got);
    voxels_free(&samples);
    voxels_free(&again);
    return good;
}

static void test_shares(void)
{
    static const shares_rule rule[] = {{1, 0, true, true, NULL, 0, 0},    {2, 0, true, true, NULL, 0, 0},
                                       {3, 0.4, true, false, NULL, 0, 0}, {4, 0.5, true, true, NULL, 0, 0},
                                       {5, 1, true, true, NULL, 0, 0},    {7, 0.1, false, true, NULL, 0, 0}};
    int scenes = 60, wrong = 0;
    for (int n = 0; n < scenes; n++) {
        scene s;
        make_scene(&s);
        wrong += !same_as_samples(&s, &rule[n % 6]);
    }
    ok(wrong == 0, "%d of %d scenes by shares differ from their samples", wrong, scenes);
}

static void test_memory(void)
{
    grid g = {.high = {1000, 1000, 1000}};
    err e = {0};
    ok(voxels_check_memory(&g, 1e8, 1e6, 20e9, &e) == 0, "1e8 elements fit 20 GB");
    ok(voxels_check_memory(&g, 1e9, 1e6, 20e9, &e) == -1 && strstr(e.text, "1000 x 1000 x 1000 cells") &&
           strstr(e.text, "20 GB are free"),
       "1e9 do not: %s", e.text);
    e = (err){0};
    ok(voxels_check_memory(&g, 3e9, 1e6, 1e15, &e) == -1 && strstr(e.text, "2147483647"), "too many to number: %s",
       e.text);
}

int main(void)
{
    test_scenes();
    test_shares();
    test_memory();
    return done_testing();
}
