/* From a model to the solver's arrays: masses, corners, what is held, shares of forces, distances;
 * and models that are no lattice of boxes.
 */
// needs: tled/problem/state.c tled/problem/deformed.c tled/problem/conforming.c
// needs: tled/problem/conforming_step.c tled/problem/script.c
// needs: tled/problem/script_surface.c tled/problem/loads.c tled/problem/followers.c tled/problem/muscle_fibre.c
// needs: tled/problem/cut.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/step.c
// needs: tled/problem/support.c tled/problem/films.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c tled/problem/bodies.c
#include "tled/problem/support.h"

#include "tap.h"
#include "tled_block.h"

#include <string.h>

static const block brick = {{2, 2, 3}, {.01, .02, .03}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 0, 0}, 0, false};

static void read_script(script *s, const model *m, const char *text)
{
    err e = {0};
    in *source = in_memory(text, strlen(text), "script", &e);
    ok(source && !script_read(s, source, m, &e), "the script: %s", e.text);
    in_close(source);
}

static void test_arrays(void)
{
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    double mass = 0, force[3], total[3] = {0};
    block_make(&brick, &m);
    read_script(&s, &m,
                "0 gravity 0,0,-10\n"
                "0 force 0.02,0.04,0.09 0.011 1,2,3\n"
                "0 force 0.02,0.04,0.09 0.001 0.5,0,0\n"
                "0 displace -1,-1,-1,1,1,0.001 -,0.001,-\n");
    ok(!tled_problem_make(&p, &m, &s, PHYSICAL, &e), "the problem: %s", e.text);
    for (int64_t n = 0; n < p.nodes; n++)
        mass += p.mass[n];
    near_(mass, 1000 * .02 * .04 * .09, 1e-12, "the nodes weigh what the block does");
    near_(p.mass[0], 1000 * .01 * .02 * .03 / 8, 1e-15, "a corner weighs an eighth of an element");
    int64_t middle = block_node(&brick, 1, 1, 1);
    near_(p.mass[middle], 1000 * .01 * .02 * .03, 1e-15, "a node inside a whole one");
    bool ascending = true;
    for (int i = 0; i < 8; i++) {
        ascending &= i == 0 || p.corner[8 * middle + i] > p.corner[8 * middle + i - 1];
        ascending &= p.element_node[p.corner[8 * middle + i]] == middle;
    }
    ok(ascending, "its corners are those of its 8 elements, in their order");
    ok(p.corner[0] == 0 && p.corner[1] == 8 * p.elements, "a corner node has one, then none");
    ok(p.hold[3 * middle] == HOLD_FREE && p.hold[0] == HOLD_STILL, "free and rigid nodes");
    ok(p.hold[1] == 3 && p.hold[2] == HOLD_STILL, "a rigid node is displaced in the components that the script names");
    ok(p.hold[3 * block_node(&brick, 2, 0, 0)] == HOLD_FREE && p.hold[3 * block_node(&brick, 2, 0, 0) + 1] == 3,
       "as is another");
    ok(p.held == 3 * 4 + 6, "%lld nodes are held", (long long)p.held);
    double value[12];
    const double at_rest[3] = {0};
    tled_curves(&p, 0, value);
    for (int64_t n = 0; n < p.nodes; n++) {
        tled_external(&p, value, at_rest, n, force);
        for (int a = 0; a < 3; a++)
            total[a] += force[a];
    }
    near_(total[0], 1.5, 1e-12, "forces in all, x");
    near_(total[1], 2, 1e-12, "y");
    near_(total[2], 3 - 10 * mass, 1e-12, "z, with the weight");
    tled_external(&p, value, at_rest, block_node(&brick, 2, 2, 3), force);
    near_(force[0], .5 + .5, 1e-12, "two forces on one node");
    support parts;
    ok(!support_of(&p, &parts, &e) && parts.loose == 0 && !parts.pushed, "all hangs on what is held");
    near_(parts.reach, 2 * .03, 1e-15, "the farthest node is two elements from what is held");
    tled_problem_free(&p);
    script_free(&s);
    model_free(&m);
}

/* Nothing held: one part, loose, and its diagonal. */
static void test_loose(bool weight)
{
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    support parts;
    err e = {0};
    block free_brick = brick;
    const double down[3] = {0, 0, -1};
    free_brick.fixed_low = 0;
    block_make(&free_brick, &m);
    if (weight)
        script_add_gravity(&s, down, .1, &e);
    ok(!tled_problem_make(&p, &m, &s, PHYSICAL, &e) && !support_of(&p, &parts, &e), "a brick: %s", e.text);
    ok(parts.loose == 1 && parts.first == 0 && parts.in_them == 12 && parts.pushed == weight,
       "hangs on nothing, and is %s", weight ? "pushed" : "not pushed");
    near_(parts.reach, sqrt(.02 * .02 + .04 * .04 + .09 * .09), 1e-15, "its diagonal counts for the reach");
    tled_problem_free(&p);
    script_free(&s);
    model_free(&m);
}

/* How far it is to what is held in the same component: a block of 10 x 4 x 25 elements of 1 mm. */
static void reaches(const char *text, double want, const char *name)
{
    static const block slice = {{10, 4, 25}, {.001, .001, .001}, 3000, .45, 1000, 0, 0, 0, 0, {0, 0, 0}, 0, false};
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    support held;
    err e = {0};
    block_make(&slice, &m);
    read_script(&s, &m, text);
    ok(!tled_problem_make(&p, &m, &s, PHYSICAL, &e) && !support_of(&p, &held, &e), "a slice: %s", e.text);
    near_(held.reach, want, 1e-15, "%s", name);
    ok(!held.loose && held.falling < 0, "and nothing is loose");
    tled_problem_free(&p);
    script_free(&s);
    model_free(&m);
}

#define ALL    "-1,-1,-1,1,1,1"
#define BOTTOM "-1,-1,-1,1,1,0"
#define LEFT   "-1,-1,-1,0,1,1"
#define FRONT  "-1,-1,-1,1,0,1"

static void test_reach(void)
{
    const double whole = 1e-3 * sqrt(10 * 10 + 4 * 4 + 25 * 25);
    reaches("0 displace " BOTTOM " 0,0,0\n", .025, "held at the bottom: its height");
    reaches("0 displace " ALL " -,0,-\n0 displace " BOTTOM " 0,-,0\n", .025, "and in plane strain no less");
    reaches("0 displace " ALL " -,0,-\n0 displace " LEFT " 0,-,-\n0 displace " BOTTOM " -,-,0\n", .025,
            "in plane strain with x held on one side and z on another: the farther");
    reaches("0 displace " LEFT " 0,-,-\n0 displace " FRONT " -,0,-\n0 displace " BOTTOM " -,-,0\n", .025,
            "three planes of symmetry: the longest side");
    reaches("0 displace " BOTTOM " -,-,0\n", .025, "on rollers: its height");
    reaches("0 displace " LEFT " 0,-,-\n", .01, "on rollers at the left: its width");
    reaches("0 displace " ALL " -,0,-\n", whole, "in plane strain and else free: its diagonal");
    reaches("0 displace " ALL " 0,0,0\n", .001, "held everywhere: one element");
}

static void refused(model *m, const char *want)
{
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    int result = tled_problem_make(&p, m, &s, PHYSICAL, &e);
    ok(result && e.status == STATUS_BAD && strstr(e.text, want), "refused: %s", e.text);
    tled_problem_free(&p);
    model_free(m);
}

static void test_refused(void)
{
    model m = {0};
    err e = {0};
    block_make(&brick, &m);
    model_find(&m, "node.position")->f64[20] += 1e-4;
    refused(&m, "is not a box of 0.01 x 0.02 x 0.03 m");
    block_make(&brick, &m);
    int32_t *node = model_find(&m, "element.node")->i32, first = node[0];
    node[0] = node[1];
    node[1] = first;
    refused(&m, "element 0 is not a box");
    block_make(&brick, &m);
    node = model_find(&m, "element.node")->i32;
    memmove(node, node + 8, 8 * sizeof *node);
    refused(&m, "is in no element");
    block_make(&brick, &m);
    node = model_find(&m, "element.node")->i32;
    for (int i = 1; i < 10; i++)
        memcpy(node + 8 * i, node, 8 * sizeof *node);
    refused(&m, "is in more than 8 elements");
    block_make(&brick, &m);
    model_remove(&m, "element.node");
    model_add_as(&m, "element.node", MODEL_I32, "@node", "element", 4, &e);
    refused(&m, "4 nodes; expected hexahedra");
    block_make(&brick, &m);
    model_remove(&m, "element.volume");
    refused(&m, "element.volume");
    block mixed = brick;
    mixed.mixed = true;
    block_make(&mixed, &m);
    model_find(&m, "element.mix")->i32[1] = model_find(&m, "element.volume")->i32[1];
    refused(&m, "element.mix of element 1 repeats the volume of the element; expected another, or -1");
    block_make(&mixed, &m);
    model_remove(&m, "element.mixture");
    refused(&m, "element.mixture");
    block_make(&brick, &m);
    model_find(&m, "material.nu")->f64[0] = .5;
    refused(&m, "nu");
}

static void test_start(void)
{
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    frame f = {.index = 4, .time = .25};
    notes warnings = {0};
    err e = {0};
    block_make(&brick, &m);
    tled_problem_make(&p, &m, &s, PHYSICAL, &e);
    ok(tled_problem_start(&p, &f, &warnings, &e) && strstr(e.text, "frame 4 has no node.displacement"), "%s", e.text);
    e = (err){0};
    frame_add(&f, &m, "node.displacement", &e)->f64[5] = .001;
    ok(!tled_problem_start(&p, &f, &warnings, &e) && warnings.count == 1, "a frame without velocity is warned of");
    ok(p.start == .25 && p.at_start.of[TLED_DISPLACEMENT][5] == .001, "the start is the frame's");
    model_array *v = frame_add(&f, &m, "node.velocity", &e);
    for (int i = 0; i < 6; i++)
        v->f64[i] = 1;
    ok(!tled_problem_start(&p, &f, &warnings, &e) && warnings.count == 1 && p.at_start.of[TLED_VELOCITY][5] == 1 &&
           p.at_start.of[TLED_VELOCITY][0] == 0,
       "and its velocity, but for what is held still");
    notes_free(&warnings);
    frame_free(&f);
    tled_problem_free(&p);
    model_free(&m);
}

int main(void)
{
    test_arrays();
    test_loose(false);
    test_loose(true);
    test_reach();
    test_refused();
    test_start();
    return done_testing();
}
