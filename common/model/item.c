#include "model/item.h"

#include "model/check.h"

#include <inttypes.h>
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

void item_place(const item_source *s, int64_t at, const char *what, char *place, size_t size)
{
    if (s->how->lines)
        snprintf(place, size, "%s", in_name(s->s));
    else if (*what)
        snprintf(place, size, "%s: block %" PRId64 " (%s)", in_name(s->s), at, what);
    else
        snprintf(place, size, "%s: block %" PRId64, in_name(s->s), at);
}

int item_error(const item_source *s, int64_t at, const char *what, err *e, const char *format, ...)
{
    char place[600], text[800];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    item_place(s, at, what, place, sizeof place);
    return err_set(e, place, s->how->lines ? at : 0, "%s", text);
}

int item_cut(const item_source *s, err *e)
{
    return err_set(e, in_name(s->s), s->how->lines ? in_lines(s->s) : 0,
                   "the model is cut short; expected `end` (did the tool before this one stop early?)");
}

int64_t item_heading(const item_source *s, item *it, err *e)
{
    model_array *a = &it->array;
    if (!check_name(a->name))
        return item_error(s, it->at, "ARRY", e, "array name '%.60s'; expected letters, digits and . _ - /", a->name);
    if (!check_unit(a->unit))
        return item_error(s, it->at, a->name, e, "unit '%.60s' of array %s; expected no spaces, 1 where it has none",
                          a->unit, a->name);
    a->rows = model_count(&s->axes, a->axis);
    if (a->rows < 0)
        return item_error(s, it->at, a->name, e,
                          "array %s is over axis %.60s, which is not there; expected its axis first", a->name, a->axis);
    if (a->columns < 1)
        return item_error(s, it->at, a->name, e, "array %s has %d columns; expected 1 or more", a->name,
                          (int)a->columns);
    int64_t n = check_count(a->rows, a->columns, model_type_size(a->type));
    if (n < 0)
        return item_error(s, it->at, a->name, e,
                          "array %s of %" PRId64 " rows and %d columns is too large for any memory", a->name, a->rows,
                          (int)a->columns);
    return n;
}

void item_canonical(model_type type, void *values, int64_t n)
{
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
}
