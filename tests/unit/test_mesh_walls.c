/* Smooth borders of labels: nodes of a tube's wall, of two tubes that touch, and of a tube that runs obliquely, against
 * their equations; what they fill; tetrahedra that stay good; and the same labels by the centres of tetrahedra.
 */
// needs: msds/mesh/mesh_tets.c msds/mesh/mesh_keys.c msds/mesh/mesh_cells.c msds/mesh/mesh_graded.c
// needs: msds/mesh/mesh_mask.c msds/mesh/mesh_runs.c msds/mesh/mesh_warp.c msds/mesh/mesh_around.c
// needs: msds/mesh/mesh_way.c msds/mesh/mesh_chosen.c msds/mesh/mesh_regions.c msds/mesh/mesh_walls.c
#include "mesh_look.h"

#include "base/mem.h"
#include "msds/mesh/mesh_walls.h"

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

/* ---- images: 20 mm, in voxels of .5 mm */

enum { VOXELS = 40, TUBE, TOUCHING, OBLIQUE };

static const double middle[3] = {10.3, 0, 9.6}, radius = 5, cut = 11; /* mm */

/* How far a place is from the middle line. */
static double radius_at(int what, const double at[3])
{
    const double slope = what == OBLIQUE ? .3 : 0, x = at[0] - middle[0] - slope * (at[1] - 10), z = at[2] - middle[2];
    return sqrt(x * x / (1 + slope * slope) + z * z);
}

static int label_at(int what, const double at[3])
{
    if (radius_at(what, at) >= radius)
        return 1;
    return what == TOUCHING && at[0] > cut ? 3 : 2;
}

static volume image(int what)
{
    volume v = {.type = VOLUME_U8, .size = {VOXELS, VOXELS, VOXELS}, .origin = {.25, .25, .25}};
    err e = {0};
    for (int a = 0; a < 3; a++)
        v.axis[a][a] = .5;
    must(!volume_make(&v, &e), &e);
    for (int i = 0; i < VOXELS * VOXELS * VOXELS; i++) {
        const double at[3] = {.5 * (i % VOXELS) + .25, .5 * (i / VOXELS % VOXELS) + .25,
                              .5 * (i / VOXELS / VOXELS) + .25};
        ((uint8_t *)v.data)[i] = (uint8_t)label_at(what, at);
    }
    return v;
}

/* ---- meshes */

typedef struct mesh {
    mesh_box box;
    mesh_cells cells;
    mesh_graded g;
    mesh_smoothed said;
    int64_t *label;
    model m;
} mesh;

static bool halve_none(const void *context, const mesh_cells *c, const mesh_cell *of, int level)
{
    (void)context, (void)c, (void)of, (void)level;
    return false;
}

static void make(mesh *k, int what, const int32_t nodes[3], const char *names)
{
    volume v = image(what);
    mesh_regions r = {0};
    err e = {0};
    *k = (mesh){.box = {{nodes[0], nodes[1], nodes[2]}, {0}, {{.02, 0, 0}, {0, .02, 0}, {0, 0, .02}}}};
    must(!mesh_cells_make(&k->cells, nodes, 0, (mesh_wish){halve_none, NULL}, &e), &e);
    must(!mesh_graded_make(&k->g, &k->box, &k->cells, &e), &e);
    k->label = mem_array(k->g.tets, sizeof *k->label, "test", &e);
    must(k->label && !mesh_regions_make(&r, names, &v, "image", &e), &e);
    must(!mesh_walls_smooth(&k->g, &k->box, &k->cells, &r, &v, k->label, &k->said, &e), &e);
    must(!mesh_graded_add(&k->g, &k->m, &e), &e);
    mesh_regions_free(&r);
    volume_free(&v);
}

static void drop(mesh *k)
{
    model_free(&k->m);
    free(k->label);
    mesh_graded_free(&k->g);
    mesh_cells_free(&k->cells);
}

/* Of each node: which labels its tetrahedra have, a bit each. */
static uint8_t *labels_at(const mesh *k)
{
    err e = {0};
    uint8_t *bits = mem_array(k->g.nodes, 1, "test", &e);
    must(bits != NULL, &e);
    for (int64_t i = 0; i < 4 * k->g.tets; i++)
        bits[k->g.node[i]] |= (uint8_t)(1 << k->label[i / 4]);
    return bits;
}

static double room_of(const mesh *k, int label)
{
    double sum = 0;
    for (int64_t t = 0; t < k->g.tets; t++)
        if (k->label[t] == label)
            sum += 1e9 / 6 * mesh_six_volumes(&k->g.node[4 * t], k->g.position);
    return sum;
}

static void place_of(const mesh *k, int64_t n, double mm[3])
{
    for (int a = 0; a < 3; a++)
        mm[a] = 1e3 * k->g.position[3 * n + a];
}

typedef struct off {
    double most, mean;
    int64_t nodes;
} off;

/* How far nodes that have these labels are off the tube's wall, or off the plane of the cut, mm. */
static off off_of(const mesh *k, int what, uint8_t bits, bool plane)
{
    uint8_t *at = labels_at(k);
    off o = {0};
    for (int64_t n = 0; n < k->g.nodes; n++) {
        double mm[3];
        place_of(k, n, mm);
        const double d = plane ? fabs(mm[0] - cut) : fabs(radius_at(what, mm) - radius);
        if (at[n] != bits)
            continue;
        o.most = fmax(o.most, d);
        o.mean = (o.mean * (double)o.nodes + d) / (double)(o.nodes + 1);
        o.nodes++;
    }
    free(at);
    return o;
}

/* Nodes that were made on a side are there. */
static bool sides_stay(const mesh *k)
{
    for (int64_t i = 0; i < 3 * k->g.nodes; i++) {
        const int32_t end = k->cells.size[i % 3];
        if ((k->g.at[i] == 0 && k->g.position[i] != 0) || (k->g.at[i] == end && fabs(k->g.position[i] - .02) > 1e-15))
            return false;
    }
    return true;
}

/* Nodes of the wall on the sides, off the wall at most, mm; and how many. */
static off off_at_ends(const mesh *k, int what)
{
    uint8_t *at = labels_at(k);
    off o = {0};
    for (int64_t n = 0; n < k->g.nodes; n++) {
        double mm[3];
        place_of(k, n, mm);
        const bool end = k->g.at[3 * n + 1] == 0 || k->g.at[3 * n + 1] == k->cells.size[1];
        if (!end || at[n] != (1 << 1 | 1 << 2))
            continue;
        o.most = fmax(o.most, fabs(radius_at(what, mm) - radius));
        o.nodes++;
    }
    free(at);
    return o;
}

static void test_good(const mesh *k)
{
    look l;
    look_at_angles(&k->m, &l);
    ok(k->said.kept >= MESH_QUALITY_KEPT && l.thin > 0 && l.least > 10 && l.most < 165,
       "%.0f %% of quality is kept; dihedral angles of %.1f to %.1f degrees", 100 * k->said.kept, l.least, l.most);
    near_(l.room, 8e-6, 1e-12, "all of the box");
    ok(sides_stay(k), "its sides stay");
}

/* ---- tests */

static const double fine = .25; /* mm: half a voxel */

static void test_tube(int what, const char *name, const int32_t nodes[3], double loss)
{
    mesh k;
    make(&k, what, nodes, "2");
    const off wall = off_of(&k, what, 1 << 1 | 1 << 2, false), ends = off_at_ends(&k, what);
    const double tall = what == OBLIQUE ? 20 * sqrt(1 + .09) : 20, exact = acos(-1) * radius * radius * tall;
    ok(k.said.nodes > 50 && !k.said.off && wall.nodes > 50, "%s, %dx%dx%d nodes: all %lld nodes of the wall are on it",
       name, nodes[0], nodes[1], nodes[2], (long long)k.said.nodes);
    ok(wall.most < fine && wall.mean < fine / 2, "by its equation, to %.2f mm, in the mean %.2f", wall.most, wall.mean);
    ok(ends.nodes > 8 && ends.most < fine, "and so are %lld where it leaves the box", (long long)ends.nodes);
    const double room = room_of(&k, 2);
    ok(room < exact && room > (1 - loss) * exact, "volume %.0f mm3 of %.0f: faces are chords", room, exact);
    test_good(&k);
    drop(&k);
}

/* Two halves: their common wall is a plane. */
static void test_touching(void)
{
    mesh k;
    const int32_t nodes[3] = {13, 7, 13};
    make(&k, TOUCHING, nodes, "2,3");
    const off wall = off_of(&k, TOUCHING, 1 << 1 | 1 << 2, false), other = off_of(&k, TOUCHING, 1 << 1 | 1 << 3, false);
    const off between = off_of(&k, TOUCHING, 1 << 2 | 1 << 3, true);
    ok(!k.said.off && wall.most < fine && other.most < fine, "two that touch: both walls, to %.2f mm",
       fmax(wall.most, other.most));
    ok(between.nodes > 20 && between.most < 1e-3, "and %lld nodes between them on their plane",
       (long long)between.nodes);
    const double angle = acos((cut - middle[0]) / radius);
    const double right = 20 * radius * radius * (angle - sin(2 * angle) / 2);
    near_(room_of(&k, 3), right, .08 * right, "the volume of one");
    near_(room_of(&k, 2), 20 * acos(-1) * radius * radius - right, .08 * right, "and of the other");
    test_good(&k);
    drop(&k);
}

/* The same twice; and what is not named has no border that is moved to. */
static void test_again(void)
{
    mesh k, again;
    const int32_t nodes[3] = {11, 6, 11};
    make(&k, TOUCHING, nodes, "3");
    make(&again, TOUCHING, nodes, "3");
    ok(!memcmp(k.g.position, again.g.position, (size_t)k.g.nodes * 24) &&
           !memcmp(k.label, again.label, (size_t)k.g.tets * sizeof *k.label),
       "the same bytes again");
    ok(off_of(&k, TOUCHING, 1 << 1 | 1 << 2, false).most > .5, "the wall of the other, which is not named, has steps");
    drop(&k);
    drop(&again);
}

static void test_names(void)
{
    volume v = image(TOUCHING);
    static const char *const wrong[] = {"vein", "2,2", ""};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        mesh_regions r = {0};
        err e = {0};
        ok(mesh_regions_make(&r, wrong[i], &v, "image", &e) && *e.text, "refused: '%s': %s", wrong[i], e.text);
        mesh_regions_free(&r);
    }
    volume_free(&v);
}

int main(void)
{
    const int32_t coarse[3] = {9, 6, 9}, usual[3] = {15, 8, 15}, oblique[3] = {11, 6, 11};
    test_tube(TUBE, "a tube", coarse, .2);
    test_tube(TUBE, "a tube", usual, .1);
    test_tube(OBLIQUE, "an oblique tube", oblique, .15);
    test_touching();
    test_again();
    test_names();
    return done_testing();
}
