#include "console/colouring.h"

#include "console/json.h"
#include "mesh/quality.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name, *unit;
} table[COLOURINGS] = {{"own", ""}, {"displacement", "m"}, {"speed", "m/s"}, {"quality", "J"}};

const char *colouring_name(colouring is)
{
    return table[is].name;
}

int colouring_find(const char *name)
{
    for (int i = 0; i < COLOURINGS; i++)
        if (!strcmp(table[i].name, name))
            return i;
    return -1;
}

void colouring_put(out *to)
{
    out_text(to, "\"colours\":[");
    for (int i = COLOURING_DISPLACEMENT; i < COLOURINGS; i++) {
        out_text(to, i > COLOURING_DISPLACEMENT ? "," : "");
        json_text(table[i].name, to);
    }
    out_text(to, "],\"units\":{");
    for (int i = COLOURING_DISPLACEMENT; i < COLOURINGS; i++) {
        out_text(to, i > COLOURING_DISPLACEMENT ? "," : "");
        json_text(table[i].name, to);
        out_text(to, ":");
        json_text(table[i].unit, to);
    }
    out_text(to, "}");
}

/* 1, 2 or 5 times a power of ten, at least x. */
static double round_up(double x)
{
    const double power = pow(10, floor(log10(x)));
    for (int i = 0; i < 2; i++)
        if (x <= (i ? 2 : 1) * power)
            return (i ? 2 : 1) * power;
    return x <= 5 * power ? 5 * power : 10 * power;
}

static void fill_speed(const model_array *v, double *value, geometry_frame *to)
{
    static const double least = 1e-3; /* m/s */
    double most = least;
    for (int64_t n = 0; n < v->rows; n++) {
        const double *x = v->f64 + 3 * n;
        value[n] = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        most = fmax(most, value[n]);
    }
    to->value = value;
    to->low = 0;
    to->high = round_up(most);
}

static void fill_quality(const model *m, double *value, geometry_frame *to)
{
    static const double step = .1;
    const model_array *node = model_find(m, "element.node"), *rest = model_find(m, "node.position");
    const quality_mesh mesh = {node->i32, node->columns, node->rows, rest->f64, NULL};
    double least = 1, most = 1;
    for (int64_t n = 0; n < rest->rows; n++)
        value[n] = INFINITY;
    for (int64_t i = 0; i < node->rows; i++) {
        const double j = quality_of(&mesh, i, to->u).corner;
        for (int k = 0; k < node->columns; k++) {
            double *at = &value[node->i32[node->columns * i + k]];
            *at = fmin(*at, j); /* which leaves out nan */
        }
    }
    for (int64_t n = 0; n < rest->rows; n++) {
        value[n] = isfinite(value[n]) ? value[n] : 1;
        least = fmin(least, value[n]);
        most = fmax(most, value[n]);
    }
    to->value = value;
    to->low = step * floor(least / step);
    to->high = step * ceil(most / step);
    to->low -= to->low < to->high ? 0 : step;
}

void colouring_fill(colouring is, const model *m, const frame *f, double *value, geometry_frame *to)
{
    const model_array *v = frame_find(f, "node.velocity");
    if (is == COLOURING_SPEED && v && v->type == MODEL_F64 && v->rows == model_count(m, "node"))
        fill_speed(v, value, to);
    if (is == COLOURING_QUALITY)
        fill_quality(m, value, to);
}
