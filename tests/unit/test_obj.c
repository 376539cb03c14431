/* OBJ files: every form of index, groups, continuations; written again to the byte; nonsense refused with its line. */
#include "surface/obj.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static int read_bytes(const void *text, size_t size, obj *o, err *e)
{
    *e = (err){0};
    in *s = in_memory(text, size, "m.obj", e);
    int code = s ? obj_read(o, s, e) : -1;
    in_close(s);
    return code;
}

static obj read_good(const char *text)
{
    obj o;
    err e;
    if (read_bytes(text, strlen(text), &o, &e))
        ok(false, "reads: %s", e.text);
    return o;
}

/* The text as obj_write gives it is the wanted one. */
static bool writes(const obj *o, const double *position, const double *normal, const char *want)
{
    err e = {0};
    out *to = out_memory(&e);
    size_t size;
    obj_write(o, position, normal, to);
    const unsigned char *bytes = out_bytes(to, &size);
    bool same = size == strlen(want) && !memcmp(bytes, want, size);
    if (!same)
        printf("# wrote '%.*s'\n", (int)size, (const char *)bytes);
    out_discard(to);
    return same;
}

static bool corners_are(const obj *o, int64_t face, const char *want)
{
    char got[200] = "";
    for (int64_t c = o->face_start[face]; c < o->face_start[face + 1]; c++) {
        size_t n = strlen(got);
        snprintf(got + n, sizeof got - n, "%s%d", n ? " " : "", o->corner_vertex[c]);
        if (o->corner_normal[c] >= 0)
            snprintf(got + strlen(got), sizeof got - strlen(got), "/%d", o->corner_normal[c]);
    }
    bool same = !strcmp(got, want);
    if (!same)
        printf("# face %d is '%s', wanted '%s'\n", (int)face, got, want);
    return same;
}

static const char *group_of(const obj *o, int64_t face)
{
    return o->group[o->face_group[face]];
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void test_forms(void)
{
    obj o = read_good(SQUARE "vt 0 0\nvn 0 0 1\nvn 0 0 2\n"
                             "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//2 3//1\nf 1/1/2 2/1/2 3/1/1 4/1/1\n"
                             "f -4 -3 -2 -1\nf -4//-2 -3//-1 -2//-1\np 1 -1\nl 1 2 3\nl 1/1 -1/-1\nfo 2 3 4\n");
    ok(o.vertices == 4 && o.normals == 2 && o.faces == 12, "counts: %d vertices, %d faces", (int)o.vertices,
       (int)o.faces);
    ok(corners_are(&o, 0, "0 1 2") && corners_are(&o, 1, "0 1 2"), "v and v/vt");
    ok(corners_are(&o, 2, "0/0 1/1 2/0") && corners_are(&o, 3, "0/1 1/1 2/0 3/0"), "v//vn and v/vt/vn");
    ok(corners_are(&o, 4, "0 1 2 3") && corners_are(&o, 5, "0/0 1/1 2/1"), "negative indices");
    ok(corners_are(&o, 6, "0") && corners_are(&o, 7, "3"), "points, one a vertex");
    ok(corners_are(&o, 8, "0 1") && corners_are(&o, 9, "1 2") && corners_are(&o, 10, "0 3"), "lines, one a segment");
    ok(corners_are(&o, 11, "1 2 3"), "fo, the old word for a face");
    obj_free(&o);
    o = read_good("v 0 0 0\nv 1 0 0\nf -2 -1 3\nv 1 1 0\nf -3 -2 -1\n");
    ok(corners_are(&o, 0, "0 1 2") && corners_are(&o, 1, "0 1 2"), "negative: from here; positive: ahead too");
    obj_free(&o);
    o = read_good("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 1e0 +1 -0.0 1 0 0 1\nv 1 2 3 1 .1 .2 .3 1\n");
    ok(o.vertices == 4 && o.position[6] == 1 && o.position[11] == 3 && !o.faces, "weights and colours; no faces");
    obj_free(&o);
    o = read_good("");
    ok(!o.vertices && !o.faces && o.face_start && o.face_start[0] == 0, "an empty file");
    obj_free(&o);
}

static void test_groups(void)
{
    obj o = read_good(SQUARE "f 1 2 3\ng skin\nf 1 2 3\ng skin  left\t\nf 1 2 3\no the head\nf 1 2 3\ng skin\nf 1 2 3\n"
                             "g\nf 1 2 3\no\nf 1 2 3\ng m\xc3\xbc nie\n");
    ok(!strcmp(group_of(&o, 0), "default"), "before any group: default");
    ok(!strcmp(group_of(&o, 1), "skin") && !strcmp(group_of(&o, 2), "skin left"), "one and several names");
    ok(!strcmp(group_of(&o, 3), "the_head"), "an object names faces where no group does");
    ok(o.face_group[4] == o.face_group[1], "the same name is the same group");
    ok(!strcmp(group_of(&o, 5), "default") && !strcmp(group_of(&o, 6), "default"), "g and o without names");
    ok(o.groups == 5 && !strcmp(o.group[4], "m\xc3\xbc nie"), "groups in order of first mention, unused ones too");
    obj_free(&o);
    char *many = calloc(1, 5000 * 32 + 64), *p = many + sprintf(many, "v 0 0 0\n");
    for (int i = 0; i < 5000; i++)
        p += sprintf(p, "g group%d\np 1\n", i % 4000);
    o = read_good(many);
    ok(o.groups == 4000 && o.face_group[4999] == 999, "4000 groups");
    obj_free(&o);
    free(many);
}

static void test_lines(void)
{
    obj o = read_good("\xef\xbb\xbf# mark\r\n  v 0 0 \\\r\n 0\r\n\tv\t1 0 0 # here\r\n\r\nv 1 1 0\r\nf 1 2 \\\r\n3\r\n"
                      "# C:\\dir\\\r\nf 1 2 3\r\nmtllib a \\\r\n b\r\nf 3 2 1");
    ok(o.vertices == 3 && o.faces == 3, "CR LF, continuations, comments, a byte order mark, no last line end");
    double moved[9] = {0, 0, 1, 1, 0, 0, 1.5, 1, 0};
    ok(writes(&o, moved, NULL,
              "\xef\xbb\xbf# mark\r\n  v 0 0 1\r\n\tv\t1 0 0 # here\r\n\r\nv 1.5 1 0\r\nf 1 2 \\\r\n3\r\n"
              "# C:\\dir\\\r\nf 1 2 3\r\nmtllib a \\\r\n b\r\nf 3 2 1"),
       "written: a moved vertex on one line, the others as they were");
    obj_free(&o);
    o = read_good("v 1.50 2.0 3 .1 \\\n.2 .3 # red\nvn 0 0 1\nv 0 0 0\nvn 0 1 0 # up\ns off\nv 4 4 4");
    double place[9] = {1. / 3, -0.0, 1e-9, 0, 0, 0, 4, 4, 5}, normal[6] = {0, 0, 1, 0.6, 0.8, 0};
    ok(writes(&o, place, normal,
              "v 0.333333333 -0 1e-09 .1  .2 .3 # red\nvn 0 0 1\nv 0 0 0\nvn 0.6 0.8 0 # up\ns off\nv 4 4 5"),
       "written: colours and comments stay; normals and vertices in any order");
    ok(writes(&o, o.position, o.normal, o.text) && writes(&o, o.position, NULL, o.text), "written: nothing moved");
    obj_free(&o);
}

/* A surface far from the origin keeps nine digits of its own extent; vertices of no face do not count. */
static void test_far(void)
{
    static const struct {
        const char *text;
        double x;
        const char *line; /* the first, with x */
    } far[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1. / 3, "v 0.333333333 0 0"},
        {"v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1. / 3, "v 0.333333333 0 0"},
        {"v 1 0 0\nv 2 0 0\nv 1 1 0\nf 1 2 3\n", 4. / 3, "v 1.333333333 0 0"},
        {"v 999999 0 0\nv 1e6 0 0\nv 1e6 1 0\nf 1 2 3\n", 999999 + 1. / 3, "v 999999.333333333 0 0"},
        {"v 999900 -2e6 3e6\nv 1e6 -2e6 3e6\nv 1e6 -2000100 3e6\nf 1 2 3\n", 999900 + 1. / 3,
         "v 999900.33333333 -2000000 3000000"},
        {"v 0 0 1e9\nv 0 0 1e9\nv 0 0 1e9\nf 1 2 3\n", 1. / 3, "v 0.33333333333333331 0 1000000000"},
        {"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", 1. / 3, "v 0.333333333 0 0"},
        {"v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1e9 0 0\nf 1 2 3\n", 1. / 3, "v 0.333333333 0 0"},
        {"v 9 0 0\nv 10 0 0\nv 9 1 0\n", 9 + 1. / 3, "v 9.333333333 0 0"},
    };
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        obj o = read_good(far[i].text);
        double place[12];
        char want[200];
        memcpy(place, o.position, 3 * (size_t)o.vertices * sizeof *place);
        place[0] = far[i].x;
        snprintf(want, sizeof want, "%s%s", far[i].line, strchr(far[i].text, '\n'));
        ok(writes(&o, place, NULL, want), "far from the origin: %s", far[i].line);
        obj_free(&o);
    }
}

/* A comment joins no line to the next, whatever it ends with and whatever it follows. */
static void test_comments(void)
{
    obj o =
        read_good(SQUARE "usemtl skin # C:\\tex\\\nf 1 2 3\nmtllib a b\t#\\\r\nf 2 3 4\nvt 0 0 \\\n# C:\\\nf 3 4 1\n"
                         "g skin # D:\\\nf 1 2 4\ng # E:\\\nf 1 2 3\no the head # F:\\\nf 1 2 3\n"
                         "f 1 2 3 # G:\\\nf 4 3 2\n");
    ok(o.faces == 8, "a comment that ends in a backslash: %d faces", (int)o.faces);
    ok(corners_are(&o, 0, "0 1 2") && corners_are(&o, 1, "1 2 3") && corners_are(&o, 2, "2 3 0"),
       "after usemtl, mtllib and a joined line");
    ok(!strcmp(group_of(&o, 3), "skin") && !strcmp(group_of(&o, 4), "default") && !strcmp(group_of(&o, 5), "the_head"),
       "after g and o, whose names it is no part of");
    ok(o.groups == 3 && corners_are(&o, 7, "3 2 1"), "after a face");
    obj_free(&o);
    o = read_good(SQUARE "usemtl skin#2\\\nf 1 2 3\nusemtl a\\\n b#\\\n c\nf 1 2 3\ng skin#2 \\\nleft\nf 1 2 3\n");
    ok(o.faces == 2 && !strcmp(group_of(&o, 1), "skin#2 left"), "a # within a word begins none: lines are joined");
    obj_free(&o);
}

static void test_gzip(void)
{
    unsigned char packed[200];
    z_stream z = {0};
    deflateInit2(&z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    unsigned char plain[] = SQUARE "f 1 2 3 4\n";
    z.next_in = plain;
    z.avail_in = sizeof plain - 1;
    z.next_out = packed;
    z.avail_out = sizeof packed;
    deflate(&z, Z_FINISH);
    obj o;
    err e;
    ok(!read_bytes(packed, z.total_out, &o, &e) && o.vertices == 4 && o.faces == 1, "gzip");
    obj_free(&o);
    ok(read_bytes(packed, z.total_out - 9, &o, &e) == -1, "gzip cut short: %s", e.text);
    deflateEnd(&z);
}

static void test_nonsense(void)
{
    static const struct {
        const char *text, *says;
    } bad[] = {
        {SQUARE "f 1 2\n", "m.obj:5: a face of 2 corners"},
        {SQUARE "f\n", "m.obj:5: a face of 0 corners"},
        {SQUARE "f 1 2 5\nf 1 2 9\n", "m.obj:5: vertex 5, but the file has 4"},
        {SQUARE "f 1 2 -5\n", "m.obj:5: vertex -5, but only 4 came before"},
        {SQUARE "f 0 1 2\n", "m.obj:5: not a corner: '0'"},
        {SQUARE "vn 0 0 1\nf 1//1 2//1 3//2\n", "m.obj:6: normal 2, but the file has 1"},
        {SQUARE "f 1//1 2//1 3//1\n", "m.obj:5: normal 1, but the file has 0"},
        {SQUARE "vn 0 0 1\nf 1 2 3//1\n", "m.obj:6: a corner unlike the face's others: '3//1'"},
        {SQUARE "f 1/0 2/1 3/1\n", "m.obj:5: not a corner: '1/0'"},
        {SQUARE "f 1/ 2/ 3/\n", "m.obj:5: not a corner: '1/'"},
        {SQUARE "f 1/1/ 2/1/ 3/1/\n", "m.obj:5: not a corner: '1/1/'"},
        {SQUARE "f 1/1/1/1 2 3\n", "m.obj:5: not a corner: '1/1/1/1'"},
        {SQUARE "f 1.0 2 3\n", "m.obj:5: not a corner: '1.0'"},
        {SQUARE "f 1 2 99999999999999999999\n", "m.obj:5: not a corner: '99999999999999999999'"},
        {SQUARE "f 1 2 \\\n\\\nx\n", "m.obj:7: not a corner: 'x'"},
        {SQUARE "l 1\n", "m.obj:5: a line of 1 vertices"},
        {SQUARE "p\n", "m.obj:5: a point statement"},
        {"v 1 2\n", "m.obj:1: a vertex of 2 numbers"},
        {"v 1 2 3 4 5\n", "m.obj:1: a vertex of 5 numbers"},
        {"v 1 2 3 4 5 6 7 8 9\n", "m.obj:1: too many numbers, from '9'"},
        {"v 1 2 nan\n", "m.obj:1: not a finite number: 'nan'"},
        {"v 1 inf 3\n", "m.obj:1: not a finite number: 'inf'"},
        {"v 1e999 2 3\n", "m.obj:1: not a finite number: '1e999'"},
        {"v 1,5 2 3\n", "m.obj:1: not a finite number: '1,5'"},
        {"v 1 2 3x\n", "m.obj:1: not a finite number: '3x'"},
        {"v 1 2 3\n\nvn 0 0\n", "m.obj:3: a normal of 2 numbers"},
        {"vn 0 0 1 1\n", "m.obj:1: too many numbers, from '1'"},
        {"vertex 1 2 3\n", "m.obj:1: unknown statement 'vertex'"},
        {"usemlt skin\n", "m.obj:1: unknown statement 'usemlt'; expected perhaps 'usemtl'"},
        {"V 1 2 3\n", "m.obj:1: unknown statement 'V'"},
        {"ply\nformat ascii 1.0\n", "m.obj:1: unknown statement 'ply'"},
        {"\x89PNG\r\n\x1a\n", "m.obj:1: unknown statement '?PNG'"},
        {SQUARE "usemtl a # b\\\nusemtl c \\\n d\nx\n", "m.obj:8: unknown statement 'x'"},
        {"v 1 2 3\n \\\n curv 0 1 1 2\nx\n", "m.obj:4: unknown statement 'x'"},
        {"call other.obj\n", "m.obj:1: a statement that runs other files: 'call'"},
        {"v 0 0 0\rv 1 0 0\rv 1 1 0\r", "m.obj:1: a CR within the line"},
        {"v 0 0 0\nv 1 0 0\rv 1 1 0\n", "m.obj:2: a CR within the line"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        obj o;
        err e;
        bool refused = read_bytes(bad[i].text, strlen(bad[i].text), &o, &e) == -1 && e.status == STATUS_BAD;
        ok(refused && !strncmp(e.text, bad[i].says, strlen(bad[i].says)) && strstr(e.text, "expected") && !o.text,
           "refused: %s", bad[i].says);
        if (strncmp(e.text, bad[i].says, strlen(bad[i].says)) != 0)
            printf("# said: %s\n", e.text);
        if (!refused)
            obj_free(&o);
    }
    obj o;
    err e;
    ok(read_bytes("v 1 2 3\nv\0 1", 12, &o, &e) == -1 && !strncmp(e.text, "m.obj:2: a NUL byte", 19), "refused: NUL");
}

/* Curves and surfaces beside polygons, as a modeller writes them: skipped, counted, and written again to the byte. */
static void test_free_form(void)
{
    static const char text[] = SQUARE "# a patch\nvp 0.5 1\ncstype rat bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 \\\n3 4\n"
                                      "parm u 0 0 \\\n 1 1\nparm v 0 0 1 1\nend\nf 1 2 3\n";
    notes n = {0};
    obj o = read_good(text), plain = read_good(SQUARE "f 1 2 3\n");
    ok(o.free_form == 7 && o.free_form_line == 6, "free-form lines: %d, from line %d on", (int)o.free_form,
       (int)o.free_form_line);
    ok(o.faces == 1 && o.vertices == 4 && corners_are(&o, 0, "0 1 2"), "polygons beside them are read");
    ok(writes(&o, o.position, o.normal, text), "written again to the byte");
    obj_notes(&plain, &n);
    ok(!n.count, "nothing is said where there are none");
    obj_notes(&o, &n);
    ok(n.count == 1 && !strncmp(n.line[0], "m.obj:6: free-form curves and surfaces are skipped, 7 lines", 58),
       "said once: %s", n.count ? n.line[0] : "");
    notes_free(&n);
    obj_free(&o);
    obj_free(&plain);
}

/* Names of any bytes, each its own. */
static void test_names(void)
{
    static const char text[] =
        "v 0 0 0\ng caf\xe9 \x1b[1m\np 1\ng caf\xc3\xa9\np 1\no a\\xe9 b\np 1\ng caf\\xe9\np 1\n";
    obj o = read_good(text);
    ok(o.groups == 4 && !strcmp(group_of(&o, 0), "caf\\xe9 \\x1b[1m"), "Latin-1 and control characters: %s",
       group_of(&o, 0));
    ok(!strcmp(group_of(&o, 1), "caf\xc3\xa9"), "UTF-8 stays");
    ok(!strcmp(group_of(&o, 2), "a\\x5cxe9_b") && !strcmp(group_of(&o, 3), "caf\\x5cxe9"),
       "what only looks like a byte is another name");
    ok(writes(&o, o.position, o.normal, text), "written again in its own bytes");
    obj_free(&o);
}

/* Cut anywhere, an OBJ is read or refused, and what was read can be written. */
static void test_cuts(void)
{
    static const char whole[] =
        "v 0 0 0 \\\n# x\nv 1 0 0\r\nvn 0 0 1\nv 1 1 0\ng a b\no c\nf -1//-1 \\\n 2//1 1//1\np 1 2\n"
        "l 1/1 2/1\ncurv 1";
    int wrong = 0;
    for (size_t n = 0; n < sizeof whole; n++) {
        obj o;
        err e;
        char text[sizeof whole] = "";
        memcpy(text, whole, n);
        if (read_bytes(whole, n, &o, &e))
            wrong += !e.status;
        else {
            wrong += !writes(&o, o.position, o.normal, text);
            obj_free(&o);
        }
    }
    ok(!wrong, "cut anywhere: read to be written, or refused");
}

int main(void)
{
    test_forms();
    test_groups();
    test_lines();
    test_far();
    test_comments();
    test_gzip();
    test_nonsense();
    test_free_form();
    test_names();
    test_cuts();
    return done_testing();
}
