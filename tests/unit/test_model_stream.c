/* The two encodings: what is written comes back, and what is cut, flipped or wrong is refused. */
#include "base/in.h"
#include "base/mem.h"
#include "base/out.h"
#include "model/stream.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <zlib.h>

/* Every type, nan, inf, -0, the ends of ranges, strings of all kinds, empty arrays, unknown blocks, frames. */
static const char rich[] =
    "%sinew 1 text\n"
    "meta source.unit \"mm\"\n"
    "meta title \"tab\\t \\\"quoted\\\" \\x01\\x7f caf\xc3\xa9 \\\\ \\n\\r\"\n"
    "meta empty \"\"\n"
    "prov voxelise 0.1.0 \"-s 12.5 --unit mm sphere.obj\"\n"
    "prov attach 0.1.0 \"\"\n"
    "axis node 3\n"
    "axis element 1\n"
    "axis none 0\n"
    "axis huge 9223372036854775807\n"
    "array node.position f64 m node 3\n"
    "-0.10000000000000001 0.012500000000000001 1.7976931348623157e+308\n"
    "nan inf -inf\n"
    "-0 1e-300 4.9406564584124654e-324\n"
    "array x-f f32 1 node 2\n"
    "0.100000001 1.40129846e-45\n"
    "3.40282347e+38 nan\n"
    "-0 -inf\n"
    "array element.node i32 @node element 4\n"
    "0 1 2 2\n"
    "array x-i32 i32 kg/m3 node 1\n"
    "-2147483648\n2147483647\n0\n"
    "array x-i64 i64 1 node 1\n"
    "-9223372036854775808\n9223372036854775807\n0\n"
    "array x-to i64 @node node 1\n"
    "-1\n0\n2\n"
    "array x-u8 u8 1 node 2\n"
    "0 255\n1 2\n3 4\n"
    "array x-s str 1 node 2\n"
    "\"\" \"\xc3\xa9\"\n\"a b\" \"\\r\\n\"\n\"\\x7f\" \"\xe6\x97\xa5\xe6\x9c\xac \xf0\x9f\x98\x80\"\n"
    "array x-empty str 1 none 3\n"
    "array x-none f64 m none 3\n"
    "block xtra 80000007 5\n"
    "0102ff0004\n"
    "block long 00000000 40\n"
    "000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f\n"
    "2021222324252627\n"
    "block zero 00000000 0\n"
    "frame 0 0.01\n"
    "array node.displacement f64 m node 3\n"
    "0 0 0\n0 0 1\nnan 0 0\n"
    "array x-lot str 1 element 1\n\"a\"\n"
    "frame -7 0.02\n"
    "array node.displacement f64 m node 3\n"
    "0 0 0\n0 0 1\n1 0 0\n"
    "array x-lot str 1 element 1\n\"b\"\n"
    "end\n";

/* A small one, for what is tried at every byte or bit. */
static const char small[] = "%sinew 1 text\n"
                            "meta k \"v\"\n"
                            "prov a 1 \"-b\"\n"
                            "axis node 2\n"
                            "array node.position f64 m node 3\n0 0 0\n1 nan -1.5\n"
                            "array x-s str 1 node 1\n\"a\"\n\"\"\n"
                            "block xtra 00000000 3\n010203\n"
                            "frame 0 0.5\n"
                            "array node.displacement f64 m node 3\n0 0 0\n0 0 1\n"
                            "frame 1 1\n"
                            "array node.displacement f64 m node 3\n0 0 0\n0 0 2\n"
                            "end\n";

typedef struct bytes {
    unsigned char *at;
    size_t size;
} bytes;

/* Reads all of a stream, and writes it into w (NULL: nowhere). */
static int pass(in *s, model_writer *w, err *e)
{
    model m = {0};
    frame f = {0};
    model_reader *r = model_reader_open(s, e);
    int got = r && !model_read(r, &m, e) && (!w || !model_write(w, &m, e)) ? 1 : -1;
    while (got > 0) {
        got = model_read_frame(r, &m, &f, e);
        if (got > 0 && w && model_write_frame(w, &f, e))
            got = -1;
    }
    if (!got && w)
        got = model_write_end(w, e);
    frame_free(&f);
    model_free(&m);
    model_reader_close(r);
    return got;
}

static int refused(const void *from, size_t size, err *e)
{
    *e = (err){0};
    in *s = in_memory(from, size, "stdin", e);
    int status = s ? pass(s, NULL, e) : -1;
    in_close(s);
    return status;
}

static bytes convert(const void *from, size_t size, bool text, err *e)
{
    bytes b = {0};
    in *s = in_memory(from, size, "stdin", e);
    out *o = out_memory(e);
    model_writer *w = o ? model_writer_open(o, text, e) : NULL;
    if (s && w && !pass(s, w, e)) {
        const unsigned char *got = out_bytes(o, &b.size);
        b.at = malloc(b.size ? b.size : 1);
        if (b.at)
            memcpy(b.at, got, b.size);
    }
    model_writer_close(w);
    out_discard(o);
    in_close(s);
    return b;
}

static bytes gzipped(bytes from)
{
    bytes b = {malloc(from.size + 1000), from.size + 1000};
    z_stream z = {.next_in = from.at, .avail_in = (uInt)from.size, .next_out = b.at, .avail_out = (uInt)b.size};
    if (deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK)
        deflate(&z, Z_FINISH);
    b.size = z.total_out;
    deflateEnd(&z);
    return b;
}

static bool same(bytes a, bytes b)
{
    return a.at && b.at && a.size == b.size && !memcmp(a.at, b.at, a.size);
}

static bool says(const err *e, const char *part)
{
    if (e->status && strstr(e->text, part))
        return true;
    printf("# got '%s', wanted '%s'\n", e->text, part);
    return false;
}

/* The lines of a text that are not a crc's. */
static bytes without_crc(bytes from)
{
    bytes b = {calloc(from.size + 1, 1), 0};
    for (size_t i = 0; i < from.size;) {
        const unsigned char *lf = memchr(from.at + i, '\n', from.size - i);
        size_t n = lf ? (size_t)(lf - from.at) - i + 1 : from.size - i;
        if (n < 4 || memcmp(from.at + i, "crc ", 4)) {
            memcpy(b.at + b.size, from.at + i, n);
            b.size += n;
        }
        i += n;
    }
    return b;
}

static void test_round_trip(void)
{
    err e = {0};
    bytes text = convert(rich, sizeof rich - 1, true, &e), binary = convert(text.at, text.size, false, &e);
    bytes again = convert(binary.at, binary.size, true, &e), plain = without_crc(text);
    bytes direct = convert(rich, sizeof rich - 1, false, &e);
    bytes packed = gzipped(binary), unpacked = convert(packed.at, packed.size, false, &e);
    ok(!e.status && same(text, again), "text -> binary -> text: the same bytes %s", e.text);
    ok(same(binary, direct), "text without checksums -> the same binary");
    ok(same(plain, (bytes){(unsigned char *)(uintptr_t)rich, sizeof rich - 1}),
       "but for the checksums, text as it was");
    ok(same(binary, unpacked), "gzipped binary -> the same binary");
    free(text.at);
    free(binary.at);
    free(again.at);
    free(plain.at);
    free(direct.at);
    free(packed.at);
    free(unpacked.at);
}

static void cut_everywhere(bytes whole, const char *what)
{
    err e;
    size_t taken = 0, silent = 0;
    for (size_t n = 0; n < whole.size; n++) {
        taken += refused(whole.at, n, &e) == 0;
        silent += !e.status || !*e.text;
    }
    ok(!taken && !silent, "%s cut at each of its %zu bytes is refused", what, whole.size);
    ok(!refused(whole.at, whole.size, &e), "%s whole is not %s", what, e.text);
}

static void test_cut(void)
{
    err e = {0};
    bytes text = convert(small, sizeof small - 1, true, &e), binary = convert(small, sizeof small - 1, false, &e);
    bytes packed = gzipped(binary);
    cut_everywhere(text, "text");
    cut_everywhere((bytes){(unsigned char *)(uintptr_t)small, sizeof small - 1}, "text without checksums");
    cut_everywhere(binary, "binary");
    cut_everywhere(packed, "gzipped binary");
    refused(text.at, text.size - 5, &e);
    ok(says(&e, "stdin:25: the model is cut short"), "the message of a cut");
    refused(binary.at, 0, &e);
    ok(says(&e, "no model on stdin (0 bytes); if bash's builtin bind ran, write 'sinew bind'"),
       "the message of nothing");
    free(text.at);
    free(binary.at);
    free(packed.at);
}

static void test_flips(void)
{
    err e = {0};
    bytes b = convert(small, sizeof small - 1, false, &e);
    size_t taken = 0, silent = 0;
    for (size_t bit = 0; bit < 8 * b.size; bit++) {
        b.at[bit / 8] ^= (unsigned char)(1 << bit % 8);
        taken += refused(b.at, b.size, &e) == 0;
        silent += e.status != STATUS_BAD || !*e.text || e.silent;
        b.at[bit / 8] ^= (unsigned char)(1 << bit % 8);
    }
    ok(!taken && !silent, "each of the %zu single flipped bits of a binary model is refused", 8 * b.size);
    size_t last = b.size - 20 - 4 - 8; /* in the last frame's array */
    b.at[last] ^= 1;
    refused(b.at, b.size, &e);
    ok(says(&e, "stdin: block 10 (ARRY node.displacement): checksum is "), "the message of a flipped bit");
    free(b.at);
}

/* ---- blocks made by hand ---- */

static size_t put_block(unsigned char *to, const char *type, uint32_t flags, uint64_t length, const void *payload,
                        size_t have)
{
    memcpy(to, type, 4);
    memcpy(to + 4, &flags, 4);
    memcpy(to + 8, &length, 8);
    if (have)
        memcpy(to + 16, payload, have);
    uint32_t crc = (uint32_t)crc32(0, to, (uInt)(16 + have));
    memcpy(to + 16 + have, &crc, 4);
    return 20 + have;
}

static size_t put_magic(unsigned char *to, int major, int minor)
{
    memcpy(to, "\x89sinew\r\n\x1a\n", 10);
    to[10] = (unsigned char)major;
    to[11] = (unsigned char)minor;
    uint32_t crc = (uint32_t)crc32(0, to, 12);
    memcpy(to + 12, &crc, 4);
    return 16;
}

/* A stream of one block (and its end), whose refusal says `what`; "" where it is to be taken. */
static void one_block(const char *type, uint32_t flags, uint64_t length, const void *payload, size_t have,
                      const char *what, const char *name)
{
    unsigned char b[1000];
    err e;
    size_t n = put_magic(b, 1, 0);
    n += put_block(b + n, type, flags, length, payload, have);
    n += put_block(b + n, "DONE", 0, 0, NULL, 0);
    clock_t from = clock();
    int status = refused(b, n, &e);
    ok((*what ? says(&e, what) : !status) && clock() - from < CLOCKS_PER_SEC, "%s", name);
}

static void test_blocks(void)
{
    static const char meta[] = "\1\0\0\0k\1\0\0\0v", nul[] = "\1\0\0\0k\1\0\0\0\0", tail[] = "\1\0\0\0k\1\0\0\0vx";
    static const char huge[] = "\xff\xff\xff\xffk";
    one_block("META", 0, 10, meta, 10, "", "a block by hand");
    one_block("META", 1, 10, meta, 10, "block 1 (META): its flags are not known", "unknown flags");
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

static size_t put_array(unsigned char *to, const char *unit, uint32_t type, uint32_t columns, uint64_t claimed)
{
    unsigned char p[100];
    size_t n = 0, u = strlen(unit);
    memcpy(p, "\3\0\0\0x-a", 7);
    n = 7;
    p[n] = (unsigned char)u;
    memset(p + n + 1, 0, 3);
    memcpy(p + n + 4, unit, u);
    n += 4 + u;
    memcpy(p + n, "\1\0\0\0n", 5);
    n += 5;
    memcpy(p + n, &type, 4);
    memcpy(p + n + 4, &columns, 4);
    n += 8;
    return put_block(to, "ARRY", 0, n + claimed, p, n);
}

/* An axis of `count` and an array over it whose `claimed` bytes are not there. */
static void one_array(uint64_t count, const char *unit, uint32_t type, uint32_t columns, uint64_t claimed,
                      const char *what, const char *name)
{
    unsigned char b[1000], axis[13] = {1, 0, 0, 0, 'n'};
    err e;
    memcpy(axis + 5, &count, 8);
    size_t n = put_magic(b, 1, 0);
    n += put_block(b + n, "AXIS", 0, 13, axis, 13);
    n += put_array(b + n, unit, type, columns, claimed);
    clock_t from = clock();
    refused(b, n, &e);
    ok(says(&e, what) && clock() - from < CLOCKS_PER_SEC, "%s", name);
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
    unsigned char b[100];
    char t[100];
    err e;
    size_t n = put_magic(b, major, minor);
    n += put_block(b + n, "DONE", 0, 0, NULL, 0);
    int status = refused(b, n, &e);
    ok(*what ? says(&e, what) : !status, "binary version %d.%d", major, minor);
    snprintf(t, sizeof t, "%%sinew %d.%d text\nend\n", major, minor);
    status = refused(t, strlen(t), &e);
    ok(*what ? says(&e, what) : !status, "text version %d.%d", major, minor);
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
    bad("\nend\n", "stdin:2: ''; expected meta");
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
        "stdin:5: array x, row 0: 2 is no index into axis node; expected -1 to 1");
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
    bad(AXES "frame 0 0\narray x i32 @node node 1\n0\n2\nend\n", "stdin:7: array x, row 1: 2 is no index");
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

/* ---- what a writer refuses ---- */

static void test_writer(void)
{
    err e = {0};
    model m = {0};
    frame f = {0};
    out *o = out_memory(&e);
    model_writer *w = model_writer_open(o, true, &e);
    ok(model_write_end(w, &e) && says(&e, "no model was written"), "an end before the model");
    e = (err){0};
    ok(model_write_frame(w, &f, &e) && says(&e, "no model before it"), "a frame before the model");
    e = (err){0};
    model_axis_add(&m, "node", 2, &e);
    model_array *a = model_add_as(&m, "x", MODEL_I32, "@node", "node", 1, &e);
    a->i32[1] = 2;
    ok(model_write(w, &m, &e) && says(&e, "array x, row 1: 2 is no index") && !out_count(o),
       "a model that would not be read is not written");
    e = (err){0};
    a->i32[1] = 1;
    ok(!model_write(w, &m, &e), "a good one is");
    frame_add(&f, &m, "node.displacement", &e);
    ok(!model_write_frame(w, &f, &e), "a frame");
    frame_free(&f);
    ok(model_write_frame(w, &f, &e) && says(&e, "other arrays than the first"), "a frame without its arrays");
    e = (err){0};
    f.time = NAN;
    ok(model_write_frame(w, &f, &e) && says(&e, "no finite time"), "a frame without a time");
    frame_free(&f);
    model_free(&m);
    model_writer_close(w);
    out_discard(o);
}

/* ---- numbers ---- */

static void test_nan(void)
{
    err e = {0};
    static const uint64_t odd64[] = {UINT64_C(0xfff8000000000000), UINT64_C(0x7ff0000000000001), UINT64_MAX};
    static const uint32_t odd32[] = {0xffc00000, 0x7f800001, UINT32_MAX};
    model m = {0};
    model_axis_add(&m, "n", 3, &e);
    model_array *d = model_add_as(&m, "d", MODEL_F64, "1", "n", 1, &e);
    memcpy(d->data, odd64, sizeof odd64);
    model_array *s = model_add_as(&m, "s", MODEL_F32, "1", "n", 1, &e);
    memcpy(s->data, odd32, sizeof odd32);
    bytes got[2];
    for (int text = 0; text < 2; text++) {
        out *o = out_memory(&e);
        model_writer *w = model_writer_open(o, text, &e);
        size_t size;
        ok(!model_write(w, &m, &e) && !model_write_end(w, &e), "odd nan are written");
        const unsigned char *b = out_bytes(o, &size);
        got[text] = convert(b, size, true, &e);
        model_writer_close(w);
        out_discard(o);
    }
    ok(same(got[0], got[1]) && strstr((char *)got[0].at, "\nnan\nnan\nnan\ncrc "), "and are one nan in both encodings");
    model_free(&m);
    free(got[0].at);
    free(got[1].at);
}

/* One f32 through the text encoding. */
static float through(const char *number)
{
    err e = {0};
    char text[500];
    model m = {0};
    float f = -1;
    snprintf(text, sizeof text, "%%sinew 1 text\naxis n 1\narray a f32 1 n 1\n%s\nend\n", number);
    in *s = in_memory(text, strlen(text), "stdin", &e);
    model_reader *r = model_reader_open(s, &e);
    if (!model_read(r, &m, &e))
        f = model_find(&m, "a")->f32[0];
    else
        printf("# %s\n", e.text);
    model_free(&m);
    model_reader_close(r);
    in_close(s);
    return f;
}

static void test_floats(void)
{
    /* Halfway between two floats but for the last digits, which a double drops. */
    static const char *const hard[] = {"1.00000005960464477539062500000000000000000001",
                                       "1.00000005960464477539062499999999999999999999",
                                       "1.000000059604644775390625",
                                       "1.00000017881393432617187500000000000000000001",
                                       "3.40282356779733661637539395458142568447e38",
                                       "7.00649232162408535461864791644958065640e-46",
                                       "1.1754943157898258998483097641290060955707622747e-38",
                                       "1e-60"};
    bool all = true;
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        float f = through(hard[i]), want = strtof(hard[i], NULL);
        all = all && !memcmp(&f, &want, sizeof f);
    }
    ok(all, "floats are rounded once");
    uint32_t seed = 1;
    int wrong = 0;
    for (int i = 0; i < 500; i++) {
        seed = seed * 1664525 + 1013904223;
        uint32_t bits = seed & 0x7f7fffff;
        float f, got;
        char text[64];
        memcpy(&f, &bits, sizeof f);
        snprintf(text, sizeof text, "%.9g", (double)f);
        got = through(text);
        wrong += memcmp(&f, &got, sizeof f) != 0;
    }
    ok(!wrong, "%%.9g gives every float back");
}

/* A frame is there as soon as its last array is (from the second on): nothing of the next may be needed. */
static void test_liveness(void)
{
    err e = {0};
    model m = {0};
    frame f = {0};
    bytes b = convert(small, sizeof small - 1, false, &e);
    in *s = in_memory(b.at, b.size - 20, "stdin", &e); /* without DONE */
    model_reader *r = model_reader_open(s, &e);
    ok(!model_read(r, &m, &e) && model_read_frame(r, &m, &f, &e) == 1 && model_read_frame(r, &m, &f, &e) == 1 &&
           f.index == 1,
       "the second frame before anything follows it");
    ok(model_read_frame(r, &m, &f, &e) == -1 && says(&e, "cut short"), "and then the cut");
    model_reader_close(r);
    in_close(s);
    frame_free(&f);
    model_free(&m);
    free(b.at);
}

/* Frames whose axes are no longer the model's, and frames that are only skipped. */
static void test_changed(void)
{
    err e = {0};
    model m = {0}, other = {0};
    frame f = {0};
    model_axis_add(&other, "node", 5, &e);
    in *s = in_memory(small, sizeof small - 1, "stdin", &e);
    model_reader *r = model_reader_open(s, &e);
    ok(!model_read(r, &m, &e) && model_read_frame(r, NULL, &f, &e) == 1, "a frame that is only skipped");
    ok(model_read_frame(r, &other, &f, &e) == -1 && says(&e, "over axis node, which has changed"),
       "a frame of another model");
    model_reader_close(r);
    in_close(s);
    frame_free(&f);
    model_free(&m);
    model_free(&other);
}

int main(void)
{
    test_round_trip();
    test_cut();
    test_flips();
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
    test_writer();
    test_nan();
    test_floats();
    test_liveness();
    test_changed();
    return done_testing();
}
