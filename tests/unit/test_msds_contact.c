/* Contact of any size in exact frames: forces by products alone, against closed forms and Gauss and Seidel's sweeps;
 * the two kinds of compliance against each other; equilibrium and contact of few and of many nodes, from the elements
 * alone, whatever the solver says; and what many nodes take against few.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c
#include "msds_block.h"

#include "msds/cpu/exact.h"
#include "msds/cpu/msds_cpu.h"

#include <time.h>

#include "tap.h"

/* ---- the minimum over x >= 0 */

enum { MOST = 400 };

typedef struct matrix {
    int64_t count;
    double a[MOST][MOST], w[MOST];
    int products;
    double share; /* the last that was told */
    bool falls;   /* one told was below the one before */
} matrix;

static void multiply(void *context, const double *way, double *product)
{
    matrix *s = context;
    s->products++;
    for (int64_t i = 0; i < s->count; i++) {
        product[i] = 0;
        for (int64_t j = 0; j < s->count; j++)
            product[i] += s->a[i][j] * way[j];
    }
}

static void tell(void *context, double share)
{
    matrix *s = context;
    s->falls = s->falls || !(share >= 0 && share <= 1);
    s->share = share;
}

/* From x as it is. */
static void begin(mprgp *m, matrix *s)
{
    m->count = s->count;
    m->context = s;
    m->multiply = multiply;
    m->tell = tell;
    multiply(s, m->x, m->g);
    for (int64_t i = 0; i < s->count; i++) {
        m->g[i] -= s->w[i];
        m->inverse[i] = 1 / s->a[i][i];
    }
    s->products = 0;
}

static matrix *make_matrix(int64_t count, mprgp *m)
{
    err e = {0};
    matrix *s = mem_array(1, sizeof *s, "test", &e);
    tets_must(s && !mprgp_make(m, MOST, &e), &e);
    s->count = count;
    return s;
}

/* A string between two pegs of height h is pulled down by q on each of its points, onto a floor. It leaves the floor
 * where q j (j + 1) / 2 = h, j from there, and has that shape: of the differences, to the last digit. */
static void test_string(void)
{
    enum { POINTS = 300, FREE = 70 };
    mprgp m = {0};
    matrix *s = make_matrix(POINTS, &m);
    const double q = .01, h = q * FREE * (FREE + 1) / 2;
    for (int i = 0; i < POINTS; i++) {
        s->a[i][i] = 2;
        if (i)
            s->a[i][i - 1] = s->a[i - 1][i] = -1;
        s->w[i] = -q + (i == 0 || i == POINTS - 1 ? h : 0);
    }
    begin(&m, s);
    const int64_t took = mprgp_solve(&m, 1e-11, 5000);
    double worst = 0;
    for (int i = 0; i < POINTS; i++) {
        const int end = i < POINTS / 2 ? i + 1 : POINTS - i, j = end < FREE ? FREE - end : 0;
        worst = fmax(worst, fabs(m.x[i] - q * j * (j + 1) / 2));
    }
    ok(worst < 1e-7 * h, "a string on a floor lies where it should: off by %.2g of its height", worst / h);
    ok(took == s->products && took < 2 * POINTS, "after %lld products", (long long)took);
    ok(mprgp_off(&m) <= 1e-11 && !s->falls && s->share > .5, "off by %.2g; told of %.0f %% at last", mprgp_off(&m),
       100 * s->share);
    begin(&m, s);
    ok(mprgp_solve(&m, 1e-10, 5000) == 0, "from the minimum it takes none");
    free(s);
    mprgp_free(&m);
}

static double noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / (1 << 24) - .5;
}

/* A compliance as of points on a half space, 1 / r far away; what they should go by is noise. */
static void fill_compliance(matrix *s)
{
    uint32_t state = 7;
    for (int64_t i = 0; i < s->count; i++) {
        for (int64_t j = 0; j < s->count; j++)
            s->a[i][j] = i == j ? 2.5 : 1 / hypot((double)(i / 20 - j / 20), (double)(i % 20 - j % 20));
        s->w[i] = 3 * noise(&state) + 1;
    }
}

static void test_sweeps(void)
{
    mprgp m = {0};
    matrix *s = make_matrix(MOST, &m);
    double want[MOST] = {0}, worst = 0, most = 0;
    int held = 0;
    fill_compliance(s);
    for (int sweep = 0; sweep < 3000; sweep++)
        for (int64_t i = 0; i < MOST; i++) {
            double sum = s->w[i];
            for (int64_t j = 0; j < MOST; j++)
                sum -= s->a[i][j] * want[j];
            want[i] = fmax(0, want[i] + sum / s->a[i][i]);
        }
    begin(&m, s);
    const int64_t took = mprgp_solve(&m, 1e-9, 2000);
    for (int64_t i = 0; i < MOST; i++) {
        worst = fmax(worst, fabs(m.x[i] - want[i]));
        most = fmax(most, want[i]);
        held += want[i] == 0;
        if (want[i] == 0 && m.x[i] != 0)
            worst = INFINITY;
    }
    ok(held > 50 && held < 350, "%d of %d are held", held, MOST);
    ok(worst < 1e-7 * most, "sweeps lead to the same, to %.2g", worst / most);
    ok(took < 200, "after %lld products", (long long)took);
    for (int64_t i = 0; i < MOST; i++)
        s->w[i] *= 3;
    begin(&m, s);
    mprgp_scale(&m);
    ok(mprgp_off(&m) < 1e-8 && s->products == 1, "thrice as deep is thrice the forces, after a product: off by %.2g",
       mprgp_off(&m));
    memset(m.x, 0, sizeof want);
    begin(&m, s);
    mprgp_scale(&m);
    ok(s->products == 0 && m.x[0] == 0, "no forces stay none");
    ok(mprgp_solve(&m, 1e-9, 7) <= 8 && mprgp_off(&m) > 1e-9, "it ends where it must");
    for (int64_t i = 0; i < MOST; i++)
        s->w[i] = -1;
    begin(&m, s);
    mprgp_solve(&m, 1e-9, 2000);
    double sum = 0;
    for (int64_t i = 0; i < MOST; i++)
        sum += m.x[i];
    ok(sum == 0 && mprgp_off(&m) == 0, "where all are away, none is pushed");
    free(s);
    mprgp_free(&m);
}

/* What is not positive ends it. */
static void test_negative(void)
{
    mprgp m = {0};
    matrix *s = make_matrix(2, &m);
    s->a[0][0] = s->a[1][1] = -1;
    s->w[0] = s->w[1] = 1;
    begin(&m, s);
    m.inverse[0] = m.inverse[1] = 1;
    ok(mprgp_solve(&m, 1e-9, 2000) == 0 && s->products == 1, "a matrix that is not positive ends it");
    free(s);
    mprgp_free(&m);
}

/* ---- tissue */

typedef struct block {
    model m;
    msds_problem p;
    pool *threads;
    stiffness k;
    contact *list;
    contacts c;
    exact x;
    double *u;
    double depth; /* m: of the deepest */
} block;

/* A block whose lower end is held, of so many nodes a side; every node of the upper end within `radius` of its middle
 * is near a probe that is so deep there, and rises by the square of the distance over 2 `bend`. */
static void make_block(block *b, int32_t nodes, bool penalty, bool warp, double radius, double depth, double bend)
{
    err e = {0};
    tets box = {{nodes, nodes, 5}, {.1, .1, .02}, 3000, .45, 1000, 2, false};
    msds_options o = tets_options();
    o.penalty = penalty;
    o.gravity[0] = 1;
    *b = (block){.depth = depth};
    tets_make(&box, &b->m);
    tets_must(!msds_problem_make(&b->p, &b->m, &o, &e), &e);
    const lanes *loops = lanes_choose(&e);
    b->threads = pool_create(2, &e);
    b->list = mem_array(b->p.nodes, sizeof *b->list, "test", &e);
    b->u = mem_array(b->p.nodes, 3 * sizeof *b->u, "test", &e);
    tets_must(loops && b->threads && b->list && b->u, &e);
    b->c.list = b->list;
    for (int64_t n = 0; n < b->p.nodes; n++) {
        const double *at = b->p.position + 3 * n, x = at[0] - .047, y = at[1] - .052, r2 = x * x + y * y;
        const double size = sqrt(1 + r2 / (bend * bend));
        if (at[2] < .02 - 1e-9 || r2 > radius * radius)
            continue;
        contact *c = &b->list[b->c.count++];
        *c = (contact){.node = (int32_t)n, .way = {x / bend / size, y / bend / size, -1 / size}};
        c->depth = (depth - r2 / (2 * bend)) / size;
    }
    tets_must(!stiffness_make(&b->k, &b->p, warp, b->threads, &e) &&
                  !exact_make(&b->x, &b->p, &b->k, &b->c, loops, b->threads, &e),
              &e);
}

static void free_block(block *b)
{
    exact_free(&b->x);
    stiffness_free(&b->k);
    pool_destroy(b->threads);
    free(b->list);
    free(b->u);
    msds_problem_free(&b->p);
    model_free(&b->m);
}

/* What elements pull nodes with at u: from each element. The caller frees it. */
static double *pull_of(const block *b, bool warp)
{
    err e = {0};
    double *f = mem_array(b->p.nodes, 3 * sizeof *f, "test", &e);
    tets_must(f != NULL, &e);
    for (int64_t t = 0; t < b->p.elements; t++) {
        const int32_t *node = b->p.element_node + 4 * t;
        double at[4][3], g[3][3], r[3][3], q[4] = {0, 0, 0, 1}, own[4][3];
        for (int c = 0; c < 4; c++)
            memcpy(at[c], b->u + 3 * (int64_t)node[c], sizeof at[c]);
        simplex_derivative(&b->p.element[t], at, g);
        simplex_rotation(g, q, r);
        if (warp)
            simplex_warped(&b->p.element[t], g, r, own);
        else
            simplex_force(&b->p.element[t], g, own);
        for (int i = 0; i < 12; i++)
            f[3 * (int64_t)node[i / 3] + i % 3] += own[i / 3][i % 3];
    }
    return f;
}

/* What is wrong with a frame. */
typedef struct wrong {
    double aside;  /* N: the most that a free node is off balance, but for a push along its way, */
    double pull;   /* or that it is pulled by the probe */
    double inside; /* m: the most that one is in the probe, or than a penalty lets it be, */
    double apart;  /* or apart from it where that pushes */
    double force;  /* N: the largest push */
    int64_t pushed;
} wrong;

static wrong look(block *b, bool warp)
{
    wrong w = {0};
    double *f = pull_of(b, warp);
    for (int64_t i = 0; i < 3 * b->p.nodes; i++)
        f[i] -= b->p.weight[i / 3] * b->p.options.gravity[i % 3];
    for (int64_t i = 0; i < b->c.count; i++) {
        const contact *c = &b->list[i];
        double push = 0, left = c->depth;
        for (int a = 0; a < 3; a++) {
            push += c->way[a] * f[3 * (int64_t)c->node + a];
            left -= c->way[a] * b->u[3 * (int64_t)c->node + a];
        }
        for (int a = 0; a < 3; a++)
            f[3 * (int64_t)c->node + a] -= push * c->way[a];
        const bool pushes = c->force > 0;
        left -= b->p.options.penalty ? push / b->p.repulsion[c->node] : 0;
        w.pushed += pushes;
        w.pull = fmax(w.pull, pushes ? -push : fabs(push));
        w.aside = fmax(w.aside, fabs(push - c->force));
        w.inside = fmax(w.inside, left);
        w.apart = fmax(w.apart, pushes ? -left : 0);
        w.force = fmax(w.force, push);
    }
    for (int64_t i = 0; i < 3 * b->p.nodes; i++)
        w.aside = fmax(w.aside, b->p.fixed[i / 3] ? 0 : fabs(f[i]));
    free(f);
    return w;
}

/* One frame from rest, and one twice as deep, in which nodes come and go. */
static void test_frame(int32_t nodes, double radius, bool dense, bool penalty, bool warp)
{
    block b;
    err e = {0};
    int64_t before = 0;
    make_block(&b, nodes, penalty, warp, radius, .0006, .3);
    for (int deeper = 0; deeper < 2; deeper++) {
        for (int64_t i = 0; i < b.c.count && deeper; i++)
            b.list[i].depth += .0006 * -b.list[i].way[2];
        tets_must(!exact_solve(&b.x, b.u, true, 1e-6, .01, &e), &e);
        const wrong w = look(&b, warp);
        const double slack = 1e-8;
        ok(b.x.compliance.dense == dense && w.aside < 1e-5 * w.force && w.pull < 1e-5 * w.force && w.inside < slack &&
               w.apart < slack,
           "%lld contacts%s%s%s: off balance by %.2g, pulled by %.2g of the most; inside by %.2g, apart by %.2g m",
           (long long)b.c.count, dense ? "" : " by solves", penalty ? ", a penalty" : "", warp ? ", turning" : "",
           w.aside / w.force, w.pull / w.force, w.inside, w.apart);
        ok(w.pushed > before && w.pushed < b.c.count, "%lld of them pushed", (long long)w.pushed);
        before = w.pushed;
    }
    free_block(&b);
}

/* The largest difference of two arrays. */
static double apart(const double *a, const double *b, int64_t count)
{
    double most = 0;
    for (int64_t i = 0; i < count; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* A product of the dense compliance is that by solves, a penalty adds what its springs give way, and what forces move
 * pulls back as much. */
static void test_products(void)
{
    block b;
    err e = {0};
    uint32_t state = 3;
    make_block(&b, 15, false, false, .04, .0006, .3);
    const int64_t count = b.c.count;
    double *force = mem_array(5 * count, sizeof *force, "test", &e);
    tets_must(force && !compliance_begin(&b.x.compliance, &e), &e);
    double *by_dense = force + count, *by_solves = by_dense + count, *soft = by_solves + count, *none = soft + count;
    for (int64_t i = 0; i < count; i++)
        force[i] = noise(&state) + .2;
    ok(b.x.compliance.dense, "%lld contacts have a dense compliance", (long long)count);
    compliance_multiply(&b.x.compliance, force, by_dense);
    b.x.compliance.dense = false;
    compliance_multiply(&b.x.compliance, force, by_solves);
    const double most = apart(by_solves, none, count);
    ok(most > 0 && apart(by_dense, by_solves, count) < 2e-6 * most, "its products are those by solves, to %.2g",
       apart(by_dense, by_solves, count) / most);
    b.p.options.penalty = true;
    for (int kind = 0; kind < 2; kind++) {
        double *hard = kind ? by_dense : by_solves;
        b.x.compliance.dense = kind;
        compliance_multiply(&b.x.compliance, force, soft);
        for (int64_t i = 0; i < count; i++)
            soft[i] -= force[i] / b.p.repulsion[b.list[i].node];
        ok(apart(soft, hard, count) < 1e-12 * most && 1 / b.p.repulsion[b.list[0].node] > 1e-3 * most,
           "a penalty adds what its springs give way: to %.2g", apart(soft, hard, count) / most);
    }
    b.p.options.penalty = false;
    memset(b.u, 0, 3 * (size_t)b.p.nodes * sizeof *b.u);
    memset(b.x.left, 0, 3 * (size_t)b.p.nodes * sizeof *b.u);
    for (int kind = 0; kind < 2; kind++) {
        b.x.compliance.dense = kind == 0;
        compliance_lead(&b.x.compliance, b.x.left, by_dense);
        compliance_follow(&b.x.compliance, force, b.u);
        double *f = pull_of(&b, false), off = 0, size = 0;
        for (int64_t i = 0; i < b.c.count; i++)
            for (int a = 0; a < 3; a++) {
                size = fmax(size, fabs(f[3 * (int64_t)b.list[i].node + a]));
                f[3 * (int64_t)b.list[i].node + a] -= force[i] * b.list[i].way[a];
            }
        for (int64_t i = 0; i < 3 * b.p.nodes; i++)
            off = fmax(off, b.p.fixed[i / 3] ? 0 : fabs(f[i]));
        ok(off < 1e-5 * size, "forces move what pulls back as much, to %.2g", off / size);
        free(f);
    }
    free(force);
    free_block(&b);
}

/* ---- frames of a flat probe on a slab of 31 x 31 x 6 nodes */

static void slab_make(model *m, msds_problem *p)
{
    err e = {0};
    tets b = {{31, 31, 6}, {.12, .12, .02}, 1e4, .45, 1000, 2, false};
    msds_options o = tets_options();
    tets_make(&b, m);
    tets_must(!msds_problem_make(p, m, &o, &e), &e);
    p->mass_factor = 1;
}

/* Five frames, ever deeper, of a probe so wide. Returns the processor's time, s. */
static double press_slab(const msds_problem *p, int threads, double wide, double *u, msds_reading *reading)
{
    err e = {0};
    const clock_t start = clock();
    pool *workers = pool_create(threads, &e);
    msds_state *state = workers ? msds_cpu.create(p, workers, &e) : NULL;
    const probe shape = probe_linear(wide, wide, .001);
    tets_must(state != NULL, &e);
    for (int i = 1; i <= 5; i++) {
        const pose at = {{.06, .06, .02 - .0004 * i}, {1, 0, 0, 0}};
        msds_plan plan = tets_plan(MSDS_EXACT);
        plan.touched = true;
        plan.probe = probe_place(&shape, &at);
        tets_must(!msds_cpu.step(state, &plan, 20, &e), &e);
    }
    tets_must(!msds_cpu.get(state, MSDS_DISPLACEMENT, u, &e) && !msds_cpu.monitor(state, reading, &e), &e);
    msds_cpu.destroy(state);
    pool_destroy(workers);
    return (double)(clock() - start) / CLOCKS_PER_SEC;
}

static void test_slab(void)
{
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    msds_reading few, many, again;
    slab_make(&m, &p);
    double *u = mem_array(p.nodes, 3 * sizeof *u, "test", &e), *w = mem_array(p.nodes, 3 * sizeof *w, "test", &e);
    tets_must(u && w, &e);
    double short_ = INFINITY, long_ = INFINITY;
    for (int i = 0; i < 3; i++) { /* the least of three: the machine has other work */
        short_ = fmin(short_, press_slab(&p, 1, .044, u, &few));
        long_ = fmin(long_, press_slab(&p, 1, .14, u, &many));
    }
    ok(few.contacts == 121 && many.contacts == 961, "%lld and %lld nodes are pushed", (long long)few.contacts,
       (long long)many.contacts);
    ok(many.residual < 1e-6 && many.solves == 1, "residual %.2g after %d solve", many.residual, many.solves);
    ok(long_ < 3 * short_, "961 take %.2g times the time of 121: %.3g and %.3g s", long_ / short_, long_, short_);
    press_slab(&p, 3, .14, w, &again);
    ok(!memcmp(u, w, 3 * (size_t)p.nodes * sizeof *u), "the same bytes by 1 and 3 threads");
    free(u);
    free(w);
    msds_problem_free(&p);
    model_free(&m);
}

int main(void)
{
    test_string();
    test_sweeps();
    test_negative();
    test_products();
    for (int kind = 0; kind < 4; kind++) {
        test_frame(15, .04, true, kind & 1, kind & 2);
        test_frame(31, .07, false, kind & 1, kind & 2);
    }
    test_slab();
    return done_testing();
}
