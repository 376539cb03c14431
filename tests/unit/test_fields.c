/* The table of a state's arrays: a row more, a history of 6 numbers an element, is allocated, written in frames and
 * checkpoints where it is asked for, read back, and part of the checksum.
 */
#include "solve/fields.h"

#include "base/checksum.h"
#include "base/in.h"
#include "base/out.h"
#include "model/stream.h"

#include "tap.h"

#include <string.h>

enum { NODES = 7, ELEMENTS = 5, HISTORY = 2, SIZE = 6 * ELEMENTS };

static const field row[] = {
    {"node.displacement", "m", FIELD_NODE, 3, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS, NULL},
    {"node.velocity", "m/s", FIELD_NODE, 3, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS, "velocity 0"},
    {"element.history", "1", FIELD_ELEMENT, 6, FIELD_IN_CHECKPOINTS, "no history"},
};
static const fields two = {row, 2, {NODES, ELEMENTS}}, three = {row, 3, {NODES, ELEMENTS}};

static void fill(const fields *f, field_values *v)
{
    for (int i = 0; i < f->count; i++)
        for (int64_t k = 0; k < fields_size(f, i); k++)
            v->of[i][k] = 100 * i + (double)k / 7;
}

static void test_memory(field_values *v, err *e)
{
    field_values framed;
    ok(fields_size(&three, 1) == 3 * NODES && fields_size(&three, HISTORY) == SIZE, "sizes");
    ok(!fields_allocate(&three, FIELD_IN_FRAMES, &framed, "a test", e) && framed.of[0] && framed.of[1] &&
           !framed.of[HISTORY],
       "memory for what frames have");
    fields_free(&framed);
    ok(!framed.of[0], "and none");
    ok(!fields_allocate(&three, FIELDS_ALL, v, "a test", e) && v->of[HISTORY] && v->of[HISTORY][SIZE - 1] == 0,
       "and for all");
    const fields large = {row, 3, {NODES, INT64_MAX / 16}};
    ok(fields_allocate(&large, FIELDS_ALL, &framed, "a test", e) && strstr(e->text, "a test"), "too much: %s", e->text);
    fields_free(&framed);
    *e = (err){0};
}

static void test_crc(const field_values *v)
{
    uint32_t crc = checksum_add(5, v->of[0], sizeof(double[3 * NODES]));
    crc = checksum_add(crc, v->of[1], sizeof(double[3 * NODES]));
    ok(fields_crc(&two, v, 5) == crc, "the checksum of two fields, one after the other");
    crc = checksum_add(crc, v->of[HISTORY], sizeof(double[SIZE]));
    ok(fields_crc(&three, v, 5) == crc, "and of three");
    v->of[HISTORY][SIZE - 1] += 1e-9;
    ok(fields_crc(&three, v, 5) != crc, "any number of which changes it");
    v->of[HISTORY][SIZE - 1] -= 1e-9;
}

/* Written as a stream and read again. */
static void round_trip(const field_values *v, model *m, err *e)
{
    frame f = {.index = 3, .time = .5}, got = {0};
    field_values back;
    model same = {0};
    size_t size;
    ok(!fields_lend(&three, FIELD_IN_CHECKPOINTS, v, &f, m, e) && f.arrays.count == 3, "all are lent %s", e->text);
    out *o = out_memory(e);
    model_writer *w = model_writer_open(o, false, e);
    ok(!model_write(w, m, e) && !model_write_frame(w, &f, e) && !model_write_end(w, e), "and written %s", e->text);
    model_writer_close(w);
    const unsigned char *bytes = out_bytes(o, &size);
    in *s = in_memory((const char *)bytes, size, "test", e);
    model_reader *r = model_reader_open(s, e);
    ok(!model_read(r, &same, e) && model_read_frame(r, &same, &got, e) == 1, "and read %s", e->text);
    ok(fields_fit(&three, FIELD_IN_CHECKPOINTS, &got), "they fit");
    fields_allocate(&three, FIELDS_ALL, &back, "a test", e);
    fields_read(&three, FIELD_IN_CHECKPOINTS, &got, &back);
    ok(fields_crc(&three, &back, 0) == fields_crc(&three, v, 0), "and are what they were");
    fields_free(&back);
    frame_free(&got);
    frame_free(&f);
    model_free(&same);
    model_reader_close(r);
    in_close(s);
    out_discard(o);
}

static void test_frames(const field_values *v, model *m, err *e)
{
    frame f = {0};
    ok(!fields_lend(&three, FIELD_IN_FRAMES, v, &f, m, e) && f.arrays.count == 2, "a frame has two");
    ok(fields_fit(&three, FIELD_IN_FRAMES, &f) && !fields_fit(&three, FIELD_IN_CHECKPOINTS, &f), "it lacks the third");
    ok(fields_find(&three, 1, &f) == v->of[1] && !fields_find(&three, HISTORY, &f), "which is not found");
    const fields other = {row, 3, {NODES + 1, ELEMENTS}};
    ok(!fields_find(&other, 0, &f), "nor is one of another length");
    const field wide = {"node.displacement", "m", FIELD_NODE, 2, FIELD_IN_FRAMES, NULL};
    const field elements = {"node.displacement", "m", FIELD_ELEMENT, 3, FIELD_IN_FRAMES, NULL};
    const fields by_columns = {&wide, 1, {NODES, ELEMENTS}}, by_axis = {&elements, 1, {NODES, NODES}};
    ok(!fields_find(&by_columns, 0, &f) && !fields_find(&by_axis, 0, &f), "of other columns, or of another axis");
    frame_free(&f);
}

int main(void)
{
    err e = {0};
    field_values v;
    model m = {0};
    model_axis_add(&m, "node", NODES, &e);
    test_memory(&v, &e);
    fill(&three, &v);
    test_crc(&v);
    test_frames(&v, &m, &e);
    frame f = {0};
    ok(fields_lend(&three, FIELDS_ALL, &v, &f, &m, &e) && strstr(e.text, "axis element"), "no axis: %s", e.text);
    frame_free(&f);
    e = (err){0};
    model_axis_add(&m, "element", ELEMENTS, &e);
    round_trip(&v, &m, &e);
    fields_free(&v);
    model_free(&m);
    return done_testing();
}
