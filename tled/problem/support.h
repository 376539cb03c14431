/* How elements hang together, node by node, and on what is held: how far it is to there, from which the damping and the
 * lowest frequency are guessed; parts that nothing holds, and parts that gravity pulls along an axis along which
 * nothing does. Owns nothing.
 */
#ifndef SINEW_SUPPORT_H
#define SINEW_SUPPORT_H

#include "tled/problem/state.h"

typedef struct support {
    /* m: the farthest that a node is from one that is held in the same component, in steps from element to element
     * times the longest side, of the component where that is most. One that is held everywhere, or nowhere, has none;
     * where none has one, the diagonal of the bounding box. */
    double reach;
    int64_t loose;   /* parts that nothing holds in any component */
    int64_t first;   /* the first element of them, or -1 */
    int64_t in_them; /* elements */
    bool pushed;     /* gravity or a force acts on one of them */
    /* Where components are held apart: the first element that gravity pulls along an axis along which nothing holds its
     * part, or -1. */
    int64_t falling;
    int falls_along; /* that axis */
} support;

/* -1 with e filled. */
int support_of(const tled_problem *p, support *of, err *e);

/* Refuses what never comes to rest in a run that is to, and warns of what nothing holds. pressed: by a probe, which, as
 * a force, may bear what gravity pulls. -1 with e filled. */
int support_check(const support *of, const tled_problem *p, bool to_rest, bool pressed, notes *warnings, err *e);

#endif
