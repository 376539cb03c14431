/* Contraction centres, fibres and axes against sums done by hand; and which surfaces are rigid, by name.
 */
// needs: attach/rigid.c attach/muscle.c attach/muscle_fibres.c attach/attachment.c attach/fibre_rule.c
// needs: attach/fibre_field.c attach/shape/laplace.c
// needs: attach/shape/ring.c attach/muscle_shape.c attach/muscle_surface.c
#include "attach/muscle.h"
#include "attach/rigid.h"
#include "surface/surface.h"

#include "block.h"
#include "muscles_made.h"

#include <stdlib.h>

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
    muscles list;
    model m;
    bar(&m, "11000" /* y 0, z 0: x = 0 and .01, which two elements share */
            "00000"
            "11000"
            "00000");
    ok(!muscles_made(&m, &(opt_list){1, {"centre"}}, NULL, &list, &warnings, &e) && list.count == 2, "two muscles %s",
       e.text);
    const double *centre = model_find(&m, "muscle.centre")->f64;
    near_(centre[0], .005, 1e-15, "contraction centre x: each node once");
    near_(centre[1], 0, 1e-15, "y");
    near_(centre[2], .005, 1e-15, "z");
    ok(isnan(centre[3]) && isnan(centre[5]), "none for the other");
    ok(model_find(&m, "muscle.volume")->i32[0] == 1 && model_find(&m, "muscle.volume")->i32[1] == 2, "their volumes");
    ok(list.of[0].elements == 2 && list.of[0].rigid_nodes == 4 && list.of[1].elements == 1, "counts");
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
    muscles_free(&list);
    model_free(&m);
}

/* The contraction centre in an element's centre: the muscle's axis there; and in a muscle of one element, nothing. */
static void at_the_centre(void)
{
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    bar(&m, "11011"
            "11011"
            "11011"
            "11011");
    ok(!muscles_made(&m, &(opt_list){1, {"centre"}}, NULL, &list, &warnings, &e), "all corners rigid %s", e.text);
    ok(fibre(&m, 0)[0] == -1 && fibre(&m, 0)[1] == 0 && fibre(&m, 1)[0] == -1, "the axis, toward the centre");
    ok(fibre(&m, 3)[0] == 0, "one element alone has no axis");
    ok(warnings.count == 1 && strstr(warnings.line[0], "muscle_b has no node that is free: it will not contract"), "%s",
       warnings.count ? warnings.line[0] : "no warning");
    notes_free(&warnings);
    muscles_free(&list);
    model_free(&m);
}

/* --fibre axis on the bar: the fibre of the first muscle, and how many warnings. */
static void axis(const char *fixed, float x, int said, const char *what)
{
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    bar(&m, fixed);
    ok(!muscles_made(&m, &(opt_list){1, {"axis"}}, NULL, &list, &warnings, &e), "--fibre axis %s", e.text);
    ok(fibre(&m, 0)[0] == x && fibre(&m, 1)[0] == x && fibre(&m, 1)[1] == 0, "%s", what);
    ok(warnings.count == said && strstr(warnings.line[0], "muscle_b has no axis"), "%d warnings", said);
    notes_free(&warnings);
    muscles_free(&list);
    model_free(&m);
}

static void axes(void)
{
    axis("00000000000010000000", 1, 1, "along x, toward the centre"); /* muscle_b has neither centre nor axis */
    axis("10000000000000000000", -1, 1, "along x, toward a centre at the other end");
    axis("00000000000000000000", 1, 1, "no rigid node: the largest component is positive");
}

/* A straight row of voxels along (1, 2, -2) gives that axis, whatever lies across. */
static void slanted_axis(void)
{
    static const lattice grid = {{0, 0, 0}, {.001, .002, .002}};
    static const int32_t size[] = {9, 9, 9};
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    block(&m, &grid, size, 0);
    model_find(&m, "volume.muscle")->u8[2] = 1;
    for (int i = 0; i < 9; i++)
        model_find(&m, "element.volume")->i32[((8 - i) * 9 + i) * 9 + i] = 2;
    model_add(&m, "node.rigid", &e);
    model_find(&m, "node.rigid")->u8[node_at(size, 0, 0, 9)] = 1;
    ok(!muscles_made(&m, &(opt_list){1, {"axis"}}, NULL, &list, &warnings, &e) && list.count == 1,
       "nine voxels in a row %s", e.text);
    near_(list.of[0].axis[0], -1. / 3, 1e-12, "axis x");
    near_(list.of[0].axis[1], -2. / 3, 1e-12, "axis y");
    near_(list.of[0].axis[2], 2. / 3, 1e-12, "axis z");
    ok(!warnings.count, "no warning");
    notes_free(&warnings);
    muscles_free(&list);
    model_free(&m);
}

/* Elements mixed of two volumes count for both, by their shares. */
static void mixed(void)
{
    static const int32_t mix[] = {-1, 0, 1, 1};
    static const float share[] = {0, .25F, .25F, .5F};
    err e = {0};
    notes warnings = {0};
    muscles list;
    model m;
    bar(&m, "10001000000000000000");
    memcpy(model_add(&m, "element.mix", &e)->i32, mix, sizeof mix);
    memcpy(model_add(&m, "element.mixture", &e)->f32, share, sizeof share);
    ok(!muscles_made(&m, &(opt_list){1, {"axis"}}, NULL, &list, &warnings, &e), "elements mixed of two volumes %s",
       e.text);
    ok(list.of[0].elements == 4 && list.of[1].elements == 1, "of the second volume too");
    near_(list.of[0].weight, 1 + .75 + .25 + .5, 1e-12, "its shares");
    near_(list.of[1].weight, .5, 1e-12, "what it leaves the other");
    near_(list.of[0].middle[0], (1 * .005 + .75 * .015 + .25 * .025 + .5 * .035) / 2.5, 1e-12, "their middle");
    near_(list.of[0].centre[0], .5 * .04 / 1.5, 1e-9, "rigid nodes count by the part that it has there");
    ok(list.of[0].rigid_nodes == 2 && list.of[1].rigid_nodes == 1 && list.attached.count == 3,
       "two attachments and one");
    near_(list.of[1].centre[0], .04, 1e-9, "the other's");
    const float *second = model_find(&m, "element.mixfibre")->f32;
    ok(fibre(&m, 0)[0] == -1 && fibre(&m, 1)[0] == -1 && fibre(&m, 2)[0] == 0, "fibres of the first volume");
    ok(second[0] == 0 && second[3] == 0 && second[6] == -1 && second[9] == -1,
       "fibres of the second, where that is a muscle");
    notes_free(&warnings);
    muscles_free(&list);
    model_find(&m, "element.mix")->i32[3] = 2;
    ok(muscles_made(&m, &(opt_list){1, {"axis"}}, NULL, &list, &warnings, &e) &&
           strstr(e.text, "element.mix, row 3 repeats the volume of the element"),
       "%s", e.text);
    notes_free(&warnings);
    muscles_free(&list);
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

static void by_name(void)
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
    ok(rigid_collect(&r, &m, &(opt_list){1, {","}}, &e) && e.status == STATUS_USAGE, "%s", e.text);
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
    centres();
    at_the_centre();
    axes();
    slanted_axis();
    mixed();
    by_name();
    return done_testing();
}
