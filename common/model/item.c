#include "model/item.h"

#include "base/mem.h"
#include "model/check.h"
#include "model/values.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void item_free(item *it)
{
    free(it->key);
    free(it->text);
    free(it->block.payload);
    model_array_free(&it->array);
    *it = (item){0};
}

const char *item_type(const item *it)
{
    static const char *const types[] = {
        [ITEM_META] = "META", [ITEM_PROV] = "PROV",  [ITEM_AXIS] = "AXIS", [ITEM_ARRAY] = "ARRY",
        [ITEM_BLOCK] = "",    [ITEM_FRAME] = "FRAM", [ITEM_END] = "DONE",  [ITEM_FAIL] = "FAIL",
    };
    return it->kind == ITEM_BLOCK ? it->block.type : types[it->kind];
}

void item_place(const item_source *s, const item *it, char *place, size_t size)
{
    const char *name = it->array.name ? it->array.name : it->key;
    if (s->how->lines)
        snprintf(place, size, "%s", in_name(s->s));
    else if (name && check_name(name))
        snprintf(place, size, "%s: block %" PRId64 " (%s %s)", in_name(s->s), it->at, item_type(it), name);
    else
        snprintf(place, size, "%s: block %" PRId64 " (%s)", in_name(s->s), it->at, item_type(it));
}

int item_error(const item_source *s, const item *it, err *e, const char *format, ...)
{
    char place[ITEM_PLACE], text[800];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    item_place(s, it, place, sizeof place);
    return err_set(e, place, s->how->lines ? it->at : 0, "%s", text);
}

int item_cut(const item_source *s, err *e)
{
    return err_set(e, in_name(s->s), s->how->lines ? in_lines(s->s) : 0,
                   "the model is cut short; expected `end` (did the tool before this one stop early?)");
}

int64_t item_heading(const item_source *s, item *it, err *e)
{
    model_array *a = &it->array;
    if (!check_name(a->name) || !check_name(a->axis))
        return item_error(s, it, e, "the name of an array or its axis is not of letters, digits and . _ - /");
    if (!check_unit(a->unit))
        return item_error(s, it, e, "array %s has no good unit; expected no spaces, and 1 where it has none", a->name);
    a->rows = model_count(&s->axes, a->axis);
    if (a->rows < 0)
        return item_error(s, it, e, "array %s is over axis %s, which is not there; expected its axis first", a->name,
                          a->axis);
    if (a->columns < 1)
        return item_error(s, it, e, "array %s has %d columns; expected 1 or more", a->name, (int)a->columns);
    int64_t n = check_count(a->rows, a->columns, model_type_size(a->type));
    if (n < 0)
        return item_error(s, it, e, "array %s of %" PRId64 " rows and %d columns is too large for any memory", a->name,
                          a->rows, (int)a->columns);
    return n;
}

bool item_passes(const item_source *s, const item *it, int64_t n)
{
    enum { SHORT = 1 << 13 };
    return s->names && it->array.type != MODEL_STR && n > SHORT;
}

int item_hurries(const item_source *s, err *e)
{
    enum { TEXT = 1 << 26, GUNZIPPED = 1 << 25 }; /* bytes; about a tenth of a second */
    int64_t most = s->how->lines ? TEXT : INT64_MAX;
    if (in_is_gzip(s->s))
        most = GUNZIPPED;
    return s->names && in_taken(s->s) > most
               ? err_set(e, in_name(s->s), 0, "is too large to be looked through for names")
               : 0;
}

bool item_canonical(model_type type, void *values, int64_t n)
{
    if (values_finite(type, values, n))
        return true;
    static const uint32_t nan32 = UINT32_C(0x7fc00000);
    static const uint64_t nan64 = UINT64_C(0x7ff8000000000000);
    float *f = values, quiet32;
    double *d = values, quiet64;
    memcpy(&quiet32, &nan32, sizeof quiet32);
    memcpy(&quiet64, &nan64, sizeof quiet64);
    if (type == MODEL_F32)
        for (int64_t i = 0; i < n; i++)
            f[i] = f[i] == f[i] ? f[i] : quiet32;
    if (type == MODEL_F64)
        for (int64_t i = 0; i < n; i++)
            d[i] = d[i] == d[i] ? d[i] : quiet64;
    return false;
}

int item_widen(model_array *a, err *e)
{
    const int64_t n = a->rows * a->columns;
    const float *from = a->f32;
    double *to = a->data ? mem_array(n, sizeof *to, a->name, e) : NULL;
    if (a->data && !to)
        return -1;
    for (int64_t i = 0; to && i < n; i++)
        to[i] = (double)from[i];
    free(a->data);
    a->f64 = to;
    a->type = MODEL_F64;
    a->narrow = true;
    return 0;
}

void item_round(const double *from, float *to, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        to[i] = (float)from[i];
}

bool item_rounds(const model_array *a)
{
    const double most = (double)FLT_MAX;
    int beyond = 0;
    for (int64_t i = 0; i < a->rows * a->columns; i++) {
        const double size = fabs(a->f64[i]);
        beyond |= (size > most) & (size < INFINITY);
    }
    return !beyond;
}
