/* The method tissue (msds/cpu/tissue.h): a patch test at large strains, at any Poisson's ratio; the linear elements'
 * answer at small strains; tissue that is scrambled or flat, which finds rest again; pressures without a checkerboard;
 * materials that do not share theirs; a contact that goes a long way at once; and the same bytes.
 */
// needs: msds/mesh/mesh_tets.c msds/problem/*.c msds/cpu/*.c
#include "msds/problem/stable_double.h"

#include "msds/cpu/msds_cpu.h"
#include "msds/cpu/tissue.h"
#include "msds/problem/largest.h"
#include "msds_block.h"

#include "tap.h"

typedef struct run {
    model m;
    msds_problem p;
    pool *threads;
    msds_state *state;
    double *u; /* nodes x 3, m */
    msds_reading reading;
} run;

static void begin(run *r, const tets *b, const msds_options *o)
{
    err e = {0};
    *r = (run){.u = NULL};
    tets_make(b, &r->m);
    tets_must(!msds_problem_make(&r->p, &r->m, o, &e), &e);
    r->u = mem_array(r->p.nodes, 3 * sizeof *r->u, "test", &e);
    tets_must(r->u != NULL, &e);
}

/* From the problem's displacements; so many frames of 20 iterations. */
static void go(run *r, const msds_plan *plan, int threads, int frames)
{
    err e = {0};
    if (!r->state) {
        r->threads = pool_create(threads, &e);
        r->state = r->threads ? msds_cpu.create(&r->p, r->threads, &e) : NULL;
        tets_must(r->state != NULL, &e);
    }
    for (int i = 0; i < frames; i++)
        tets_must(!msds_cpu.step(r->state, plan, 20, &e), &e);
    tets_must(!msds_cpu.get(r->state, MSDS_DISPLACEMENT, r->u, &e) && !msds_cpu.monitor(r->state, &r->reading, &e), &e);
}

static void end(run *r)
{
    msds_cpu.destroy(r->state);
    pool_destroy(r->threads);
    msds_problem_free(&r->p);
    model_free(&r->m);
    free(r->u);
}

static double uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) / (double)(UINT64_C(1) << 53);
}

static int inverted(const run *r)
{
    int count = 0;
    for (int64_t t = 0; t < r->p.elements; t++) {
        const int32_t *n = r->p.element_node + 4 * t;
        double x[4][3];
        simplex s;
        for (int c = 0; c < 4; c++)
            for (int a = 0; a < 3; a++)
                x[c][a] = r->p.position[3 * (int64_t)n[c] + a] + r->u[3 * (int64_t)n[c] + a];
        simplex_shape(x[0], x[1], x[2], x[3], &s);
        count += !(s.volume > 0);
    }
    return count;
}

/* A block whose surface is held as all of it would stand under one gradient: what is inside goes there too. */
static void test_patch(double poisson)
{
    static const double g[9] = {.25, .1, -.05, .2, -.15, .1, .05, -.1, .1};
    const tets b = {{7, 6, 5}, {.06, .05, .04}, 3000, poisson, 1000, -1, true};
    const msds_options o = tets_options();
    const msds_plan plan = tets_plan(MSDS_TISSUE);
    double off = 0, most = 0;
    uint64_t seed = 3;
    run r;
    begin(&r, &b, &o);
    for (int64_t i = 0; i < 3 * r.p.nodes; i++) {
        const double *x = r.p.position + i / 3 * 3, *row = g + 3 * (i % 3);
        r.p.displacement[i] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
        if (!r.p.fixed[i / 3])
            r.p.displacement[i] += .004 * (2 * uniform(&seed) - 1);
    }
    go(&r, &plan, 2, 40);
    for (int64_t i = 0; i < 3 * r.p.nodes; i++) {
        const double *x = r.p.position + i / 3 * 3, *row = g + 3 * (i % 3);
        const double want = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
        off = fmax(off, fabs(r.u[i] - want));
        most = fmax(most, fabs(want));
    }
    ok(off < 2e-6 * most, "nu %g: a patch test at large strains: %.1e off", poisson, off / most);
    end(&r);
}

/* Pressed so little that strains are small, without points of pressure: as linear elements, solved exactly. */
static void test_small(void)
{
    const tets b = {{9, 9, 7}, {.08, .08, .06}, 3000, .28, 1000, 2, false};
    const msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_TISSUE), exact = tets_plan(MSDS_EXACT);
    run r, s;
    double off = 0, most = 0;
    begin(&r, &b, &o);
    begin(&s, &b, &o);
    tets_press(&plan, .02, .04, .04, .06 - 2e-5);
    exact.touched = true;
    exact.probe = plan.probe;
    go(&r, &plan, 2, 30);
    go(&s, &exact, 2, 2);
    for (int64_t i = 0; i < 3 * r.p.nodes; i++) {
        off = fmax(off, fabs(r.u[i] - s.u[i]));
        most = fmax(most, fabs(s.u[i]));
    }
    ok(off < 2e-3 * most && fabs(r.reading.force[2] - s.reading.force[2]) < 2e-3 * fabs(s.reading.force[2]),
       "at small strains, linear elements: %.1e off, %.6g N and %.6g N", off / most, r.reading.force[2],
       s.reading.force[2]);
    end(&r);
    end(&s);
}

/* What holds the tissue stays; all else begins anywhere in a box about where it is at rest, or in one plane. From boxes
 * as large as the block, it may come to a knot that is not inside out anywhere. */
static void test_rest(double poisson, double box, bool flat)
{
    const tets b = {{6, 6, 6}, {.05, .05, .05}, 3000, poisson, 1000, 2, false};
    const msds_options o = tets_options();
    const msds_plan plan = tets_plan(MSDS_TISSUE);
    uint64_t seed = 5;
    double most = 0;
    run r;
    begin(&r, &b, &o);
    for (int64_t i = 0; i < 3 * r.p.nodes; i++) {
        const double anywhere = box * (uniform(&seed) - .5), plane = i % 3 == 2 ? .001 - r.p.position[i] : 0;
        r.u[i] = r.p.displacement[i] = r.p.fixed[i / 3] ? 0 : flat ? plane : anywhere;
    }
    const int before = inverted(&r);
    go(&r, &plan, 2, 300);
    for (int64_t i = 0; i < 3 * r.p.nodes; i++)
        most = fmax(most, fabs(r.u[i]));
    ok(before > 100 && !inverted(&r), "nu %g, %s: of %d elements that were inside out none is", poisson,
       flat ? "flat" : "scrambled", before);
    if (box < .02)
        ok(most < 1e-5, "and it is at rest, to %.1e mm", 1e3 * most);
    end(&r);
}

/* The mean pressure of each cell of five elements, away from what is pressed: every other cell is a mirrored one. */
static void test_cells(const msds_problem *p, const sell *s, const tissue_mesh *m)
{
    enum { X = 12, Z = 8, CELLS = X * X * Z };
    static double sum[CELLS], volume[CELLS];
    double alternating = 0, all = 0;
    for (int64_t i = 0; i < m->groups * LANES; i++) {
        const int64_t g = i / LANES, l = i % LANES;
        double pressure = 0, middle[3] = {0};
        for (int c = 0; c < 4; c++) {
            const int64_t at = (4 * g + c) * LANES + l;
            pressure += (double)m->pressure[m->point[at]] / 4;
            for (int a = 0; a < 3; a++)
                middle[a] += p->position[3 * (int64_t)s->model_node[m->node[at]] + a] / 4;
        }
        if (!(m->volume[i] > 0))
            continue;
        pressure += (double)(m->kappa[i] * m->swollen[i] * 4 / m->volume[i]);
        const int cell = (int)(middle[0] / .005) + X * ((int)(middle[1] / .005) + X * (int)(middle[2] / .005));
        sum[cell] += pressure * (double)m->volume[i];
        volume[cell] += (double)m->volume[i];
    }
    for (int i = 0; i < CELLS; i++) {
        const int x = i % X, y = i / X % X, z = i / X / X;
        if (x < 2 || x > 9 || y < 2 || y > 9 || z < 1 || z > 5)
            continue;
        const double here = sum[i] / volume[i];
        alternating += (x + y + z) % 2 ? here : -here;
        all += fabs(here);
    }
    ok(all > 1e3 && fabs(alternating) < .01 * all, "no checkerboard of pressures: %.4f of them alternate",
       alternating / all);
}

/* Nearly incompressible, pressed beside the middle of its top, or symmetry would hide it. */
static void test_checkerboard(void)
{
    const tets b = {{13, 13, 9}, {.06, .06, .04}, 3000, .499, 1000, 2, false};
    const msds_options o = tets_options();
    err e = {0};
    run r;
    begin(&r, &b, &o);
    pool *threads = pool_create(2, &e);
    sell order = {.count = 0};
    contacts c = {.count = 0};
    lanes_field u = {.memory = NULL}, weight = {.memory = NULL};
    tissue t;
    const lanes *loops = lanes_choose(&e);
    tets_must(threads && loops && !sell_make(&order, &r.p, &e) && !contacts_make(&c, &order, r.p.nodes, &e) &&
                  !lanes_field_make(&u, order.nodes, &e) && !lanes_field_make(&weight, order.nodes, &e) &&
                  !tissue_make(&t, &r.p, &order, &c, loops, threads, &u, &weight, &e),
              &e);
    for (int64_t n = 0; n < r.p.nodes; n++) /* down at the middle of the top, and nowhere else */
        if (r.p.position[3 * n + 2] > .0399 && hypot(r.p.position[3 * n] - .021, r.p.position[3 * n + 1] - .034) < .011)
            c.list[c.count++] = (contact){.node = (int32_t)n, .way = {0, 0, -1}, .depth = .004};
    for (int i = 0; i < 60; i++) {
        tissue_begin(&t, 0);
        for (int64_t k = 0; k < 20;)
            k += tissue_step(&t, 20 - k);
        for (int64_t k = 0; k < c.count; k++)
            c.list[k].depth = 0;
    }
    test_cells(&r.p, &order, &t.m);
    ok(t.residual < 1e-3, "in balance, to %.1e", t.residual);
    tissue_free(&t);
    contacts_free(&c);
    lanes_field_free(&u);
    lanes_field_free(&weight);
    sell_free(&order);
    pool_destroy(threads);
    end(&r);
}

/* Elements of two volumes do not share points of pressure: there are two of each node between. */
static void test_points(void)
{
    const tets b = {{5, 5, 5}, {.04, .04, .04}, 3000, .49, 1000, 2, false};
    const msds_options o = tets_options();
    err e = {0};
    run r;
    begin(&r, &b, &o);
    int32_t *volume = model_find(&r.m, "element.volume")->i32;
    for (int64_t t = 0; t < r.p.elements; t++)
        volume[t] = r.p.position[3 * (int64_t)r.p.element_node[4 * t] + 2] +
                        r.p.position[3 * (int64_t)r.p.element_node[4 * t + 1] + 2] +
                        r.p.position[3 * (int64_t)r.p.element_node[4 * t + 2] + 2] +
                        r.p.position[3 * (int64_t)r.p.element_node[4 * t + 3] + 2] >
                    .08;
    sell order = {.count = 0};
    tissue_mesh m = {.groups = 0};
    tets_must(!sell_make(&order, &r.p, &e) && !tissue_mesh_make(&m, &r.p, &order, &e), &e);
    int64_t used = 0;
    for (int64_t i = 0; i < m.points; i++)
        used += m.bulk[i] > 0;
    ok(used == 125 + 25, "two volumes that meet in a layer of 25 nodes: %lld points of 125 nodes", (long long)used);
    double volume_of = 0, off = 0;
    for (int64_t i = 0; i < m.groups * LANES; i++)
        volume_of += (double)m.volume[i];
    near_(volume_of, .04 * .04 * .04, 1e-9, "all elements are in groups, once each");
    tissue_mesh_free(&m);
    for (r.p.elements = 1; r.p.elements < 20; r.p.elements++) {
        double want = 0, got = 0;
        tets_must(!tissue_mesh_make(&m, &r.p, &order, &e), &e);
        for (int64_t t = 0; t < r.p.elements; t++)
            want += r.p.element[t].volume;
        for (int64_t i = 0; i < m.groups * LANES; i++)
            got += (double)m.volume[i];
        off = fmax(off, fabs(got - want) / want);
        tissue_mesh_free(&m);
    }
    ok(off < 1e-6, "also of 1 to 19 elements: %.1e off", off);
    sell_free(&order);
    end(&r);
}

/* A probe that comes two cells deep at once. */
static void test_jump(void)
{
    const tets b = {{13, 13, 9}, {.06, .06, .04}, 3000, .45, 1000, 2, false};
    const msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_TISSUE), away = plan;
    run r, s;
    begin(&r, &b, &o);
    begin(&s, &b, &o);
    for (int i = 1; i <= 40; i++) {
        tets_press(&plan, .015, .03, .03, .04 - .012 * i / 40);
        go(&s, &plan, 2, 1);
    }
    go(&r, &plan, 2, 60);
    go(&s, &plan, 2, 60);
    ok(!inverted(&r) && r.reading.contacts > 5 && r.reading.residual < 1e-4,
       "12 mm at once, in cells of 5: %lld nodes pressed, %d inside out, residual %.1e", (long long)r.reading.contacts,
       inverted(&r), r.reading.residual);
    ok(fabs(r.reading.force[2] / s.reading.force[2] - 1) < .05, "%.4g N, and %.4g N in 40 poses", r.reading.force[2],
       s.reading.force[2]);
    go(&r, &away, 2, 60);
    ok(!inverted(&r) && r.reading.largest < 1e-6, "let go, it is back, to %.1e mm", 1e3 * r.reading.largest);
    end(&r);
    end(&s);
}

/* What is all but empty under the probe is pressed nearly flat, and gets stiff; nothing is thrown away. */
static void test_hollow(void)
{
    const tets b = {{13, 13, 9}, {.06, .06, .04}, 10000, .45, 1000, 2, false};
    const msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_TISSUE), away = plan;
    double most = 0, force = 0;
    run r;
    begin(&r, &b, &o);
    for (int64_t t = 0; t < r.p.elements; t++) {
        const int32_t *n = r.p.element_node + 4 * t;
        double middle[3] = {0};
        for (int c = 0; c < 4; c++)
            for (int a = 0; a < 3; a++)
                middle[a] += r.p.position[3 * (int64_t)n[c] + a] / 4;
        if (hypot(middle[0] - .03, middle[2] - .024) < .009)
            simplex_material(200, 0, &r.p.element[t]);
    }
    for (int i = 1; i <= 60; i++) {
        tets_press(&plan, .015, .03, .03, .04 - .018 * i / 60);
        go(&r, &plan, 2, 1);
        most = fmax(most, r.reading.largest);
    }
    go(&r, &plan, 2, 60);
    most = fmax(most, r.reading.largest);
    force = -r.reading.force[2];
    go(&r, &away, 2, 120);
    ok(most < .02 && fabs(force) < 20, "over a hollow: nodes go %.3g mm at most, %.3g N", 1e3 * most, force);
    ok(!inverted(&r) && r.reading.largest < 1e-5, "and come back, to %.1e mm", 1e3 * r.reading.largest);
    end(&r);
}

static void test_bytes(void)
{
    const tets b = {{9, 8, 7}, {.05, .05, .04}, 3000, .48, 1000, 2, false};
    const msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_TISSUE);
    run r, s;
    tets_press(&plan, .01, .02, .03, .035);
    begin(&r, &b, &o);
    begin(&s, &b, &o);
    go(&r, &plan, 1, 5);
    go(&s, &plan, 5, 5);
    ok(r.reading.largest > 1e-3 && !memcmp(r.u, s.u, 3 * (size_t)r.p.nodes * sizeof *r.u),
       "any number of threads, the same bytes");
    err e = {0};
    tets_must(!msds_cpu.reset(r.state, &e), &e);
    go(&r, &plan, 1, 5);
    ok(!memcmp(r.u, s.u, 3 * (size_t)r.p.nodes * sizeof *r.u), "and from rest again");
    end(&r);
    end(&s);
}

/* Every set of vectors that this processor has. */
static void test_vectors(void)
{
    const tets b = {{9, 8, 7}, {.05, .05, .04}, 3000, .48, 1000, 2, false};
    const msds_options o = tets_options();
    msds_plan plan = tets_plan(MSDS_TISSUE);
    double *first = NULL;
    int sets = 0, same = 0;
    err e = {0};
    tets_press(&plan, .01, .02, .03, .035);
    for (int i = 0; i < VECTORS_COUNT; i++) {
        run r;
        setenv("SINEW_VECTORS", lanes_all[i]->name, 1);
        err none = {0};
        if (!lanes_choose(&none))
            continue;
        begin(&r, &b, &o);
        go(&r, &plan, 2, 5);
        if (!first) {
            first = mem_array(r.p.nodes, 3 * sizeof *first, "test", &e);
            tets_must(first != NULL, &e);
            memcpy(first, r.u, 3 * (size_t)r.p.nodes * sizeof *first);
        }
        sets++;
        same += !memcmp(first, r.u, 3 * (size_t)r.p.nodes * sizeof *first);
        end(&r);
    }
    unsetenv("SINEW_VECTORS");
    free(first);
    ok(sets >= 1 && same == sets, "%d sets of vectors, the same bytes", sets);
}

int main(void)
{
    static const double poisson[] = {.3, .45, .499};
    for (int i = 0; i < 3; i++) {
        test_patch(poisson[i]);
        test_rest(poisson[i], .015, false);
        test_rest(poisson[i], .05, false);
        test_rest(poisson[i], 0, true);
    }
    test_small();
    test_checkerboard();
    test_points();
    test_jump();
    test_hollow();
    test_bytes();
    test_vectors();
    return done_testing();
}
