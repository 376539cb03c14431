/* What msds-run's solvers stand on: slices of the graph of springs, the loops over them in each instruction set, an
 * element's rotation, and the mixing of solves.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/problem.c msds/problem/springs.c msds/problem/sell.c msds/cpu/lanes.c
// needs: msds/cpu/lanes_loops.c msds/cpu/mixing.c
#include "msds_block.h"

#include "base/mem.h"
#include "msds/cpu/lanes.h"
#include "msds/cpu/mixing.h"
#include "msds/problem/sell.h"
#include "solve/vectors.h"

#include "tap.h"

static void make_problem(const tets *b, model *m, msds_problem *p)
{
    err e = {0};
    msds_options o = tets_options();
    tets_make(b, m);
    tets_must(!msds_problem_make(p, m, &o, &e), &e);
}

static void free_problem(model *m, msds_problem *p)
{
    msds_problem_free(p);
    model_free(m);
}

/* Every slot's neighbour is the spring's other end, and every spring is met from both. */
static void test_slices(void)
{
    model m = {0};
    msds_problem p = {0};
    sell s = {0};
    err e = {0};
    tets b = {{9, 6, 5}, {.1, .1, .1}, 3000, .45, 1000, 2, false};
    int64_t met = 0, wrong = 0, rows = 0;
    make_problem(&b, &m, &p);
    tets_must(!sell_make(&s, &p, &e), &e);
    for (int64_t slice = 0; slice < s.count; slice++)
        for (int64_t slot = s.start[slice]; slot < s.start[slice + 1]; slot++)
            for (int64_t lane = 0; lane < LANES; lane++) {
                int32_t i = s.spring[slot * LANES + lane], other = s.neighbour[slot * LANES + lane];
                if (i < 0)
                    continue;
                int32_t a = s.model_node[slice * LANES + lane], c = s.model_node[other];
                wrong += !((p.spring[i].node[0] == a && p.spring[i].node[1] == c) ||
                           (p.spring[i].node[1] == a && p.spring[i].node[0] == c));
                wrong += s.first[slot] != SELL_SCATTERED && s.first[slot] + lane != other;
                rows += s.first[slot] != SELL_SCATTERED;
                met++;
            }
    ok(met == 2 * p.springs && !wrong, "each spring is met from both its ends");
    ok(rows > met * 7 / 10, "mostly in rows: %lld of %lld", (long long)rows, (long long)met);
    sell_free(&s);
    free_problem(&m, &p);
}

/* A strained element's rotation, from none: the turn that its strain was turned by, however far. */
static void test_rotation(void)
{
    double worst = 0;
    for (int i = 0; i < 200; i++) {
        double angle = 2.8 * (i + .5) / 200, x = sin(1. + i), y = cos(2. * i), z = sin(3. * i);
        double half = sin(angle / 2) / sqrt(x * x + y * y + z * z);
        double q[4] = {half * x, half * y, half * z, cos(angle / 2)}, r[3][3], g[3][3], found[3][3];
        double strain[3][3] = {{1.4, .2, -.1}, {.2, .7, .15}, {-.1, .15, 1 - .3 * sin(i)}}, start[4] = {0, 0, 0, 1};
        simplex_matrix(q, r);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                g[a][b] = r[a][0] * strain[0][b] + r[a][1] * strain[1][b] + r[a][2] * strain[2][b] - (a == b);
        simplex_rotation(g, start, found);
        for (int a = 0; a < 9; a++)
            worst = fmax(worst, fabs(found[a / 3][a % 3] - r[a / 3][a % 3]));
    }
    ok(worst < 1e-9, "the turn of a strained element, up to 2.8: off by %.2g", worst);
}

/* Mixing brings a slow linear iteration to rest in as many steps as it has directions, and one that grows, too. */
static void test_mixing(void)
{
    err e = {0};
    mixing m = {0};
    double x[6] = {0}, step[6], left = 0;
    static const double rate[6] = {.9, .8, -.7, .95, 1.3, -2};
    tets_must(!mixing_make(&m, 6, 6, &e), &e);
    for (int k = 0; k < 8; k++) {
        left = 0;
        for (int i = 0; i < 6; i++) {
            step[i] = (rate[i] - 1) * (x[i] - i);
            left = fmax(left, fabs(x[i] - i));
        }
        mixing_next(&m, x, step);
    }
    ok(left < 1e-8, "mixing: at rest after 7 steps, to %.2g", left);
    mixing_free(&m);
}

enum { LANE_FIELDS = 6, DENSE = 29, DENSE_ROWS = 43, DENSE_STRIDE = 45 };

/* What the loops of one build make of numbers with no pattern, all that they write together. */
static double *run_lanes(const lanes *loops, const sell *s, int64_t *count)
{
    err e = {0};
    lanes_field f[LANE_FIELDS] = {{{NULL}, NULL}};
    const int64_t slots = s->slots * 9 * LANES, dense = DENSE_STRIDE * DENSE, all = 3 * s->nodes * LANE_FIELDS;
    float *number = mem_array(slots, sizeof *number, "test", &e);
    double *result = mem_array(all + 3 + 3 * dense, sizeof *result, "test", &e), *to = result;
    tets_must(number && result, &e);
    for (int i = 0; i < LANE_FIELDS; i++) {
        tets_must(!lanes_field_make(&f[i], s->nodes, &e), &e);
        for (int64_t k = 0; k < 3 * s->nodes; k++)
            f[i].x[k % 3][k / 3] = (float)(sin(1.3 * (double)k + i) * (i ? .001 : 1));
    }
    for (int64_t k = 0; k < slots; k++)
        number[k] = 1 + (float)cos(.7 * (double)k);
    lanes_springs w = {s,    number, number + 8, number + 16, f[0], f[1], f[2], f[3], f[4], number,
                       f[5], .01F,   false,      {0},         0,    NULL, 0,    NULL, NULL};
    lanes_matrix a = {s, number, number};
    loops->step(&w, 0, s->count);
    *to++ = loops->multiply(&a, &f[1], &f[5], 0, s->count);
    *to++ = loops->advance(&f[1], &f[2], &f[3], &f[4], .37F, 0, s->count);
    loops->turn(&f[0], &f[2], .61F, 0, s->count);
    for (int i = 0; i < LANE_FIELDS; i++)
        for (int64_t k = 0; k < 3 * s->nodes; k++)
            *to++ = (double)f[i].x[k % 3][k / 3];
    double *c = to, *l = c + dense, *x = l + dense;
    for (int64_t k = 0; k < 3 * dense; k++)
        c[k] = sin(.9 * (double)k);
    for (int columns = 1; columns <= 4; columns++)
        loops->update(c + columns, DENSE_STRIDE, l, x, DENSE_ROWS - columns, columns, DENSE);
    loops->forward(c, number, DENSE_STRIDE, DENSE_ROWS, DENSE, x);
    loops->backward(x, number, DENSE_STRIDE, DENSE_ROWS, DENSE, c);
    *count = (x - result) + dense;
    for (int i = 0; i < LANE_FIELDS; i++)
        lanes_field_free(&f[i]);
    free(number);
    return result;
}

/* Every build of the loops gives the same bytes. */
static void test_lanes(void)
{
    model m = {0};
    msds_problem p = {0};
    sell s = {0};
    err e = {0};
    tets b = {{9, 6, 5}, {.1, .1, .1}, 3000, .45, 1000, 2, false};
    int64_t count;
    make_problem(&b, &m, &p);
    tets_must(!sell_make(&s, &p, &e), &e);
    double *plain = run_lanes(&lanes_plain, &s, &count);
    for (int i = 0; i < VECTORS_plain; i++) {
        if (!vectors_can(i)) {
            skip(1, "not on this processor");
            continue;
        }
        double *other = run_lanes(lanes_all[i], &s, &count);
        ok(!memcmp(plain, other, (size_t)count * sizeof *plain), "%s: the bytes of plain", lanes_all[i]->name);
        free(other);
    }
    free(plain);
    sell_free(&s);
    free_problem(&m, &p);
}

int main(void)
{
    test_slices();
    test_rotation();
    test_mixing();
    test_lanes();
    return done_testing();
}
