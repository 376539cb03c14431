#include "tled/muscle/activation.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>

static const double tolerance = 1e-8; /* of a step, and of what is still to go where a level stays */

void activation_free(activation *a)
{
    free(a->node);
    *a = (activation){0};
}

/* ---- The equation */

static double level_at(const activation_span *span, double time)
{
    const double s = time - span->from, *c = span->c;
    return num_clamp(c[0] + s * (c[1] + s * (c[2] + s * c[3])), 0, 1);
}

static bool is_constant(const activation_span *span)
{
    return span->c[1] == 0 && span->c[2] == 0 && span->c[3] == 0;
}

typedef struct rate {
    double slope;      /* 1/s: da/dt */
    double derivative; /* 1/s: of that by a */
} rate;

static rate rate_of(const activation_times *times, double level, double value)
{
    const double gap = level - value, factor = .5 + 1.5 * fmax(value, 0);
    if (gap > 0)
        return (rate){gap / (times->rise * factor), -(.5 + 1.5 * level) / (times->rise * factor * factor)};
    return (rate){gap * factor / times->fall, (1.5 * gap - factor) / times->fall};
}

/* s: in which it would get there if it went on so. */
static double time_constant(const activation_times *times, double level, double value)
{
    const double factor = .5 + 1.5 * value;
    return level > value ? times->rise * factor : times->fall / factor;
}

/* ---- A step: the cubic between two nodes that has the slopes of the equation at both ends and in its middle
 * (collocation at the points of Lobatto IIIA, of order 4), for it is stable however long the step is. */

typedef struct stepper {
    const activation_times *times;
    const activation_span *span;
} stepper;

/* What is left of the equation for a value at the end of a step; and its derivative by that value. */
static double residual(const stepper *s, double time, double value, double h, double end, double *derivative)
{
    const rate begins = rate_of(s->times, level_at(s->span, time), value);
    const rate ends = rate_of(s->times, level_at(s->span, time + h), end);
    const double middle = (value + end) / 2 + h / 8 * (begins.slope - ends.slope);
    const rate half = rate_of(s->times, level_at(s->span, time + h / 2), middle);
    *derivative = 1 - h / 6 * (4 * half.derivative * (.5 - h / 8 * ends.derivative) + ends.derivative);
    return end - value - h / 6 * (begins.slope + 4 * half.slope + ends.slope);
}

/* The value at the end of a step: the residual rises with it, so Newton's method is kept between bounds that close
 * in. */
static double end_of_step(const stepper *s, double time, double value, double h)
{
    enum { MOST = 60 };
    double low = 0, high = 1, end = value, derivative;
    for (int i = 0; i < MOST; i++) {
        const double rest = residual(s, time, value, h, end, &derivative);
        if (rest > 0)
            high = end;
        else
            low = end;
        double next = end - rest / derivative;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (!(fabs(next - end) > 1e-15))
            return next;
        end = next;
    }
    return end;
}

static double slope_at(const stepper *s, double time, double value)
{
    return rate_of(s->times, level_at(s->span, time), value).slope;
}

static activation_node *last_of(const activation *a)
{
    return &a->node[a->nodes - 1];
}

/* The activation has come from its last node to this value. */
static int add_node(activation *a, const stepper *s, double time, double value, err *e)
{
    if (MEM_ROOM(&a->node, &a->room, a->nodes + 1, "activations", e))
        return -1;
    activation_node *was = last_of(a);
    was->after = slope_at(s, was->time, was->value);
    a->node[a->nodes++] = (activation_node){.time = time, .value = value, .before = slope_at(s, time, value)};
    return 0;
}

int activation_begin(activation *a, double time, double value, err *e)
{
    a->nodes = 0;
    if (MEM_ROOM(&a->node, &a->room, 1, "activations", e))
        return -1;
    a->node[a->nodes++] = (activation_node){.time = time, .value = value};
    return 0;
}

/* ---- From node to node */

/* How much a step of 2 h differs from two of h: at their end; and between, where the cubic's error goes by h^4. */
static double error_of(const stepper *s, double time, double value, double h, double half, double end)
{
    const double whole = end_of_step(s, time, value, 2 * h);
    const double turn = slope_at(s, time, value) - slope_at(s, time + 2 * h, whole);
    return fmax(fabs(whole - end), fabs((value + whole) / 2 + h / 4 * turn - half) / 16);
}

/* Two steps of h, or, where one of 2 h differs from them by more than the tolerance, none. Sets *error. */
static int try_two(activation *a, const stepper *s, double h, double until, double *error, err *e)
{
    const double time = last_of(a)->time, value = last_of(a)->value;
    const double half = end_of_step(s, time, value, h), end = end_of_step(s, time + h, half, h);
    const double least = 1e-9 * fmin(s->times->rise, s->times->fall);
    *error = error_of(s, time, value, h, half, end);
    if (!(*error <= tolerance) && h > least)
        return 0;
    return add_node(a, s, time + h, half, e) || add_node(a, s, fmin(time + 2 * h, until), end, e) ? -1 : 1;
}

/* Where a level stays, steps of many time constants would not come closer to it. */
static double longest(const activation *a, const stepper *s)
{
    const double value = last_of(a)->value;
    return is_constant(s->span) ? 2 * time_constant(s->times, level_at(s->span, s->span->from), value)
                                : (double)INFINITY;
}

static bool has_settled(const activation *a, const stepper *s)
{
    return is_constant(s->span) && fabs(level_at(s->span, s->span->from) - last_of(a)->value) <= tolerance;
}

/* It is at the span's level from here on, to its end. */
static int stay(activation *a, const stepper *s, err *e)
{
    const double until = s->span->until, level = level_at(s->span, isfinite(until) ? until : s->span->from);
    last_of(a)->value = level;
    last_of(a)->after = 0;
    return isfinite(until) && until > last_of(a)->time ? add_node(a, s, until, level, e) : 0;
}

int activation_follow(activation *a, const activation_times *times, const activation_span *span, err *e)
{
    const stepper s = {times, span};
    double h = fmin(times->rise, times->fall) / 16, error;
    while (last_of(a)->time < span->until) {
        const double left = (span->until - last_of(a)->time) / 2, step = fmin(fmin(h, left), longest(a, &s));
        const bool lost = !(last_of(a)->time + step > last_of(a)->time); /* in the digits of so late a time */
        if (lost || has_settled(a, &s))
            return stay(a, &s, e);
        const int took = try_two(a, &s, step, span->until, &error, e);
        if (took < 0)
            return -1;
        if (step == left && took)
            last_of(a)->time = span->until;
        if (!took)
            h = step / 2;
        else if (error < tolerance / 64)
            h = 2 * step;
    }
    return 0;
}

int activation_settle(activation *a, const activation_times *times, double level, err *e)
{
    return activation_follow(a, times, &(activation_span){last_of(a)->time, INFINITY, {level, 0, 0, 0}}, e);
}

/* ---- What comes of it */

double activation_at(const activation *a, double time)
{
    int64_t low = 0, high = a->nodes;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (a->node[middle].time <= time)
            low = middle + 1;
        else
            high = middle;
    }
    if (!a->nodes)
        return 0;
    if (low == 0 || low == a->nodes)
        return a->node[low ? low - 1 : 0].value;
    const activation_node *from = &a->node[low - 1], *to = &a->node[low];
    const double h = to->time - from->time, s = (time - from->time) / h, r = 1 - s;
    const double value = r * r * (1 + 2 * s) * from->value + s * s * (1 + 2 * r) * to->value +
                         s * r * h * (r * from->after - s * to->before);
    return num_clamp(value, 0, 1);
}

double activation_end(const activation *a)
{
    return a->nodes ? last_of(a)->time : 0;
}
