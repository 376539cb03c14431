#include "model/binary.h"

#include "base/checksum.h"
#include "base/mem.h"
#include "model/check.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if !defined(__BYTE_ORDER__) || __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "arrays are read and written as they lie in memory: this needs a little-endian machine"
#endif

/* Bytes handled at once: they stay in the cache between reading, checksum and the search for nan. */
enum { PIECE = 1 << 18, FIRST = 1 << 24, HEAD = 16, MAGIC = 10 };

static const unsigned char magic[MAGIC] = {BINARY_FIRST, 's', 'i', 'n', 'e', 'w', '\r', '\n', 0x1a, '\n'};

/* ---- reading ---- */

/* A block that is being read. */
typedef struct block {
    item_source *s;
    item *it;
    uint64_t left;     /* of the payload */
    uint32_t crc;      /* so far */
    check_range range; /* of an array's indices, or none */
} block;

/* Exactly size bytes of the stream. */
static int take_raw(item_source *s, void *to, size_t size, err *e)
{
    int64_t got = in_read(s->s, to, size, e);
    s->stopped = got < 0 || (size_t)got < size;
    if (got < 0)
        return -1;
    return s->stopped ? item_cut(s, e) : 0;
}

/* Exactly size bytes of the payload. */
static int take(block *b, void *to, size_t size, err *e)
{
    if (size > b->left)
        return item_error(b->s, b->it, e, "its length is less than what it holds; the stream is damaged");
    if (take_raw(b->s, to, size, e))
        return -1;
    b->crc = checksum_add(b->crc, to, size);
    b->left -= size;
    return 0;
}

/* Makes *bytes of *have at least FIRST larger, at most size, with `extra` bytes behind. (What is not touched takes no
 * memory.) */
static int more_room(unsigned char **bytes, uint64_t *have, uint64_t size, size_t extra, err *e)
{
    uint64_t next = 2 * *have < FIRST ? FIRST : 2 * *have;
    next = next < size ? next : size;
    unsigned char *grown = realloc(*bytes, next + extra ? next + extra : 1);
    if (!grown)
        return err_memory(e, "what a block holds");
    mem_large(grown, next + extra);
    *bytes = grown;
    *have = next;
    return 0;
}

/* Of n values of an array that were just read, and are in the cache. */
static void check_piece(block *b, model_type type, void *values, int64_t n)
{
    b->it->finite &= item_canonical(type, values, n);
    b->it->within &= b->range.end >= 0 && check_within(b->range, type, values, n);
}

/* Exactly size bytes of the payload, in memory that grows as they come: a length is only a claim. `extra` bytes more
 * are allocated. canonical: the type whose nan are made so, and whose values the item then says to be finite or not,
 * and within the range, if there is one, or not; or MODEL_TYPES. The caller frees it; NULL with e filled. */
static void *take_grown(block *b, uint64_t size, size_t extra, model_type canonical, err *e)
{
    unsigned char *bytes = NULL;
    uint64_t have = 0, done = 0;
    if (size > b->left || size > PTRDIFF_MAX / 2 - PIECE) {
        item_error(b->s, b->it, e, "its length is less than what it holds; the stream is damaged");
        return NULL;
    }
    do {
        if (done == have && more_room(&bytes, &have, size, extra, e))
            goto fail;
        size_t n = have - done < PIECE ? have - done : PIECE;
        if (take(b, bytes + done, n, e))
            goto fail;
        if (canonical != MODEL_TYPES)
            check_piece(b, canonical, bytes + done, (int64_t)(n / model_type_size(canonical)));
        done += n;
    } while (done < size);
    return bytes;
fail:
    free(bytes);
    return NULL;
}

static int take_u32(block *b, uint32_t *v, err *e)
{
    return take(b, v, sizeof *v, e);
}

/* u32 length and bytes, as a string without NUL, which is the caller's. */
static int take_text(block *b, char **text, err *e)
{
    uint32_t n = 0;
    if (take_u32(b, &n, e))
        return -1;
    char *bytes = take_grown(b, n, 1, MODEL_TYPES, e);
    if (!bytes)
        return -1;
    bytes[n] = 0;
    *text = bytes;
    return memchr(bytes, 0, n) ? item_error(b->s, b->it, e, "a string holds a NUL byte; expected none") : 0;
}

static int read_strings(block *b, int64_t n, err *e)
{
    model_array *a = &b->it->array;
    int64_t capacity = 0, at = 0;
    char **list = NULL;
    int status = (uint64_t)n > b->left / sizeof(uint32_t)
                     ? item_error(b->s, b->it, e, "its length is less than its strings need; the stream is damaged")
                     : mem_grow(&list, &capacity, 1, sizeof *list, a->name, e);
    for (; !status && at < n; at++) {
        status = mem_grow(&list, &capacity, at + 1, sizeof *list, a->name, e);
        if (status)
            break;
        list[at] = NULL;
        status = take_text(b, &list[at], e);
    }
    if (!status) {
        a->str = list;
        return 0;
    }
    while (at--)
        free(list[at]);
    free(list);
    return -1;
}

/* Takes the rest of the payload, which is not kept. */
static int pass_over(block *b, err *e)
{
    unsigned char *scratch = mem_array(PIECE, 1, "reading a model", e);
    int status = scratch ? 0 : -1;
    b->it->passed = true;
    while (!status && b->left) {
        const size_t n = b->left < PIECE ? b->left : PIECE;
        status = take_raw(b->s, scratch, n, e) || item_hurries(b->s, e);
        b->left -= n;
    }
    free(scratch);
    return status;
}

static int read_array(block *b, err *e)
{
    model_array *a = &b->it->array;
    uint32_t type = 0, columns = 0;
    if (take_text(b, &a->name, e) || take_text(b, &a->unit, e) || take_text(b, &a->axis, e) || take_u32(b, &type, e) ||
        take_u32(b, &columns, e))
        return -1;
    if (type >= MODEL_TYPES)
        return item_error(b->s, b->it, e, "its values have an unknown type; expected 0 to 5");
    a->type = (model_type)type;
    a->columns = columns <= INT32_MAX ? (int32_t)columns : -1;
    int64_t n = item_heading(b->s, b->it, e);
    if (n < 0)
        return -1;
    if (a->type == MODEL_STR)
        return read_strings(b, n, e);
    if (b->left != (uint64_t)n * model_type_size(a->type))
        return item_error(b->s, b->it, e, "its length is not that of its rows and columns; the stream is damaged");
    if (item_passes(b->s, b->it, n))
        return pass_over(b, e);
    b->it->finite = b->it->within = true;
    b->range = check_range_of(&b->s->axes, a);
    a->data = take_grown(b, b->left, 0, a->type, e);
    return a->data ? 0 : -1;
}

static int read_payload(block *b, err *e)
{
    item *it = b->it;
    uint64_t count = 0;
    uint32_t status = 0;
    switch (it->kind) {
    case ITEM_META:
        return take_text(b, &it->key, e) || take_text(b, &it->text, e);
    case ITEM_PROV:
        return take_text(b, &it->text, e);
    case ITEM_AXIS:
        if (take_text(b, &it->key, e) || take(b, &count, sizeof count, e))
            return -1;
        it->number = count <= INT64_MAX ? (int64_t)count : -1;
        return 0;
    case ITEM_ARRAY:
        return read_array(b, e);
    case ITEM_BLOCK:
        it->block.payload = take_grown(b, b->left, 0, MODEL_TYPES, e);
        return it->block.payload ? 0 : -1;
    case ITEM_FRAME:
        return take(b, &it->number, sizeof it->number, e) || take(b, &it->time, sizeof it->time, e);
    case ITEM_FAIL:
        if (take_u32(b, &status, e) || take_text(b, &it->text, e))
            return -1;
        it->number = status;
        return 0;
    case ITEM_END:
        break;
    }
    return 0;
}

/* What kind of item the type in it->block is. */
static int find_kind(const block *b, err *e)
{
    item *it = b->it;
    for (int k = ITEM_META; k <= ITEM_FAIL; k++)
        if (k != ITEM_BLOCK && !strcmp(item_type(&(item){.kind = (item_kind)k}), it->block.type)) {
            it->kind = (item_kind)k;
            return it->block.flags
                       ? item_error(b->s, it, e, "its flags are unknown; expected 0 (a newer sinew wrote it?)")
                       : 0;
        }
    it->kind = ITEM_BLOCK;
    if (!check_type(it->block.type)) {
        it->block.type[0] = 0;
        return item_error(b->s, it, e, "its type is not four letters or digits; the stream is damaged");
    }
    if (it->block.type[0] < 'a')
        return item_error(b->s, it, e, "its type is not known and may not be skipped (a newer sinew wrote it?)");
    return 0;
}

static int binary_read(item_source *s, item *it, err *e)
{
    unsigned char head[HEAD] = {0};
    uint32_t crc;
    it->at = ++s->blocks;
    const int cut = take_raw(s, head, HEAD, e);
    s->within = (char)head[0];
    if (cut)
        return -1;
    memcpy(it->block.type, head, 4);
    memcpy(&it->block.flags, head + 4, sizeof it->block.flags);
    memcpy(&it->block.length, head + 8, sizeof it->block.length);
    block b = {.s = s, .it = it, .left = it->block.length, .crc = checksum_add(0, head, HEAD)};
    if (find_kind(&b, e) || read_payload(&b, e))
        return -1;
    if (b.left)
        return item_error(s, it, e, "its length is more than what it holds; the stream is damaged");
    if (take_raw(s, &crc, sizeof crc, e))
        return -1;
    if (crc != b.crc && !it->passed)
        return item_error(s, it, e, "checksum is %08" PRIx32 "; expected %08" PRIx32 ": the stream is damaged", crc,
                          b.crc);
    return 0;
}

static int binary_begin(item_source *s, err *e)
{
    unsigned char head[HEAD] = {0};
    uint32_t crc;
    int64_t got = in_read(s->s, head, HEAD, e);
    if (got < 0)
        return -1;
    if (got < HEAD && !memcmp(head, magic, got < MAGIC ? (size_t)got : MAGIC))
        return item_cut(s, e);
    if (memcmp(head, magic, MAGIC))
        return err_set(e, in_name(s->s), 0,
                       "is not a sinew model, or its line ends were changed in transfer; expected the magic of a "
                       "binary model");
    memcpy(&crc, head + MAGIC + 2, sizeof crc);
    if (crc != checksum_add(0, head, MAGIC + 2))
        return err_set(e, in_name(s->s), 0, "checksum of the version is wrong: the stream is damaged");
    if (head[MAGIC] != ITEM_MAJOR)
        return err_set(e, in_name(s->s), 0, "is a model of format version %d; expected %d", head[MAGIC], ITEM_MAJOR);
    return 0;
}

/* ---- writing ---- */

/* Where a block goes: to a stream, or (o NULL) only into its checksum. */
typedef struct sink {
    out *o;
    uint32_t crc;
} sink;

static void put(sink *k, const void *bytes, size_t size)
{
    k->crc = checksum_add(k->crc, bytes, size);
    if (k->o)
        out_write(k->o, bytes, size);
}

static void put_u32(sink *k, uint32_t v)
{
    put(k, &v, sizeof v);
}

static void put_u64(sink *k, uint64_t v)
{
    put(k, &v, sizeof v);
}

/* model_check and its like hold strings to 32 bits of length. */
static void put_text(sink *k, const char *text)
{
    size_t n = strlen(text);
    put_u32(k, (uint32_t)n);
    put(k, text, n);
}

/* One comparison tells it of two. (Not a bool, which is made of each before the next.) */
static bool has_nan(model_type type, const void *values, int64_t n)
{
    const float *f = values;
    const double *d = values;
    int any = 0;
    if (type == MODEL_F32)
        for (int64_t i = n % 2; i < n; i += 2)
            any |= isunordered(f[i], f[i + 1]);
    if (type == MODEL_F64)
        for (int64_t i = n % 2; i < n; i += 2)
            any |= isunordered(d[i], d[i + 1]);
    if (n % 2)
        any |= (type == MODEL_F32 && isnan(f[0])) || (type == MODEL_F64 && isnan(d[0]));
    return any;
}

/* A piece with nan in it, made canonical in a copy. */
static void put_canonical(sink *k, model_type type, const unsigned char *bytes, size_t size)
{
    double copy[1024];
    while (size) {
        size_t n = size < sizeof copy ? size : sizeof copy;
        memcpy(copy, bytes, n);
        item_canonical(type, copy, (int64_t)(n / model_type_size(type)));
        put(k, copy, n);
        bytes += n;
        size -= n;
    }
}

/* Doubles as floats: rounded some at a time, which stay in the cache. */
static void put_narrow(sink *k, const model_array *a, bool finite)
{
    enum { SOME = 1 << 13 };
    float some[SOME];
    const int64_t n = a->rows * a->columns;
    for (int64_t at = 0; at < n; at += SOME) {
        const int64_t now = n - at < SOME ? n - at : SOME;
        item_round(a->f64 + at, some, now);
        if (!finite)
            item_canonical(MODEL_F32, some, now);
        put(k, some, (size_t)now * sizeof *some);
    }
}

static void put_values(sink *k, const model_array *a, bool finite)
{
    if (a->narrow) {
        put_narrow(k, a, finite);
        return;
    }
    size_t each = model_type_size(a->type), left = (size_t)(a->rows * a->columns) * each;
    const unsigned char *bytes = a->data;
    while (left) {
        size_t n = left < PIECE ? left : PIECE;
        if (!finite && has_nan(a->type, bytes, (int64_t)(n / each)))
            put_canonical(k, a->type, bytes, n);
        else
            put(k, bytes, n);
        bytes += n;
        left -= n;
    }
}

static uint64_t text_length(const char *text)
{
    return sizeof(uint32_t) + strlen(text);
}

static uint64_t array_length(const model_array *a)
{
    int64_t n = a->rows * a->columns;
    uint64_t length = text_length(a->name) + text_length(a->unit) + text_length(a->axis) + 2 * sizeof(uint32_t);
    if (a->type != MODEL_STR)
        return length + (uint64_t)n * model_type_size(model_stored(a));
    for (int64_t i = 0; i < n; i++)
        length += text_length(a->str[i]);
    return length;
}

static void put_array(sink *k, const item *it)
{
    const model_array *a = &it->array;
    put_text(k, a->name);
    put_text(k, a->unit);
    put_text(k, a->axis);
    put_u32(k, model_stored(a));
    put_u32(k, (uint32_t)a->columns);
    if (a->type != MODEL_STR)
        put_values(k, a, it->finite);
    else
        for (int64_t i = 0; i < a->rows * a->columns; i++)
            put_text(k, a->str[i]);
}

static uint64_t payload_length(const item *it)
{
    switch (it->kind) {
    case ITEM_META:
        return text_length(it->key) + text_length(it->text);
    case ITEM_PROV:
        return text_length(it->text);
    case ITEM_AXIS:
        return text_length(it->key) + sizeof(uint64_t);
    case ITEM_ARRAY:
        return array_length(&it->array);
    case ITEM_BLOCK:
        return it->block.length;
    case ITEM_FRAME:
        return sizeof it->number + sizeof it->time;
    case ITEM_FAIL:
        return sizeof(uint32_t) + text_length(it->text);
    case ITEM_END:
        break;
    }
    return 0;
}

static void put_payload(sink *k, const item *it)
{
    switch (it->kind) {
    case ITEM_META:
        put_text(k, it->key);
        put_text(k, it->text);
        break;
    case ITEM_PROV:
        put_text(k, it->text);
        break;
    case ITEM_AXIS:
        put_text(k, it->key);
        put_u64(k, (uint64_t)it->number);
        break;
    case ITEM_ARRAY:
        put_array(k, it);
        break;
    case ITEM_BLOCK:
        for (uint64_t at = 0; at < it->block.length; at += PIECE)
            put(k, it->block.payload + at, it->block.length - at < PIECE ? it->block.length - at : PIECE);
        break;
    case ITEM_FRAME:
        put(k, &it->number, sizeof it->number);
        put(k, &it->time, sizeof it->time);
        break;
    case ITEM_FAIL:
        put_u32(k, (uint32_t)it->number);
        put_text(k, it->text);
        break;
    case ITEM_END:
        break;
    }
}

static uint32_t put_block(out *o, const item *it)
{
    sink k = {.o = o};
    put(&k, item_type(it), 4);
    put_u32(&k, it->kind == ITEM_BLOCK ? it->block.flags : 0);
    put_u64(&k, payload_length(it));
    put_payload(&k, it);
    return k.crc;
}

uint32_t binary_crc(const item *it)
{
    return put_block(NULL, it);
}

static void binary_write(out *o, const item *it)
{
    uint32_t crc = put_block(o, it);
    out_write(o, &crc, sizeof crc);
}

static void binary_write_begin(out *o)
{
    unsigned char head[HEAD];
    memcpy(head, magic, MAGIC);
    head[MAGIC] = ITEM_MAJOR;
    head[MAGIC + 1] = ITEM_MINOR;
    uint32_t crc = checksum_add(0, head, MAGIC + 2);
    memcpy(head + MAGIC + 2, &crc, sizeof crc);
    out_write(o, head, HEAD);
}

const encoding binary_encoding = {false, binary_begin, binary_read, binary_write_begin, binary_write};
