/* The activation of a muscle, which follows the level that it is asked for:
 *
 *     da/dt = (u - a) / tau(a, u),   tau = rise (.5 + 1.5 a) where u > a, and fall / (.5 + 1.5 a) where u < a
 *
 * (Thelen 2003, Millard et al. 2013). As levels are known ahead, an activation is solved before it is used: over one
 * span of the level after another, into nodes between which it is a cubic. So it is a function of time alone, whatever
 * steps a run takes and wherever it begins. The owner zeroes an activation to begin with, and frees it.
 */
#ifndef SINEW_ACTIVATION_H
#define SINEW_ACTIVATION_H

#include "base/err.h"

/* s; rise 0: an activation is its level, at once. */
typedef struct activation_times {
    double rise, fall;
} activation_times;

/* A level between two times (s): c[0] + c[1] s + c[2] s^2 + c[3] s^3, s since `from`, but from 0 to 1. */
typedef struct activation_span {
    double from, until, c[4];
} activation_span;

typedef struct activation_node {
    double time, value;
    double before, after; /* 1/s: the slope on its way here, and on its way on */
} activation_node;

typedef struct activation {
    activation_node *node; /* owned; times rise */
    int64_t nodes, room;
} activation;

/* Begins anew with a value at a time (s). -1 with e filled, as for those below. */
int activation_begin(activation *a, double time, double value, err *e);

/* Goes on over a span, which begins where the one before ended. */
int activation_follow(activation *a, const activation_times *times, const activation_span *span, err *e);

/* Goes on until it has come to within 1e-8 of a level that stays. */
int activation_settle(activation *a, const activation_times *times, double level, err *e);

/* The activation at a time: before its first node and from its last on, the value there; 0 where there are
 * none. */
double activation_at(const activation *a, double time);

/* From here on it stays, s. */
double activation_end(const activation *a);

void activation_free(activation *a);

#endif
