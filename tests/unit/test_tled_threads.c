/* A problem, its tiles and its march are the same for any number of threads, to the last byte; so is what is wrong with
 * a model. Blocks of more than one chunk of nodes and of elements.
 */
// needs: tled/cuda/march.c tled/cuda/march_units.c tled/cuda/march_near.c tled/cuda/march_tips.c
// needs: tled/cuda/march_cells.c tled/tiles/tiles.c tled/tiles/bricks.c tled/tiles/tile_split.c tled/tiles/tile_parts.c
// needs: tled/tiles/lattice_sheet.c tled/tiles/places.c  tled/*/*.c
#include "base/checksum.h"
#include "tled/cuda/march.h"
#include "tled/problem/step.h"
#include "tled/problem/support.h"
#include "tled/tiles/tiles.h"

#include "tap.h"
#include "tled_block.h"

enum { SUMS = 6 };

static uint32_t sum_of(uint32_t sum, const void *bytes, int64_t count, size_t size)
{
    return bytes && count ? checksum_add(sum, bytes, (size_t)count * size) : sum;
}

static uint32_t sum_of_tiles(const tiles *t)
{
    uint32_t sum = sum_of(0, t->tile, t->count, sizeof *t->tile);
    sum = sum_of(sum, t->node, t->nodes, sizeof *t->node);
    sum = sum_of(sum, t->node_info, t->nodes, sizeof *t->node_info);
    sum = sum_of(sum, t->halo_node, t->halos, sizeof *t->halo_node);
    sum = sum_of(sum, t->halo_place, t->halos, sizeof *t->halo_place);
    sum = sum_of(sum, t->cell, t->cells, sizeof *t->cell);
    sum = sum_of(sum, t->cell_element, t->cells, sizeof *t->cell_element);
    sum = sum_of(sum, t->share, t->cells, sizeof *t->share);
    sum = sum_of(sum, t->mixed, t->cells, sizeof *t->mixed);
    return sum_of(sum, t->fibre, 3 * t->directions, sizeof *t->fibre);
}

static uint32_t sum_of_march(const march *m, int64_t nodes)
{
    const int64_t layers = m->units ? m->layers + MARCH_AHEAD : 0;
    uint32_t sum = sum_of(0, m->axis, 3, sizeof *m->axis);
    sum = sum_of(sum, m->order, m->units ? nodes : 0, sizeof *m->order);
    sum = sum_of(sum, m->word, layers * MARCH_WORDS, sizeof *m->word);
    sum = sum_of(sum, m->unit, m->units, sizeof *m->unit);
    sum = sum_of(sum, m->near, m->units * m->nears, sizeof *m->near);
    sum = sum_of(sum, m->detail, layers, sizeof *m->detail);
    sum = sum_of(sum, m->which, m->details * MARCH_THREADS, sizeof *m->which);
    return sum_of(sum, m->cell, m->cells, sizeof *m->cell);
}

/* threads: 0: none are made. */
static void sums_with(int threads, const model *m, const script *s, uint32_t sum[SUMS])
{
    static const int brick[3] = {8, 8, 4};
    err e = {0};
    tiles t = {0};
    march way = {0};
    support held;
    tled_problem p = {.threads = threads ? pool_create(threads, &e) : NULL};
    pool *own = p.threads;
    int32_t stiffest = -1;
    const int failed = tled_problem_make(&p, m, s, (hourglass_control){.kind = HOURGLASS_PHYSICAL}, &e) ||
                       support_of(&p, &held, &e) || tiles_make(&t, &p, brick, &e) || march_make(&way, &p, 64, &e);
    ok(!failed && way.units, "%d threads: a problem, %lld tiles, %lld units %s", threads, (long long)t.count,
       (long long)way.units, e.text);
    const double step = failed ? 0 : step_at_rest(&p, &stiffest);
    sum[0] = sum_of(0, p.corner, 8 * p.nodes, sizeof *p.corner);
    sum[1] = sum_of(0, p.mass, p.nodes, sizeof *p.mass);
    sum[2] = sum_of(sum_of(0, &step, 1, sizeof step), &stiffest, 1, sizeof stiffest);
    sum[3] = sum_of(0, &held.reach, 1, sizeof held.reach);
    sum[4] = sum_of_tiles(&t);
    sum[5] = sum_of_march(&way, p.nodes);
    tiles_free(&t);
    march_free(&way);
    tled_problem_free(&p);
    pool_destroy(own);
}

static void test_alike(const block *what, const char *name)
{
    static const char *const of[SUMS] = {"corners", "masses", "the step", "the reach", "tiles", "the march"};
    model m = {0};
    script s = {0};
    err e = {0};
    uint32_t alone[SUMS], many[SUMS];
    block_make(what, &m);
    ok(!script_add_contract(&s, &m, "m=.1", .1, &e), "%s %s", name, e.text);
    sums_with(0, &m, &s, alone);
    for (int threads = 1; threads <= 3; threads += 2) {
        sums_with(threads, &m, &s, many);
        for (int i = 0; i < SUMS; i++)
            ok(many[i] == alone[i], "%s, %d threads: the same bytes of %s", name, threads, of[i]);
    }
    script_free(&s);
    model_free(&m);
}

/* Of several elements and nodes that are wrong, the first is told. */
static void test_wrong(const block *what)
{
    char said[3][200] = {""};
    for (int i = 0; i < 3; i++) {
        model m = {0};
        script s = {0};
        err e = {0};
        block_make(what, &m);
        model_array *node = (model_array *)model_find(&m, "element.node");
        for (int64_t k = 10007; k < node->rows; k += 5003)
            node->i32[8 * k + 3] = node->i32[8 * k + 4];
        tled_problem p = {.threads = i ? pool_create(2 * i, &e) : NULL};
        pool *own = p.threads;
        ok(tled_problem_make(&p, &m, &s, (hourglass_control){.kind = HOURGLASS_PHYSICAL}, &e), "not a box: %s", e.text);
        snprintf(said[i], sizeof said[i], "%.199s", e.text);
        tled_problem_free(&p);
        pool_destroy(own);
        script_free(&s);
        model_free(&m);
    }
    ok(strstr(said[0], "element 10007 ") && !strcmp(said[1], said[0]) && !strcmp(said[2], said[0]),
       "the first is told, by any number of threads");
}

int main(void)
{
    block whole = {.cells = {38, 36, 33},
                   .side = {.001, .001, .001},
                   .young = 3000,
                   .poisson = .45,
                   .density = 1000,
                   .peak = 1e5,
                   .fixed_low = 1,
                   .fibre = {1, 0, 0}};
    block mixed = whole;
    mixed.mixed = true;
    mixed.fraction = -1;
    test_alike(&whole, "a block");
    test_alike(&mixed, "a block that is mixed");
    test_wrong(&whole);
    return done_testing();
}
