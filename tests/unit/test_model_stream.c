/* The two encodings: what is written comes back; cut anywhere, or with any bit flipped, it is refused. */
#include "streams.h"
#include "tap.h"

#include <math.h>
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
    "array x-place f64 m node 3\n"
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
    "frame -9 0.01\n"
    "array node.displacement f64 m node 3\n"
    "0 0 0\n0 0 1\n-0 0 1e-300\n"
    "array node.velocity f32 m/s node 3\n"
    "0.100000001 0 0\n0 -0 1\n1.40129846e-45 0 3.40282347e+38\n"
    "array x-lot str 1 element 1\n\"a\"\n"
    "frame -7 0.02\n"
    "array node.displacement f64 m node 3\n"
    "0 0 0\n0 0 1\n1 0 0\n"
    "array node.velocity f32 m/s node 3\n"
    "0 0 0\n0 0 0\n0 0 0\n"
    "array x-lot str 1 element 1\n\"b\"\n"
    "end\n";

/* A small one, for what is tried at every byte or bit. */
static const char small[] = "%sinew 1 text\n"
                            "meta k \"v\"\n"
                            "prov a 1 \"-b\"\n"
                            "axis node 2\n"
                            "array x-place f64 m node 3\n0 0 0\n1 nan -1.5\n"
                            "array x-s str 1 node 1\n\"a\"\n\"\"\n"
                            "block xtra 00000000 3\n010203\n"
                            "frame 0 0.5\n"
                            "array node.displacement f64 m node 3\n0 0 0\n0 0 1\n"
                            "frame 1 1\n"
                            "array node.displacement f64 m node 3\n0 0 0\n0 0 2\n"
                            "end\n";

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

static bool same_as(bytes a, const void *b, size_t size)
{
    return a.at && b && a.size == size && !memcmp(a.at, b, size);
}

static bool same(bytes a, bytes b)
{
    return same_as(a, b.at, b.size);
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
    ok(same_as(plain, rich, sizeof rich - 1), "but for the checksums, text as it was");
    ok(same(binary, unpacked), "gzipped binary -> the same binary");
    free(text.at);
    free(binary.at);
    free(again.at);
    free(plain.at);
    free(direct.at);
    free(packed.at);
    free(unpacked.at);
}

static void cut_everywhere(const void *whole, size_t size, const char *what)
{
    err e;
    size_t taken = 0, silent = 0;
    for (size_t n = 0; n < size; n++) {
        taken += refused(whole, n, &e) == 0;
        silent += !e.status || !*e.text;
    }
    ok(!taken && !silent, "%s cut at each of its %zu bytes is refused", what, size);
    ok(!refused(whole, size, &e), "%s whole is not %s", what, e.text);
}

static void test_cut(void)
{
    err e = {0};
    bytes text = convert(small, sizeof small - 1, true, &e), binary = convert(small, sizeof small - 1, false, &e);
    bytes packed = gzipped(binary);
    cut_everywhere(text.at, text.size, "text");
    cut_everywhere(small, sizeof small - 1, "text without checksums");
    cut_everywhere(binary.at, binary.size, "binary");
    cut_everywhere(packed.at, packed.size, "gzipped binary");
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
    ok(model_write(w, &m, &e) && says(&e, "array x, row 1: 2 is not an index") && !out_count(o),
       "a model that would not be read is not written");
    e = (err){0};
    a->i32[1] = 1;
    ok(!model_write(w, &m, &e), "a good one is");
    frame_add(&f, &m, "node.displacement", &e);
    ok(!model_write_frame(w, &f, &e), "a frame");
    ok(model_write_frame(w, &f, &e) && says(&e, "frame 0 after frame 0; expected indices that increase"),
       "a second one of its index");
    e = (err){0};
    frame_free(&f);
    f.index = 1;
    ok(model_write_frame(w, &f, &e) && says(&e, "other arrays than the first"), "a frame without its arrays");
    e = (err){0};
    f.time = NAN;
    ok(model_write_frame(w, &f, &e) && says(&e, "no finite time"), "a frame without a time");
    frame_free(&f);
    model_free(&m);
    model_writer_close(w);
    out_discard(o);
}

/* A frame of numbers that stand elsewhere is written as one with its own, and leaves them there. */
static void test_lent(void)
{
    err e = {0};
    double numbers[6] = {1, -2, 0, 4e-300, 5, -0.}, copy[6];
    memcpy(copy, numbers, sizeof copy);
    out *o[2] = {out_memory(&e), out_memory(&e)};
    model m = {0};
    model_axis_add(&m, "node", 2, &e);
    for (int lent = 0; lent < 2; lent++) {
        frame f = {.index = 3, .time = .5};
        model_array *a = lent ? frame_lend(&f, &m, "node.displacement", "m", "node", 3, numbers, &e)
                              : frame_add(&f, &m, "node.displacement", &e);
        if (a && !lent)
            memcpy(a->f64, numbers, sizeof numbers);
        model_writer *w = model_writer_open(o[lent], false, &e);
        ok(a && !model_write(w, &m, &e) && !model_write_frame(w, &f, &e), "written %s", e.text);
        model_writer_close(w);
        frame_free(&f);
    }
    size_t size[2];
    const unsigned char *b[2] = {out_bytes(o[0], &size[0]), out_bytes(o[1], &size[1])};
    ok(size[0] == size[1] && !memcmp(b[0], b[1], size[0]), "lent or not, the same bytes");
    ok(!memcmp(numbers, copy, sizeof copy), "and what is lent stays as it is");
    out_discard(o[0]);
    out_discard(o[1]);
    model_free(&m);
}

/* ---- numbers ---- */

/* A binary model of n numbers, all 1 but for that at `at`. */
static out *write_with(model_type type, int64_t n, int64_t at, const void *number)
{
    err e = {0};
    model m = {0};
    model_axis_add(&m, "n", n, &e);
    model_array *a = model_add_as(&m, "a", type, "1", "n", 1, &e);
    for (int64_t i = 0; i < n; i++)
        if (type == MODEL_F32)
            a->f32[i] = 1;
        else
            a->f64[i] = 1;
    memcpy(a->u8 + (size_t)at * model_type_size(type), number, model_type_size(type));
    out *o = out_memory(&e);
    model_writer *w = model_writer_open(o, false, &e);
    model_write(w, &m, &e);
    model_writer_close(w);
    model_free(&m);
    return o;
}

static bool is_made_one(model_type type, int64_t n, int64_t at, const void *odd, const void *one)
{
    out *o[2] = {write_with(type, n, at, odd), write_with(type, n, at, one)};
    size_t size[2];
    const unsigned char *b[2] = {out_bytes(o[0], &size[0]), out_bytes(o[1], &size[1])};
    bool same = size[0] == size[1] && !memcmp(b[0], b[1], size[0]);
    out_discard(o[0]);
    out_discard(o[1]);
    return same;
}

/* Wherever it stands. (Readers would mend it, so it is looked for in what was written.) */
static void test_one_nan(void)
{
    static const uint64_t odd64 = UINT64_C(0xfff0000000000001), one64 = UINT64_C(0x7ff8000000000000);
    static const uint32_t odd32 = 0xff800001, one32 = 0x7fc00000;
    int wrong = 0;
    for (int64_t n = 1; n <= 8; n++)
        for (int64_t at = 0; at < n; at++)
            wrong += !is_made_one(MODEL_F64, n, at, &odd64, &one64) || !is_made_one(MODEL_F32, n, at, &odd32, &one32);
    ok(!wrong, "a nan is the one nan wherever it stands: %d are not", wrong);
}

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

static uint32_t bits_of(float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return bits;
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
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++)
        all = all && bits_of(through(hard[i])) == bits_of(strtof(hard[i], NULL));
    ok(all, "floats are rounded once");
    uint32_t seed = 1;
    int wrong = 0;
    for (int i = 0; i < 500; i++) {
        seed = seed * 1664525 + 1013904223;
        uint32_t bits = seed & 0x7f7fffff;
        float f;
        char text[64];
        memcpy(&f, &bits, sizeof f);
        snprintf(text, sizeof text, "%.9g", (double)f);
        wrong += bits_of(through(text)) != bits;
    }
    ok(!wrong, "%%.9g gives every float back");
}

/* A model of 3 nodes with a frame whose displacements are written as f32; what comes back, in *back. -1 where it is
 * refused. */
static int through_narrow(const double u[9], bool text, frame *back, err *e)
{
    model m = {0}, read = {0};
    frame f = {.time = 1};
    size_t size;
    int got = -1;
    out *o = out_memory(e);
    model_writer *w = o ? model_writer_open(o, text, e) : NULL;
    model_array *a =
        w && !model_axis_add(&m, "node", 3, e) ? frame_lend(&f, &m, "node.displacement", "m", "node", 3, u, e) : NULL;
    if (a)
        a->narrow = true;
    const bool whole = a && !model_write(w, &m, e) && !model_write_frame(w, &f, e) && !model_write_end(w, e);
    const unsigned char *at = o ? out_bytes(o, &size) : NULL;
    in *s = whole ? in_memory(at, size, "stdin", e) : NULL;
    model_reader *r = s ? model_reader_open(s, e) : NULL;
    if (r && !model_read(r, &read, e))
        got = model_read_frame(r, &read, back, e) == 1 ? 0 : -1;
    model_reader_close(r);
    in_close(s);
    model_writer_close(w);
    out_discard(o);
    frame_free(&f);
    model_free(&m);
    model_free(&read);
    return got;
}

/* Doubles that are stored as f32 come back as the nearest floats, in doubles. */
static void test_narrow(void)
{
    double u[9] = {.1, -1.0 / 3, 1e-50, 1e-40, -0.0, 3.4e38, 1 + 0x1p-24, 1 + 0x1.8p-23, 7};
    for (int text = 0; text < 2; text++) {
        frame back = {0};
        err e = {0};
        const int failed = through_narrow(u, text, &back, &e);
        const model_array *a = failed ? NULL : frame_find(&back, "node.displacement");
        bool same = a && a->type == MODEL_F64 && a->narrow && model_stored(a) == MODEL_F32;
        for (int i = 0; same && i < 9; i++)
            same = a->f64[i] == (double)(float)u[i] && !signbit(a->f64[i]) == !signbit(u[i]);
        ok(same,
           text ? "doubles stored as f32 come back rounded, from text" : "doubles stored as f32 come back rounded");
        frame_free(&back);
    }
    u[4] = -1e39;
    frame back = {0};
    err e = {0};
    ok(through_narrow(u, false, &back, &e) == -1 && strstr(e.text, "node.displacement has a number that no f32 holds"),
       "what is beyond f32 is refused");
    frame_free(&back);
}

/* Two frames of the same numbers, the second of floats if so. */
static out *write_two(bool text, bool floats)
{
    static const float single[9] = {.1f, -1 / 3.f, 0, 1e-40f, -0.f, 3e38f, 1, 2, 3};
    double wide[9];
    err e = {0};
    model m = {0};
    frame f = {.time = 1};
    out *o = out_memory(&e);
    model_writer *w = model_writer_open(o, text, &e);
    for (int i = 0; i < 9; i++)
        wide[i] = (double)single[i];
    model_axis_add(&m, "node", 3, &e);
    model_array *a = frame_lend(&f, &m, "node.displacement", "m", "node", 3, wide, &e);
    a->narrow = true;
    bool whole = !model_write(w, &m, &e) && !model_write_frame(w, &f, &e);
    f.index = 1;
    a->narrow = !floats;
    model_array_lend(a, floats ? MODEL_F32 : MODEL_F64, floats ? (const void *)single : wide);
    whole = whole && !model_write_frame(w, &f, &e) && !model_write_end(w, &e);
    ok(whole, "two frames stored as f32%s: %s", floats ? ", one of floats" : "", e.text);
    model_writer_close(w);
    frame_free(&f);
    model_free(&m);
    return o;
}

static void test_lent_floats(void)
{
    for (int text = 0; text < 2; text++) {
        out *o[2] = {write_two(text, false), write_two(text, true)};
        size_t size[2];
        const unsigned char *b[2] = {out_bytes(o[0], &size[0]), out_bytes(o[1], &size[1])};
        ok(size[0] == size[1] && size[0] > 0 && !memcmp(b[0], b[1], size[0]), "of doubles or floats, the same bytes");
        out_discard(o[0]);
        out_discard(o[1]);
    }
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
    test_writer();
    test_lent();
    test_nan();
    test_one_nan();
    test_floats();
    test_narrow();
    test_lent_floats();
    test_liveness();
    test_changed();
    return done_testing();
}
