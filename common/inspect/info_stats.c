#include "inspect/info_stats.h"

#include "base/num.h"
#include "model/source.h"

#include <inttypes.h>
#include <math.h>

bool info_is_vector(const model_array *a)
{
    return a->columns == 3 && (a->type == MODEL_F32 || a->type == MODEL_F64);
}

/* Takes one value (a norm, for vectors) into the range. */
static void widen(info_stats *s, double value, int64_t row)
{
    s->min = fmin(s->min, value);
    if (!isnan(value) && !(value <= s->max)) {
        s->max = value;
        s->at_max = row;
    }
}

static void take_vector(info_stats *s, const model_array *a, int64_t row)
{
    double v[3], square = 0;
    for (int c = 0; c < 3; c++) {
        v[c] = source_value(a, row * 3 + c);
        s->sum[c] += v[c];
        s->nans += isnan(v[c]);
        square += v[c] * v[c];
    }
    widen(s, sqrt(square), row);
}

/* Takes the value at `at` into the range, and into that of i64. */
static void take_value(info_stats *s, const model_array *a, int64_t at)
{
    double v = source_value(a, at);
    s->sum[0] += v;
    s->nans += isnan(v);
    widen(s, v, at / a->columns);
    if (a->type != MODEL_I64)
        return;
    s->min_i64 = a->i64[at] < s->min_i64 ? a->i64[at] : s->min_i64;
    s->max_i64 = a->i64[at] > s->max_i64 ? a->i64[at] : s->max_i64;
}

static info_stats none(int64_t count)
{
    return (info_stats){
        .min = NAN, .max = NAN, .min_i64 = INT64_MAX, .max_i64 = INT64_MIN, .at_max = -1, .count = count};
}

info_stats info_stats_of(const model_array *a)
{
    bool vector = info_is_vector(a);
    info_stats s = none(vector ? a->rows : a->rows * a->columns);
    for (int64_t i = 0; i < s.count; i++)
        if (vector)
            take_vector(&s, a, i);
        else
            take_value(&s, a, i);
    return s;
}

info_stats info_column_of(const model_array *a, int32_t column)
{
    info_stats s = none(a->rows);
    for (int64_t i = 0; i < a->rows; i++)
        take_value(&s, a, i * a->columns + column);
    return s;
}

void info_put_number(double value, model_type from, out *to)
{
    char text[NUM_TEXT];
    num_text(value, from == MODEL_F32, text);
    out_text(to, text);
}

void info_put_end(const model_array *a, const info_stats *s, bool max, out *to)
{
    const model_type type = info_is_vector(a) ? MODEL_F64 : model_stored(a);
    if (a->type == MODEL_I64 && s->count)
        out_format(to, "%" PRId64, max ? s->max_i64 : s->min_i64);
    else
        info_put_number(max ? s->max : s->min, type, to);
}

void info_put_value(const model_array *a, int64_t at, out *to)
{
    if (a->type == MODEL_I64)
        out_format(to, "%" PRId64, a->i64[at]);
    else
        info_put_number(source_value(a, at), model_stored(a), to);
}
