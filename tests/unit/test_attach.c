/* W&M Algorithm 2 on voxels made by hand: figure 5's regions, the limits, symmetry, and all voxels tried against those
 * near each primitive; then contraction centres, fibres and axes against their sums done by hand; and which surfaces are rigid.
 */
// needs: attach/anchor.c attach/rigid.c attach/muscle.c
#include "attach/anchor.h"
#include "attach/muscle.h"
#include "base/mem.h"
#include "mesh/closest.h"
#include "mesh/lattice.h"
#include "mesh/surface.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static double random_in(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / (double)(1ull << 52) - 1;
}

static int32_t node_at(const int32_t *size, int32_t i, int32_t j, int32_t k)
{
    return (k * (size[1] + 1) + j) * (size[0] + 1) + i;
}

static void node_arrays(model *m, const lattice *l, const int32_t *size, err *e)
{
    model_axis_add(m, "node", (size[0] + 1) * (size[1] + 1) * (size[2] + 1), e);
    model_array *position = model_add(m, "node.position", e);
    int64_t n = 0;
    for (int32_t k = 0; position && k <= size[2]; k++)
        for (int32_t j = 0; j <= size[1]; j++)
            for (int32_t i = 0; i <= size[0]; i++)
                lattice_corner(l, (int32_t[]){i, j, k}, &position->f64[3 * n++]);
}

/* A block of size[0] x size[1] x size[2] voxels, all in volume 0, without every skip-th (0: with all). */
static void block(model *m, const lattice *l, const int32_t *size, int skip_each)
{
    err e = {0};
    int32_t cells = size[0] * size[1] * size[2];
    *m = (model){0};
    lattice_save(l, m, &e);
    node_arrays(m, l, size, &e);
    model_axis_add(m, "element", skip_each ? cells - (cells + skip_each - 1) / skip_each : cells, &e);
    model_axis_add(m, "material", 1, &e);
    model_axis_add(m, "volume", 3, &e);
    model_add(m, "element.lattice", &e);
    model_add(m, "element.node", &e);
    model_add(m, "element.volume", &e);
    model_add(m, "volume.muscle", &e);
    model_add(m, "volume.name", &e);
    int32_t *cell = model_find(m, "element.lattice")->i32, *node = model_find(m, "element.node")->i32;
    for (int32_t c = 0, n = 0; c < cells; c++) {
        if (skip_each && c % skip_each == 0)
            continue;
        int32_t at[] = {c % size[0], c / size[0] % size[1], c / size[0] / size[1]};
        memcpy(&cell[3 * n], at, sizeof at);
        for (int v = 0; v < 8; v++)
            node[8 * n + v] =
                node_at(size, at[0] + lattice_vtk[v][0], at[1] + lattice_vtk[v][1], at[2] + lattice_vtk[v][2]);
        n++;
    }
    if (e.status)
        ok(false, "a block: %s", e.text);
}

static const int32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};

/* One primitive on the model; its nodes are in node.rigid. */
static int attach_one(model *m, const double *position, int corners, double strictness)
{
    err e = {0};
    rigid_surface skull = {.name = (char[]){"skull"}, .primitives = 1};
    rigid_primitive primitive = {position, in_order, corners, 0};
    rigid r = {&skull, &primitive, 1, 1, 1, 1};
    if (anchor_nodes(m, &r, strictness, NULL, &e))
        ok(false, "attach: %s", e.text);
    return (int)skull.nodes;
}

/* The rigid nodes of one voxel [0, 1]^3 as digits in VTK order, with one primitive. */
static const char *held(const double *position, int corners, double strictness, char *digits)
{
    static const lattice unit = {{0, 0, 0}, {1, 1, 1}};
    static const int32_t one[] = {1, 1, 1};
    model m;
    block(&m, &unit, one, 0);
    attach_one(&m, position, corners, strictness);
    const model_array *fixed = model_find(&m, "node.rigid"), *node = model_find(&m, "element.node");
    int n = 0;
    for (int v = 0; v < 8; v++)
        if (fixed->u8[node->i32[v]])
            digits[n++] = (char)('0' + v);
    digits[n] = 0;
    model_free(&m);
    return digits;
}

typedef struct example {
    const char *what;
    int corners;
    double position[12], strictness;
    const char *nodes; /* VTK: 0-3 round z = 0 from (0, 0) by (1, 0), 4-7 the same at z = 1 */
} example;

#define SQUARE(z)                                                                                                      \
    {                                                                                                                  \
        -9, -9, z, 9, -9, z, 9, 9, z, -9, 9, z                                                                         \
    }
#define TURNED(z)                                                                                                      \
    {                                                                                                                  \
        -9, 9, z, 9, 9, z, 9, -9, z, -9, -9, z                                                                         \
    }

static const example examples[] = {
    /* Figure 5: within a quarter of a side two nodes of the face are left out. */
    {"the middle of a face", 1, {1, .5, .5}, .75, "1256"},
    {"a face, low y", 1, {1, .2, .5}, .75, "15"},
    {"a face, high y", 1, {1, .8, .5}, .75, "26"},
    {"a face, low z", 1, {1, .5, .2}, .75, "12"},
    {"a face, high z", 1, {1, .5, .8}, .75, "56"},
    {"a face, low y and z", 1, {1, .2, .2}, .75, "1"},
    {"a face, high y and z", 1, {1, .8, .8}, .75, "6"},
    {"just on the limit", 1, {1, .25, .25}, .75, "1256"},
    {"just on it by z alone", 1, {1, .2, .25}, .75, "15"},
    {"just on it but for rounding", 1, {1, .25 - 1e-12, .75 + 1e-12}, .75, "1256"},
    {"just past it", 1, {1, .25 - 1e-6, .5}, .75, "15"},
    {"the line's end inside the voxel", 1, {.6, .5, .46}, .75, "1256"},
    {"inside, toward low y", 1, {.6, .42, .46}, .75, "15"},
    {"outside, toward low y", 1, {1.3, .02, .3}, .75, "15"},
    {"an edge of the voxel", 1, {1, 1, .5}, .75, "26"},
    {"an edge, high z", 1, {1, 1, .8}, .75, "6"},
    {"a corner", 1, {0, 1, 1}, .75, "7"},
    {"outside a corner", 1, {-.4, 1.4, 1.4}, .75, "7"},
    {"a side from the centre", 1, {1.5, .5, .5}, .75, "1256"},
    {"a side from the centre but for rounding", 1, {1.5 + 1e-12, .5, .5}, .75, "1256"},
    {"past the box", 1, {1.5 + 1e-6, .5, .5}, .75, ""},
    {"the box's corner", 1, {-.5, -.5, -.5}, .75, "0"},
    {"past the box's corner", 1, {-.5, -.5, -.5 - 1e-6}, .75, ""},
    {"near, but not along z", 1, {.5, .5, 1.6}, .75, ""},
    {"strictness .5: one node", 1, {1, .4, .4}, .5, "1"},
    {"strictness .5: its limit", 1, {1, .5, .4}, .5, "12"},
    {"strictness .4: between the nodes", 1, {1, .5, .5}, .4, ""},
    {"strictness 1: all", 1, {1, .4, .1}, 1, "01234567"},
    {"strictness just below 1: a face", 1, {1, .4, .1}, .999, "1256"},
    {"a point at the centre", 1, {.5, .5, .5}, .75, "01234567"},
    {"a line beside", 2, {1, -9, .5, 1, 9, .5}, .75, "1256"},
    {"a line along an edge", 2, {1, 1, -9, 1, 1, 9}, .75, "26"},
    {"a line's end", 2, {1, .2, .2, 2, -.5, -.5}, .75, "1"},
    {"a line past the centre", 2, {.6, .1, .5, .6, .9, .5}, .75, "1256"},
    {"a line through the centre", 2, {.5, .5, -9, .5, .5, 9}, .75, "01234567"},
    {"a polygon above the centre", 4, SQUARE(.8), .75, "4567"},
    {"turned round", 4, TURNED(.8), .75, "4567"},
    {"above the voxel", 4, SQUARE(1.5), .75, "4567"},
    {"far above", 4, SQUARE(1.51), .75, ""},
    {"below the centre", 4, SQUARE(.2), .75, "0123"},
    {"below the voxel", 4, SQUARE(-.5), .75, "0123"},
    {"through the centre, its normal up", 4, SQUARE(.5), .75, "4567"},
    {"through the centre, its normal down", 4, TURNED(.5), .75, "0123"},
    {"through it but for rounding", 4, SQUARE(.5 - 1e-12), .75, "4567"},
    {"just below it", 4, SQUARE(.5 - 1e-6), .75, "0123"},
    {"slanted through the centre", 3, {-9, 1.5, -.1, 0, -.5, 1.1, 9, 1.5, -.1}, .75, "67"},
    {"no area, through the centre", 3, {.5, .5, .5, .5, .5, 1, .5, .5, 3}, .75, "01234567"},
    {"a triangle's corner", 3, {.9, .9, .9, 3, 4, 2, 4, 3, 2}, .75, "6"},
    {"a triangle's side", 3, {-9, .9, .9, 9, .9, .9, 0, 5, 5}, .75, "67"},
    {"a triangle past the box", 3, {1.6, .5, .5, 2, 0, 0, 2, 1, 1}, .75, ""},
};

static void hand_examples(void)
{
    char digits[9];
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        const example *x = &examples[i];
        ok(!strcmp(held(x->position, x->corners, x->strictness, digits), x->nodes), "%s: nodes %s", x->what, digits);
    }
    int different = 0;
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) { /* the corners in another order, same sense */
        const example *x = &examples[i];
        double turned[12];
        for (int n = 0; n < 3 * x->corners; n++)
            turned[n] = x->position[(n + 3) % (3 * x->corners)];
        different += strcmp(held(turned, x->corners, x->strictness, digits), x->nodes) != 0;
    }
    ok(!different, "from whatever corner the primitives begin");
}

/* Of a concave polygon with two closest points each counts, wherever it begins: a C round the voxel, open to +x. */
static void two_closest(void)
{
    static const double c[][3] = {{-9, -2, .5}, {9, -2, .5}, {9, .1, .5}, {-1, .1, .5},
                                  {-1, .9, .5}, {9, .9, .5}, {9, 2, .5},  {-9, 2, .5}};
    char digits[9];
    for (int first = 0; first < 8; first++) {
        double turned[24];
        for (int n = 0; n < 8; n++)
            memcpy(&turned[3 * n], c[(first + n) % 8], sizeof c[0]);
        ok(!strcmp(held(turned, 8, .75, digits), "01234567"), "a C from corner %d: nodes %s", first, digits);
    }
}

/* Lines 1 to 10 to the letter over every voxel, for a flat convex polygon. */
static void brute_force(const model *m, const double *position, int corners, double strictness, uint8_t *fixed)
{
    err e = {0};
    lattice l;
    lattice_of(m, &l, &e);
    const model_array *cell = model_find(m, "element.lattice"), *node = model_find(m, "element.node");
    for (int64_t v = 0; v < cell->rows; v++) {
        double c[3], p[3] = {0}, best = INFINITY;
        for (int a = 0; a < 3; a++)
            c[a] = l.origin[a] + (cell->i32[3 * v + a] + .5) * l.spacing[a];
        for (int t = 0; t < (corners < 3 ? 1 : corners - 2); t++) {
            double near[3], d = 0;
            if (corners == 1)
                memcpy(near, position, sizeof near);
            else if (corners == 2)
                closest_segment(position, position + 3, c, near);
            else
                closest_triangle(position, &position[3 * t + 3], &position[3 * t + 6], c, near);
            for (int a = 0; a < 3; a++)
                d += (near[a] - c[a]) * (near[a] - c[a]);
            if (d < best) {
                best = d;
                memcpy(p, near, sizeof p);
            }
        }
        bool inside = true;
        double at = INFINITY; /* where along c + at (p - c) the first of the voxel's planes is met */
        for (int a = 0; a < 3; a++) {
            inside &= fabs(p[a] - c[a]) <= l.spacing[a];
            at = fmin(at, l.spacing[a] / 2 / fabs(p[a] - c[a]));
        }
        for (int n = 0; inside && n < 8; n++) {
            bool within = true;
            for (int a = 0; a < 3; a++) {
                double i = c[a] + at * (p[a] - c[a]);
                double corner = l.origin[a] + (cell->i32[3 * v + a] + lattice_vtk[n][a]) * l.spacing[a];
                within &= fabs(i - corner) <= strictness * l.spacing[a];
            }
            if (within)
                fixed[node->i32[8 * v + n]] = 1;
        }
    }
}

/* A flat convex polygon, line or point of random size, place and turn. */
static int random_primitive(uint64_t *seed, double reach, double *position)
{
    double centre[3], u[3], w[3], size = reach * pow(10, random_in(seed) - 1);
    int corners = 1 + (int)((random_in(seed) + 1) * 3);
    for (int a = 0; a < 3; a++) {
        centre[a] = reach * random_in(seed);
        u[a] = size * random_in(seed);
        w[a] = size * random_in(seed);
    }
    for (int n = 0; n < corners; n++)
        for (int a = 0; a < 3; a++)
            position[3 * n + a] = centre[a] + u[a] * cos(6.28 * n / corners) + w[a] * sin(6.28 * n / corners);
    return corners;
}

static void all_voxels(void)
{
    static const lattice grids[] = {
        {{-1, -1, -1}, {.2, .2, .2}}, {{-1, -1.5, -.7}, {.3, .15, .1}}, {{-.02, -.01, -.03}, {.0025, .0025, .01}}};
    static const int32_t size[] = {11, 13, 9};
    uint64_t seed = 7;
    for (int g = 0; g < 3; g++) {
        model m;
        block(&m, &grids[g], size, g ? 3 : 0);
        int64_t nodes = model_count(&m, "node"), total = 0;
        uint8_t *want = malloc((size_t)nodes);
        int wrong = 0;
        for (int n = 0; want && n < 150; n++) {
            double position[18], strictness = n % 3 ? .75 : .6;
            int corners = random_primitive(&seed, grids[g].spacing[0] * 8, position);
            memset(want, 0, (size_t)nodes);
            brute_force(&m, position, corners, strictness, want);
            total += attach_one(&m, position, corners, strictness);
            wrong += memcmp(want, model_find(&m, "node.rigid")->u8, (size_t)nodes) != 0;
        }
        ok(!wrong && total > 500, "150 primitives on lattice %d, near voxels and all: %d differ, %d nodes", g, wrong,
           (int)total);
        free(want);
        model_free(&m);
    }
}

/* Turned a quarter about z, or mirrored in x, what goes in and what comes out. */
static void symmetry(void)
{
    static const lattice grid = {{-2, -2, -2}, {.5, .5, .5}};
    static const int32_t size[] = {8, 8, 8};
    model m, other;
    uint64_t seed = 3;
    int wrong[2] = {0}, total = 0;
    block(&m, &grid, size, 0);
    block(&other, &grid, size, 0);
    for (int n = 0; n < 200; n++) {
        double position[18], moved[18];
        int corners = random_primitive(&seed, 2, position);
        if (n % 2 && corners <= 3) /* what stays flat, onto the limits */
            for (int i = 0; i < 3 * corners; i++)
                position[i] = round(position[i] * 8) / 8;
        total += attach_one(&m, position, corners, .75);
        for (int way = 0; way < 2; way++) {
            for (int c = 0; c < corners; c++) {
                int to = way ? corners - 1 - c : c; /* a mirror turns polygons over */
                moved[3 * to] = way ? -position[3 * c] : -position[3 * c + 1];
                moved[3 * to + 1] = way ? position[3 * c + 1] : position[3 * c];
                moved[3 * to + 2] = position[3 * c + 2];
            }
            attach_one(&other, moved, corners, .75);
            const uint8_t *a = model_find(&m, "node.rigid")->u8, *b = model_find(&other, "node.rigid")->u8;
            for (int32_t v = 0; v < 9 * 9 * 9; v++) {
                int32_t i = v % 9, j = v / 9 % 9, k = v / 81;
                wrong[way] += a[v] != b[way ? node_at(size, 8 - i, j, k) : node_at(size, 8 - j, i, k)];
            }
        }
    }
    ok(!wrong[0] && total > 500, "a quarter turn turns the nodes: %d of %d differ", wrong[0], total);
    ok(!wrong[1], "a mirror mirrors them: %d differ", wrong[1]);
    model_free(&m);
    model_free(&other);
}

/* The closest point is so in metres, the box and the boundary are in voxel sides. */
static void anisotropic(void)
{
    static const lattice flat = {{0, 0, 0}, {.004, .002, .001}};
    static const int32_t one[] = {1, 1, 1};
    static const struct {
        double p[3];
        const char *nodes;
    } want[] = {{{.004, .0005, .00025}, "01100110"}, {{.004, .0005 - 1e-9, .0005}, "01000100"},
                {{.006, .001, .0005}, "01100110"},   {{.0061, .001, .0005}, "00000000"},
                {{.002, .003, .0005}, "00110011"},   {{.002, .0031, .0005}, "00000000"},
                {{.002, .001, .0015}, "00001111"},   {{.002, .001, .0016}, "00000000"}};
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        model m;
        char got[9] = "";
        block(&m, &flat, one, 0);
        attach_one(&m, want[i].p, 1, .75);
        for (int v = 0; v < 8; v++)
            got[v] = model_find(&m, "node.rigid")->u8[model_find(&m, "element.node")->i32[v]] ? '1' : '0';
        ok(!strcmp(got, want[i].nodes), "flat voxels %d: nodes %s", (int)i, got);
        model_free(&m);
    }
    /* A plane at 45 degrees, x + z = .0027, from the centre .0025: along (1, 0, 1) in metres, (1, 0, 4) in sides. */
    model m;
    block(&m, &flat, one, 0);
    ok(attach_one(&m, (double[]){.0027, -1, 0, .0027, 1, 0, -1, 0, 1.0027}, 3, .75) == 4,
       "a slanted plane holds a side");
    const uint8_t *r = model_find(&m, "node.rigid")->u8;
    ok(r[4] && r[5] && r[6] && r[7], "the upper one, since the line is steep in sides");
    model_free(&m);
}

/* Several surfaces on one model: counts, idle primitives, and whose a node is. */
static void several(void)
{
    static const lattice unit = {{0, 0, 0}, {1, 1, 1}};
    static const int32_t two[] = {2, 1, 1};
    static const double at[] = {0, .5, .5, 1, .2, .5, 1, .5, .5, 5, 5, 5};
    static const int32_t want[] = {0, 1, -1, 0, 1, -1, 0, 1, -1, 0, 1, -1}; /* with i fastest */
    err e = {0};
    model m;
    block(&m, &unit, two, 0);
    rigid_surface three[] = {{.name = (char[]){"a"}}, {.name = (char[]){"b"}}, {.name = (char[]){"far"}}};
    rigid_primitive primitive[] = {{at, &in_order[0], 1, 0}, {at, &in_order[3], 1, 0}, {at, &in_order[1], 1, 1},
                                   {at, &in_order[2], 1, 1}, {at, &in_order[0], 1, 1}, {at, &in_order[3], 1, 2}};
    rigid r = {three, primitive, 3, 6, 3, 6};
    ok(!anchor_nodes(&m, &r, .75, NULL, &e), "three surfaces %s", e.text);
    ok(three[0].nodes == 4 && three[1].nodes == 8 && three[2].nodes == 0, "each node once a surface: %d %d %d",
       (int)three[0].nodes, (int)three[1].nodes, (int)three[2].nodes);
    ok(three[0].idle == 1 && three[1].idle == 0 && three[2].idle == 1, "primitives that hold none");
    const model_array *anchor = model_find(&m, "node.anchor"), *name = model_find(&m, "anchor.name");
    ok(!memcmp(anchor->i32, want, sizeof want), "a node is its first surface's");
    ok(name->rows == 3 && !strcmp(name->str[2], "far"), "the surfaces are named");
    rigid none = {0};
    ok(!anchor_nodes(&m, &none, .75, NULL, &e) && model_count(&m, "anchor") == 0, "again, with none %s", e.text);
    int left = 0;
    for (int n = 0; n < 12; n++)
        left += model_find(&m, "node.rigid")->u8[n] || model_find(&m, "node.anchor")->i32[n] != -1;
    ok(!left, "nothing is left of the first time");
    model_free(&m);
}

/* A bar of 4 x 1 x 1 voxels of .01 m, the first two of volume 1, a muscle, and the last of volume 2, another. */
static void bar(model *m, const char *fixed)
{
    static const lattice grid = {{0, 0, 0}, {.01, .01, .01}};
    static const int32_t size[] = {4, 1, 1}, volume[] = {1, 1, 0, 2};
    err e = {0};
    block(m, &grid, size, 0);
    memcpy(model_find(m, "element.volume")->i32, volume, sizeof volume);
    model_find(m, "volume.muscle")->u8[1] = model_find(m, "volume.muscle")->u8[2] = 1;
    model_set_text(model_find(m, "volume.name"), 1, "muscle_a", &e);
    model_set_text(model_find(m, "volume.name"), 2, "muscle_b", &e);
    model_array *r = model_add(m, "node.rigid", &e);
    for (int n = 0; n < 20; n++)
        r->u8[n] = fixed[n] == '1';
}

static const float *fibre(const model *m, int element)
{
    return &model_find(m, "element.fibre")->f32[3 * element];
}

static void centres(void)
{
    err e = {0};
    notes warnings = {0};
    muscle *list;
    int64_t count;
    model m;
    bar(&m, "11000" /* y 0, z 0: x = 0 and .01, which two elements share */
            "00000"
            "11000"
            "00000");
    ok(!muscle_make(&m, MUSCLE_CENTRE, &list, &count, &warnings, &e) && count == 2, "two muscles %s", e.text);
    const double *centre = model_find(&m, "muscle.centre")->f64;
    near_(centre[0], .005, 1e-15, "contraction centre x: each node once");
    near_(centre[1], 0, 1e-15, "y");
    near_(centre[2], .005, 1e-15, "z");
    ok(isnan(centre[3]) && isnan(centre[5]), "none for the other");
    ok(model_find(&m, "muscle.volume")->i32[0] == 1 && model_find(&m, "muscle.volume")->i32[1] == 2, "their volumes");
    ok(list[0].elements == 2 && list[0].rigid_nodes == 4 && list[1].elements == 1, "counts");
    const float *f = fibre(&m, 0);
    ok(f[0] == 0 && f[1] == -1 && f[2] == 0, "from (.005, .005, .005) straight down");
    f = fibre(&m, 1);
    near_(f[0], -sqrt(.8), 1e-7, "from (.015, .005, .005): x");
    near_(f[1], -sqrt(.2), 1e-7, "y");
    near_(f[2], 0, 1e-7, "z");
    ok(fibre(&m, 2)[0] == 0 && fibre(&m, 3)[0] == 0, "no fibre in no muscle, nor in one without a centre");
    ok(warnings.count == 1 && strstr(warnings.line[0], "muscle_b") && strstr(warnings.line[0], "no rigid node"), "%s",
       warnings.count ? warnings.line[0] : "no warning");
    notes_free(&warnings);
    free(list);
    model_free(&m);
}

/* The contraction centre in an element's centre: the muscle's axis there; and in a muscle of one element, nothing. */
static void at_the_centre(void)
{
    err e = {0};
    notes warnings = {0};
    muscle *list;
    int64_t count;
    model m;
    bar(&m, "11011"
            "11011"
            "11011"
            "11011");
    ok(!muscle_make(&m, MUSCLE_CENTRE, &list, &count, &warnings, &e), "all corners rigid %s", e.text);
    ok(fibre(&m, 0)[0] == -1 && fibre(&m, 0)[1] == 0 && fibre(&m, 1)[0] == -1, "the axis, toward the centre");
    ok(fibre(&m, 3)[0] == 0, "one element alone has no axis");
    ok(warnings.count == 1 && strstr(warnings.line[0], "muscle_b") && strstr(warnings.line[0], "1 of its 1"), "%s",
       warnings.count ? warnings.line[0] : "no warning");
    notes_free(&warnings);
    free(list);
    model_free(&m);
}

/* --fibre axis on the bar: the fibre of the first muscle, and how many warnings. */
static void axis(const char *fixed, float x, int said, const char *what)
{
    err e = {0};
    notes warnings = {0};
    muscle *list;
    int64_t count;
    model m;
    bar(&m, fixed);
    ok(!muscle_make(&m, MUSCLE_AXIS, &list, &count, &warnings, &e), "--fibre axis %s", e.text);
    ok(fibre(&m, 0)[0] == x && fibre(&m, 1)[0] == x && fibre(&m, 1)[1] == 0, "%s", what);
    ok(warnings.count == said && strstr(warnings.line[0], said > 2 ? "muscle_a" : "muscle_b"), "%d warnings", said);
    notes_free(&warnings);
    free(list);
    model_free(&m);
}

static void axes(void)
{
    axis("00000000000010000000", 1, 2, "along x, toward the centre"); /* muscle_b has neither centre nor axis */
    axis("10000000000000000000", -1, 2, "along x, toward a centre at the other end");
    axis("00000000000000000000", 1, 3, "no rigid node: the largest component is positive");
}

/* A straight row of voxels along (1, 2, -2) gives that axis, whatever lies across. */
static void slanted_axis(void)
{
    static const lattice grid = {{0, 0, 0}, {.001, .002, .002}};
    static const int32_t size[] = {9, 9, 9};
    err e = {0};
    notes warnings = {0};
    muscle *list;
    int64_t count;
    model m;
    block(&m, &grid, size, 0);
    model_find(&m, "volume.muscle")->u8[2] = 1;
    for (int i = 0; i < 9; i++)
        model_find(&m, "element.volume")->i32[((8 - i) * 9 + i) * 9 + i] = 2;
    model_add(&m, "node.rigid", &e);
    model_find(&m, "node.rigid")->u8[node_at(size, 0, 0, 9)] = 1;
    ok(!muscle_make(&m, MUSCLE_AXIS, &list, &count, &warnings, &e) && count == 1, "nine voxels in a row %s", e.text);
    near_(list[0].axis[0], -1. / 3, 1e-12, "axis x");
    near_(list[0].axis[1], -2. / 3, 1e-12, "axis y");
    near_(list[0].axis[2], 2. / 3, 1e-12, "axis z");
    ok(!warnings.count, "no warning");
    notes_free(&warnings);
    free(list);
    model_free(&m);
}

static const char face[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                           "f 1 2 3\ng Skull_upper\nf 1 2 4\nl 1 2 3\ng skin\nf 2 3 4\n"
                           "g cheek BONE_7 rigid\nf 1 3 4\ng skull_lower\np 4\n";

static void load(model *m, const char *name, err *e)
{
    obj o = {0};
    in *source = in_memory(face, sizeof face - 1, "face.obj", e);
    if (obj_read(&o, source, e) || surface_add(m, name, &o, .001, e))
        ok(false, "a surface: %s", e->text);
    in_close(source);
    obj_free(&o);
}

static void names(void)
{
    err e = {0};
    model m = {0};
    rigid r = {0};
    load(&m, "face", &e);
    ok(!rigid_collect(&r, &m, &(opt_list){0}, &e) && r.surfaces == 3 && r.primitives == 5, "by the usual names");
    ok(!strcmp(r.surface[0].name, "Skull_upper") && !strcmp(r.surface[1].name, "BONE_7") &&
           !strcmp(r.surface[2].name, "skull_lower"),
       "in order of the groups, under the first name that matches");
    ok(r.surface[0].primitives == 3 && r.primitive[0].corners == 3 && r.primitive[4].corners == 1, "their primitives");
    rigid_free(&r);
    ok(!rigid_collect(&r, &m, &(opt_list){2, {"rigid,SKIN", "sku*"}}, &e) && r.surfaces == 4 && r.primitives == 6,
       "by --rigid");
    rigid_free(&r);
    ok(rigid_collect(&r, &m, &(opt_list){1, {"skin,skull_uper"}}, &e) && strstr(e.text, "Skull_upper"), "%s", e.text);
    rigid_free(&r);
    e = (err){0};
    ok(rigid_collect(&r, &m, &(opt_list){1, {","}}, &e) && e.status == STATUS_BAD, "%s", e.text);
    rigid_free(&r);
    e = (err){0};
    ok(!rigid_collect_all(&r, &m, &e) && r.surfaces == 5 && r.primitives == 7 && !strcmp(r.surface[0].name, "face"),
       "all of a file, the part in no group under the file's name");
    rigid_free(&r);
    model_find(&m, "face/vertex.position")->f64[0] = NAN;
    ok(rigid_collect(&r, &m, &(opt_list){0}, &e) && strstr(e.text, "vertex 0"), "%s", e.text);
    rigid_free(&r);
    model_free(&m);
}

int main(void)
{
    hand_examples();
    two_closest();
    all_voxels();
    symmetry();
    anisotropic();
    several();
    centres();
    at_the_centre();
    axes();
    slanted_axis();
    names();
    return done_testing();
}
