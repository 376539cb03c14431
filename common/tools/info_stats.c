#include "tools/info_stats.h"

#include "base/num.h"
#include "model/source.h"

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

info_stats info_stats_of(const model_array *a)
{
    bool vector = info_is_vector(a);
    info_stats s = {.min = NAN, .max = NAN, .at_max = -1, .count = vector ? a->rows : a->rows * a->columns};
    for (int64_t i = 0; i < s.count; i++) {
        if (vector) {
            take_vector(&s, a, i);
            continue;
        }
        double v = source_value(a, i);
        s.sum[0] += v;
        s.nans += isnan(v);
        widen(&s, v, i / a->columns);
    }
    return s;
}

void info_column_range(const model_array *a, int32_t column, double *low, double *high)
{
    *low = *high = NAN;
    for (int64_t i = 0; i < a->rows; i++) {
        double v = source_value(a, i * a->columns + column);
        *low = fmin(*low, v);
        *high = fmax(*high, v);
    }
}

void info_put_number(double value, model_type from, out *to)
{
    char text[NUM_TEXT];
    num_text(value, from == MODEL_F32, text);
    out_text(to, text);
}
