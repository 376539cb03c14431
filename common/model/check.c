#include "model/check.h"

#include "base/chars.h"
#include "model/known.h"
#include "model/values.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

bool check_name(const char *name)
{
    size_t n = 0;
    for (; name[n]; n++)
        if (n == MODEL_NAME - 1 || !(isalnum((unsigned char)name[n]) || strchr("._-/", name[n])))
            return false;
    return n > 0;
}

bool check_unit(const char *unit)
{
    size_t n = 0;
    if (unit[0] == '@')
        return check_name(unit + 1);
    for (; unit[n]; n++)
        if (n == MODEL_NAME - 1 || unit[n] <= ' ' || unit[n] > '~' || unit[n] == '"')
            return false;
    return n > 0;
}

bool check_type(const char *type)
{
    size_t n = 0;
    while (isalnum((unsigned char)type[n]))
        n++;
    return n == 4 && !type[n];
}

const char *check_text(const char *text)
{
    if (strlen(text) > UINT32_MAX)
        return "is longer than 4294967295 bytes";
    return chars_utf8(text) ? NULL : "is not UTF-8";
}

int64_t check_count(int64_t rows, int32_t columns, size_t size)
{
    if (rows < 0 || columns < 1 || rows > PTRDIFF_MAX / columns || rows * columns > (int64_t)(PTRDIFF_MAX / size))
        return -1;
    return rows * columns;
}

/* What a check needs to say where it stands: rows follow the heading's line, one each. */
typedef struct site {
    const model_array *a;
    const char *where;
    int64_t line;
    err *e;
} site;

static int64_t row_line(const site *s, int64_t row)
{
    return s->line > 0 ? s->line + 1 + row : 0;
}

/* Who writes a frame may have floats of what is f64: they are stored as f32, as what is narrow is. */
static bool has_type(const model_array *a, const known *k)
{
    return a->type == k->type || (k->flags & KNOWN_FRAME && k->type == MODEL_F64 && a->type == MODEL_F32);
}

static int check_known(const site *s, const known *k)
{
    const model_array *a = s->a;
    char unit[MODEL_NAME], axis[MODEL_NAME];
    known_expand(k->unit, a->name, unit, sizeof unit);
    known_expand(k->axis, a->name, axis, sizeof axis);
    if (!has_type(a, k))
        return err_set(s->e, s->where, s->line, "array %s has type %s; expected %s", a->name, model_type_name(a->type),
                       model_type_name(k->type));
    if (strcmp(a->unit, unit))
        return err_set(s->e, s->where, s->line, "array %s has unit %s; expected %s", a->name, a->unit, unit);
    if (strcmp(a->axis, axis))
        return err_set(s->e, s->where, s->line, "array %s is over axis %s; expected %s", a->name, a->axis, axis);
    if (!strcmp(k->name, "element.node") && a->columns != 4 && a->columns != 8)
        return err_set(s->e, s->where, s->line,
                       "array element.node has %d columns; expected 8 (hexahedra) or 4 (tetrahedra)", (int)a->columns);
    if (a->columns < k->columns_min || a->columns > k->columns_max)
        return err_set(s->e, s->where, s->line, "array %s has %d columns; expected %d to %d", a->name, (int)a->columns,
                       k->columns_min, k->columns_max);
    return 0;
}

static int64_t index_at(const model_array *a, int64_t i)
{
    return a->type == MODEL_I32 ? a->i32[i] : a->i64[i];
}

check_range check_range_of(const model *m, const model_array *a)
{
    const known *k = a->unit[0] == '@' ? known_find(a->name) : NULL;
    const int64_t low = k && (k->flags & KNOWN_EVERY) ? 0 : -1;
    const bool whole = a->type == MODEL_I32 || a->type == MODEL_I64;
    return (check_range){low, whole && a->unit[0] == '@' ? model_count(m, a->unit + 1) : -1};
}

/* One plain pass, for speed: who failed is looked for afterwards. An i32 is compared as how far it is above `low`,
 * without a sign. */
bool check_within(check_range r, model_type type, const void *values, int64_t n)
{
    const int32_t *narrow = values;
    const int64_t *wide = values, most = INT64_C(1) << 31;
    const uint32_t low = (uint32_t)r.low, span = (uint32_t)((r.end < most ? r.end : most) - r.low);
    bool bad = false;
    if (type == MODEL_I32)
        for (int64_t i = 0; i < n; i++)
            bad |= (uint32_t)narrow[i] - low >= span;
    else
        for (int64_t i = 0; i < n; i++)
            bad |= (wide[i] < r.low) | (wide[i] >= r.end);
    return !bad;
}

static int check_indices(const site *s, const model *m)
{
    const model_array *a = s->a;
    const check_range r = check_range_of(m, a);
    if (model_count(m, a->unit + 1) < 0)
        return err_set(s->e, s->where, s->line,
                       "array %s points to axis %s, which is not there; expected its axis line", a->name, a->unit + 1);
    if (a->type != MODEL_I32 && a->type != MODEL_I64)
        return err_set(s->e, s->where, s->line, "array %s of indices has type %s; expected i32 or i64", a->name,
                       model_type_name(a->type));
    if (check_within(r, a->type, a->data, a->rows * a->columns))
        return 0;
    int64_t i = 0;
    while (index_at(a, i) >= r.low && index_at(a, i) < r.end)
        i++;
    int64_t row = i / a->columns;
    return err_set(s->e, s->where, row_line(s, row),
                   "array %s, row %" PRId64 ": %" PRId64 " is not an index into axis %s; expected %" PRId64
                   " to %" PRId64,
                   a->name, row, index_at(a, i), a->unit + 1, r.low, r.end - 1);
}

static int check_strings(const site *s)
{
    const model_array *a = s->a;
    for (int64_t i = 0; i < a->rows * a->columns; i++) {
        const char *wrong = check_text(a->str[i]);
        if (wrong)
            return err_set(s->e, s->where, row_line(s, i / a->columns), "array %s, row %" PRId64 ": a string %s",
                           a->name, i / a->columns, wrong);
    }
    return 0;
}

/* What the table says of the values themselves. */
static int check_values(const site *s, const known *k, bool finite)
{
    char words[KNOWN_WORDS], values[VALUES_TEXT];
    const int64_t row = values_bad_row(k, s->a, finite);
    if (row < 0)
        return 0;
    known_words(k, words);
    values_text(s->a, row, values);
    return err_set(s->e, s->where, row_line(s, row), "array %s, row %" PRId64 ": %s; expected %s%s", s->a->name, row,
                   values, words, k->flags & KNOWN_NAN ? ", or nan" : "");
}

int check_array(const model_array *a, bool finite, const char *where, int64_t line, err *e)
{
    const site s = {a, where, line, e};
    const known *k = known_find(a->name);
    if ((k && check_known(&s, k)) || (a->type == MODEL_STR && check_strings(&s)))
        return -1;
    return k ? check_values(&s, k, finite) : 0;
}

int check_indexed(const model *m, const model_array *a, const char *where, int64_t line, err *e)
{
    const site s = {a, where, line, e};
    return a->unit[0] == '@' ? check_indices(&s, m) : 0;
}

int model_check(const model *m, const model_array *a, const char *where, int64_t line, err *e)
{
    return check_array(a, false, where, line, e) || check_indexed(m, a, where, line, e) ? -1 : 0;
}
