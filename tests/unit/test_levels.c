/* The coarser lattices of a mesh: how many nodes they have, that what is linear on one is the same on the next, that
 * each matrix has the energy of the one before (Galerkin), that the coarsest is inverted; on a lattice, on one that
 * lies askew, on a mesh without any order, with nodes held fast inside; the same bytes for any number of threads; and
 * that cycles through them converge on a graded mesh as on a lattice.
 */
// needs: msds/mesh/mesh_keys.c msds/mesh/mesh_cells.c msds/mesh/mesh_graded.c msds/mesh/mesh_refine.c
// needs: msds/mesh/mesh_mask.c msds/mesh/mesh_runs.c msds/mesh/mesh_chosen.c
// needs: msds/mesh/mesh_tets.c msds/problem/problem.c msds/problem/springs.c msds/problem/sell.c msds/cpu/lanes.c
// needs: msds/cpu/lanes_loops.c msds/cpu/contacts.c msds/cpu/grips.c
// needs: msds/problem/stiffness.c msds/cpu/cg.c msds/cuda/levels.c msds/cuda/parts.c
#include "msds_block.h"

#include "base/mem.h"
#include "msds/cpu/cg.h"
#include "msds/cuda/levels.h"
#include "msds/cuda/parts.h"
#include "msds/mesh/mesh_graded.h"
#include "msds/mesh/mesh_refine.h"

#include "tap.h"

typedef struct subject {
    model m;
    msds_problem p;
    sell s;
    stiffness k;
    lanes_matrix matrix;
    levels l;
    pool *threads;
} subject;

static double any(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 8388608. - 1;
}

static void turn(model *m) /* about z, then x */
{
    double *x = model_find(m, "node.position")->f64;
    for (int64_t n = 0; n < model_count(m, "node"); n++) {
        double a = .8 * x[3 * n] - .6 * x[3 * n + 1], b = .6 * x[3 * n] + .8 * x[3 * n + 1], c = x[3 * n + 2];
        x[3 * n] = a;
        x[3 * n + 1] = .28 * b - .96 * c;
        x[3 * n + 2] = .96 * b + .28 * c;
    }
}

static void shake(model *m, double by)
{
    double *x = model_find(m, "node.position")->f64;
    uint32_t seed = 1;
    for (int64_t i = 0; i < 3 * model_count(m, "node"); i++)
        x[i] += by * any(&seed);
}

/* Of the model that is there. */
static void make_levels(subject *s, int threads)
{
    err e = {0};
    msds_options o = tets_options();
    s->threads = pool_create(threads, &e);
    tets_must(s->threads && !msds_problem_make(&s->p, &s->m, &o, &e) && !sell_make(&s->s, &s->p, &e) &&
                  !stiffness_make(&s->k, &s->p, false, s->threads, &e),
              &e);
    s->matrix.s = &s->s;
    s->matrix.diagonal = mem_array(s->s.count, 9 * LANES * sizeof(float), "test", &e);
    s->matrix.block = mem_array(s->s.slots, 9 * LANES * sizeof(float), "test", &e);
    tets_must(s->matrix.diagonal && s->matrix.block, &e);
    cg_fill(&s->matrix, &s->p, &s->k, s->threads);
    tets_must(!levels_make(&s->l, &s->p, &s->s, &s->matrix, s->threads, &e), &e);
}

static void make(subject *s, const tets *b, void (*change)(model *), double shaken, bool hold, int threads)
{
    tets_make(b, &s->m);
    shake(&s->m, shaken);
    if (change)
        change(&s->m);
    for (int64_t n = 100; hold && n < model_count(&s->m, "node"); n += 37)
        model_find(&s->m, "node.rigid")->u8[n] = 1;
    make_levels(s, threads);
}

/* 80 x 80 x 40 mm in cells of 10 mm, halved up to three times at the middle of the top; the bottom is held. */
static void make_graded(subject *s, int halved)
{
    static const double middle[3] = {.04, .04, .04};
    const mesh_box b = {{9, 9, 5}, {0}, {{.08, 0, 0}, {0, .08, 0}, {0, 0, .04}}};
    const mesh_refine r = {.box = &b, .top = 5, .levels = halved, .within = {.02, .01, .005}, .around = middle};
    mesh_cells c = {0};
    mesh_graded g = {0};
    err e = {0};
    tets_must(!mesh_cells_make(&c, b.nodes, halved, mesh_refine_wish(&r), &e) && !mesh_graded_make(&g, &b, &c, &e) &&
                  !mesh_graded_add(&g, &s->m, &e),
              &e);
    tets_tables(&(tets){.young = 3000, .poisson = .45, .density = 1000}, &s->m);
    uint8_t *rigid = tets_array(&s->m, "node.rigid")->u8;
    for (int64_t n = 0; n < g.nodes; n++)
        rigid[n] = g.at[3 * n + 2] == 0;
    mesh_graded_free(&g);
    mesh_cells_free(&c);
    make_levels(s, 2);
}

static void drop(subject *s)
{
    levels_free(&s->l);
    free(s->matrix.diagonal);
    free(s->matrix.block);
    stiffness_free(&s->k);
    sell_free(&s->s);
    pool_destroy(s->threads);
    msds_problem_free(&s->p);
    model_free(&s->m);
}

/* y = A v on a level, to which it is added. */
static void apply(const level *l, const double *v, double *y)
{
    const sell *g = &l->graph;
    for (int64_t n = 0; n < g->nodes; n++)
        for (int64_t slot = g->start[n / LANES] - 1; slot < g->start[n / LANES + 1]; slot++) {
            const bool own = slot < g->start[n / LANES];
            const int64_t other = own ? n : g->neighbour[slot * LANES + n % LANES];
            const float *k = own ? l->matrix.diagonal + n / LANES * 9 * LANES : l->matrix.block + slot * 9 * LANES;
            for (int i = 0; i < 9; i++)
                y[3 * n + i / 3] += (double)k[i * LANES + n % LANES] * v[3 * other + i % 3];
        }
}

static double product(const double *a, const double *b, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

static double energy(const level *l, const double *v)
{
    err e = {0};
    double *y = mem_array(l->graph.nodes, 3 * sizeof *y, "test", &e);
    tets_must(y != NULL, &e);
    apply(l, v, y);
    double sum = product(v, y, 3 * l->graph.nodes);
    free(y);
    return sum;
}

static void times(const levels_weights *w, const double *from, double *to)
{
    for (int64_t row = 0; row < w->count * LANES; row++)
        for (int64_t slot = w->start[row / LANES]; slot < w->start[row / LANES + 1]; slot++)
            for (int a = 0; a < 3; a++)
                to[3 * row + a] += (double)w->weight[slot * LANES + row % LANES] *
                                   from[3 * (int64_t)w->column[slot * LANES + row % LANES] + a];
}

static void test_pair(const level *fine, const level *coarse, const char *name, int number)
{
    err e = {0};
    uint32_t seed = 7;
    const int64_t nodes = fine->graph.nodes, next = coarse->graph.nodes;
    double *v = mem_array(next, 3 * sizeof *v, "test", &e), *up = mem_array(nodes, 3 * sizeof *up, "test", &e);
    double *w = mem_array(nodes, 3 * sizeof *w, "test", &e), *down = mem_array(next, 3 * sizeof *down, "test", &e);
    tets_must(v && up && w && down, &e);
    double worst = 0;
    times(&fine->up, coarse->place, up); /* places are linear */
    for (int64_t n = 0; n < nodes; n++)
        for (int a = 0; a < 3 && fine->moves[n]; a++)
            worst = fmax(worst, fabs(up[3 * n + a] - fine->place[3 * n + a] / 2));
    near_(worst, 0, 1e-4, "%s, level %d: what is linear stays", name, number);
    for (int64_t n = 0; n < next; n++)
        for (int a = 0; a < 3; a++)
            v[3 * n + a] = coarse->moves[n] ? any(&seed) : 0;
    for (int64_t i = 0; i < 3 * nodes; i++)
        w[i] = fine->moves[i / 3] ? any(&seed) : 0;
    memset(up, 0, 3 * (size_t)nodes * sizeof *up);
    times(&fine->up, v, up);
    times(&fine->down, w, down);
    near_(product(v, down, 3 * next), product(up, w, 3 * nodes), 1e-4 * sqrt(product(v, v, 3 * next)),
          "%s, level %d: down is up transposed", name, number);
    near_(energy(coarse, v) / energy(fine, up), 1, 1e-5, "%s, level %d: the same energy", name, number);
    ok(coarse->largest > 1.5 && coarse->largest < 10, "%s, level %d: largest eigenvalue %.3g", name, number + 1,
       coarse->largest);
    free(v);
    free(up);
    free(w);
    free(down);
}

static void test_coarsest(const levels *l, const char *name)
{
    err e = {0};
    const level *last = &l->at[l->count - 1];
    uint32_t seed = 3;
    double *b = mem_array(l->order, sizeof *b, "test", &e), *v = mem_array(l->order, sizeof *v, "test", &e);
    double *y = mem_array(l->order, sizeof *y, "test", &e), off = 0;
    tets_must(b && v && y, &e);
    for (int64_t i = 0; i < l->order; i++)
        b[i] = last->moves[i / 3] ? any(&seed) : 0;
    for (int64_t i = 0; i < l->order * l->order; i++)
        v[i / l->order] += (double)l->coarsest[i] * b[i % l->order];
    apply(last, v, y);
    for (int64_t i = 0; i < l->order; i++)
        off += last->moves[i / 3] ? (y[i] - b[i]) * (y[i] - b[i]) : 0;
    near_(sqrt(off / product(b, b, l->order)), 0, 1e-2, "%s: the coarsest, of %d nodes, is inverted", name,
          (int)last->graph.nodes);
    free(b);
    free(v);
    free(y);
}

static void test_mesh(const tets *b, void (*change)(model *), double shaken, bool hold, const char *name)
{
    subject s = {0};
    make(&s, b, change, shaken, hold, 2);
    ok(s.l.count >= 3 && s.l.at[s.l.count - 1].graph.nodes <= LEVELS_COARSEST, "%s: %d levels", name, s.l.count);
    for (int i = 0; i + 1 < s.l.count; i++)
        test_pair(&s.l.at[i], &s.l.at[i + 1], name, i);
    test_coarsest(&s.l, name);
    drop(&s);
}

static void test_counts(const tets *b, void (*change)(model *), const char *name)
{
    subject s = {0};
    make(&s, b, change, 0, false, 2);
    int64_t nodes = 0; /* of level 1, whose first plane is held by the rigid one above it */
    for (int64_t n = 0; n < s.l.at[1].graph.nodes; n++)
        nodes += s.l.at[1].moves[n];
    ok(nodes == 17 * 9 * 9, "%s: 32x16x16 nodes become 17x9x9: %d", name, (int)nodes);
    double slots = (double)s.l.at[1].graph.slots / (double)s.l.at[1].graph.count;
    ok(slots <= 26, "%s: and each has at most 26 around it", name);
    drop(&s);
}

static void test_threads(const tets *b)
{
    subject one = {0}, three = {0};
    bool same = true;
    make(&one, b, NULL, 0, true, 1);
    make(&three, b, NULL, 0, true, 3);
    for (int i = 1; i < one.l.count; i++)
        same = same && one.l.at[i].graph.slots == three.l.at[i].graph.slots &&
               !memcmp(one.l.at[i].matrix.block, three.l.at[i].matrix.block,
                       (size_t)one.l.at[i].graph.slots * 9 * LANES * sizeof(float)) &&
               one.l.at[i].largest == three.l.at[i].largest;
    ok(same && one.l.count == three.l.count, "one thread or three: the same bytes");
    drop(&one);
    drop(&three);
}

static void test_nothing_moves(void)
{
    static const tets b = {{3, 3, 3}, {.02, .02, .02}, 1e4, .3, 1000, 2, false};
    subject s = {0};
    err e = {0};
    make(&s, &b, NULL, 0, false, 1);
    levels_free(&s.l);
    memset(s.p.fixed, 1, (size_t)s.p.nodes);
    ok(levels_make(&s.l, &s.p, &s.s, &s.matrix, s.threads, &e) && strstr(e.text, "no node is free"), "refused: %s",
       e.text);
    drop(&s);
}

static void test_held(void)
{
    static const tets b = {{4, 3, 3}, {.03, .02, .02}, 1e4, .3, 1000, 2, false};
    subject s = {0};
    err e = {0};
    make(&s, &b, NULL, 0, false, 1);
    ok(!parts_held(&s.p, &e), "a block that hangs is held");
    for (int fixed = 12; fixed >= 0; fixed--) { /* of the twelve, fewer and fewer */
        int left = 0;
        e = (err){0};
        for (int64_t n = 0; n < s.p.nodes; n++)
            left += s.p.fixed[n] = s.p.fixed[n] && left < fixed;
        if (fixed == 3)
            ok(!parts_held(&s.p, &e), "by three nodes");
        if (fixed == 2)
            ok(parts_held(&s.p, &e) && strstr(e.text, "nothing holds node"), "not by two: %s", e.text);
        if (fixed == 0)
            ok(parts_held(&s.p, &e) && strstr(e.text, "nothing holds node 0's"), "nor by none: %s", e.text);
    }
    drop(&s);
}

static void test_two_parts(void)
{
    static const tets b = {{4, 3, 3}, {.03, .02, .02}, 1e4, .3, 1000, 0, false};
    subject s = {0};
    err e = {0};
    int64_t springs = 0;
    make(&s, &b, NULL, 0, false, 1);
    const double *x = s.p.position;
    for (int64_t i = 0; i < s.p.springs; i++) { /* cut between x = 1 cm and 2 cm */
        const int32_t *n = s.p.spring[i].node;
        if ((x[3 * (int64_t)n[0]] < .015) == (x[3 * (int64_t)n[1]] < .015))
            s.p.spring[springs++] = s.p.spring[i];
    }
    s.p.springs = springs;
    ok(parts_held(&s.p, &e) && strstr(e.text, "nothing holds node 2's"), "one of two parts is not: %s", e.text);
    drop(&s);
}

/* ---- cycles */

static double *numbers(int64_t count)
{
    err e = {0};
    double *to = mem_array(count, sizeof *to, "test", &e);
    tets_must(to != NULL, &e);
    return to;
}

/* Steps of damped Jacobi. */
static void smooth(const level *l, const double *b, double *x)
{
    const int64_t nodes = l->graph.nodes;
    double *y = numbers(3 * nodes);
    for (int step = 0; step < 2; step++) {
        memset(y, 0, 3 * (size_t)nodes * sizeof *y);
        apply(l, x, y);
        for (int64_t n = 0; n < nodes; n++)
            for (int i = 0; i < 9 && l->moves[n]; i++)
                x[3 * n + i / 3] += 1.5 / l->largest *
                                    (double)l->inverse[n / LANES * 9 * LANES + i * LANES + n % LANES] *
                                    (b[3 * n + i % 3] - y[3 * n + i % 3]);
    }
    free(y);
}

static void solve_coarsest(const levels *l, const double *b, double *x)
{
    for (int64_t i = 0; i < l->order; i++)
        for (int64_t j = 0; j < l->order; j++)
            x[i] += (double)l->coarsest[i * l->order + j] * b[j];
}

/* One V-cycle, without recursion: down from the first level to the last, and up again; x[0]: its result. */
static void cycle(const levels *l, double **b, double **x)
{
    const int last = l->count - 1;
    for (int i = 0; i <= last; i++) {
        const int64_t nodes = l->at[i].graph.nodes;
        memset(x[i], 0, 3 * (size_t)nodes * sizeof **x);
        if (i == last)
            break;
        double *y = numbers(3 * nodes);
        smooth(&l->at[i], b[i], x[i]);
        apply(&l->at[i], x[i], y);
        for (int64_t k = 0; k < 3 * nodes; k++)
            y[k] = l->at[i].moves[k / 3] ? b[i][k] - y[k] : 0;
        memset(b[i + 1], 0, 3 * (size_t)l->at[i + 1].graph.nodes * sizeof **b);
        times(&l->at[i].down, y, b[i + 1]);
        free(y);
    }
    solve_coarsest(l, b[last], x[last]);
    for (int i = last - 1; i >= 0; i--) {
        const int64_t nodes = l->at[i].graph.nodes;
        double *y = numbers(3 * nodes);
        times(&l->at[i].up, x[i + 1], y);
        for (int64_t k = 0; k < 3 * nodes; k++)
            x[i][k] += l->at[i].moves[k / 3] ? y[k] : 0;
        free(y);
        smooth(&l->at[i], b[i], x[i]);
    }
}

/* Conjugate gradients with a cycle each, until a random load is left to a millionth. */
static int count_cycles(const levels *l)
{
    const level *f = &l->at[0];
    const int64_t count = 3 * f->graph.nodes;
    double *b[LEVELS_MOST], *x[LEVELS_MOST], *p = numbers(count), *q = numbers(count), before = 0;
    uint32_t seed = 3;
    int cycles = 0;
    for (int i = 0; i < l->count; i++) {
        b[i] = numbers(3 * l->at[i].graph.nodes);
        x[i] = numbers(3 * l->at[i].graph.nodes);
    }
    for (int64_t i = 0; i < count; i++)
        b[0][i] = f->moves[i / 3] ? any(&seed) : 0;
    const double start = product(b[0], b[0], count);
    for (; cycles < 100 && product(b[0], b[0], count) > 1e-12 * start; cycles++) {
        cycle(l, b, x);
        const double next = product(b[0], x[0], count);
        for (int64_t i = 0; i < count; i++)
            p[i] = x[0][i] + (cycles ? next / before : 0) * p[i];
        before = next;
        memset(q, 0, (size_t)count * sizeof *q);
        apply(f, p, q);
        for (int64_t i = 0; i < count; i++)
            q[i] = f->moves[i / 3] ? q[i] : 0;
        const double step = next / product(p, q, count);
        for (int64_t i = 0; i < count; i++)
            b[0][i] -= step * q[i];
    }
    for (int i = 0; i < l->count; i++) {
        free(b[i]);
        free(x[i]);
    }
    free(p);
    free(q);
    return cycles;
}

/* A lattice of the coarse cells alone would take 43 cycles for cells that are halved thrice. */
static void test_graded(void)
{
    int cycles[4];
    for (int halved = 0; halved < 4; halved++) {
        subject s = {0};
        make_graded(&s, halved);
        cycles[halved] = count_cycles(&s.l);
        for (int i = 0; halved == 2 && i + 1 < s.l.count; i++)
            test_pair(&s.l.at[i], &s.l.at[i + 1], "graded", i);
        ok(s.l.count == 2 + halved && cycles[halved] <= 17, "cells halved %d times: %d levels, %d cycles", halved,
           s.l.count, cycles[halved]);
        drop(&s);
    }
}

int main(void)
{
    static const tets block = {{32, 16, 16}, {.16, .08, .08}, 1e4, .45, 1000, 2, false};
    static const tets odd = {{21, 14, 9}, {.1, .05, .06}, 1e4, .45, 1000, 2, false};
    test_counts(&block, NULL, "a lattice");
    test_counts(&block, turn, "askew");
    test_mesh(&odd, NULL, 0, false, "a lattice");
    test_mesh(&odd, turn, 0, false, "askew");
    test_mesh(&odd, NULL, .0007, false, "no lattice");
    test_mesh(&odd, NULL, 0, true, "nodes held inside");
    test_threads(&odd);
    test_nothing_moves();
    test_held();
    test_two_parts();
    test_graded();
    return done_testing();
}
