/* Regions of a mask of voxels: what is joined, through faces of voxels, to a place. Masks are the caller's; the walk's
 * memory, at most 8 bytes for every REGION_SHARE voxels, is kept from one call to the next: voxels that it has no room
 * for are marked, and found again.
 */
#ifndef SINEW_SEGMENT_REGION_H
#define SINEW_SEGMENT_REGION_H

#include "base/err.h"

enum { REGION_SHARE = 64, REGION_LEAST = 1 << 16 };

typedef struct region {
    uint8_t *mask; /* size[0] x size[1] x size[2], x fastest; borrowed */
    int64_t size[3];
    int64_t *held, capacity; /* owned */
} region;

/* The most that a walk over so many voxels holds, bytes. */
double region_bytes(double voxels);

void region_free(region *r);

/* Turns all voxels of value `from` that are joined to voxel `at` to `to`. How many,
 * 0 where it has another value; -1. */
int64_t region_flood(region *r, int64_t at, uint8_t from, uint8_t to, err *e);

/* Keeps, of the voxels that are 1, those of the largest region (the first of equals); the others become 0. */
int region_largest(region *r, err *e);

/* Turns the voxels that are 0 and not joined to the border to 1. */
int region_fill(region *r, err *e);

#endif
