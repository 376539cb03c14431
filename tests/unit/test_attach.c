/* W&M Algorithm 2 on voxels made by hand: figure 5's regions, the limits, symmetry, and all voxels tried against those
 * near each primitive, by random ones and on a real skull.
 */
// needs: attach/anchor.c attach/rigid.c
#include "attach/anchor.h"
#include "base/mem.h"
#include "surface/closest.h"
#include "surface/surface.h"

#include "block.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static double random_in(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / (double)(1ull << 52) - 1;
}

static const int32_t in_order[] = {0, 1, 2, 3, 4, 5, 6, 7};

/* One primitive on the model; its nodes are in node.rigid. */
static int attach_one(model *m, const double *position, int corners, double strictness)
{
    err e = {0};
    rigid_surface skull = {.name = "skull", .primitives = 1};
    rigid_primitive primitive = {.position = position, .vertex = in_order, .corners = corners};
    rigid r = {.surface = &skull, .primitive = &primitive, .surfaces = 1, .primitives = 1};
    if (anchor_nodes(m, &r, strictness, NULL, NULL, &e))
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
    {"through the centre, its normal up", 4, SQUARE(.5), .75, "01234567"},
    {"through the centre, its normal down", 4, TURNED(.5), .75, "01234567"},
    {"through it but for rounding", 4, SQUARE(.5 - 1e-12), .75, "01234567"},
    {"just below it", 4, SQUARE(.5 - 1e-6), .75, "0123"},
    {"slanted through the centre", 3, {-9, 1.5, -.1, 0, -.5, 1.1, 9, 1.5, -.1}, .75, "0167"},
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
    int different[2] = {0};
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        const example *x = &examples[i];
        for (int first = 0; first < x->corners; first++)
            for (int way = 0; way < 2; way++) {
                double turned[12];
                for (int c = 0; c < x->corners; c++)
                    memcpy(&turned[3 * c], &x->position[3 * ((first + (way ? x->corners - c : c)) % x->corners)],
                           3 * sizeof *turned);
                different[way] += strcmp(held(turned, x->corners, x->strictness, digits), x->nodes) != 0;
            }
    }
    ok(!different[0], "from whatever corner the primitives begin: %d differ", different[0]);
    ok(!different[1], "and whichever way round: %d differ", different[1]);
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

/* Of a convex polygon there is one closest point, however it is cut: here 3e-5 from a diagonal, and the line to it 2e-5
 * past the limit for two more nodes. To rounding the diagonal is as near. */
static void beside_a_cut(void)
{
    const double n[] = {0, .50002, 1}, length = sqrt(.50002 * .50002 + 1), d = .8;
    const double along[][3] = {{-9, -3e-5, 0}, {0, 9, 0}, {9, -3e-5, 0}, {0, -9, 0}}; /* x, up the slope */
    double corner[4][3], turned[12];
    char digits[9];
    for (int c = 0; c < 4; c++) {
        corner[c][0] = .5 + along[c][0];
        corner[c][1] = .5 + (d * n[1] + along[c][1] * n[2]) / length;
        corner[c][2] = .5 + (d * n[2] - along[c][1] * n[1]) / length;
    }
    for (int first = 0; first < 4; first++) {
        for (int c = 0; c < 4; c++)
            memcpy(&turned[3 * c], corner[(first + c) % 4], sizeof corner[0]);
        ok(!strcmp(held(turned, 4, .75, digits), "67"), "beside a cut, from corner %d: nodes %s", first, digits);
    }
}

/* Lines 1 to 10 to the letter over every voxel, for a flat convex polygon. The real face is symmetric: some of its
 * places lie just on a limit, so rounding is allowed for. */
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
            inside &= fabs(p[a] - c[a]) <= l.spacing[a] * (1 + 1e-9);
            at = fmin(at, l.spacing[a] / 2 / fabs(p[a] - c[a]));
        }
        for (int n = 0; inside && n < 8; n++) {
            bool within = true;
            for (int a = 0; a < 3; a++) {
                double i = c[a] + at * (p[a] - c[a]);
                double corner = l.origin[a] + (cell->i32[3 * v + a] + lattice_vtk[n][a]) * l.spacing[a];
                within &= fabs(i - corner) <= (strictness + 1e-9) * l.spacing[a];
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
                moved[3 * c] = way ? -position[3 * c] : -position[3 * c + 1];
                moved[3 * c + 1] = way ? position[3 * c + 1] : position[3 * c];
                moved[3 * c + 2] = position[3 * c + 2];
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
    rigid_surface three[] = {{.name = "a"}, {.name = "b"}, {.name = "far"}};
    static const struct {
        int vertex, surface;
    } each[] = {{0, 0}, {3, 0}, {1, 1}, {2, 1}, {0, 1}, {3, 2}};
    rigid_primitive primitive[6] = {{0}};
    for (int i = 0; i < 6; i++)
        primitive[i] = (rigid_primitive){
            .position = at, .vertex = &in_order[each[i].vertex], .corners = 1, .surface = each[i].surface};
    rigid r = {.surface = three, .primitive = primitive, .surfaces = 3, .primitives = 6};
    ok(!anchor_nodes(&m, &r, .75, NULL, NULL, &e), "three surfaces %s", e.text);
    ok(three[0].nodes == 4 && three[1].nodes == 8 && three[2].nodes == 0, "each node once a surface: %d %d %d",
       (int)three[0].nodes, (int)three[1].nodes, (int)three[2].nodes);
    ok(three[0].idle == 1 && three[1].idle == 0 && three[2].idle == 1, "primitives that hold none");
    const model_array *anchor = model_find(&m, "node.anchor"), *name = model_find(&m, "anchor.name");
    ok(!memcmp(anchor->i32, want, sizeof want), "a node is its first surface's");
    ok(name->rows == 3 && !strcmp(name->str[2], "far"), "the surfaces are named");
    rigid none = {0};
    ok(!anchor_nodes(&m, &none, .75, NULL, NULL, &e) && model_count(&m, "anchor") == 0, "again, with none %s", e.text);
    int left = 0;
    for (int n = 0; n < 12; n++)
        left += model_find(&m, "node.rigid")->u8[n] || model_find(&m, "node.anchor")->i32[n] != -1;
    ok(!left, "nothing is left of the first time");
    model_free(&m);
}

/* Where less than half of a voxel is tissue and a plane cuts it, its centre is in
 * the bone: what is behind is held too. */
static void cut_voxels(void)
{
    static const lattice unit = {{0, 0, 0}, {1, 1, 1}};
    static const int32_t one[] = {1, 1, 1};
    static const struct {
        double z, fraction;
        const char *nodes, *what;
    } cut[] = {{.7, .3, "11111111", "the centre in the bone"},
               {.7, .5, "00001111", "just half"},
               {.2, .8, "11110000", "the centre in the tissue"},
               {1, .4, "11111111", "on the voxel's side"},
               {1.1, .4, "00001111", "less than half, but cut by something else"}};
    for (size_t i = 0; i < sizeof cut / sizeof *cut; i++) {
        const double plane[] = SQUARE(cut[i].z);
        err e = {0};
        model m;
        char got[9] = "";
        block(&m, &unit, one, 0);
        model_add(&m, "element.fraction", &e)->f32[0] = (float)cut[i].fraction;
        attach_one(&m, plane, 4, .75);
        for (int v = 0; v < 8; v++)
            got[v] = model_find(&m, "node.rigid")->u8[model_find(&m, "element.node")->i32[v]] ? '1' : '0';
        ok(!strcmp(got, cut[i].nodes), "%s: nodes %s", cut[i].what, got);
        model_free(&m);
    }
}

/* The largest distance of a rigid node from the surfaces, m. */
static double farthest(const model *m, const rigid *r)
{
    err e = {0};
    closest_shape shape = {0};
    const model_array *fixed = model_find(m, "node.rigid"), *position = model_find(m, "node.position");
    double *nearest = malloc(sizeof *nearest * (size_t)fixed->rows), most = 0;
    for (int64_t n = 0; nearest && n < fixed->rows; n++)
        nearest[n] = INFINITY;
    for (int64_t i = 0; nearest && i < r->primitives; i++) {
        const rigid_primitive *p = &r->primitive[i];
        if (!closest_shape_of(&shape, p->position, p->vertex, p->corners, &e))
            for (int64_t n = 0; n < fixed->rows; n++)
                if (fixed->u8[n])
                    nearest[n] = fmin(nearest[n], closest_distance(&shape, &position->f64[3 * n]));
    }
    for (int64_t n = 0; nearest && n < fixed->rows; n++)
        most = fixed->u8[n] ? fmax(most, nearest[n]) : most;
    closest_shape_free(&shape);
    free(nearest);
    return most;
}

/* The skull of a real face in the voxels round it. */
static void real_skull(void)
{
    static const lattice grid = {{-.075, -.1, -.13}, {.01, .008, .009}};
    static const int32_t size[] = {15, 25, 26};
    const char *shared = getenv("SINEW_SHARED");
    char path[1000];
    snprintf(path, sizeof path, "%s/data/face/face_zyg.obj", shared ? shared : "../shared");
    if (access(path, R_OK)) {
        skip(4, "no shared data");
        return;
    }
    err e = {0};
    obj o = {0};
    rigid r = {0};
    model m, file = {0};
    block(&m, &grid, size, 0);
    in *source = in_open(path, &e);
    opt_list pattern = {1, {"skull"}};
    ok(source && !obj_read(&o, source, &e) && !surface_add(&file, "face", &o, .001, &e) &&
           !rigid_collect(&r, &file, &pattern, &e) && !anchor_nodes(&m, &r, .75, NULL, NULL, &e),
       "a real skull %s", e.text);
    int64_t nodes = model_count(&m, "node"), held = 0, wrong = 0;
    uint8_t *want = calloc((size_t)nodes, 1);
    for (int64_t i = 0; want && i < r.primitives; i++) {
        double corner[9];
        for (int n = 0; n < 9; n++)
            corner[n] = r.primitive[i].position[3 * (int64_t)r.primitive[i].vertex[n / 3] + n % 3];
        wrong += r.primitive[i].corners != 3;
        brute_force(&m, corner, 3, .75, want);
    }
    ok(!wrong, "of triangles");
    for (int64_t n = 0; want && n < nodes; n++) {
        held += want[n];
        wrong += want[n] != model_find(&m, "node.rigid")->u8[n];
    }
    ok(!wrong && held > 500 && held == r.surface[0].nodes, "its nodes, near voxels and all: %d of %d differ",
       (int)wrong, (int)held);
    double far = farthest(&m, &r);
    ok(far > 0 && far < .0156, "and none is farther from the skull than a voxel's diagonal: %g mm", 1000 * far);
    free(want);
    in_close(source);
    obj_free(&o);
    rigid_free(&r);
    model_free(&file);
    model_free(&m);
}

int main(void)
{
    hand_examples();
    two_closest();
    beside_a_cut();
    all_voxels();
    symmetry();
    anisotropic();
    several();
    cut_voxels();
    real_skull();
    return done_testing();
}
