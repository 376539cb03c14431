/* Finds, among many boxes, those that may overlap, by a bounding volume hierarchy (surface/embree.h). Embree works in
 * floats, so the caller gives boxes in a frame of its own choosing, shifted and scaled so that they keep within `reach`
 * of the origin. The boxes are then made larger by more than any rounding: a pair that does not overlap may be given,
 * but none that does is missed. The caller decides what truly meets. The creator owns it.
 */
#ifndef SINEW_CANDIDATES_H
#define SINEW_CANDIDATES_H

#include "base/err.h"

#include <stdint.h>

typedef struct candidates candidates;

/* Gives the box of one item. Called from several threads. */
typedef void candidates_box(const void *context, int64_t item, double *low, double *high);

/* context is used during this call only. At most 2^32 - 2 items. NULL with e filled. */
candidates *candidates_create(int64_t count, candidates_box *box, const void *context, double reach, int threads,
                              err *e);
void candidates_destroy(candidates *c);

/* Takes two items, the lower number first. Called from several threads. */
typedef void candidates_pair(void *context, int64_t one, int64_t other);

/* Gives every two items whose boxes may overlap, each two once, in any order. */
void candidates_pairs(const candidates *c, candidates_pair *take, void *context);

#endif
