/* The model in memory: its lists, its rules, and what a tool that changes an axis loses. */
#include "base/chars.h"
#include "model/check.h"
#include "model/known.h"
#include "model/model.h"

#include "tap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static bool says(const err *e, const char *part)
{
    if (e->status && strstr(e->text, part))
        return true;
    printf("# got '%s', wanted '%s'\n", e->text, part);
    return false;
}

static void test_meta(void)
{
    model m = {0};
    err e = {0};
    double v[3] = {0.1, -0.0, 1e300}, got[3];
    ok(!model_meta_of(&m, "source.unit"), "no metadata at first");
    ok(!model_meta_set(&m, "source.unit", "cm", &e) && !model_meta_set(&m, "source.unit", "mm", &e) && m.metas == 1 &&
           !strcmp(model_meta_of(&m, "source.unit"), "mm"),
       "a key that is set again has the new value");
    ok(!model_meta_set_numbers(&m, "v", v, 3, &e) && !model_meta_numbers(&m, "v", got, 3, &e) && got[0] == v[0] &&
           got[1] == 0 && signbit(got[1]) && got[2] == v[2],
       "numbers come back bit by bit: %s", model_meta_of(&m, "v"));
    ok(model_meta_numbers(&m, "v", got, 2, &e) && says(&e, "no more than 2 numbers"), "too many numbers");
    e = (err){0};
    ok(model_meta_numbers(&m, "source.unit", got, 1, &e) && says(&e, "expected 1 number"), "no number");
    e = (err){0};
    ok(model_meta_numbers(&m, "w", got, 1, &e) && says(&e, "no metadata w"), "numbers that are not there");
    e = (err){0};
    ok(model_meta_set(&m, "a b", "", &e) && says(&e, "expected a key"), "a key with a space");
    e = (err){0};
    ok(model_meta_set(&m, "k", "\xff", &e) && says(&e, "not UTF-8"), "a value that is not UTF-8");
    e = (err){0};
    bool all = true;
    for (int i = 0; i < 1000; i++) {
        char key[20];
        snprintf(key, sizeof key, "k%d", i);
        all = all && !model_meta_set(&m, key, key, &e);
    }
    ok(all && m.metas == 1002 && !strcmp(model_meta_of(&m, "k999"), "k999"), "a thousand keys");
    model_free(&m);
    ok(!m.meta && !m.metas, "a freed model is an empty one");
}

static void test_provenance(void)
{
    model m = {0};
    err e = {0};
    ok(!model_prov_add(&m, "voxelise", "0.1.0", "-s 2 a.obj", &e) && !strcmp(m.prov[0], "voxelise 0.1.0 -s 2 a.obj"),
       "tool, version and options");
    ok(!model_prov_add(&m, "attach", "0.1.0", "", &e) && !strcmp(m.prov[1], "attach 0.1.0"), "no options");
    ok(!model_prov_add(&m, "bind", "0.1.0", "caf\xe9.obj", &e) && !strcmp(m.prov[2], "bind 0.1.0 caf?.obj"),
       "a file name that is not UTF-8 is mended");
    ok(model_prov_add(&m, "a b", "1", "", &e) && says(&e, "expected a tool"), "a tool's name with a space");
    model_free(&m);
}

static void test_axes(void)
{
    model m = {0};
    err e = {0};
    ok(model_count(&m, "node") == -1, "no axis at first");
    ok(!model_axis_add(&m, "node", 3, &e) && !model_axis_add(&m, "node", 3, &e) && m.axis_count == 1,
       "an axis added again with its count is one axis");
    ok(model_axis_add(&m, "node", 4, &e) && says(&e, "axis node of 3 already"), "the same axis with another count");
    e = (err){0};
    ok(model_axis_add(&m, "a b", 4, &e) && says(&e, "expected a name"), "an axis with a space");
    e = (err){0};
    ok(model_axis_add(&m, "n", -1, &e), "a negative count");
    model_free(&m);
}

static void test_arrays(void)
{
    model m = {0};
    err e = {0};
    model_axis_add(&m, "node", 3, &e);
    model_axis_add(&m, "volume", 2, &e);
    model_array *a = model_add(&m, "node.position", &e);
    ok(a && a->type == MODEL_F64 && a->columns == 3 && a->rows == 3 && !strcmp(a->unit, "m") && a->f64[8] == 0,
       "a known array has its type, unit and columns, and is zeroed");
    a = model_add(&m, "volume.name", &e);
    ok(a && !strcmp(a->str[1], ""), "strings begin empty");
    ok(a && !model_set_text(a, 1, "skin", &e) && !strcmp(a->str[1], "skin"), "a string is set");
    ok(a && model_set_text(a, 1, "\xc0\x80", &e) && says(&e, "not UTF-8") && !strcmp(a->str[1], "skin"),
       "one that is not UTF-8 is not");
    e = (err){0};
    a = model_find(&m, "node.position");
    a->f64[0] = 7;
    a = model_add(&m, "node.position", &e);
    ok(a == &m.arrays.v[0] && m.arrays.count == 2 && a->f64[0] == 0, "an array added again is replaced where it stood");
    ok(!model_add(&m, "element.node", &e) && says(&e, "no axis element"), "an array over no axis");
    e = (err){0};
    ok(!model_add(&m, "node.colour", &e) && says(&e, "not known"), "an array that the table lacks");
    e = (err){0};
    ok(!model_add(&m, "node.displacement", &e) && says(&e, "not known"), "an array of frames in the body");
    e = (err){0};
    ok(!model_need(&m, "node.rigid", &e) && says(&e, "expected a model from attach"), "the tool that is missing");
    e = (err){0};
    ok(!model_add_as(&m, "x-b", MODEL_F64, "1", "node", 0, &e) && says(&e, "too many"), "no column");
    model_free(&m);
}

static void test_too_large(void)
{
    model m = {0};
    err e = {0};
    model_axis_add(&m, "node", INT64_MAX, &e);
    ok(!model_add(&m, "node.position", &e) && says(&e, "too many"), "rows x columns that overflow");
    model_free(&m);
}

static void test_frames(void)
{
    model m = {0};
    frame f = {0};
    err e = {0};
    model_axis_add(&m, "node", 3, &e);
    ok(frame_add(&f, &m, "node.displacement", &e) && frame_find(&f, "node.displacement")->rows == 3, "a frame's array");
    ok(!frame_add(&f, &m, "node.position", &e) && says(&e, "in frames"), "an array of the body in a frame");
    static const double numbers[9] = {0};
    e = (err){0};
    ok(!frame_lend(&f, &m, "element.history", "1", "element", 3, numbers, &e) && says(&e, "no axis element"),
       "nor may one be lent that has no axis");
    frame_free(&f);
    model_free(&m);
}

static void add(model *m, const char *name, model_type type, const char *unit, const char *axis)
{
    err e = {0};
    if (!model_add_as(m, name, type, unit, axis, 1, &e))
        printf("# %s\n", e.text);
}

static void test_drop(void)
{
    model m = {0};
    notes n = {0};
    err e = {0};
    model_axis_add(&m, "node", 3, &e);
    model_axis_add(&m, "element", 1, &e);
    model_add(&m, "node.position", &e);
    model_add(&m, "element.node", &e);
    add(&m, "x-over", MODEL_U8, "1", "node");
    add(&m, "x-to", MODEL_I32, "@node", "element");
    add(&m, "x-stays", MODEL_U8, "1", "element");
    model_axis_drop(&m, "node", &n);
    ok(m.arrays.count == 1 && model_find(&m, "x-stays"), "what is over the axis or points to it goes");
    ok(model_count(&m, "node") == -1 && model_count(&m, "element") == 1, "the axis goes");
    ok(n.count == 2 && strstr(n.line[0], "x-to") && strstr(n.line[1], "x-over"), "unknown arrays are said, known not");
    model_axis_drop(&m, "nothing", &n);
    ok(n.count == 2 && m.axis_count == 1, "an axis that is not there");
    model_remove(&m, "x-stays");
    model_remove(&m, "x-stays");
    ok(m.arrays.count == 0, "removed");
    notes_free(&n);
    model_free(&m);
}

static void test_surfaces(void)
{
    model m = {0};
    err e = {0};
    char name[64];
    int at = 0;
    model_axis_add(&m, "node", 3, &e);
    model_axis_add(&m, "a/vertex", 3, &e);
    model_axis_add(&m, "/vertex", 3, &e);
    model_axis_add(&m, "a/face", 3, &e);
    model_axis_add(&m, "x-b/vertex", 3, &e);
    model_axis_add(&m, "b/c/vertex", 3, &e);
    ok(model_surface(&m, &at, name, sizeof name) && !strcmp(name, "a"), "the first surface");
    ok(model_surface(&m, &at, name, sizeof name) && !strcmp(name, "b/c"), "the second, with a slash in its name");
    ok(!model_surface(&m, &at, name, sizeof name), "no third: one that begins x- is the user's");
    model_free(&m);
}

static void test_known(void)
{
    char text[64];
    ok(known_find("node.position") == known_row(0) && !known_find("node.colour"), "rows by name");
    const known *k = known_find("a/b/face.start");
    ok(k && !strcmp(k->name, "*/face.start"), "a surface's row, whatever its name");
    ok(!known_find("/face.start") && !known_find("*/x") && !known_find("face.start"), "no surface without a name");
    known_expand(k->unit, "a/b/face.start", text, sizeof text);
    ok(!strcmp(text, "@a/b/corner"), "the * of a unit is the surface's name: %s", text);
    known_expand("node", "a/b/face.start", text, sizeof text);
    ok(!strcmp(text, "node"), "no * stays");
    int rows = 0;
    bool good = true;
    for (; (k = known_row(rows)); rows++)
        good = good && check_unit(k->unit[0] == '@' && k->unit[1] == '*' ? "@s" : k->unit) &&
               k->columns_min <= k->columns_max && k->columns_min > 0 && known_find(k->name) == k;
    ok(good && rows > 20 && !known_row(-1), "each of the %d rows is found under its name", rows);
}

static void test_names(void)
{
    char name[MODEL_NAME + 1];
    memset(name, 'a', sizeof name);
    name[MODEL_NAME - 1] = 0;
    ok(check_name(name) && check_name("a/b.c_D-9"), "names");
    name[MODEL_NAME - 1] = 'a';
    name[MODEL_NAME] = 0;
    ok(!check_name(name) && !check_name("") && !check_name("a b") && !check_name("a\"") && !check_name("\xc3\xa9"),
       "no names");
    ok(check_unit("kg/m3") && check_unit("1") && check_unit("@a/b") && check_unit("%"), "units");
    ok(!check_unit("") && !check_unit("@") && !check_unit("a b") && !check_unit("\"") && !check_unit("@a b"),
       "no units");
    ok(check_type("aB09") && !check_type("aB0") && !check_type("aB09x") && !check_type("a b "), "types of blocks");
}

static void test_utf8(void)
{
    static const char *const good[] = {"",
                                       "a",
                                       "\xc2\x80",
                                       "\xdf\xbf",
                                       "\xe0\xa0\x80",
                                       "\xed\x9f\xbf",
                                       "\xee\x80\x80",
                                       "\xef\xbf\xbf",
                                       "\xf0\x90\x80\x80",
                                       "\xf4\x8f\xbf\xbf"};
    static const char *const bad[] = {"\x80",     "\xc0\x80",         "\xc1\xbf",         "\xc2",
                                      "\xc2\x41", "\xe0\x9f\xbf",     "\xed\xa0\x80",     "\xe2\x82",
                                      "\xff",     "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80"};
    bool all = true, none = true;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        all = all && chars_utf8(good[i]);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        none = none && !chars_utf8(bad[i]);
    ok(all, "well-formed UTF-8, to the ends of each length");
    ok(none, "overlong, surrogate, cut and stray bytes are not");
    char text[] = "a\xc3\xa9\xe9 b\xe2\x82";
    chars_mend(text);
    ok(!strcmp(text, "a\xc3\xa9? b??"), "mended: %s", text);
}

/* 4 GiB of 'a', of 2 MiB of memory mapped again and again; NULL where that cannot be. */
static char *huge_text(size_t size, size_t piece)
{
    FILE *f = tmpfile();
    char *all = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    bool good = f && all != MAP_FAILED;
    for (size_t i = 0; good && i < piece; i++)
        good = putc('a', f) == 'a';
    good = good && !fflush(f);
    for (size_t at = 0; good && at + piece < size; at += piece)
        good = mmap(all + at, piece, PROT_READ, MAP_SHARED | MAP_FIXED, fileno(f), 0) != MAP_FAILED;
    if (f)
        fclose(f);
    if (!good && all != MAP_FAILED)
        munmap(all, size);
    return good ? all : NULL;
}

/* The last piece of the mapping is zero, so the text is 4 GiB long: one byte more than a length can say. */
static void test_huge(void)
{
    size_t piece = (size_t)1 << 21, size = ((size_t)1 << 32) + piece;
    char *text = huge_text(size, piece);
    model m = {0};
    err e = {0};
    if (!text) {
        skip(2, "no address space for a string of 4 GiB");
        return;
    }
    ok(model_meta_set(&m, "key", text, &e) && says(&e, "metadata key: its value is longer than 4294967295 bytes"),
       "metadata of 4 GiB: %s", e.text);
    e = (err){0};
    model_axis_add(&m, "x-n", 1, &e);
    model_array *a = model_add_as(&m, "x-s", MODEL_STR, "1", "x-n", 1, &e);
    char *was = a->str[0];
    a->str[0] = text;
    ok(model_check(&m, a, "place", 0, &e) && says(&e, "row 0: a string is longer"), "a string of 4 GiB: %s", e.text);
    a->str[0] = was;
    munmap(text, size);
    model_free(&m);
}

static int checked(model *m, const char *name, err *e)
{
    *e = (err){0};
    return model_check(m, model_find(m, name), "place", 10, e);
}

static void test_check(void)
{
    model m = {0};
    err e = {0};
    model_axis_add(&m, "node", 3, &e);
    model_axis_add(&m, "element", 2, &e);
    model_axis_add(&m, "s/face", 3, &e);
    model_axis_add(&m, "s/corner", 9, &e);
    model_array *a = model_add(&m, "element.node", &e);
    ok(!checked(&m, "element.node", &e), "indices in range");
    a->i32[9] = 3;
    ok(checked(&m, "element.node", &e) &&
           says(&e, "place:12: array element.node, row 1: 3 is not an index into axis node; "
                    "expected 0 to 2"),
       "past the end, with its row's line");
    a->i32[9] = -1;
    ok(checked(&m, "element.node", &e) && says(&e, "expected 0 to 2"), "none where each must have one");
    add(&m, "x-i", MODEL_I64, "@node", "element");
    model_find(&m, "x-i")->i64[1] = -1;
    ok(!checked(&m, "x-i", &e), "-1, none, in another array of indices");
    model_find(&m, "x-i")->i64[0] = -2;
    ok(checked(&m, "x-i", &e) && says(&e, "place:11") && says(&e, "expected -1 to 2"), "-2");
    add(&m, "x-f", MODEL_F32, "@node", "element");
    ok(checked(&m, "x-f", &e) && says(&e, "has type f32; expected i32 or i64"), "indices that are no integers");
    add(&m, "x-n", MODEL_I32, "@nowhere", "element");
    ok(checked(&m, "x-n", &e) && says(&e, "points to axis nowhere"), "indices into no axis");
    a = model_add(&m, "s/face.start", &e);
    ok(checked(&m, "s/face.start", &e) && says(&e, "place:12") &&
           says(&e, "row 1: 0; expected 0 first, then each more"),
       "an empty face");
    a->i64[0] = 1, a->i64[1] = 2, a->i64[2] = 3;
    ok(checked(&m, "s/face.start", &e) && says(&e, "place:11"), "a first face that does not start at 0");
    a->i64[0] = 0;
    ok(!checked(&m, "s/face.start", &e), "faces of 2, 1 and 6 corners");
    model_free(&m);
}

static void known_as(model_type type, const char *unit, const char *axis, int columns, const char *what)
{
    model m = {0};
    err e = {0};
    model_axis_add(&m, "element", 1, &e);
    model_axis_add(&m, "node", 1, &e);
    model_add_as(&m, "element.node", type, unit, axis, columns, &e);
    ok(*what ? checked(&m, "element.node", &e) && says(&e, what) : !checked(&m, "element.node", &e),
       "element.node %s %s %s %d", model_type_name(type), unit, axis, columns);
    model_free(&m);
}

int main(void)
{
    test_meta();
    test_provenance();
    test_axes();
    test_arrays();
    test_too_large();
    test_frames();
    test_drop();
    test_surfaces();
    test_known();
    test_names();
    test_utf8();
    test_huge();
    test_check();
    known_as(MODEL_I32, "@node", "element", 8, "");
    known_as(MODEL_I32, "@node", "element", 4, "");
    known_as(MODEL_I32, "@node", "element", 6, "8 (hexahedra) or 4 (tetrahedra)");
    known_as(MODEL_I32, "@node", "element", 9, "8 (hexahedra) or 4 (tetrahedra)");
    known_as(MODEL_I64, "@node", "element", 8, "expected i32");
    known_as(MODEL_I32, "1", "element", 8, "expected @node");
    known_as(MODEL_I32, "@node", "node", 8, "expected element");
    return done_testing();
}
