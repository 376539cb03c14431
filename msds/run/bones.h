/* What a probe cannot enter: volumes of the model all of whose nodes are rigid, as msds-mesh --fix makes them. Other
 * rigid nodes, such as those of a side, stop nothing. The creator owns the triangles of their outside, which do not
 * move.
 */
#ifndef SINEW_BONES_H
#define SINEW_BONES_H

#include "msds/problem/problem.h"
#include "probe/screw.h"

typedef struct bones {
    int64_t faces;  /* 0: there is no bone */
    double *corner; /* faces x 9: m */
    double *ball;   /* faces x 4: the middle of a ball around a face, and its radius, m */
} bones;

/* Of the problem's model, at its displacement. -1 with e filled on no memory. */
int bones_make(bones *b, const msds_problem *p, const model *m, err *e);
void bones_free(bones *b);

/* How far the probe is from bone, m: `most` where that is farther; 0: it is in it, or touches it. */
double bones_gap(const bones *b, const probe_placed *at, double most);

/* The share of a motion after which bone stops the probe; 1: none does. By conservative advancement: the probe goes on
 * by as much as it is from bone, since no point of it goes farther, until it is within a hundredth of its size. A probe
 * that is as near to begin with may go on where it comes no nearer, and one that begins in bone may go anywhere. */
double bones_stop(const bones *b, const probe *shape, const screw *way);

#endif
