#include "model/model.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"
#include "model/check.h"
#include "model/known.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    size_t size;
} types[MODEL_TYPES] = {
    [MODEL_F32] = {"f32", sizeof(float)},   [MODEL_F64] = {"f64", sizeof(double)},
    [MODEL_I32] = {"i32", sizeof(int32_t)}, [MODEL_I64] = {"i64", sizeof(int64_t)},
    [MODEL_U8] = {"u8", sizeof(uint8_t)},   [MODEL_STR] = {"str", sizeof(char *)},
};

size_t model_type_size(model_type t)
{
    return types[t].size;
}

const char *model_type_name(model_type t)
{
    return types[t].name;
}

model_type model_type_of(const char *name)
{
    for (int t = 0; t < MODEL_TYPES; t++)
        if (!strcmp(types[t].name, name))
            return (model_type)t;
    return MODEL_TYPES;
}

void model_array_free(model_array *a)
{
    if (a->type == MODEL_STR && a->data && !a->lent)
        for (int64_t i = 0; i < a->rows * a->columns; i++)
            free(a->str[i]);
    if (!a->lent)
        free(a->data);
    free(a->name);
    free(a->unit);
    free(a->axis);
    *a = (model_array){0};
}

static void arrays_free(model_arrays *list)
{
    for (int i = 0; i < list->count; i++)
        model_array_free(&list->v[i]);
    free(list->v);
    lookup_free(&list->index);
    *list = (model_arrays){0};
}

void model_free(model *m)
{
    for (int i = 0; i < m->metas; i++) {
        free(m->meta[i].key);
        free(m->meta[i].value);
    }
    for (int i = 0; i < m->provs; i++)
        free(m->prov[i]);
    for (int i = 0; i < m->axis_count; i++)
        free(m->axes[i].name);
    for (int i = 0; i < m->block_count; i++)
        free(m->blocks[i].payload);
    free(m->meta);
    free(m->prov);
    free(m->axes);
    free(m->blocks);
    free(m->stream);
    lookup_free(&m->meta_index);
    lookup_free(&m->axis_index);
    arrays_free(&m->arrays);
    *m = (model){0};
}

void frame_free(frame *f)
{
    arrays_free(&f->arrays);
    *f = (frame){0};
}

/* Room for one more in a list that has count things; the list's pointer is at `list`. Returns that room, or NULL. */
static void *one_more(void *list, int count, size_t size, err *e)
{
    /* Doubling by counts alone: room is made at each power of two. */
    int64_t capacity = count;
    char *first;
    if (!(count & (count - 1))) {
        if (count > INT32_MAX / 2) {
            err_memory(e, "the model");
            return NULL;
        }
        if (mem_grow(list, &capacity, count ? 2 * (int64_t)count : 16, size, "the model", e))
            return NULL;
    }
    memcpy(&first, list, sizeof first);
    return first + (size_t)count * size;
}

static char **meta_at(const model *m, const char *key)
{
    int i = lookup_find(&m->meta_index, m->meta, sizeof *m->meta, key);
    return i < 0 ? NULL : &m->meta[i].value;
}

const char *model_meta_of(const model *m, const char *key)
{
    char **value = meta_at(m, key);
    return value ? *value : NULL;
}

int model_meta_set(model *m, const char *key, const char *value, err *e)
{
    if (!check_name(key))
        return err_set(e, NULL, 0, "metadata '%.60s': expected a key of letters, digits and . _ - /", key);
    const char *wrong = check_text(value);
    if (wrong)
        return err_set(e, NULL, 0, "metadata %s: its value %s", key, wrong);
    char *copy = mem_text(value, e), **old = meta_at(m, key);
    if (!copy)
        return -1;
    if (old) {
        free(*old);
        *old = copy;
        return 0;
    }
    char *name = mem_text(key, e);
    model_meta *at = name ? one_more(&m->meta, m->metas, sizeof *m->meta, e) : NULL;
    if (!at)
        goto fail;
    *at = (model_meta){name, copy};
    if (lookup_add(&m->meta_index, m->meta, sizeof *m->meta, m->metas + 1, e))
        goto fail;
    m->metas++;
    return 0;
fail:
    free(name);
    free(copy);
    return -1;
}

int model_meta_numbers(const model *m, const char *key, double *value, int count, err *e)
{
    const char *text = model_meta_of(m, key);
    if (!text)
        return err_set(e, NULL, 0, "the model has no metadata %s; expected %d number%s", key, count,
                       count == 1 ? "" : "s");
    const char *p = text, *end = text + strlen(text);
    for (int i = 0; i < count; i++) {
        p += strspn(p, " ");
        if (num_scan(p, end, &p, &value[i]) || (*p && *p != ' '))
            return err_set(e, NULL, 0, "metadata %s is \"%.100s\"; expected %d number%s", key, text, count,
                           count == 1 ? "" : "s");
    }
    if (p[strspn(p, " ")])
        return err_set(e, NULL, 0, "metadata %s is \"%.100s\"; expected no more than %d number%s", key, text, count,
                       count == 1 ? "" : "s");
    return 0;
}

int model_meta_set_numbers(model *m, const char *key, const double *value, int count, err *e)
{
    enum { WIDTH = NUM_TEXT + 1 };
    char *text = mem_array(count, WIDTH, "metadata", e), *p = text;
    if (!text)
        return -1;
    for (int i = 0; i < count; i++) {
        if (i)
            *p++ = ' ';
        p += num_text(value[i], false, p);
    }
    int status = model_meta_set(m, key, text, e);
    free(text);
    return status;
}

int model_prov_add(model *m, const char *tool, const char *version, const char *options, err *e)
{
    if (!check_name(tool) || !check_name(version))
        return err_set(e, NULL, 0, "provenance '%.60s %.60s': expected a tool's name and version", tool, version);
    size_t size = strlen(tool) + strlen(version) + strlen(options) + 3;
    if (size - 1 > UINT32_MAX)
        return err_set(e, NULL, 0, "provenance of %s: %zu bytes; expected at most %" PRIu32, tool, size - 1,
                       UINT32_MAX);
    char *line = mem_array((int64_t)size, 1, "provenance", e);
    char **at = line ? one_more(&m->prov, m->provs, sizeof *m->prov, e) : NULL;
    if (!at) {
        free(line);
        return -1;
    }
    snprintf(line, size, "%s %s%s%s", tool, version, *options ? " " : "", options);
    chars_mend(line);
    *at = line;
    m->provs++;
    return 0;
}

static int axis_at(const model *m, const char *axis)
{
    return lookup_find(&m->axis_index, m->axes, sizeof *m->axes, axis);
}

int64_t model_count(const model *m, const char *axis)
{
    int i = axis_at(m, axis);
    return i < 0 ? -1 : m->axes[i].count;
}

int model_axis_add(model *m, const char *axis, int64_t count, err *e)
{
    int64_t had = model_count(m, axis);
    if (had == count && count >= 0)
        return 0;
    if (had >= 0)
        return err_set(e, NULL, 0, "the model has an axis %s of %" PRId64 " already; expected %" PRId64, axis, had,
                       count);
    if (!check_name(axis) || count < 0)
        return err_set(e, NULL, 0, "axis '%.60s': expected a name of letters, digits and . _ - / and a count", axis);
    char *name = mem_text(axis, e);
    model_axis *at = name ? one_more(&m->axes, m->axis_count, sizeof *m->axes, e) : NULL;
    if (!at)
        goto fail;
    *at = (model_axis){name, count};
    if (lookup_add(&m->axis_index, m->axes, sizeof *m->axes, m->axis_count + 1, e))
        goto fail;
    m->axis_count++;
    return 0;
fail:
    free(name);
    return -1;
}

int model_block_take(model *m, model_block *b, err *e)
{
    model_block *at = one_more(&m->blocks, m->block_count, sizeof *m->blocks, e);
    if (!at)
        return -1;
    *at = *b;
    m->block_count++;
    *b = (model_block){0};
    return 0;
}

model_array *model_arrays_find(const model_arrays *list, const char *name)
{
    int i = lookup_find(&list->index, list->v, sizeof *list->v, name);
    return i < 0 ? NULL : &list->v[i];
}

model_array *model_find(const model *m, const char *name)
{
    return model_arrays_find(&m->arrays, name);
}

model_array *frame_find(const frame *f, const char *name)
{
    return model_arrays_find(&f->arrays, name);
}

model_array *model_need(const model *m, const char *name, err *e)
{
    model_array *a = model_find(m, name);
    const known *k = a ? NULL : known_find(name);
    if (k)
        err_set(e, NULL, 0, "the model has no %s; expected a model from %s", name, k->maker ? k->maker : "elsewhere");
    else if (!a)
        err_set(e, NULL, 0, "the model has no array %s", name);
    return a;
}

model_array *model_arrays_take(model_arrays *list, model_array *a, err *e)
{
    model_array *at = model_arrays_find(list, a->name);
    if (at) {
        model_array_free(at);
        *at = *a;
    } else {
        at = one_more(&list->v, list->count, sizeof *list->v, e);
        if (!at)
            return NULL;
        *at = *a;
        if (lookup_add(&list->index, list->v, sizeof *list->v, list->count + 1, e))
            return NULL;
        list->count++;
    }
    *a = (model_array){0};
    return at;
}

static int make_strings(model_array *a, int64_t n, err *e)
{
    for (int64_t i = 0; i < n; i++) {
        a->str[i] = mem_text("", e);
        if (!a->str[i])
            return -1;
    }
    return 0;
}

/* An array, owned by the caller, of what is lent, or zeroed; the names are checked. */
static int make(model_array *a, const char *name, model_type type, const char *unit, const char *axis, int64_t rows,
                int32_t columns, const double *lent, err *e)
{
    int64_t n = check_count(rows, columns, model_type_size(type));
    *a = (model_array){.type = type, .columns = columns, .rows = rows, .lent = lent != NULL};
    if (!check_name(name) || !check_unit(unit))
        return err_set(e, NULL, 0, "array '%.60s' in '%.60s': expected a name and a unit without spaces", name, unit);
    if (rows < 0)
        return err_set(e, NULL, 0, "array %s: the model has no axis %s", name, axis);
    if (n < 0)
        return err_set(e, NULL, 0, "array %s: %" PRId64 " rows of %d columns are too many", name, rows, (int)columns);
    a->name = mem_text(name, e);
    a->unit = mem_text(unit, e);
    a->axis = mem_text(axis, e);
    if (lent)
        memcpy(&a->f64, &lent, sizeof lent); /* not const there, but only read */
    else
        a->data = mem_array(n, model_type_size(type), name, e);
    if (!a->name || !a->unit || !a->axis || !a->data || (type == MODEL_STR && make_strings(a, n, e))) {
        model_array_free(a);
        return -1;
    }
    return 0;
}

static model_array *add(model_arrays *list, const model *m, const char *name, model_type type, const char *unit,
                        const char *axis, int32_t columns, const double *lent, err *e)
{
    model_array a;
    if (make(&a, name, type, unit, axis, model_count(m, axis), columns, lent, e))
        return NULL;
    model_array *at = model_arrays_take(list, &a, e);
    if (!at)
        model_array_free(&a);
    return at;
}

static model_array *add_known(model_arrays *list, const model *m, const char *name, int in_frame, err *e)
{
    char unit[MODEL_NAME], axis[MODEL_NAME];
    const known *k = known_find(name);
    if (!k || (k->flags & KNOWN_FRAME) != in_frame) {
        err_set(e, NULL, 0, "array %s is not known %s", name, in_frame ? "in frames" : "in a model's body");
        return NULL;
    }
    known_expand(k->unit, name, unit, sizeof unit);
    known_expand(k->axis, name, axis, sizeof axis);
    return add(list, m, name, k->type, unit, axis, k->columns_max, NULL, e);
}

model_array *model_add(model *m, const char *name, err *e)
{
    return add_known(&m->arrays, m, name, 0, e);
}

model_array *frame_add(frame *f, const model *m, const char *name, err *e)
{
    return add_known(&f->arrays, m, name, KNOWN_FRAME, e);
}

model_array *frame_lend(frame *f, const model *m, const char *name, const char *unit, const char *axis, int32_t columns,
                        const double *numbers, err *e)
{
    return add(&f->arrays, m, name, MODEL_F64, unit, axis, columns, numbers, e);
}

void model_array_lend(model_array *a, model_type type, const void *numbers)
{
    a->type = type;
    memcpy(&a->data, &numbers, sizeof numbers); /* not const there, but only read */
}

model_array *model_add_as(model *m, const char *name, model_type type, const char *unit, const char *axis,
                          int32_t columns, err *e)
{
    return add(&m->arrays, m, name, type, unit, axis, columns, NULL, e);
}

int model_set_text(model_array *a, int64_t at, const char *text, err *e)
{
    const char *wrong = check_text(text);
    if (wrong)
        return err_set(e, NULL, 0, "array %s, row %" PRId64 ": '%.60s' %s", a->name, at / a->columns, text, wrong);
    char *copy = mem_text(text, e);
    if (!copy)
        return -1;
    free(a->str[at]);
    a->str[at] = copy;
    return 0;
}

static void remove_all(model_arrays *list, bool goes(const model_array *a, const void *context), const void *context)
{
    int kept = 0, had = list->count;
    for (int i = 0; i < had; i++) {
        if (goes(&list->v[i], context))
            model_array_free(&list->v[i]);
        else
            list->v[kept++] = list->v[i];
    }
    list->count = kept;
    if (kept < had)
        lookup_again(&list->index, list->v, sizeof *list->v, kept);
}

void model_remove_all(model *m, bool goes(const model_array *a, const void *context), const void *context)
{
    remove_all(&m->arrays, goes, context);
}

void frame_remove_all(frame *f, bool goes(const model_array *a, const void *context), const void *context)
{
    remove_all(&f->arrays, goes, context);
}

static bool is_named(const model_array *a, const void *name)
{
    return !strcmp(a->name, name);
}

void model_remove(model *m, const char *name)
{
    char copy[MODEL_NAME];
    snprintf(copy, sizeof copy, "%s", name); /* it may be the array's own */
    if (model_find(m, name))
        model_remove_all(m, is_named, copy);
}

static bool is_over(const model_array *a, const char *axis)
{
    return !strcmp(a->axis, axis);
}

static bool is_of_axis(const model_array *a, const void *axis)
{
    return is_over(a, axis) || (a->unit[0] == '@' && !strcmp(a->unit + 1, axis));
}

void model_axis_drop(model *m, const char *axis, notes *warnings)
{
    int at = axis_at(m, axis);
    for (int i = m->arrays.count - 1; i >= 0; i--) {
        const model_array *a = &m->arrays.v[i];
        if (is_of_axis(a, axis) && !known_find(a->name))
            notes_add(warnings, "array %s is dropped: it %s axis %s, which changes", a->name,
                      is_over(a, axis) ? "is over" : "points to", axis);
    }
    model_remove_all(m, is_of_axis, axis);
    if (at < 0)
        return;
    free(m->axes[at].name);
    m->axis_count--;
    memmove(&m->axes[at], &m->axes[at + 1], (size_t)(m->axis_count - at) * sizeof *m->axes);
    lookup_again(&m->axis_index, m->axes, sizeof *m->axes, m->axis_count);
}

const char *model_surface(const model *m, int *at, char *name, size_t size)
{
    static const char end[] = "/vertex";
    size_t tail = sizeof end - 1;
    while (*at < m->axis_count) {
        const char *axis = m->axes[(*at)++].name;
        size_t n = strlen(axis);
        if (n <= tail || strcmp(axis + n - tail, end) != 0 || known_users(axis))
            continue;
        snprintf(name, size, "%.*s", (int)(n - tail), axis);
        return name;
    }
    return NULL;
}
