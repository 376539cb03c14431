/* What a reader refuses, with its place and what was expected: blocks made by hand, lines of text, failures. */
#include "streams.h"
#include "tap.h"

#include <time.h>
#include <zlib.h>

/* A stream of blocks in the making. */
typedef struct hand {
    unsigned char b[1000];
    size_t n;
} hand;

static void put(hand *h, const void *from, size_t size)
{
    for (size_t i = 0; i < size; i++)
        h->b[h->n++] = ((const unsigned char *)from)[i];
}

static void put_crc(hand *h, size_t from)
{
    uint32_t crc = (uint32_t)crc32(0, h->b + from, (uInt)(h->n - from));
    put(h, &crc, sizeof crc);
}

static void put_text(hand *h, const char *text)
{
    uint32_t n = (uint32_t)strlen(text);
    put(h, &n, sizeof n);
    put(h, text, n);
}

static void put_block(hand *h, const char *type, uint32_t flags, uint64_t length, const void *payload, size_t have)
{
    size_t from = h->n;
    put(h, type, 4);
    put(h, &flags, sizeof flags);
    put(h, &length, sizeof length);
    put(h, payload, have);
    put_crc(h, from);
}

static void put_magic(hand *h, int major, int minor)
{
    unsigned char version[2] = {(unsigned char)major, (unsigned char)minor};
    h->n = 0;
    put(h, "\x89sinew\r\n\x1a\n", 10);
    put(h, version, 2);
    put_crc(h, 0);
}

/* Whether the bytes are refused with a text that has `what` in it ("": taken), and soon. */
static void judge(const hand *h, const char *what, const char *name)
{
    err e;
    clock_t from = clock();
    int status = refused(h->b, h->n, &e);
    ok((*what ? says(&e, what) : !status) && clock() - from < CLOCKS_PER_SEC, "%s", name);
}

/* A stream of one block, and its end. */
static void one_block(const char *type, uint32_t flags, uint64_t length, const void *payload, size_t have,
                      const char *what, const char *name)
{
    hand h;
    put_magic(&h, 1, 0);
    put_block(&h, type, flags, length, payload, have);
    put_block(&h, "DONE", 0, 0, "", 0);
    judge(&h, what, name);
}

static void test_blocks(void)
{
    static const char meta[] = "\1\0\0\0k\1\0\0\0v", nul[] = "\1\0\0\0k\1\0\0\0\0", tail[] = "\1\0\0\0k\1\0\0\0vx";
    static const char huge[] = "\xff\xff\xff\xffk";
    one_block("META", 0, 10, meta, 10, "", "a block by hand");
    one_block("META", 1, 10, meta, 10, "block 1 (META): its flags are unknown", "unknown flags");
    one_block("METB", 0, 10, meta, 10, "block 1 (METB): its type is not known and may not be skipped",
              "upper-case type");
    one_block("mETB", 7, 10, meta, 10, "", "lower-case type, with flags");
    one_block("me~a", 0, 10, meta, 10, "not four letters or digits", "a type that is no word");
    one_block("META", 0, 10, nul, 10, "NUL byte", "a NUL in a string");
    one_block("META", 0, 11, tail, 11, "more than what it holds", "a payload that is too long");
    one_block("META", 0, 9, meta, 9, "less than what it holds", "a payload that is too short");
    one_block("META", 0, 5, huge, 5, "less than what it holds", "a string longer than its block");
    one_block("META", 0, UINT64_C(1) << 60, huge, 5, "cut short", "a string of 4 GiB that is not there");
    one_block("mETB", 0, UINT64_C(1) << 36, meta, 10, "cut short", "an unknown block of 64 GiB that is not there");
    one_block("mETB", 0, UINT64_C(1) << 60, meta, 10, "cut short", "one of 2^60 bytes");
    one_block("mETB", 0, UINT64_MAX, meta, 10, "less than what it holds", "one of 2^64 - 1 bytes");
    one_block("DONE", 0, 10, meta, 10, "more than what it holds", "an end that holds something");
}

/* An axis of `count` and an array over it whose `claimed` bytes are not there. */
static void one_array(uint64_t count, const char *unit, uint32_t type, uint32_t columns, uint64_t claimed,
                      const char *what, const char *name)
{
    hand h, part = {.n = 0};
    put_text(&part, "n");
    put(&part, &count, sizeof count);
    put_magic(&h, 1, 0);
    put_block(&h, "AXIS", 0, part.n, part.b, part.n);
    part.n = 0;
    put_text(&part, "x-a");
    put_text(&part, unit);
    put_text(&part, "n");
    put(&part, &type, sizeof type);
    put(&part, &columns, sizeof columns);
    put_block(&h, "ARRY", 0, part.n + claimed, part.b, part.n);
    judge(&h, what, name);
}

static void test_arrays(void)
{
    uint64_t large = UINT64_C(1) << 60;
    one_array(large, "1", MODEL_U8, 1, large, "cut short", "2^60 bytes of u8 that are not there");
    one_array(large / 8, "1", MODEL_F64, 1, large, "cut short", "2^57 doubles that are not there");
    one_array(UINT64_C(1) << 36, "1", MODEL_U8, 1, UINT64_C(1) << 36, "cut short", "64 GiB that are not there");
    one_array(UINT64_C(1) << 30, "1", MODEL_STR, 1, UINT64_C(1) << 36, "cut short", "2^30 strings that are not there");
    one_array(large, "1", MODEL_F64, 3, large, "too large for any memory", "a product that overflows");
    one_array(large, "1", MODEL_F64, INT32_MAX, 8, "too large for any memory", "one that overflows twice");
    one_array(UINT64_MAX, "1", MODEL_U8, 1, 8, "and a count", "a count past 2^63");
    one_array(2, "1", MODEL_U8, 1, 3, "not that of its rows", "more bytes than rows");
    one_array(2, "1", MODEL_STR, 1, 7, "less than its strings need", "fewer bytes than strings");
    one_array(2, "1", 6, 1, 2, "unknown type", "an unknown type of values");
    one_array(2, "1", MODEL_U8, 0, 0, "expected 1 or more", "no column");
    one_array(2, "1", MODEL_U8, UINT32_MAX, 0, "expected 1 or more", "2^32 - 1 columns");
    one_array(2, "a b", MODEL_U8, 1, 2, "no good unit", "a unit with a space");
}

static void version(int major, int minor, const char *what)
{
    hand h;
    char text[100], name[40];
    snprintf(name, sizeof name, "binary version %d.%d", major, minor);
    put_magic(&h, major, minor);
    put_block(&h, "DONE", 0, 0, "", 0);
    judge(&h, what, name);
    snprintf(name, sizeof name, "text version %d.%d", major, minor);
    snprintf(text, sizeof text, "%%sinew %d.%d text\nend\n", major, minor);
    h.n = 0;
    put(&h, text, strlen(text));
    judge(&h, what, name);
}

/* ---- text ---- */

static void bad(const char *text, const char *what)
{
    err e;
    char name[60], whole[2000];
    snprintf(whole, sizeof whole, "%%sinew 1 text\n%s", text);
    int status = refused(whole, strlen(whole), &e);
    snprintf(name, sizeof name, "%s", text);
    name[strcspn(name, "\n")] = 0;
    ok(*what ? says(&e, what) && e.status == STATUS_BAD : !status, "%s: %s", *what ? "refused" : "taken", name);
    if (!*what && status)
        printf("# %s\n", e.text);
}

#define AXES "axis node 2\naxis element 1\n"

static void test_bad_lines(void)
{
    bad("end\n", "");
    bad("end\r\n", "");
    bad("end", "stdin:2: the model is cut short");
    bad("end\n\n", "something follows the model's end");
    bad("end\nend\n", "something follows");
    bad("nonsense\n", "stdin:2: 'nonsense'; expected meta, prov");
    bad("\nend\n", "stdin:2: an empty line; expected meta");
    bad("meta k v\nend\n", "stdin:2: expected meta KEY \"VALUE\"");
    bad("meta k \"v\" x\nend\n", "expected meta KEY");
    bad("meta k \"v\nend\n", "expected meta KEY");
    bad("meta k \"\\q\"\nend\n", "expected meta KEY");
    bad("meta k \"\\x00\"\nend\n", "expected meta KEY");
    bad("meta k \"\\x80\"\nend\n", "expected meta KEY");
    bad("meta k \"\\x4\"\nend\n", "expected meta KEY");
    bad("meta k \"\t\"\nend\n", "expected meta KEY");
    bad("meta k \"\\", "cut short");
    bad("meta k \"\\\nend\n", "expected meta KEY");
    bad("meta \tk   \"\\x41\"  \nend\n", "");
    bad("meta k \"\xff\"\nend\n", "stdin:2: the value of k is not UTF-8");
    bad("meta a+b \"\"\nend\n", "stdin:2: key 'a+b'");
    bad("meta k \"\"\nmeta k \"\"\nend\n", "stdin:3: a second meta k");
    bad("prov a 1\nend\n", "stdin:2: expected prov");
    bad("prov a+b 1 \"\"\nend\n", "stdin:2: provenance 'a+b'");
    bad("prov a \"\"\nend\n", "stdin:2: expected prov");
    bad("axis node\nend\n", "stdin:2: expected axis NAME COUNT");
    bad("axis node -1\nend\n", "expected axis NAME COUNT");
    bad("axis node 9223372036854775808\nend\n", "expected axis NAME COUNT");
    bad("axis no+de 1\nend\n", "stdin:2: axis 'no+de'");
    bad("axis node 1\naxis node 1\nend\n", "stdin:3: a second axis node");
    bad("block xtra 00000000 2\n01\nend\n", "stdin:4: expected pairs of hexadecimal digits, 2 bytes in all");
    bad("block xtra 00000000 2\n0102\ncrc 00000000\nend\n", "stdin:4: crc 00000000 does not fit block xtra");
    bad("block xtra 00000000 1\n0102\nend\n", "stdin:3: expected pairs of hexadecimal digits, 1 bytes in all");
    bad("block Xtra 00000000 0\nend\n", "stdin:2: expected block TYPE");
    bad("block xtra 0 0\nend\n", "stdin:2: expected block TYPE");
    bad("block xtra 00000000 1152921504606846976\n00\n", "cut short");
}

static void test_bad_arrays(void)
{
    bad("array x f64 m node 1\nend\n", "stdin:2: array x is over axis node, which is not there");
    bad(AXES "array x f63 m node 1\nend\n", "stdin:4: expected array NAME TYPE");
    bad(AXES "array x f64 m node 0\nend\n", "stdin:4: expected array NAME TYPE");
    bad(AXES "array x f64 m node 2147483648\nend\n", "stdin:4: expected array NAME TYPE");
    bad(AXES "array x f64 m node\nend\n", "stdin:4: expected array NAME TYPE");
    bad(AXES "array x+ f64 m node 1\n0\n0\nend\n", "stdin:4: the name of an array");
    bad(AXES "array x f64 m node 1\n0\nend\n",
        "stdin:6: array x, row 1 (of 2, from 0), value 1: expected 1 numbers of f64");
    bad(AXES "array x f64 m node 2\n0 0\n0\nend\n", "stdin:6: array x, row 1 (of 2, from 0), value 2");
    bad(AXES "array x f64 m node 1\n0 0\n0\nend\n", "stdin:5: array x, row 0 has too many values");
    bad(AXES "array x f64 m node 1\n0\n0\n0\nend\n", "stdin:7: '0'; expected meta");
    bad(AXES "array x f64 m node 1\n0x1\n0\nend\n", "stdin:5");
    bad(AXES "array x f64 m node 1\n1e400\n0\nend\n", "stdin:5");
    bad(AXES "array x f64 m node 1\nnano\n0\nend\n", "stdin:5");
    bad(AXES "array x f64 m node 1\n-nan\n+inf\nend\n", "");
    bad(AXES "array x f32 m node 1\n3.5e38\n0\nend\n",
        "stdin:5: array x, row 0 (of 2, from 0), value 1: expected 1 numbers of f32");
    bad(AXES "array x f32 m node 1\n-3.4028236e38\n0\nend\n", "stdin:5");
    bad(AXES "array x i32 1 node 1\n2147483648\n0\nend\n",
        "stdin:5: array x, row 0 (of 2, from 0), value 1: expected 1 whole");
    bad(AXES "array x i32 1 node 1\n-2147483649\n0\nend\n", "stdin:5");
    bad(AXES "array x i32 1 node 1\n0.5\n0\nend\n", "stdin:5");
    bad(AXES "array x i32 1 node 1\nnan\n0\nend\n", "stdin:5");
    bad(AXES "array x i64 1 node 1\n9223372036854775808\n0\nend\n", "stdin:5");
    bad(AXES "array x i64 1 node 1\n-9223372036854775809\n0\nend\n", "stdin:5");
    bad(AXES "array x i64 1 node 1\n99999999999999999999999\n0\nend\n", "stdin:5");
    bad(AXES "array x u8 1 node 1\n256\n0\nend\n", "stdin:5");
    bad(AXES "array x u8 1 node 1\n-1\n0\nend\n", "stdin:5");
    bad(AXES "array x u8 1 node 1\n-\n0\nend\n", "stdin:5");
    bad(AXES "array x str 1 node 1\na\n\"\"\nend\n",
        "stdin:5: array x, row 0 (of 2, from 0), value 1: expected 1 quoted");
    bad(AXES "array x str 1 node 2\n\"a\"\"b\"\n\"\" \"\"\nend\n", "stdin:5");
    bad(AXES "array x str 1 node 1\n\"\"\n\"\xc3\"\nend\n", "stdin:6: array x, row 1: a string is not UTF-8");
    bad(AXES "array x u8 1 node 1\n1\n2\ncrc 00000000\nend\n", "stdin:7: crc 00000000 does not fit array x");
    bad(AXES "array x u8 1 node 1\n1\n2\ncrc 0\nend\n", "stdin:7: expected crc and 8");
    bad(AXES "array x u8 1 node 1\n1\n2\ncrc\nend\n", "stdin:7: expected crc and 8");
    bad(AXES "array x u8 1 node 1\n1\n2\narray x u8 1 node 1\n1\n2\nend\n", "stdin:7: a second array x");
    bad(AXES "array x i32 @node element 1\n-1\nend\n", "");
    bad(AXES "array x i32 @node element 1\n2\nend\n",
        "stdin:5: array x, row 0: 2 is not an index into axis node; expected -1 to 1");
    bad(AXES "array x i32 @later element 1\n2\naxis later 3\nend\n", "");
    bad(AXES "array x i32 @later element 1\n2\nend\n", "stdin:4: array x points to axis later");
    bad(AXES "array node.position f32 m node 3\n0 0 0\n0 0 0\nend\n",
        "stdin:4: array node.position has type f32; expected f64");
    bad(AXES "array node.rigid u8 1 node 2\n0 0\n0 0\nend\n",
        "stdin:4: array node.rigid has 2 columns; expected 1 to 1");
    bad(AXES "array node.displacement f64 m node 3\n0 0 0\n0 0 0\nend\n",
        "stdin:4: array node.displacement belongs to frames");
    bad("axis n 9000000000000000000\narray x f64 1 n 1\nend\n", "stdin:3: array x of 9000000000000000000 rows");
    bad("axis n 1000000000000000000\narray x f64 1 n 1\n0\n1\nend\n", "stdin:6: array x, row 2");
}

#define MOVE "array node.displacement f64 m node 3\n0 0 0\n0 0 0\n"

static void test_bad_frames(void)
{
    bad(AXES "frame 0 0\nframe 1 1\nend\n", "");
    bad(AXES "frame 0\nend\n", "stdin:4: expected frame INDEX TIME");
    bad(AXES "frame 0 nan\nend\n", "stdin:4: expected frame INDEX TIME");
    bad(AXES "frame 0 0\n" MOVE "frame 1 0\n" MOVE "end\n", "");
    bad(AXES "frame 0 0\n" MOVE "frame 1 0\nend\n", "stdin:8: frame 1 has 0 arrays; expected 1");
    bad(AXES "frame 0 0\nframe 1 0\n" MOVE "end\n", "stdin:6: an array more than the first frame has");
    bad(AXES "frame 0 0\n" MOVE MOVE "end\n", "stdin:8: a second array node.displacement in a frame");
    bad(AXES "frame 0 0\n" MOVE "frame 1 0\narray x u8 1 node 1\n0\n0\nend\n",
        "stdin:9: array x is not as in the first");
    bad(AXES "frame 0 0\narray node.rigid u8 1 node 1\n0\n0\nend\n", "stdin:5: array node.rigid belongs to the model");
    bad(AXES "frame 0 0\narray x i32 @node node 1\n0\n2\nend\n", "stdin:7: array x, row 1: 2 is not an index");
    bad(AXES "frame 0 0\nmeta k \"\"\nend\n", "stdin:5: a part of the body after the first frame");
    bad(AXES "frame 0 0\nblock xtra 00000000 0\nend\n", "stdin:5: a part of the body after the first frame");
    bad(AXES "frame 0 0\n" MOVE, "cut short");
}

static void fail_of(const char *text, int status, bool silent, const char *what)
{
    err e;
    char whole[500];
    snprintf(whole, sizeof whole, "%%sinew 1 text\n%s", text);
    int got = refused(whole, strlen(whole), &e);
    ok(got && e.status == status && e.silent == silent && says(&e, what), "fail: %s", e.text);
}

/* What a writer is given too long it cuts between characters, so that every reader takes it and hands on the same. */
static void test_long_fail(void)
{
    err e = {0}, got;
    char given[MODEL_FAIL_MOST + 32];
    for (size_t i = 0; i + 2 < sizeof given; i += 2)
        memcpy(given + i, "\xc3\xa9", 3);
    out *o = out_memory(&e);
    model_writer *w = model_writer_open(o, true, &e);
    size_t size;
    model_write_fail(w, 3, given, &e);
    const unsigned char *b = out_bytes(o, &size);
    refused(b, size, &got);
    ok(got.status == 3 && got.silent && strlen(got.text) == MODEL_FAIL_MOST - 1 &&
           !strncmp(got.text, given, MODEL_FAIL_MOST - 1),
       "a text too long is cut between characters: %zu bytes", strlen(got.text));
    model_writer_close(w);
    out_discard(o);
}

static void test_fail(void)
{
    err e = {0};
    fail_of("fail 3 \"tled-run: diverged\"\n", 3, true, "tled-run: diverged");
    fail_of(AXES "fail 2 \"a: b\"\n", 2, true, "a: b");
    fail_of(AXES "frame 0 0\n" MOVE "fail 1 \"a: b\"\n", 1, true, "a: b");
    fail_of(AXES "frame 0 0\n" MOVE "frame 1 0\nfail 3 \"a: b\"\n", 3, true, "a: b");
    fail_of("fail 0 \"a: b\"\n", 1, false, "expected 1 to 255");
    fail_of("fail 256 \"a: b\"\n", 1, false, "expected 1 to 255");
    fail_of("fail 1 \"\xff\"\n", 1, false, "not UTF-8");
    fail_of("fail 1 \"a\"", 1, false, "cut short");
    fail_of("fail 1 \"a\"\nend\n", 1, false, "something follows");
    fail_of("fail a\n", 1, false, "expected fail STATUS");
    char line[MODEL_FAIL_MOST + 32] = "%sinew 1 text\nfail 3 \"";
    size_t at = strlen(line);
    memset(line + at, 'a', MODEL_FAIL_MOST + 1);
    strcpy(line + at + MODEL_FAIL_MOST + 1, "\"\n");
    ok(refused(line, strlen(line), &e) && !e.silent && says(&e, "its text has 1000 bytes; expected at most 999"),
       "too long: %s", e.text);
    strcpy(line + at + MODEL_FAIL_MOST, "\"\n");
    ok(refused(line, strlen(line), &e) && e.status == 3 && e.silent && strlen(e.text) == MODEL_FAIL_MOST,
       "the longest text comes as it is");
    test_long_fail();
    e = (err){0};
    for (int text = 0; text < 2; text++) {
        out *o = out_memory(&e);
        model_writer *w = model_writer_open(o, text, &e);
        size_t size;
        ok(!model_write_fail(w, 3, "tool: caf\xe9\n\"x\"", &e), "a failure before anything was written");
        const unsigned char *b = out_bytes(o, &size);
        err got;
        refused(b, size, &got);
        ok(got.status == 3 && got.silent && !strcmp(got.text, "tool: caf?\n\"x\""), "reads back: %d", got.status);
        model_writer_close(w);
        out_discard(o);
    }
}

/* Adds a block with an array behind its payload's beginning. */
static void add_block(unsigned char *to, size_t *n, const char *type, const hand *begins, const void *array,
                      size_t size)
{
    const uint32_t flags = 0;
    const uint64_t length = begins->n + size;
    const size_t from = *n;
    const struct {
        const void *at;
        size_t size;
    } part[] = {{type, 4}, {&flags, sizeof flags}, {&length, sizeof length}, {begins->b, begins->n}, {array, size}};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        if (part[i].size)
            memcpy(to + *n, part[i].at, part[i].size);
        *n += part[i].size;
    }
    const uint32_t crc = (uint32_t)crc32(0, to + from, (uInt)(*n - from));
    memcpy(to + *n, &crc, sizeof crc);
    *n += sizeof crc;
}

static void add_axis(unsigned char *to, size_t *n, const char *name, uint64_t count)
{
    hand h = {.n = 0};
    put_text(&h, name);
    put(&h, &count, sizeof count);
    add_block(to, n, "AXIS", &h, NULL, 0);
}

static void add_indices(unsigned char *to, size_t *n, const char *name, const int32_t *of, size_t count)
{
    const uint32_t type = MODEL_I32, columns = 1;
    hand h = {.n = 0};
    put_text(&h, name);
    put_text(&h, "@node");
    put_text(&h, "mark");
    put(&h, &type, sizeof type);
    put(&h, &columns, sizeof columns);
    add_block(to, n, "ARRY", &h, of, count * sizeof *of);
}

/* Two arrays of indices, each read in several pieces, of which those at `bad` are wrong. late: their axis comes behind
 * them. */
static void indices(const int64_t bad[2][2], bool late, const char *what, const char *name)
{
    enum { ROWS = 200000, NODES = 1000 };
    unsigned char *to = calloc(2, ROWS * sizeof(int32_t) + 1000);
    int32_t *of = calloc(ROWS, sizeof *of);
    hand h;
    err e;
    put_magic(&h, 1, 0);
    size_t n = h.n;
    if (!to || !of)
        return;
    memcpy(to, h.b, n);
    add_axis(to, &n, "mark", ROWS);
    if (!late)
        add_axis(to, &n, "node", NODES);
    for (int k = 0; k < 2; k++) {
        for (int32_t i = 0; i < ROWS; i++)
            of[i] = i % (NODES + 1) - 1;
        for (int j = 0; j < 2; j++)
            if (bad[k][j] >= 0)
                of[bad[k][j]] = j ? NODES : -2;
        add_indices(to, &n, k ? "second" : "first", of, ROWS);
    }
    if (late)
        add_axis(to, &n, "node", NODES);
    h.n = 0;
    add_block(to, &n, "DONE", &h, NULL, 0);
    const int status = refused(to, n, &e);
    ok(*what ? says(&e, what) : !status, "%s: %s", name, *what ? e.text : "taken");
    free(to);
    free(of);
}

/* The first is told, whichever piece it is in, and whatever is known when. */
static void test_bad_indices(void)
{
    for (int late = 0; late < 2; late++) {
        indices((const int64_t[2][2]){{-1, -1}, {-1, -1}}, late, "", "indices of several pieces");
        indices((const int64_t[2][2]){{150000, -1}, {3, -1}}, late, "array first, row 150000: -2 is not an index",
                "the first array's");
        indices((const int64_t[2][2]){{-1, -1}, {199999, -1}}, late, "array second, row 199999: -2 is not", "the last");
        indices((const int64_t[2][2]){{150000, 70000}, {-1, -1}}, late,
                "array first, row 70000: 1000 is not an index into axis node; expected -1 to 999", "the first of two");
    }
}

int main(void)
{
    test_bad_indices();
    test_blocks();
    test_arrays();
    version(1, 0, "");
    version(1, 7, "");
    version(0, 0, "format version 0; expected 1");
    version(2, 0, "format version 2; expected 1");
    test_bad_lines();
    test_bad_arrays();
    test_bad_frames();
    test_fail();
    return done_testing();
}
