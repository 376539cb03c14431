/* Regions of a mask of voxels: what is joined, through faces of voxels, to a place. Masks are the caller's; the walk's memory is
 * kept from one call to the next.
 */
#ifndef SINEW_SEGMENT_REGION_H
#define SINEW_SEGMENT_REGION_H

#include "base/err.h"

typedef struct region {
    uint8_t *mask; /* size[0] x size[1] x size[2], x fastest; borrowed */
    int64_t size[3];
    int64_t *held, capacity; /* owned */
} region;

void region_free(region *r);

/* Turns all voxels of value `from` that are joined to voxel `at` to `to`. How many, 0 where it has another value; -1. */
int64_t region_flood(region *r, int64_t at, uint8_t from, uint8_t to, err *e);

/* Keeps, of the voxels that are 1, those of the largest region (the first of equals); the others become 0. */
int region_largest(region *r, err *e);

/* Turns the voxels that are 0 and not joined to the border to 1. */
int region_fill(region *r, err *e);

#endif
