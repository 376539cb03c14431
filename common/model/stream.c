#include "model/stream.h"

#include "base/chars.h"
#include "base/mem.h"
#include "model/binary.h"
#include "model/check.h"
#include "model/item.h"
#include "model/known.h"
#include "model/text.h"
#include "model/values.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(MODEL_FAIL_MOST < sizeof((err *)0)->text, "an err holds the text of any failure");

/* What every frame must have: the arrays of the first. Readers and writers both hold to it. */
typedef struct pattern {
    model_array *v; /* without data */
    int count;
    bool set;
} pattern;

/* The index of the frame before; each is more than that. */
typedef struct order {
    int64_t last;
    bool any;
} order;

/* Where an array of the body stood: its line or block. */
typedef struct array_place {
    int64_t at;
    bool within; /* its indices are known to be in their range */
} array_place;

struct model_reader {
    item_source from;
    item next; /* read, not yet taken, where `waiting` */
    bool waiting, ended;
    bool gives_cut; /* see model_reader_give_cut */
    bool lets_follow;
    err cut;             /* of the next frame: the stream was cut behind the one that was given */
    array_place *places; /* of the body's arrays */
    int64_t place_capacity;
    pattern pattern;
    order order;
};

struct model_writer {
    out *o;
    const encoding *how;
    bool begun;
    model axes;     /* of the body that was written, */
    bool is_headed; /* once its beginning was */
    int arrays;     /* of it that were written */
    bool body;      /* all of it was */
    pattern pattern;
    order order;
};

/* ---- what readers and writers share ---- */

static void pattern_free(pattern *p)
{
    for (int i = 0; i < p->count; i++)
        model_array_free(&p->v[i]);
    free(p->v);
    *p = (pattern){0};
}

static int pattern_set(pattern *p, const model_arrays *arrays, err *e)
{
    p->v = mem_array(arrays->count, sizeof *p->v, "a frame", e);
    if (!p->v)
        return -1;
    for (int i = 0; i < arrays->count; i++) {
        const model_array *a = &arrays->v[i];
        p->v[i] = (model_array){.type = a->type, .columns = a->columns, .narrow = a->narrow};
        p->count = i + 1;
        p->v[i].name = mem_text(a->name, e);
        p->v[i].unit = mem_text(a->unit, e);
        p->v[i].axis = mem_text(a->axis, e);
        if (!p->v[i].name || !p->v[i].unit || !p->v[i].axis)
            return -1;
    }
    p->set = true;
    return 0;
}

/* Whether a is what the first frame has as its i-th array. */
static bool pattern_fits(const pattern *p, int i, const model_array *a)
{
    const model_array *b = i < p->count ? &p->v[i] : NULL;
    return b && model_stored(a) == model_stored(b) && a->columns == b->columns && !strcmp(a->name, b->name) &&
           !strcmp(a->unit, b->unit) && !strcmp(a->axis, b->axis);
}

static int copy_axes(model *to, const model *m, err *e)
{
    for (int i = 0; i < m->axis_count; i++)
        if (model_axis_add(to, m->axes[i].name, m->axes[i].count, e))
            return -1;
    return 0;
}

static const char *belongs(const char *name, bool in_frame)
{
    const known *k = known_find(name);
    if (!k || !!(k->flags & KNOWN_FRAME) == in_frame)
        return NULL;
    return in_frame ? "belongs to the model, not to a frame" : "belongs to frames; expected it after a frame line";
}

/* ---- reading ---- */

model_reader *model_reader_open(in *s, err *e)
{
    int first = in_peek(s, e);
    if (first == -2)
        return NULL;
    if (first == -1) {
        err_set(e, NULL, 0, "no model on %s (0 bytes); if bash's builtin bind ran, write 'sinew bind'", in_name(s));
        return NULL;
    }
    if (first != TEXT_FIRST && first != BINARY_FIRST) {
        err_set(e, in_name(s), 0, "is not a sinew model; expected '%%sinew 1 text' or the magic of a binary one");
        return NULL;
    }
    model_reader *r = mem_array(1, sizeof *r, "reading a model", e);
    if (!r)
        return NULL;
    r->from.s = s;
    r->from.how = first == TEXT_FIRST ? &text_encoding : &binary_encoding;
    if (r->from.how->begin(&r->from, e)) {
        model_reader_close(r);
        return NULL;
    }
    return r;
}

void model_reader_close(model_reader *r)
{
    if (!r)
        return;
    item_free(&r->next);
    model_free(&r->from.axes);
    pattern_free(&r->pattern);
    free(r->places);
    free(r);
}

void model_reader_give_cut(model_reader *r)
{
    r->gives_cut = true;
}

void model_reader_names(model_reader *r)
{
    r->from.names = true;
}

void model_reader_let_follow(model_reader *r)
{
    r->lets_follow = true;
}

/* The stream said `end` or `fail`: nothing may follow. */
static int finish(model_reader *r, const item *it, err *e)
{
    int more = r->lets_follow ? -1 : in_peek(r->from.s, e);
    if (more == -2)
        return -1;
    if (more != -1)
        return item_error(&r->from, it, e, "something follows the model's end; expected nothing");
    r->ended = true;
    if (it->kind == ITEM_END)
        return 0;
    if (it->number < 1 || it->number > 255)
        return item_error(&r->from, it, e, "status %" PRId64 " of a failure; expected 1 to 255", it->number);
    const char *wrong = check_text(it->text);
    if (wrong)
        return item_error(&r->from, it, e, "its text %s", wrong);
    if (strlen(it->text) > MODEL_FAIL_MOST)
        return item_error(&r->from, it, e, "its text has %zu bytes; expected at most %d", strlen(it->text),
                          MODEL_FAIL_MOST);
    err_set(e, NULL, 0, "%s", it->text);
    e->status = (int)it->number;
    e->silent = true;
    return -1;
}

/* The next item, into r->next, where it waits until it is taken. */
static int look(model_reader *r, err *e)
{
    if (r->waiting)
        return 0;
    item_free(&r->next);
    if (r->from.how->read(&r->from, &r->next, e))
        return -1;
    r->waiting = true;
    return 0;
}

static int add_meta(model_reader *r, model *m, item *it, err *e)
{
    if (!check_name(it->key))
        return item_error(&r->from, it, e, "key '%.60s'; expected letters, digits and . _ - /", it->key);
    const char *wrong = check_text(it->text);
    if (wrong)
        return item_error(&r->from, it, e, "the value of %s %s", it->key, wrong);
    if (model_meta_of(m, it->key))
        return item_error(&r->from, it, e, "a second meta %s; expected one", it->key);
    return model_meta_set(m, it->key, it->text, e);
}

/* Cuts "TOOL VERSION OPTIONS" into its three at its first two spaces. */
static int add_prov(model_reader *r, model *m, item *it, err *e)
{
    char *version = strchr(it->text, ' '), *options = version ? strchr(version + 1, ' ') : NULL;
    const char *wrong = check_text(it->text);
    if (wrong)
        return item_error(&r->from, it, e, "provenance %s", wrong);
    if (version)
        *version++ = 0;
    if (options)
        *options++ = 0;
    if (!version || !check_name(it->text) || !check_name(version) || (options && !*options))
        return item_error(&r->from, it, e, "provenance '%.60s'; expected a tool's name, version and options", it->text);
    return model_prov_add(m, it->text, version, options ? options : "", e);
}

static int add_axis(model_reader *r, model *m, item *it, err *e)
{
    if (!check_name(it->key) || it->number < 0)
        return item_error(&r->from, it, e, "axis '%.60s'; expected letters, digits and . _ - /, and a count", it->key);
    if (model_count(m, it->key) >= 0)
        return item_error(&r->from, it, e, "a second axis %s; expected one", it->key);
    return model_axis_add(m, it->key, it->number, e) || model_axis_add(&r->from.axes, it->key, it->number, e);
}

/* All of an array's rules but the range of its indices, which may be into an axis that comes later. */
static int check_part(const model_reader *r, const item *it, err *e)
{
    char place[ITEM_PLACE];
    item_place(&r->from, it, place, sizeof place);
    return check_array(&it->array, it->finite, place, r->from.how->lines ? it->at : 0, e);
}

static int check_rest(const model_reader *r, const model *m, const model_array *a, int64_t at, err *e)
{
    char place[ITEM_PLACE];
    item_place(&r->from, &(item){.kind = ITEM_ARRAY, .at = at, .array.name = a->name}, place, sizeof place);
    return check_indexed(m, a, place, r->from.how->lines ? at : 0, e);
}

static int add_array(model_reader *r, model *m, item *it, err *e)
{
    const char *name = it->array.name, *wrong = belongs(name, false);
    if (wrong)
        return item_error(&r->from, it, e, "array %s %s", name, wrong);
    if (model_find(m, name))
        return item_error(&r->from, it, e, "a second array %s; expected one", name);
    if (mem_grow(&r->places, &r->place_capacity, m->arrays.count + 1, sizeof *r->places, "the model", e))
        return -1;
    if (!it->passed && check_part(r, it, e))
        return -1;
    r->places[m->arrays.count] = (array_place){it->at, it->within};
    it->array.line = r->from.how->lines ? it->at : 0;
    return model_arrays_take(&m->arrays, &it->array, e) ? 0 : -1;
}

static int add_item(model_reader *r, model *m, item *it, err *e)
{
    switch (it->kind) {
    case ITEM_META:
        return add_meta(r, m, it, e);
    case ITEM_PROV:
        return add_prov(r, m, it, e);
    case ITEM_AXIS:
        return add_axis(r, m, it, e);
    case ITEM_ARRAY:
        return add_array(r, m, it, e);
    case ITEM_BLOCK:
        return model_block_take(m, &it->block, e);
    case ITEM_FRAME:
    case ITEM_END:
    case ITEM_FAIL:
        break;
    }
    return 0;
}

int model_read(model_reader *r, model *m, err *e)
{
    free(m->stream);
    m->stream = mem_text(in_name(r->from.s), e);
    if (!m->stream)
        return -1;
    for (;;) {
        if (look(r, e))
            return -1;
        if (r->next.kind == ITEM_FAIL)
            return finish(r, &r->next, e);
        if (r->next.kind == ITEM_FRAME || r->next.kind == ITEM_END)
            break;
        r->waiting = false;
        if (add_item(r, m, &r->next, e))
            return -1;
    }
    for (int i = 0; i < m->arrays.count; i++)
        if (m->arrays.v[i].data && !r->places[i].within && check_rest(r, m, &m->arrays.v[i], r->places[i].at, e))
            return -1;
    return r->next.kind == ITEM_END ? finish(r, &r->next, e) : 0;
}

/* A known array of f64 may be stored as f32 in frames. */
static int widen(model_array *a, err *e)
{
    const known *k = a->type == MODEL_F32 ? known_find(a->name) : NULL;
    return k && k->type == MODEL_F64 ? item_widen(a, e) : 0;
}

static int add_frame_array(model_reader *r, const model *m, frame *f, item *it, err *e)
{
    const char *name = it->array.name, *wrong = belongs(name, true);
    if (wrong)
        return item_error(&r->from, it, e, "array %s %s", name, wrong);
    if (widen(&it->array, e))
        return -1;
    if (frame_find(f, name))
        return item_error(&r->from, it, e, "a second array %s in a frame; expected one", name);
    if (r->pattern.set && !pattern_fits(&r->pattern, f->arrays.count, &it->array))
        return item_error(&r->from, it, e, "array %s is not as in the first frame; expected the same arrays in each",
                          name);
    if (m && model_count(m, it->array.axis) != it->array.rows)
        return item_error(&r->from, it, e, "array %s is over axis %s, which has changed; expected no frames", name,
                          it->array.axis);
    if (check_part(r, it, e) || check_rest(r, &r->from.axes, &it->array, it->at, e))
        return -1;
    return model_arrays_take(&f->arrays, &it->array, e) ? 0 : -1;
}

/* Whether a failed look shows the first frame to be whole, as far as the stream tells: it stopped behind an array, or
 * within an item that is none. All encodings' names of what may follow a frame begin so. */
static bool is_whole(const model_reader *r, const frame *f)
{
    return r->gives_cut && !r->pattern.set && f->arrays.count && r->from.stopped &&
           (!r->from.within || strchr("FEfe", r->from.within));
}

/* The error waits for the next frame. */
static void keep_cut(model_reader *r, const frame *f, err *e)
{
    const size_t n = strlen(e->text);
    const int count = f->arrays.count;
    if (!r->from.within)
        snprintf(e->text + n, sizeof e->text - n,
                 " (the first frame has %d array%s before that, and may have had more)", count, count == 1 ? "" : "s");
    r->cut = *e;
    *e = (err){0};
}

/* The arrays of a frame whose heading was taken. From the second frame on their number is known, so that a frame is
 * given out when its last array is there, and not only when the next frame comes. */
static int read_frame_arrays(model_reader *r, const model *m, frame *f, int64_t at, err *e)
{
    while (!r->pattern.set || f->arrays.count < r->pattern.count) {
        if (look(r, e)) {
            if (!is_whole(r, f))
                return -1;
            keep_cut(r, f, e);
            break;
        }
        if (r->next.kind != ITEM_ARRAY)
            break;
        r->waiting = false;
        if (add_frame_array(r, m, f, &r->next, e))
            return -1;
    }
    if (!r->pattern.set)
        return pattern_set(&r->pattern, &f->arrays, e);
    if (f->arrays.count < r->pattern.count && r->next.kind == ITEM_FAIL)
        return finish(r, &r->next, e);
    if (f->arrays.count < r->pattern.count)
        return item_error(&r->from, &(item){.kind = ITEM_FRAME, .at = at}, e,
                          "frame %" PRId64 " has %d arrays; expected %d, as in the first frame", f->index,
                          f->arrays.count, r->pattern.count);
    return 0;
}

int model_read_frame(model_reader *r, const model *m, frame *f, err *e)
{
    frame_free(f);
    if (r->ended)
        return 0;
    if (r->cut.status) {
        *e = r->cut;
        return -1;
    }
    if (look(r, e))
        return -1;
    item *it = &r->next;
    if (it->kind == ITEM_END || it->kind == ITEM_FAIL)
        return finish(r, it, e);
    if (it->kind != ITEM_FRAME)
        return item_error(&r->from, it, e, "%s; expected a frame or the end",
                          it->kind == ITEM_ARRAY ? "an array more than the first frame has"
                                                 : "a part of the body after the first frame");
    if (!isfinite(it->time))
        return item_error(&r->from, it, e, "frame %" PRId64 " has no finite time", it->number);
    if (r->order.any && it->number <= r->order.last)
        return item_error(&r->from, it, e, "frame %" PRId64 " after frame %" PRId64 "; expected indices that increase",
                          it->number, r->order.last);
    r->order = (order){it->number, true};
    f->index = it->number;
    f->time = it->time;
    r->waiting = false;
    return read_frame_arrays(r, m, f, it->at, e) ? -1 : 1;
}

/* ---- writing ---- */

model_writer *model_writer_open(out *o, bool text, err *e)
{
    model_writer *w = mem_array(1, sizeof *w, "writing a model", e);
    if (!w)
        return NULL;
    w->o = o;
    w->how = text ? &text_encoding : &binary_encoding;
    return w;
}

void model_writer_close(model_writer *w)
{
    if (!w)
        return;
    model_free(&w->axes);
    pattern_free(&w->pattern);
    free(w);
}

static void write_item(model_writer *w, const item *it)
{
    if (!w->begun)
        w->how->write_begin(w->o);
    w->begun = true;
    w->how->write(w->o, it);
}

/* An array that was checked. */
static void write_array(model_writer *w, const model_array *a)
{
    const known *k = known_find(a->name);
    write_item(w, &(item){.kind = ITEM_ARRAY, .array = *a, .finite = k && values_must_be_finite(k)});
}

/* From the first of the arrays that are still to be written. */
static int check_body(const model *m, int first, int end, err *e)
{
    for (int i = first; i < end; i++) {
        const model_array *a = &m->arrays.v[i];
        const char *wrong = belongs(a->name, false);
        if (wrong)
            return err_set(e, "model", 0, "array %s %s", a->name, wrong);
        if (a->rows != model_count(m, a->axis))
            return err_set(e, "model", 0, "array %s has %" PRId64 " rows; expected those of its axis", a->name,
                           a->rows);
        if (model_check(m, a, "model", 0, e))
            return -1;
    }
    return 0;
}

static int write_head(model_writer *w, const model *m, err *e)
{
    if (copy_axes(&w->axes, m, e))
        return -1;
    for (int i = 0; i < m->metas; i++)
        write_item(w, &(item){.kind = ITEM_META, .key = m->meta[i].key, .text = m->meta[i].value});
    for (int i = 0; i < m->provs; i++)
        write_item(w, &(item){.kind = ITEM_PROV, .text = m->prov[i]});
    for (int i = 0; i < m->axis_count; i++)
        write_item(w, &(item){.kind = ITEM_AXIS, .key = m->axes[i].name, .number = m->axes[i].count});
    w->is_headed = true;
    return 0;
}

int model_write_ahead(model_writer *w, const model *m, int arrays, err *e)
{
    if (w->is_headed && w->axes.axis_count != m->axis_count)
        return err_set(e, "model", 0, "%d axes; expected the %d that were written already", m->axis_count,
                       w->axes.axis_count);
    if (check_body(m, w->arrays, arrays, e) || (!w->is_headed && write_head(w, m, e)))
        return -1;
    for (; w->arrays < arrays; w->arrays++)
        write_array(w, &m->arrays.v[w->arrays]);
    return 0;
}

int model_write(model_writer *w, const model *m, err *e)
{
    if (model_write_ahead(w, m, m->arrays.count, e))
        return -1;
    for (int i = 0; i < m->block_count; i++)
        write_item(w, &(item){.kind = ITEM_BLOCK, .block = m->blocks[i]});
    w->body = true;
    out_flush(w->o);
    return 0;
}

static int check_frame(const model_writer *w, const frame *f, err *e)
{
    bool same = f->arrays.count == w->pattern.count;
    if (!w->body || !isfinite(f->time))
        return err_set(e, "model", 0, "frame %" PRId64 " has no model before it, or no finite time", f->index);
    if (w->order.any && f->index <= w->order.last)
        return err_set(e, "model", 0, "frame %" PRId64 " after frame %" PRId64 "; expected indices that increase",
                       f->index, w->order.last);
    for (int i = 0; i < f->arrays.count; i++) {
        const model_array *a = &f->arrays.v[i];
        if (belongs(a->name, true) || a->rows != model_count(&w->axes, a->axis))
            return err_set(e, "model", 0, "array %s does not fit into a frame of this model", a->name);
        if (model_check(&w->axes, a, "model", 0, e))
            return -1;
        if (a->narrow && !item_rounds(a))
            return err_set(e, "model", 0, "array %s has a number that no f32 holds; expected it as f64", a->name);
        same = same && pattern_fits(&w->pattern, i, a);
    }
    if (w->pattern.set && !same)
        return err_set(e, "model", 0, "frame %" PRId64 " has other arrays than the first; expected the same", f->index);
    return 0;
}

int model_write_frame(model_writer *w, const frame *f, err *e)
{
    if (check_frame(w, f, e) || (!w->pattern.set && pattern_set(&w->pattern, &f->arrays, e)))
        return -1;
    w->order = (order){f->index, true};
    write_item(w, &(item){.kind = ITEM_FRAME, .number = f->index, .time = f->time});
    for (int i = 0; i < f->arrays.count; i++)
        write_array(w, &f->arrays.v[i]);
    out_flush(w->o);
    return 0;
}

int model_write_end(model_writer *w, err *e)
{
    if (!w->body)
        return err_set(e, "model", 0, "no model was written before the end");
    write_item(w, &(item){.kind = ITEM_END});
    return 0;
}

/* Cuts a text to at most that many bytes, between characters. */
static void cut(char *text, size_t most)
{
    size_t n = strlen(text);
    if (n <= most)
        return;
    for (n = most; n && ((unsigned char)text[n] & 0xc0) == 0x80; n--)
        ;
    text[n] = 0;
}

int model_write_fail(model_writer *w, int status, const char *text, err *e)
{
    char *copy = mem_text(text, e);
    if (!copy)
        return -1;
    chars_mend(copy);
    cut(copy, MODEL_FAIL_MOST);
    write_item(w, &(item){.kind = ITEM_FAIL, .number = status, .text = copy});
    free(copy);
    return 0;
}
