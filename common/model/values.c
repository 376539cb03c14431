#include "model/values.h"

#include "base/num.h"

#include <math.h>
#include <string.h>

static double value_at(const model_array *a, int64_t i)
{
    switch (a->type) {
    case MODEL_F32:
        return (double)a->f32[i];
    case MODEL_F64:
        return a->f64[i];
    case MODEL_I32:
        return a->i32[i];
    case MODEL_I64:
        return (double)a->i64[i];
    case MODEL_U8:
        return a->u8[i];
    case MODEL_STR:
    case MODEL_TYPES:
        break;
    }
    return 0;
}

/* ---- all values at once, for speed: false where some may be bad */

/* x - x is 0, or nan where x is nan or an infinity, and nan stays. In lanes, which a compiler makes vectors of: this is
 * done to each number that is read. */
#define FINITE(number)                                                                                                 \
    static bool finite_##number(const number *v, int64_t n)                                                            \
    {                                                                                                                  \
        enum { LANES = 64 / sizeof(number) };                                                                          \
        number sum[LANES] = {0}, all = 0;                                                                              \
        int64_t i = 0;                                                                                                 \
        for (; i + LANES <= n; i += LANES)                                                                             \
            for (int k = 0; k < LANES; k++)                                                                            \
                sum[k] += v[i + k] - v[i + k];                                                                         \
        for (; i < n; i++)                                                                                             \
            all += v[i] - v[i];                                                                                        \
        for (int k = 0; k < LANES; k++)                                                                                \
            all += sum[k];                                                                                             \
        return all == 0;                                                                                               \
    }
FINITE(double)
FINITE(float)

bool values_finite(model_type type, const void *values, int64_t n)
{
    if (type == MODEL_F64)
        return finite_double(values, n);
    return type != MODEL_F32 || finite_float(values, n);
}

bool values_must_be_finite(const known *k)
{
    return k->rule != KNOWN_ANY && !(k->flags & KNOWN_NAN);
}

static bool within_f32(const float *v, int64_t n, float low, float high)
{
    int bad = 0;
    for (int64_t i = 0; i < n; i++)
        bad |= !(v[i] >= low) | !(v[i] <= high);
    return !bad;
}

static bool within_u8(const uint8_t *v, int64_t n, int high)
{
    int most = 0;
    for (int64_t i = 0; i < n; i++)
        most = v[i] > most ? v[i] : most;
    return most <= high;
}

static bool is_direction(double square)
{
    return (square >= (1 - KNOWN_LENGTH) * (1 - KNOWN_LENGTH)) & (square <= (1 + KNOWN_LENGTH) * (1 + KNOWN_LENGTH));
}

/* Most elements are of no muscle: rows of zeros are passed over, some at a time. */
static bool directions_f32(const float *v, int64_t rows)
{
    enum { SOME = 16 };
    int bad = 0;
    for (int64_t row = 0; row < rows; row++, v += 3) {
        uint32_t bits[3 * SOME], any = 0;
        if (row + SOME <= rows) {
            memcpy(bits, v, sizeof bits);
            for (int i = 0; i < 3 * SOME; i++)
                any |= bits[i];
            if (!any) {
                row += SOME - 1;
                v += 3 * (SOME - 1);
                continue;
            }
        }
        const double x = (double)v[0], y = (double)v[1], z = (double)v[2], square = x * x + y * y + z * z;
        bad |= !((square == 0) | is_direction(square)); /* no square of a float is too small for a double */
    }
    return !bad;
}

static bool ascending(const int64_t *v, int64_t n)
{
    int bad = n > 0 && v[0] != 0;
    for (int64_t i = 1; i < n; i++)
        bad |= v[i] <= v[i - 1];
    return !bad;
}

static bool all_good(const known *k, const model_array *a)
{
    const int64_t n = a->rows * a->columns;
    switch (k->rule) {
    case KNOWN_ANY:
        return true;
    case KNOWN_FINITE:
        return values_finite(a->type, a->data, n);
    case KNOWN_FROM:
        return (a->type == MODEL_F32 && within_f32(a->f32, n, (float)k->low, (float)k->high)) ||
               (a->type == MODEL_U8 && k->low == 0 && within_u8(a->u8, n, (int)k->high));
    case KNOWN_DIRECTION:
        return a->type == MODEL_F32 && a->columns == 3 && directions_f32(a->f32, a->rows);
    case KNOWN_STARTS:
        return a->type == MODEL_I64 && ascending(a->i64, n);
    case KNOWN_POSE:
    case KNOWN_WEIGHTS:
        break;
    }
    return false;
}

/* ---- row by row */

static bool all_finite(const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

static bool is_nan(const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isnan(v[i]))
            return false;
    return true;
}

static double square_of(const double *v, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += v[i] * v[i];
    return sum;
}

static bool is_zero(const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (v[i] != 0)
            return false;
    return true;
}

static bool is_partition(const double *v)
{
    const double most = fmax(fmax(fabs(v[0]), fabs(v[1])), fmax(fabs(v[2]), fabs(v[3])));
    return fabs(v[0] + v[1] + v[2] + v[3] - 1) <= KNOWN_SUM * fmax(most, 1);
}

/* v: the row's; before: the first value of the row before, -1 where there is none. */
static bool row_good(const known *k, const double *v, int columns, double before)
{
    switch (k->rule) {
    case KNOWN_ANY:
        return true;
    case KNOWN_FINITE:
        return all_finite(v, columns);
    case KNOWN_FROM:
        for (int i = 0; i < columns; i++)
            if (!(v[i] >= k->low && v[i] <= k->high))
                return false;
        return true;
    case KNOWN_DIRECTION:
        return is_zero(v, columns) || is_direction(square_of(v, columns));
    case KNOWN_POSE:
        return all_finite(v, columns) && is_direction(square_of(v + columns - 4, 4));
    case KNOWN_WEIGHTS:
        return all_finite(v, columns) && (columns != 4 || is_partition(v));
    case KNOWN_STARTS:
        return before < 0 ? v[0] == 0 : v[0] > before;
    }
    return false;
}

int64_t values_bad_row(const known *k, const model_array *a, bool finite)
{
    double v[VALUES_MOST] = {0}, before = -1;
    if ((finite && k->rule == KNOWN_FINITE) || all_good(k, a) || a->columns > VALUES_MOST)
        return -1;
    for (int64_t row = 0; row < a->rows; row++) {
        for (int i = 0; i < a->columns; i++)
            v[i] = value_at(a, row * a->columns + i);
        if (!row_good(k, v, a->columns, before) && !(k->flags & KNOWN_NAN && is_nan(v, a->columns)))
            return row;
        before = v[0];
    }
    return -1;
}

void values_text(const model_array *a, int64_t row, char to[VALUES_TEXT])
{
    char *at = to;
    for (int i = 0; i < a->columns && i < VALUES_MOST; i++) {
        if (i)
            *at++ = ' ';
        at += num_text(value_at(a, row * a->columns + i), model_stored(a) == MODEL_F32, at);
    }
    *at = '\0';
}
