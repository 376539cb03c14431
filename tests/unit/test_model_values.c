/* What the table of known arrays says of their values holds for whoever reads them, in the body and in frames, as text
 * and as binary, and for whoever writes them; every array of real numbers has a rule. */
#include "model/known.h"
#include "streams.h"
#include "tap.h"

#include <math.h>
#include <zlib.h>

/* A model of one array, which has these rows: the axes that it needs, and a frame where it lives in one. */
static size_t model_of(char *to, size_t size, const known *k, const char *name, int columns, const char *rows)
{
    char full[MODEL_NAME], unit[MODEL_NAME], axis[MODEL_NAME];
    int count = 0;
    known_expand(k->name, "s/x", full, sizeof full);
    known_expand(k->unit, full, unit, sizeof unit);
    known_expand(k->axis, full, axis, sizeof axis);
    for (const char *c = rows; *c; c++)
        count += *c == '\n';
    size_t n = (size_t)snprintf(to, size, "%%sinew 1 text\naxis %s %d\n", axis, count);
    if (unit[0] == '@' && strcmp(unit + 1, axis) != 0)
        n += (size_t)snprintf(to + n, size - n, "axis %s 100\n", unit + 1);
    if (k->flags & KNOWN_FRAME)
        n += (size_t)snprintf(to + n, size - n, "frame 0 0\n");
    return n + (size_t)snprintf(to + n, size - n, "array %s %s %s %s %d\n%send\n", *name ? name : full,
                                model_type_name(k->type), unit, axis, columns, rows);
}

/* In a binary model the array that has a name of the user's gets this one, which is as long, and its block's
 * checksum. */
static void rename_array(bytes b, const char *from, const char *to)
{
    const size_t n = strlen(from);
    uint64_t length;
    for (size_t at = 16; at + 20 <= b.size; at += 20 + length) {
        memcpy(&length, b.at + at + 8, sizeof length);
        if (memcmp(b.at + at, "ARRY", 4) != 0 || memcmp(b.at + at + 20, from, n) != 0)
            continue;
        memcpy(b.at + at + 20, to, n);
        const uint32_t crc = (uint32_t)crc32(0, b.at + at, (uInt)(16 + length));
        memcpy(b.at + at + 16 + length, &crc, sizeof crc);
    }
}

/* want: what is said after "array NAME, "; NULL: nothing, it is taken. */
static void judge(const known *k, int columns, const char *rows, const char *want)
{
    char text[2000], own[MODEL_NAME], full[MODEL_NAME], said[1200];
    err e;
    known_expand(k->name, "s/x", full, sizeof full);
    snprintf(own, sizeof own, "x-%s", full + 2);
    size_t n = model_of(text, sizeof text, k, "", columns, rows);
    int status = refused(text, n, &e);
    snprintf(said, sizeof said, "array %s, %s", full, want ? want : "");
    ok(want ? status && says(&e, said) && says(&e, "stdin:") : !status, "%s: %.*s: %s", full, (int)strcspn(rows, "\n"),
       rows, e.text);
    n = model_of(text, sizeof text, k, own, columns, rows);
    err bad = {0};
    bytes b = convert(text, n, false, &bad);
    rename_array(b, own, full);
    status = refused(b.at, b.size, &e);
    ok(!bad.status && (want ? status && says(&e, said) && says(&e, "stdin: block ") : !status), "binary: %s%s", e.text,
       bad.text);
    free(b.at);
}

static void of(const char *name, const char *rows, const char *want)
{
    const known *k = known_find(name);
    judge(k, k->columns_max, rows, want);
}

static void directions(void)
{
    static const char expected[] = "row 1: 0 0 2; expected rows of length 1, to 0.001, or 0 0 0";
    of("element.fibre", "0 0 0\n0 0 2\n", expected);
    of("element.mixfibre", "0 0 1\n0 0 2\n", expected);
    of("s/vertex.normal", "0 0 1\n0 0 2\n", expected);
    of("element.fibre", "0 0 0\n-0 0 -0\n0.577 0.577 0.577\n0.577350259 -0.577350259 0.577350259\n", NULL);
    of("element.fibre", "0 0 1.0009\n0 0.9991 0\n", NULL);
    of("element.fibre", "0 0 1\n0 1.0011 0\n", "row 1: 0 1.0011 0; expected rows of length 1");
    of("element.fibre", "0 0 0.9989\n0 1 0\n", "row 0: 0 0 0.9989; expected");
    of("element.fibre", "0 0 1e-40\n", "row 0: 0 0 9.99995e-41; expected");
    of("element.fibre", "1e30 0 0\n", "row 0: 1e+30 0 0; expected");
    of("element.fibre", "1 0 inf\n", "row 0: 1 0 inf; expected");
    of("probe.pose", "1e3 -5 7 0 0 0 1\n", NULL);
    of("probe.pose", "0 0 0 0.7071 0 0 0.7071\n", NULL);
    of("probe.pose", "0 0 0 0 0 0 0\n",
       "row 0: 0 0 0 0 0 0 0; expected a place and a quaternion of length 1, to 0.001");
    of("probe.pose", "0 inf 0 0 0 0 1\n", "row 0: 0 inf 0 0 0 0 1; expected");
}

static void sums(void)
{
    const known *k = known_find("s/vertex.weight");
    judge(k, 4, "0.25 0.25 0.25 0.25\n1e6 -1e6 0.5 0.5\n", NULL);
    judge(k, 4, "0.25 0.25 0.25 0.25\n0.2 0.2 0.2 0.2\n",
          "row 1: 0.2 0.2 0.2 0.2; expected finite numbers; four must add to 1");
    judge(k, 4, "1 0 0 nan\n", "row 0: 1 0 0 nan; expected");
    judge(k, 3, "0.2 0.2 7\n", NULL);
    judge(k, 3, "0.2 inf 7\n", "row 0: 0.2 inf 7; expected");
    of("s/face.start", "0\n3\n5\n", NULL);
    of("s/face.start", "1\n3\n", "row 0: 1; expected 0 first, then each more than the one before");
    of("s/face.start", "0\n3\n3\n", "row 2: 3; expected");
}

/* Two rows that have the same number in each column. */
static void put_rows(const known *k, double first, double second, char *to)
{
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < k->columns_max; i++)
            to += sprintf(to, "%.17g%s", row ? second : first, i + 1 < k->columns_max ? " " : "\n");
}

/* The ends of a range are in it, and what comes next is not. */
static void range(const known *k)
{
    char rows[200];
    double past = k->high + 1, less = k->low - 1;
    if (k->type == MODEL_F64) {
        past = nextafter(k->high, INFINITY);
        less = nextafter(k->low, -INFINITY);
    } else if (k->type == MODEL_F32) {
        past = (double)nextafterf((float)k->high, INFINITY);
        less = k->low - 1e-6;
    }
    put_rows(k, k->low, k->high, rows);
    judge(k, k->columns_max, rows, NULL);
    if (k->high < (double)INT32_MAX || k->type == MODEL_F64) {
        put_rows(k, k->low, past, rows);
        judge(k, k->columns_max, rows, "row 1: ");
    }
    if (k->type == MODEL_U8)
        return;
    put_rows(k, less, k->high, rows);
    judge(k, k->columns_max, rows, "row 0: ");
}

/* A row that is nan in one column, and one that is in all. */
static void nothing(const known *k)
{
    char rows[200] = "", *at = rows;
    for (int i = 0; i < k->columns_max; i++)
        at += sprintf(at, "nan%s", i + 1 < k->columns_max ? " " : "\n");
    judge(k, k->columns_max, rows, k->flags & KNOWN_NAN ? NULL : "row 0: nan");
    if (k->columns_max == 1)
        return;
    at = rows;
    for (int i = 0; i < k->columns_max; i++)
        at += sprintf(at, "%s", i + 1 < k->columns_max ? "0 " : "nan\n");
    judge(k, k->columns_max, rows, "row 0: 0 0 ");
}

static void whole_table(void)
{
    const known *k;
    for (int i = 0; (k = known_row(i)); i++) {
        const bool real = k->type == MODEL_F32 || k->type == MODEL_F64;
        if (real)
            nothing(k);
        if (k->rule == KNOWN_FROM)
            range(k);
        if (k->type == MODEL_U8 && k->rule == KNOWN_ANY)
            ok(false, "%s has no range", k->name);
    }
}

/* Of a model's text the line is told. */
static void place(void)
{
    static const char text[] =
        "%sinew 1 text\naxis element 3\narray element.fraction f32 1 element 1\n1\n0.5\n1.5\nend\n";
    err e;
    ok(refused(text, sizeof text - 1, &e) &&
           !strcmp(e.text, "stdin:6: array element.fraction, row 2: 1.5; expected 0 to 1"),
       "%s", e.text);
}

/* What a reader refuses is not written: not a byte of it. */
static void writers(void)
{
    err e = {0};
    size_t size;
    model m = {0};
    frame f = {.index = 0};
    model_axis_add(&m, "node", 2, &e);
    out *o = out_memory(&e);
    model_writer *w = model_writer_open(o, false, &e);
    model_add(&m, "node.position", &e)->f64[4] = INFINITY;
    ok(model_write(w, &m, &e) && says(&e, "model: array node.position, row 1: 0 inf 0; expected finite numbers"), "%s",
       e.text);
    out_bytes(o, &size);
    ok(size == 0, "nothing is written");
    e = (err){0};
    model_find(&m, "node.position")->f64[4] = 0;
    frame_add(&f, &m, "node.velocity", &e)->f64[0] = NAN;
    ok(!model_write(w, &m, &e) && model_write_frame(w, &f, &e) && says(&e, "array node.velocity, row 0: nan 0 0"),
       "nor of a frame: %s", e.text);
    frame_free(&f);
    model_free(&m);
    model_writer_close(w);
    out_discard(o);
}

int main(void)
{
    directions();
    sums();
    whole_table();
    place();
    writers();
    return done_testing();
}
