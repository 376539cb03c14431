/* Which of many boxes a ray may meet: a bounding volume hierarchy (mesh/embree.h). Embree works in floats, so
 * the caller gives boxes in a frame of its own choosing, shifted and scaled so that rays keep within `reach` of the
 * origin; the boxes are then made larger by more than any rounding, so that a ray may be given a box that it misses
 * but never misses a box that it meets. What truly is met is the caller's to decide. The creator owns it; lists are
 * the caller's, one for each thread.
 */
#ifndef SINEW_CANDIDATES_H
#define SINEW_CANDIDATES_H

#include "base/err.h"

#include <stdint.h>

typedef struct candidates candidates;

/* Gives the box of one item. Called from several threads. */
typedef void candidates_box(const void *context, int64_t item, double *low, double *high);

typedef struct candidates_list {
    uint32_t *item; /* owned */
    int64_t count, capacity;
    bool lost; /* no memory for one of them */
} candidates_list;

/* context is used during this call only. At most 2^32 - 2 items. NULL with e filled. */
candidates *candidates_create(int64_t count, candidates_box *box, const void *context, double reach, int threads,
                              err *e);
void candidates_destroy(candidates *c);

/* Fills the list anew with the items whose boxes the ray from a point (within reach) along a direction may meet, each
 * once, in ascending order. -1 with e filled on no memory. Any number of threads may call it at once. */
int candidates_ray(const candidates *c, const double *from, const double *direction, candidates_list *list, err *e);

/* Takes two items, the lower number first. Called from several threads. */
typedef void candidates_pair(void *context, int64_t one, int64_t other);

/* Gives every two items whose boxes may overlap, each two once, in any order. */
void candidates_pairs(const candidates *c, candidates_pair *take, void *context);

void candidates_list_free(candidates_list *list);

#endif
