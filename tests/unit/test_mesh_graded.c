/* Cells that are halved here and there, and some left out: graded 2:1, and their tetrahedra conforming, filling the
 * box, of shapes whose angles are known; a linear displacement of the border is that of every node; which cells are
 * halved, and which nodes fixed.
 */
// needs: msds/mesh/mesh_tets.c msds/mesh/mesh_keys.c msds/mesh/mesh_cells.c msds/mesh/mesh_graded.c
// needs: msds/mesh/mesh_refine.c msds/mesh/mesh_mask.c msds/mesh/mesh_runs.c msds/mesh/mesh_around.c
// needs: msds/mesh/mesh_chosen.c msds/mesh/mesh_sides.c msds/mesh/mesh_fix.c msds/problem/*.c msds/cpu/*.c
#include "mesh_look.h"
#include "msds_block.h"

#include "mesh/boundary.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/mesh/mesh_fix.h"
#include "msds/mesh/mesh_graded.h"
#include "msds/mesh/mesh_refine.h"

#include "tap.h"

/* ---- meshes */

typedef struct hashed {
    unsigned seed, share; /* of cells, in 256 */
} hashed;

static bool halve_hashed(const void *context, const mesh_cells *c, const mesh_cell *of, int level)
{
    const hashed *h = context;
    unsigned x = h->seed + 7U * (unsigned)level;
    (void)c;
    for (int a = 0; a < 3; a++)
        x = (x ^ (unsigned)of->at[a]) * 2654435761U;
    return (x >> 16 & 255) < h->share;
}

/* Leaves out cells by a hash. */
static void leave_out(mesh_cells *c, const hashed *h)
{
    err e = {0};
    uint8_t *marked = mem_array(c->count, 1, "test", &e);
    tets_must(marked != NULL, &e);
    for (int64_t i = 0; i < c->count; i++)
        marked[i] = !halve_hashed(h, c, &c->cell[i], 99);
    mesh_cells_keep(c, marked);
    free(marked);
}

static const mesh_box cube = {{4, 5, 4}, {.1, -.2, .3}, {{.03, 0, 0}, {0, .04, 0}, {0, 0, .03}}};

/* A mesh of the cube's cells, of 10 mm. */
static void make(const hashed *h, int levels, unsigned gone, bool mirrored, mesh_cells *c, model *m)
{
    err e = {0};
    mesh_graded g = {0};
    mesh_box b = cube;
    b.edge[1][1] = mirrored ? -b.edge[1][1] : b.edge[1][1];
    tets_must(!mesh_cells_make(c, b.nodes, levels, (mesh_wish){halve_hashed, h}, &e), &e);
    if (gone)
        leave_out(c, &(hashed){h->seed, gone});
    tets_must(!mesh_graded_make(&g, &b, c, &e) && !mesh_graded_add(&g, m, &e), &e);
    mesh_graded_free(&g);
}

static bool touch(const mesh_cell *a, const mesh_cell *b)
{
    for (int i = 0; i < 3; i++)
        if (a->at[i] > b->at[i] + b->side || b->at[i] > a->at[i] + a->side)
            return false;
    return true;
}

static bool is_graded(const mesh_cells *c)
{
    for (int64_t i = 0; i < c->count; i++)
        for (int64_t j = 0; j < i; j++)
            if (touch(&c->cell[i], &c->cell[j]) &&
                (c->cell[i].side > 2 * c->cell[j].side || c->cell[j].side > 2 * c->cell[i].side))
                return false;
    return true;
}

static double room_of(const mesh_cells *c)
{
    double sum = 0;
    for (int64_t i = 0; i < c->count; i++)
        sum += pow(.01 * c->cell[i].side / MESH_UNITS(c->levels), 3);
    return sum;
}

/* ---- tetrahedra */

typedef struct face {
    int32_t node[3], of;
} face;

static int by_nodes(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(int32_t));
}

static face face_of(const int32_t *n, int without, int64_t of)
{
    face f = {.of = (int32_t)of};
    for (int i = 0, k = 0; i < 4; i++)
        if (i != without)
            f.node[k++] = n[i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 2; j++)
            if (f.node[j] > f.node[j + 1]) {
                const int32_t one = f.node[j];
                f.node[j] = f.node[j + 1];
                f.node[j + 1] = one;
            }
    return f;
}

/* Twice the area of a face, as a vector away from the tetrahedron's node `without`. */
static void area_of(const model *m, const int32_t *n, int without, double sum[3])
{
    static const int others[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const int *o = others[without];
    double u[3], v[3];
    less(place(m, n[o[1]]), place(m, n[o[0]]), u);
    less(place(m, n[o[2]]), place(m, n[o[0]]), v);
    for (int i = 0; i < 3; i++)
        sum[i] += fabs(u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]) / 2;
}

/* area: becomes the sums of |components| of the areas of faces of one tetrahedron, m2. */
static void look_at_faces(const model *m, look *l, double area[3])
{
    const model_array *node = model_find(m, "element.node");
    face *list = calloc((size_t)node->rows * 4 + 1, sizeof *list);
    for (int64_t t = 0; list && t < node->rows; t++)
        for (int f = 0; f < 4; f++)
            list[4 * t + f] = face_of(&node->i32[4 * t], f, t);
    qsort(list, (size_t)node->rows * 4, sizeof *list, by_nodes);
    for (int64_t i = 0, next; list && i < 4 * node->rows; i = next) {
        for (next = i + 1; next < 4 * node->rows && !by_nodes(&list[i], &list[next]); next++)
            ;
        l->outside += next - i == 1;
        l->shared += next - i == 2;
        l->torn += next - i > 2;
        const int32_t *n = &node->i32[4 * (int64_t)list[i].of];
        if (next - i == 2) {
            const double a = longest_edge(m, n), b = longest_edge(m, &node->i32[4 * (int64_t)list[i + 1].of]);
            l->ratio = fmax(l->ratio, fmax(a / b, b / a));
        }
        for (int f = 0; f < 4 && next - i == 1; f++) {
            const face same = face_of(n, f, 0);
            if (!by_nodes(&same, &list[i]))
                area_of(m, n, f, area);
        }
    }
    free(list);
}

/* The sums of sides of cells, on which another does not lie: the area that the mesh has outside if it is conforming. */
static double area_of_cells(const mesh_cells *c, int axis)
{
    double sum = 0;
    for (int64_t i = 0; i < c->count; i++) {
        const mesh_cell *a = &c->cell[i];
        double hidden = 0;
        for (int64_t j = 0; j < c->count; j++) {
            const mesh_cell *b = &c->cell[j];
            double both = b->at[axis] + b->side == a->at[axis] || a->at[axis] + a->side == b->at[axis];
            for (int k = 1; k < 3; k++) {
                const int o = (axis + k) % 3;
                const int32_t low = a->at[o] > b->at[o] ? a->at[o] : b->at[o];
                const int32_t p = a->at[o] + a->side, q = b->at[o] + b->side;
                both *= fmax((p < q ? p : q) - low, 0);
            }
            hidden += both;
        }
        sum += 2. * a->side * a->side - hidden;
    }
    return sum * pow(.01 / MESH_UNITS(c->levels), 2);
}

static void test_mesh(unsigned seed, int levels, unsigned share, unsigned gone, bool mirrored)
{
    const hashed h = {seed, share};
    mesh_cells c = {0};
    model m = {0};
    look l;
    double area[3] = {0}, want = 0;
    make(&h, levels, gone, mirrored, &c, &m);
    look_at_angles(&m, &l);
    look_at_faces(&m, &l, area);
    ok(is_graded(&c), "seed %u, %d levels%s: %lld cells, graded 2:1", seed, levels, gone ? ", some left out" : "",
       (long long)c.count);
    near_(l.room, room_of(&c), 1e-17, "%lld tetrahedra fill them", (long long)model_count(&m, "element"));
    ok(l.thin > 0 && !l.torn && 2 * l.shared + l.outside == 4 * model_count(&m, "element"),
       "none is inverted, and no face is of more than two");
    for (int a = 0; a < 3; a++)
        want = fmax(want, fabs(area[a] - area_of_cells(&c, a)));
    ok(want < 1e-13, "what is of one is outside: the areas of cells' free sides, to %.1g m2", want);
    ok(l.least > 45 - 1e-9 && l.most < 120 + 1e-9, "dihedral angles of %.2f to %.2f degrees", l.least, l.most);
    ok(l.ratio < 2 + 1e-9, "the longest edges of neighbours are %.3f to 1 at most", l.ratio);
    mesh_cells_free(&c);
    model_free(&m);
}

/* Nothing is halved, nothing left out: mesh_box_add's bytes. */
static void test_plain(void)
{
    const hashed h = {1, 0};
    mesh_cells c = {0};
    model m = {0}, box = {0};
    err e = {0};
    make(&h, 3, 0, false, &c, &m);
    tets_must(!mesh_box_add(&box, &cube, &e), &e);
    const model_array *a = model_find(&m, "element.node"), *b = model_find(&box, "element.node");
    ok(a->rows == b->rows && !memcmp(a->i32, b->i32, (size_t)a->rows * 16), "no cell halved: the lattice's tetrahedra");
    ok(model_count(&m, "node") == model_count(&box, "node") &&
           !memcmp(place(&m, 0), place(&box, 0), (size_t)model_count(&box, "node") * 24),
       "and its nodes");
    mesh_cells_free(&c);
    model_free(&m);
    model_free(&box);
}

/* ---- a patch test */

static void add_tables(model *m)
{
    tets_tables(&(tets){.young = 3000, .poisson = .45, .density = 1000}, m);
}

static void fix_border(model *m)
{
    boundary b = {0};
    err e = {0};
    uint8_t *rigid = tets_array(m, "node.rigid")->u8;
    tets_must(!boundary_of(&b, m, NULL, NULL, &e), &e);
    for (int64_t i = 0; i < 3 * b.faces; i++)
        rigid[b.node[i]] = 1;
    boundary_free(&b);
}

static double linear(const double *x, int axis)
{
    static const double slope[9] = {.01, .004, -.003, .002, -.008, .005, .001, .006, .012};
    return slope[3 * axis] * x[0] + slope[3 * axis + 1] * x[1] + slope[3 * axis + 2] * x[2];
}

/* Nodes inside begin at rest, and end on the field. */
static double solve_off(const msds_problem *p)
{
    err e = {0};
    msds_plan plan = tets_plan(MSDS_EXACT);
    pool *workers = pool_create(1, &e);
    msds_state *state = workers ? msds_cpu.create(p, workers, &e) : NULL;
    double *u = mem_array(p->nodes, 3 * sizeof *u, "test", &e), off = 0;
    tets_must(state && u, &e);
    for (int i = 0; i < 3; i++)
        tets_must(!msds_cpu.step(state, &plan, 20, &e), &e);
    tets_must(!msds_cpu.get(state, MSDS_DISPLACEMENT, u, &e), &e);
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        off = fmax(off, fabs(u[i] - linear(p->position + i / 3 * 3, (int)(i % 3))));
    msds_cpu.destroy(state);
    pool_destroy(workers);
    free(u);
    return off;
}

static void test_patch(unsigned gone)
{
    const hashed h = {5, 60};
    const msds_options o = tets_options();
    mesh_cells c = {0};
    model m = {0};
    msds_problem p = {0};
    err e = {0};
    int64_t inside = 0;
    make(&h, 2, gone, false, &c, &m);
    add_tables(&m);
    fix_border(&m);
    tets_must(!msds_problem_make(&p, &m, &o, &e), &e);
    for (int64_t i = 0; i < 3 * p.nodes; i++) {
        inside += !p.fixed[i / 3];
        p.displacement[i] = p.fixed[i / 3] ? linear(p.position + i / 3 * 3, (int)(i % 3)) : 0;
    }
    const double off = solve_off(&p);
    ok(off < 1e-9 * .3 && inside > 600, "patch test: %lld nodes inside are off by %.2g m", (long long)(inside / 3),
       off);
    msds_problem_free(&p);
    mesh_cells_free(&c);
    model_free(&m);
}

/* ---- where cells are halved */

/* Depths: of a box 30 x 40 x 30 mm of 10 mm cells, the top at the high end of z. */
static void test_depths(void)
{
    const mesh_refine r = {.box = &cube, .top = 5, .levels = 2, .within = {.012, .004}};
    mesh_cells c = {0};
    err e = {0};
    int64_t count[3] = {0};
    bool good = true;
    tets_must(!mesh_cells_make(&c, cube.nodes, r.levels, mesh_refine_wish(&r), &e), &e);
    for (int64_t i = 0; i < c.count; i++) {
        const mesh_cell *of = &c.cell[i];
        const double depth = 10. * (c.size[2] - of->at[2] - of->side) / MESH_UNITS(2); /* mm: of its upper face */
        count[of->side == 2 ? 2 : of->side == 4 ? 1 : 0]++;
        good = good && (depth >= 4 - 1e-9 || of->side == 2) && (depth >= 12 - 1e-9 || of->side <= 4);
    }
    ok(good, "cells that begin above 4 mm are halved twice, above 12 mm once");
    ok(count[0] == 3 * 4 && count[1] == 6 * 8 * 2 + 6 * 8 && count[2] == 12 * 16 * 2, "and no others: %lld, %lld, %lld",
       (long long)count[0], (long long)count[1], (long long)count[2]);
    mesh_cells_free(&c);
}

static void test_around(void)
{
    static const double at[3] = {.115, -.18, .33};
    const mesh_refine r = {.box = &cube, .top = 5, .levels = 3, .within = {.02, .01, .004}, .around = at};
    mesh_cells c = {0};
    err e = {0};
    bool good = true;
    int64_t coarse = 0;
    tets_must(!mesh_cells_make(&c, cube.nodes, r.levels, mesh_refine_wish(&r), &e), &e);
    for (int64_t i = 0; i < c.count; i++) {
        const mesh_cell *of = &c.cell[i];
        double square = 0;
        for (int a = 0; a < 3; a++) {
            const double unit = .01 / MESH_UNITS(3), low = cube.origin[a] + unit * of->at[a];
            const double off = at[a] - fmin(fmax(at[a], low), low + unit * of->side);
            square += off * off;
        }
        for (int l = 0; l < 3; l++)
            good = good && (sqrt(square) >= r.within[l] - 1e-9 || of->side <= MESH_UNITS(3) >> (l + 1));
        coarse += of->side == MESH_UNITS(3);
    }
    ok(good && coarse > 5, "around a place, within 20 mm once, 10 mm twice, 4 mm thrice; %lld stay whole",
       (long long)coarse);
    mesh_cells_free(&c);
}

/* ---- what is fixed */

/* Seen from a side, the first nodes in each column. */
static void test_fixed(void)
{
    static const int32_t nodes[3] = {4, 3, 4};
    const hashed h = {1, 0};
    const mesh_box b = {{4, 3, 4}, {0}, {{3, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
    mesh_cells c = {0};
    model m = {0};
    err e = {0};
    mesh_graded g = {0};
    uint8_t marked[18];
    tets_must(!mesh_cells_make(&c, nodes, 0, (mesh_wish){halve_hashed, &h}, &e), &e);
    for (int i = 0; i < 18; i++) /* a step: x 0 from z 1 on, x 1 and 2 from z 0; and a hole in the middle */
        marked[i] = !(i / 6 == 0 && i % 3 == 0) && i != 2 * 3 + 3 + 1;
    mesh_cells_keep(&c, marked);
    const mesh_made made = {&g, &b, &c};
    tets_must(
        !mesh_graded_make(&g, &b, &c, &e) && !mesh_graded_add(&g, &m, &e) && !mesh_fix_made(&m, "zmin", &made, &e), &e);
    const uint8_t *rigid = model_find(&m, "node.rigid")->u8;
    bool good = true;
    for (int64_t n = 0; n < model_count(&m, "node"); n++) {
        const double *x = place(&m, n);
        good = good && rigid[n] == ((x[0] > .5 && x[2] < .5) || (x[0] < 1.5 && x[2] > .5 && x[2] < 1.5));
    }
    ok(good, "zmin of a step: both of its treads");
    mesh_graded_free(&g);
    mesh_cells_free(&c);
    model_free(&m);
}

static void refuse(int32_t n, int levels, const char *want)
{
    const int32_t nodes[3] = {n, 2, 2};
    const hashed h = {1, 0};
    mesh_cells c = {0};
    err e = {0};
    ok(mesh_cells_make(&c, nodes, levels, (mesh_wish){halve_hashed, &h}, &e) == -1 && strstr(e.text, want), "%s",
       e.text);
    mesh_cells_free(&c);
}

int main(void)
{
    test_plain();
    for (unsigned seed = 1; seed < 4; seed++) {
        test_mesh(seed, 1, 100, 0, seed == 2);
        test_mesh(seed, 3, 40, 0, seed == 3);
        test_mesh(seed, 2, 60, 70, seed == 1);
    }
    test_patch(0);
    test_patch(40);
    test_depths();
    test_around();
    test_fixed();
    refuse(1, 0, "1 nodes along a side");
    refuse(100000, 4, "100000 nodes along a side, whose cells are halved 4 times; expected at most 32768");
    return done_testing();
}
