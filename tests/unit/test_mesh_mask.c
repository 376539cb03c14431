/* What of an image is meshed: the largest component of voxels, and of tetrahedra; holes; what lies under tissue; and
 * a ball, whose border the nodes of its mesh are on.
 */
// needs: msds/mesh/mesh_tets.c msds/mesh/mesh_keys.c msds/mesh/mesh_cells.c msds/mesh/mesh_graded.c
// needs: msds/mesh/mesh_refine.c msds/mesh/mesh_mask.c msds/mesh/mesh_runs.c msds/mesh/mesh_border.c
// needs: msds/mesh/mesh_warp.c msds/mesh/mesh_around.c msds/mesh/mesh_way.c msds/mesh/mesh_chosen.c
#include "mesh_look.h"

#include "base/mem.h"
#include "mesh/boundary.h"
#include "msds/mesh/mesh_border.h"
#include "msds/mesh/mesh_refine.h"
#include "msds/mesh/mesh_runs.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void must(bool good, const err *e)
{
    if (good)
        return;
    printf("Bail out! %s\n", e->text);
    exit(1);
}

static bool halve_none(const void *context, const mesh_cells *c, const mesh_cell *of, int level)
{
    (void)context, (void)c, (void)of, (void)level;
    return false;
}

/* ---- parts */

/* Two cells, and three that touch them along an edge. */
static void test_parts(void)
{
    const mesh_box b = {{6, 3, 2}, {0}, {{5, 0, 0}, {0, 2, 0}, {0, 0, 1}}};
    const uint8_t marked[10] = {1, 1, 0, 0, 0, 0, 0, 1, 1, 1};
    mesh_cells c = {0};
    mesh_graded g = {0};
    mesh_left left;
    err e = {0};
    double least = 9;
    must(!mesh_cells_make(&c, b.nodes, 1, (mesh_wish){halve_none, NULL}, &e), &e);
    mesh_cells_keep(&c, marked);
    must(!mesh_graded_make(&g, &b, &c, &e) && !mesh_around_largest(&g, &left, &e), &e);
    for (int64_t n = 0; n < g.nodes; n++)
        least = fmin(least, g.position[3 * n]);
    ok(g.tets == 15 && g.nodes == 16 && left.tets == 10 && left.parts == 1 && least == 2,
       "what touches along an edge is another part; the largest stays, with its nodes");
    mesh_graded_free(&g);
    mesh_cells_free(&c);
}

enum { WIDE = 11, HIGH = 9, DEEP = 8, VOXELS = WIDE * HIGH * DEEP };

/* Voxels, slowly: each takes the least number of those that it is joined to, until none changes. 0: another value. */
static void number_voxels(const uint8_t *mask, uint8_t of, int *number)
{
    static const int apart[3] = {1, WIDE, WIDE * HIGH}, size[3] = {WIDE, HIGH, DEEP};
    for (int i = 0; i < VOXELS; i++)
        number[i] = mask[i] == of ? i + 1 : 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < VOXELS; i++)
            for (int a = 0; a < 3 && number[i]; a++) {
                const int next = i + apart[a];
                if (i / apart[a] % size[a] == size[a] - 1 || !number[next] || number[next] == number[i])
                    continue;
                number[i] = number[next] = number[i] < number[next] ? number[i] : number[next];
                changed = true;
            }
    }
}

static bool is_outermost(int i)
{
    const int x = i % WIDE, y = i / WIDE % HIGH, z = i / WIDE / HIGH;
    return x == 0 || y == 0 || z == 0 || x == WIDE - 1 || y == HIGH - 1 || z == DEEP - 1;
}

/* How many voxels the largest component of a value has; those of components that are not joined to the outside. */
static void count_voxels(const uint8_t *mask, uint8_t of, int64_t *largest, int64_t *enclosed)
{
    int number[VOXELS], count[VOXELS + 1] = {0};
    bool outside[VOXELS + 1] = {false};
    number_voxels(mask, of, number);
    for (int i = 0; i < VOXELS; i++) {
        count[number[i]] += number[i] > 0;
        outside[number[i]] = outside[number[i]] || is_outermost(i);
    }
    *largest = *enclosed = 0;
    for (int n = 1; n <= VOXELS; n++) {
        *largest = count[n] > *largest ? count[n] : *largest;
        *enclosed += outside[n] ? 0 : count[n];
    }
}

static void test_runs(unsigned seed)
{
    const int64_t size[3] = {WIDE, HIGH, DEEP};
    uint8_t mask[VOXELS], filled[VOXELS];
    int64_t largest, kept, holes, left, ones = 0, more = 0, unused;
    err e = {0};
    for (int i = 0; i < VOXELS; i++) {
        seed = seed * 1664525U + 1013904223U;
        ones += mask[i] = (seed >> 24) < 120;
    }
    memcpy(filled, mask, VOXELS);
    count_voxels(mask, 1, &largest, &unused);
    must(!mesh_runs_largest(mask, size, &e), &e);
    count_voxels(mask, 1, &kept, &unused);
    for (int i = 0; i < VOXELS; i++)
        more += mask[i];
    ok(kept == largest && more == largest && largest < ones, "the largest component of voxels: %lld of %lld",
       (long long)kept, (long long)ones);
    for (int i = 0; i < VOXELS; i++)
        filled[i] = (uint8_t)(filled[i] || i % 3 == 0);
    count_voxels(filled, 0, &unused, &holes);
    more = 0;
    for (int i = 0; i < VOXELS; i++)
        more -= filled[i];
    must(!mesh_runs_fill(filled, size, &e), &e);
    count_voxels(filled, 0, &unused, &left);
    for (int i = 0; i < VOXELS; i++)
        more += filled[i];
    ok(holes > 0 && !left && more == holes, "%lld voxels of holes are filled", (long long)holes);
}

/* ---- a ball in an image */

enum { BALL = 40 };

static double radius_at(const double place_[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += (place_[a] - .02) * (place_[a] - .02);
    return sqrt(square);
}

/* 40 mm of voxels of 1 mm, as bright as the part of them in a ball of 15 mm; its label is 3. */
static volume ball_image(double bright)
{
    volume v = {.type = VOLUME_F32, .size = {BALL, BALL, BALL}, .origin = {.5, .5, .5}};
    err e = {0};
    for (int a = 0; a < 3; a++)
        v.axis[a][a] = 1;
    must(!volume_make(&v, &e), &e);
    for (int i = 0; i < BALL * BALL * BALL; i++) {
        const double at[3] = {1e-3 * (i % BALL + .5), 1e-3 * (i / BALL % BALL + .5), 1e-3 * (i / BALL / BALL + .5)};
        ((float *)v.data)[i] = radius_at(at) < .015 ? (float)bright : 0;
    }
    return v;
}

static void make_ball(mesh_mask *mask, const char *words, int top, int nodes, int levels, mesh_cells *c)
{
    volume v = ball_image(3);
    err e = {0};
    const double cell[3] = {40. / (nodes - 1), 40. / (nodes - 1), 40. / (nodes - 1)};
    const mesh_box b = {{nodes, nodes, nodes}, {0}, {{.04, 0, 0}, {0, .04, 0}, {0, 0, .04}}};
    const mesh_refine r = {.box = &b, .mask = mask, .top = top, .levels = levels, .within = {.004}};
    must(!mesh_mask_grey(mask, words, &v, top, cell, &e) && !mesh_mask_labels(mask, words, &v, "ball", &e), &e);
    must(!mesh_cells_make(c, b.nodes, levels, mesh_refine_wish(&r), &e), &e);
    uint8_t *tissue = mem_array(c->count, 1, "test", &e);
    must(tissue != NULL, &e);
    for (int64_t i = 0; i < c->count; i++)
        tissue[i] = mesh_mask_share(mask, c, &c->cell[i]) > 0;
    mesh_cells_keep(c, tissue);
    free(tissue);
    volume_free(&v);
}

static void test_ball(int levels)
{
    const mesh_box b = {{14, 14, 14}, {0}, {{.04, 0, 0}, {0, .04, 0}, {0, 0, .04}}};
    mesh_mask mask = {0};
    mesh_cells c = {0};
    mesh_graded g = {0};
    mesh_moved moved;
    model m = {0};
    look l;
    err e = {0};
    boundary border = {0};
    double worst = 0, sum = 0;
    make_ball(&mask, "tissue:3", 5, b.nodes[0], levels, &c);
    must(!mesh_graded_make(&g, &b, &c, &e) && !mesh_border_fit(&g, &b, &c, &mask, &moved, &e), &e);
    must(!mesh_graded_add(&g, &m, &e) && !boundary_of(&border, &m, NULL, NULL, &e), &e);
    for (int64_t i = 0; i < 3 * border.faces; i++) {
        const double off = fabs(radius_at(place(&m, border.node[i])) - .015);
        worst = fmax(worst, off);
        sum += off / (3. * (double)border.faces);
    }
    look_at_angles(&m, &l);
    ok(!moved.left.tets && 6 * moved.off < moved.nodes,
       "%lld nodes of the ball's skin, %lld of them beside it, moved by %.2f mm at most", (long long)moved.nodes,
       (long long)moved.off, 1e3 * moved.largest);
    ok(worst < 1e-3 && sum < 3e-4, "off by %.2f mm at most, %.3f in the mean: voxels are of 1 mm", 1e3 * worst,
       1e3 * sum);
    near_(l.room, 4. / 3 * acos(-1) * pow(.015, 3), .04 * l.room, "its volume");
    ok(l.thin > 0 && l.least > 10 && l.most < 165, "dihedral angles of %.1f to %.1f degrees", l.least, l.most);
    boundary_free(&border);
    mesh_graded_free(&g);
    mesh_mask_free(&mask);
    mesh_cells_free(&c);
    model_free(&m);
}

/* Above a level, what lies under the ball's upper half is tissue too. */
static void test_above(void)
{
    mesh_mask mask = {0};
    mesh_cells c = {0};
    int64_t sum = 0, shade = 0;
    make_ball(&mask, "above:1", 3, 41, 0, &c);
    for (int64_t i = 0; i < BALL * BALL * BALL; i++)
        sum += mask.tissue[i];
    for (int i = 0; i < BALL * BALL * BALL; i++) {
        const double at[3] = {1e-3 * (i % BALL + .5), .02, 1e-3 * (i / BALL / BALL + .5)};
        const double up = .015 * .015 - pow(radius_at(at), 2);
        shade += up > 0 && 1e-3 * (i / BALL % BALL + .5) < .02 + sqrt(up);
    }
    ok(sum == shade, "%lld voxels in and under the ball, seen from ymax", (long long)sum);
    mesh_mask_free(&mask);
    mesh_cells_free(&c);
}

int main(void)
{
    test_parts();
    for (unsigned seed = 1; seed < 4; seed++)
        test_runs(seed);
    test_ball(0);
    test_ball(1);
    test_above();
    return done_testing();
}
