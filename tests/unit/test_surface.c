/* Surfaces carried by a model, and their names. */
#include "surface/surface.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void test_names(void)
{
    static const char *const cases[][2] = {
        {"a/b/face.obj", "face"},
        {"face.OBJ.gz", "face"},
        {"fa ce(1).obj", "fa_ce_1_"},
        {"-", "stdin"},
        {"/x/m\xc3\xbcnze", "m__nze"},
        {"v.2-b_3.obj", "v.2-b_3"},
        {".obj", ".obj"},
        {"a.gz", "a"},
        {"x-wing.obj", "x_wing"},
        {"X-wing.obj", "X-wing"},
    };
    char name[64];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        surface_name(cases[i][0], name, sizeof name);
        ok(!strcmp(name, cases[i][1]), "name of %s: %s", cases[i][0], name);
    }
    char small[4];
    surface_name("abcdef.obj", small, sizeof small);
    ok(!strcmp(small, "abc"), "a name cut to its room");
    ok(surface_in_group("skin left", "SKIN") && surface_in_group("skin left", "left") &&
           surface_in_group("skin muscle_zyg", "muscle*") && surface_in_group("a", "*"),
       "in a group: any case, any of its names, a pattern's start");
    ok(!surface_in_group("skin left", "skin left") && !surface_in_group("skinny", "skin") &&
           !surface_in_group("", "*") && !surface_in_group("bone", "bones"),
       "not in a group");
}

static void test_carried(void)
{
    static const char text[] = "v 1 2 3\nv 4 5 6\nv 7 8 10\ng a b\nf 1 2 3\ng c\nl 3 1\np 2\n";
    model m = {0};
    err e = {0};
    obj o;
    surface s;
    in *source = in_memory(text, sizeof text - 1, "s.obj", &e);
    bool good =
        source && !obj_read(&o, source, &e) && !surface_add(&m, "s", &o, .001, &e) && !surface_of(&m, "s", &s, &e);
    in_close(source);
    if (!ok(good, "an OBJ carried: %s", e.text))
        return;
    ok(s.vertices == 3 && s.faces == 3 && s.corners == 6 && s.groups == 2, "counts");
    ok(s.position[4] == 5 * .001 && surface_end(&s, 0) == 3 && surface_end(&s, 2) == 6, "metres, faces");
    ok(s.vertex[3] == 2 && s.vertex[4] == 0 && s.vertex[5] == 1 && s.group[1] == 1, "corners, groups");
    ok(!strcmp(s.group_name[0], "a b") && !strcmp(s.group_name[1], "c"), "names of groups");
    ok(!surface_is(&s, &o, .001, &e), "it is this OBJ");
    ok(surface_is(&s, &o, .01, &e) && strstr(e.text, "s.obj:1: vertex 1 is 1 2 3, but"), "not in another unit: %s",
       e.text);
    o.position[8] = 9;
    e = (err){0};
    ok(surface_is(&s, &o, .001, &e) && strstr(e.text, "s.obj:3: vertex 3 is 7 8 9, but 7 8 10"), "what differs: %s",
       e.text);
    o.vertices = 2;
    e = (err){0};
    ok(surface_is(&s, &o, .001, &e) && strstr(e.text, "2 vertices, but the model's surface s has 3"), "%s", e.text);
    o.vertices = 3;
    e = (err){0};
    ok(surface_of(&m, "t", &s, &e) && strstr(e.text, "t/vertex.position"), "none of that name: %s", e.text);
    char longest[MODEL_NAME + 1];
    memset(longest, 'a', MODEL_NAME);
    longest[MODEL_NAME] = 0;
    e = (err){0};
    ok(surface_add(&m, longest, &o, .001, &e) && strstr(e.text, "too long"), "a name too long for its arrays: %s",
       e.text);
    ok(!surface_there(&m, longest) && !surface_part(&m, longest, "face.start"), "is not there");
    ok(surface_there(&m, "s") && surface_part(&m, "s", "face.start")->rows == 3, "what is there is found");
    e = (err){0};
    model_axis_add(&m, "x-s/vertex", 1, &e);
    model_add_as(&m, "x-s/vertex.position", MODEL_U8, "1", "x-s/vertex", 1, &e);
    ok(!surface_there(&m, "x-s") && surface_of(&m, "x-s", &s, &e) && strstr(e.text, "x-s/vertex.position"),
       "the user's arrays are no surface: %s", e.text);
    obj_free(&o);
    model_free(&m);
}

int main(void)
{
    test_names();
    test_carried();
    return done_testing();
}
