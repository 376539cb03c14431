/* What a probe does, a line each, as poses: it is put somewhere (stand.h), and from there it is pressed, swept, fanned,
 * rocked, turned, moved or held, each for so many seconds; what moves begins and ends slowly. Poses are written as the
 * lines come. The caller owns it; it borrows the places and what is written to.
 */
#ifndef SINEW_PLAN_H
#define SINEW_PLAN_H

#include "base/out.h"
#include "plan/stand.h"

typedef struct plan {
    const stand *s;
    out *to;
    double rate;    /* poses a second */
    bool is_placed; /* there was a place */
    pose at;        /* where the probe is at the time so far */
    double time;    /* s */
    int64_t poses;  /* written */
    double tremor;  /* m: of the hand, from here on, */
    double hertz;   /* at about this frequency */
} plan;

/* Takes a line, and writes the poses up to its end. -1 with e filled, with the line. */
int plan_take(plan *p, const keyfile *k, err *e);

/* Writes the last pose. -1 with e filled where there was no place. */
int plan_end(plan *p, const keyfile *k, err *e);

#endif
