/* Scripts of a run: curves and their values, targets and their nodes, the command line's curves, and nonsense. */
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
#include "tled/problem/script.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* 3 x 3 x 3 nodes 1 cm apart from the origin, x fastest; the plane z = 0 is held by skull_left (x = 0) and skull_right
 * (x > 0); one element a volume; volumes skin, muscle_zyg (with a fibre), Muscle_lev (without), buccinator. */
static void make_model(model *m, err *e)
{
    static const char *const volume[] = {"skin", "muscle_zyg", "Muscle_lev", "buccinator"};
    *m = (model){0};
    model_axis_add(m, "node", 27, e);
    model_axis_add(m, "anchor", 3, e);
    model_axis_add(m, "volume", 4, e);
    model_axis_add(m, "element", 4, e);
    double *p = model_add(m, "node.position", e)->f64;
    for (int i = 0; i < 27; i++)
        p[3 * i] = .01 * (i % 3), p[3 * i + 1] = .01 * (i / 3 % 3), p[3 * i + 2] = .01 * (i / 9);
    int32_t *anchor = model_add(m, "node.anchor", e)->i32;
    for (int i = 0; i < 27; i++)
        anchor[i] = i < 9 ? i % 3 != 0 : -1;
    model_array *name = model_add(m, "anchor.name", e);
    model_set_text(name, 0, "skull_left", e);
    model_set_text(name, 1, "skull_right", e);
    model_set_text(name, 2, "bone", e);
    model_add(m, "volume.name", e);
    uint8_t *muscle = model_add(m, "volume.muscle", e)->u8;
    int32_t *of = model_add(m, "element.volume", e)->i32;
    for (int i = 0; i < 4; i++)
        model_set_text(model_find(m, "volume.name"), i, volume[i], e), muscle[i] = i > 0, of[i] = i;
    model_add(m, "element.lattice", e);
    model_add(m, "element.fibre", e)->f32[3] = 1;
}

static int read_text(script *s, const model *m, const char *text, err *e)
{
    in *source = in_memory(text, strlen(text), "s.txt", e);
    int status = source ? script_read(s, source, m, e) : -1;
    if (source)
        in_close(source);
    return status;
}

static double at(const script *s, int64_t curve, double time, int component)
{
    double value[3];
    script_value(s, &s->curve[curve], time, value);
    return value[component];
}

static void curves(const model *m)
{
    script s = {0};
    err e = {0};
    ok(!read_text(&s, m,
                  "0.5 contract zyg 0\n0.25 gravity 0,0,-9.81\n1.5 contract muscle_zyg 0.4\n1.5 contract zyg 0.1\n"
                  "2 contract zyg 1 # done\n",
                  &e),
       "a script is read: %s", e.text);
    ok(s.curves == 2 && s.keys == 5 && s.curve[0].key_count == 4 && s.curve[1].key_count == 1,
       "short and long name are one muscle: 2 curves");
    ok(s.curve[0].verb == SCRIPT_CONTRACT && s.curve[0].volume == 1 && s.curve[0].line == 1, "the muscle's volume");
    near_(at(&s, 0, 0, 0), 0, 0, "0 before the first key");
    near_(at(&s, 0, 1, 0), .2, 1e-15, "linear between keys");
    near_(at(&s, 0, 1.5 - 1e-9, 0), .4, 1e-8, "up to a jump");
    near_(at(&s, 0, 1.5, 0), .1, 0, "at a jump the later key");
    near_(at(&s, 0, 1.75, 0), .55, 1e-15, "linear after it");
    near_(at(&s, 0, 2, 0), 1, 0, "the last key, exactly");
    near_(at(&s, 0, 1e9, 0), 1, 0, "which holds");
    near_(at(&s, 1, .25 - 1e-12, 2), 0, 0, "no gravity before its key");
    near_(at(&s, 1, .25, 2), -9.81, 0, "gravity from its key on");
    near_(script_end(&s), 2, 0, "the end of the script");
    script_free(&s);
}

static void many_keys(const model *m)
{
    enum { KEYS = 1000 };
    char *text = malloc(KEYS * 64);
    size_t n = 0;
    script s = {0};
    err e = {0};
    for (int i = 0; text && i < KEYS; i++)
        n += (size_t)sprintf(text + n, "%d contract zyg %g\n%d gravity %d,0,0\n", i, i % 2 * .5, i, i);
    ok(text && !read_text(&s, m, text, &e), "2000 lines of two curves, interleaved: %s", e.text);
    double worst = 0;
    for (int i = 0; i < KEYS - 1; i++) {
        worst = fmax(worst, fabs(at(&s, 0, i + .5, 0) - .25));
        worst = fmax(worst, fabs(at(&s, 1, i + .5, 0) - (i + .5)));
    }
    near_(worst, 0, 1e-12, "each value is linear between its keys");
    script_free(&s);
    free(text);
}

static void forces(const model *m)
{
    script s = {0};
    err e = {0};
    ok(!read_text(&s, m,
                  "0 force 1cm,10mm,0.01 10.5mm 0,0,1\n1 force 0.01,0.01,0.01 0.0105 0,0,3\n0 force 0,0,0 1mm 1,0,0\n",
                  &e),
       "forces: %s", e.text);
    ok(s.curves == 2 && s.curve[0].key_count == 2, "suffixes do not matter: one target");
    ok(s.curve[0].node_count == 7 && s.curve[0].node_first == 0, "the node and its 6 neighbours within 10.5 mm");
    static const int32_t want[] = {4, 10, 12, 13, 14, 16, 22};
    ok(s.curve[0].node_count == 7 && !memcmp(s.node, want, sizeof want), "are these");
    ok(s.curve[1].node_count == 1 && s.node[s.curve[1].node_first] == 0, "a single node");
    near_(at(&s, 0, .5, 2), 2, 1e-15, "the total between keys");
    script_free(&s);
}

static void displacements(const model *m)
{
    script s = {0};
    err e = {0};
    ok(!read_text(&s, m,
                  "0 displace SKULL* -,0,1mm\n0.5 displace skull* -,2mm,0.001\n"
                  "0 displace 0,0,0.02,0.02,2cm,20mm 0,-,-\n0 displace 0,0,0,0.02,0.02,0 1mm,-,-\n",
                  &e),
       "displacements: %s", e.text);
    ok(s.curves == 3 && s.curve[0].key_count == 2 && s.curve[0].node_count == 9, "a pattern of surfaces, in any case");
    ok(s.curve[0].mask == 6 && s.curve[1].mask == 1, "free components");
    ok(s.curve[1].node_count == 9 && s.node[s.curve[1].node_first] == 18, "a box holds what lies on its faces");
    ok(s.curve[2].node_count == 9, "two targets may share nodes in other components");
    near_(at(&s, 0, .25, 1), .001, 1e-18, "metres between keys");
    near_(at(&s, 0, .25, 2), .001, 1e-18, "a constant");
    script_free(&s);
    ok(!read_text(&s, m, "0 displace skull_left 0,0,-5mm\n", &e) && s.curve[0].node_count == 3, "one surface: %s",
       e.text);
    near_(at(&s, 0, 0, 2), -.005, 1e-18, "a minus sign is not '-'");
    script_free(&s);
}

static void command_line(const model *m)
{
    script s = {0};
    err e = {0};
    double g[3] = {0, 0, -9.81};
    ok(!script_add_contract(&s, m, "zyg=0.4,buccinator=1", .2, &e), "-c: %s", e.text);
    ok(!script_add_gravity(&s, g, 0, &e), "-g");
    ok(s.curves == 3 && s.curve[0].volume == 1 && s.curve[1].volume == 3, "two muscles and gravity");
    near_(at(&s, 0, .1, 0), .2, 1e-15, "half of the ramp");
    near_(at(&s, 1, .2, 0), 1, 0, "its end");
    near_(at(&s, 2, 0, 2), -9.81, 0, "no ramp: at once");
    near_(script_end(&s), .2, 0, "the end");
    ok(!read_text(&s, m, "0 contract Muscle_lev 1\n", &e) && s.curve[3].key_first == 5, "and a script after it");
    near_(at(&s, 3, 0, 0), 1, 0, "whose keys come last");
    near_(at(&s, 1, .2, 0), 1, 0, "the others stay");
    ok(read_text(&s, m, "0 contract muscle_zyg 1\n", &e) == -1 && strstr(e.text, "s.txt:1: 'muscle_zyg' is set on"),
       "the same muscle in both: %s", e.text);
    script_free(&s);
}

/* Muscles that cannot contract: a warning where others can, an error where none can. want: what the message begins
 * with. */
static void muscles(const model *m, const char *list, int warned, int status, const char *want)
{
    script s = {0};
    err e = {0};
    notes warnings = {0};
    ok(!script_add_contract(&s, m, list, 0, &e) && script_check_muscles(&s, m, &warnings, &e) == (status ? -1 : 0) &&
           e.status == status,
       "-c %s: status %d", list, status);
    ok(warnings.count == warned, "%d warnings", warnings.count);
    const char *got = warned ? warnings.line[0] : "";
    if (status)
        got = e.text;
    ok(!strncmp(got, want, strlen(want)), "'%s'", got);
    script_free(&s);
    notes_free(&warnings);
}

static void muscles_without_fibres(const model *m)
{
    model bare;
    err e = {0};
    muscles(m, "zyg=1", 0, 0, "");
    muscles(m, "zyg=1,buccinator=1", 1, 0,
            "-c: buccinator will not contract: its elements (1) have no fibre; attach --fibre field");
    muscles(m, "buccinator=1", 0, STATUS_BAD, "-c: buccinator cannot contract: its elements (1) have no fibre; attach");
    muscles(m, "buccinator=1,lev=1", 0, STATUS_BAD, "-c: none of the 2 muscles can contract; buccinator: its elements");
    make_model(&bare, &e);
    model_remove(&bare, "element.fibre");
    muscles(&bare, "zyg=0,lev=0", 0, 0, "");
    muscles(&bare, "zyg=0,lev=.1", 0, STATUS_BAD, "-c: Muscle_lev cannot contract: the model has no fibres");
    muscles(&bare, "zyg=0.1", 0, STATUS_BAD,
            "-c: muscle_zyg cannot contract: the model has no fibres (element.fibre); run attach");
    model_remove(&bare, "element.lattice");
    muscles(&bare, "zyg=0.1", 0, STATUS_BAD,
            "-c: muscle_zyg cannot contract: its elements (1) have no fibre; expected");
    memset(model_find(&bare, "element.volume")->i32, 0, 4 * sizeof(int32_t));
    muscles(&bare, "zyg=1", 0, STATUS_BAD, "-c: muscle_zyg cannot contract: it has no elements; smaller voxels");
    ok(!e.status, "the model: %s", e.text);
    model_free(&bare);
}

static void muscles_that_are_held(void)
{
    model m;
    err e = {0};
    make_model(&m, &e);
    int32_t *node = model_add(&m, "element.node", &e)->i32;
    uint8_t *rigid = model_add(&m, "node.rigid", &e)->u8;
    for (int n = 0; n < 8; n++)
        node[8 + n] = 3 + n, rigid[3 + n] = n > 0;
    muscles(&m, "zyg=1", 0, 0, "");
    rigid[3] = 1;
    muscles(&m, "zyg=1", 0, STATUS_BAD,
            "-c: muscle_zyg cannot contract: all nodes of its elements with a fibre (1) are rigid");
    model_add(&m, "element.mix", &e)->i32[0] = 1; /* of the first element, whose node 0 is free */
    model_add(&m, "element.mixfibre", &e)->f32[1] = 1;
    for (int i = 1; i < 4; i++)
        model_find(&m, "element.mix")->i32[i] = -1;
    muscles(&m, "zyg=1", 0, 0, "");
    ok(!e.status, "the model: %s", e.text);
    model_free(&m);
}

static void refuse(const model *m, const char *text, const char *want)
{
    script s = {0};
    err e = {0};
    ok(read_text(&s, m, text, &e) == -1 && e.status == STATUS_BAD && strstr(e.text, want), "refused: %s", e.text);
    script_free(&s);
}

static void refuse_contract(const model *m, const char *list, const char *want)
{
    script s = {0};
    err e = {0};
    ok(script_add_contract(&s, m, list, 0, &e) == -1 && e.status == STATUS_USAGE && strstr(e.text, want), "-c '%s': %s",
       list, e.text);
    script_free(&s);
}

static void refuse_after_script(const model *m)
{
    script s = {0};
    err e = {0};
    double g[3] = {0};
    read_text(&s, m, "0 gravity 0,0,0\n0 contract zyg 1\n", &e);
    ok(script_add_gravity(&s, g, 0, &e) == -1 && strstr(e.text, "line 1 of the script"), "%s", e.text);
    e = (err){0};
    ok(script_add_contract(&s, m, "zyg=1", 0, &e) == -1 && strstr(e.text, "line 2 of the script"), "%s", e.text);
    script_free(&s);
}

/* Lines that are wrong by their form. */
static void refuse_forms(const model *m)
{
    refuse(m, "", "s.txt: nothing in it");
    refuse(m, "# only this\n", "s.txt: nothing in it");
    refuse(m, "\n-1 gravity 0,0,0", "s.txt:2: '-1' is not a time");
    refuse(m, "nan gravity 0,0,0", "s.txt:1: 'nan' is not a time");
    refuse(m, "1e999 gravity 0,0,0", "is not a time");
    refuse(m, "0.1s gravity 0,0,0", "is not a time");
    refuse(m, "gravity 0,0,0", "'gravity' is not a time; expected TIME VERB");
    refuse(m, "0", "s.txt:1: a time alone");
    refuse(m, "0 contact zyg 1", "unknown verb 'contact'; did you mean 'contract'?");
    refuse(m, "0 contract zyg", "3 words; expected TIME contract MUSCLE LEVEL");
    refuse(m, "0 contract zyg 1 2", "5 words; expected TIME contract");
    refuse(m, "0 gravity 0 0 -9.81", "5 words; expected TIME gravity X,Y,Z");
    refuse(m, "0 gravity 0,0", "'0,0'; expected X,Y,Z in m/s2");
    refuse(m, "0 gravity 0,0,nan", "expected X,Y,Z in m/s2");
    refuse(m, "0 gravity 0,0,0,0", "expected X,Y,Z in m/s2");
    refuse(m, "0 gravity 0,0,1\n1 gravity 0,0,2\n0.5 gravity 0,0,3", "s.txt:3: time 0.5 s comes after 1 s");
}

static void refuse_targets(const model *m)
{
    refuse(m, "0 contract zyo 1", "unknown muscle 'zyo'; did you mean 'zyg'? expected one of: zyg, lev, buccinator");
    refuse(m, "0 contract muscle_zgg 1", "did you mean 'muscle_zyg'?");
    refuse(m, "0 contract skin 1", "unknown muscle 'skin'");
    refuse(m, "0 contract zyg 1.5", "level '1.5'; expected a number from 0 to 1");
    refuse(m, "0 contract zyg -0.1", "level '-0.1'");
    refuse(m, "0 contract zyg 40%", "level '40%'");
    refuse(m, "0 force 0,0,0 0 1,0,0", "radius '0'; expected more than 0");
    refuse(m, "0 force 0,0,0 -1mm 1,0,0", "radius '-1mm'");
    refuse(m, "0 force 0,0 1mm 1,0,0", "'0,0'; expected X,Y,Z: a point");
    refuse(m, "0 force 0,0,0 1mm,2mm 1,0,0", "expected a radius");
    refuse(m, "0 force 0,0,0 1pt 1,0,0", "expected a radius");
    refuse(m, "0 force 0,0,0 1mm 1N,0,0", "expected FX,FY,FZ in N");
    refuse(m, "0 force 0,0,0.05 1mm 1,0,0", "no node lies within 0.001 m of 0,0,0.05; the nearest is 0.03 m away");
    refuse(m, "0 force 1e305in,0,0 1mm 1,0,0", "expected X,Y,Z");
    refuse(m, "0 displace skul 0,0,0", "unknown rigid surface 'skul'");
    refuse(m, "0 displace bonne 0,0,0", "did you mean 'bone'?");
    refuse(m, "0 displace bone 0,0,0", "no node is held by 'bone'");
    refuse(m, "0 displace 0,0,0,1,1 0,0,0", "expected X0,Y0,Z0,X1,Y1,Z1");
    refuse(m, "0 displace 0,0,1,1,1,0 0,0,0", "is empty: 1 > 0");
    refuse(m, "0 displace 1,1,1,2,2,2 0,0,0", "no node lies in the box");
    refuse(m, "0 displace skull* -,-,-", "leaves all components free");
    refuse(m, "0 displace skull* 0,0", "expected UX,UY,UZ");
    refuse(m, "0 displace skull* 0,0,0,0", "expected UX,UY,UZ");
    refuse(m, "0 displace skull* 0,,0", "expected UX,UY,UZ");
    refuse(m, "0 displace skull* 0,--,0", "expected UX,UY,UZ");
    refuse(m, "0 displace skull* 0,0,1\n1 displace SKULL* 0,-,1",
           "s.txt:2: '0,-,1' frees other components than line 1");
    refuse(m, "0 displace skull* 0,-,-\n0 displace skull_left 1,-,-",
           "s.txt:2: component x of node 0 is displaced by line 1 too");
}

int main(void)
{
    model m;
    err e = {0};
    make_model(&m, &e);
    if (!ok(!e.status, "a model: %s", e.text))
        return done_testing();
    curves(&m);
    many_keys(&m);
    forces(&m);
    displacements(&m);
    command_line(&m);
    muscles_without_fibres(&m);
    muscles_that_are_held();
    refuse_after_script(&m);
    refuse_forms(&m);
    refuse_targets(&m);
    refuse_contract(&m, "zyg", "expected MUSCLE=LEVEL");
    refuse_contract(&m, "", "expected MUSCLE=LEVEL");
    refuse_contract(&m, "zyg=0.4,", "expected MUSCLE=LEVEL");
    refuse_contract(&m, "=1", "expected MUSCLE=LEVEL");
    refuse_contract(&m, "zyg=", "level ''");
    refuse_contract(&m, "zyg=2", "level '2' of zyg; expected a number from 0 to 1");
    refuse_contract(&m, "zyg=0.1,muscle_zyg=0.2", "given twice");
    refuse_contract(&m, "zyh=1", "-c: unknown muscle 'zyh'; did you mean 'zyg'?");
    model_free(&m);
    return done_testing();
}
