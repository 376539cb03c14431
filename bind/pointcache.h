/* A point cache in the PC2 format, which Blender's Mesh Cache modifier and others read: every frame's vertices in one
 * file, as float32. The out is the caller's; it must be a file, since the count of frames goes into the head at the
 * end.
 *
 * Layout, little-endian: "POINTCACHE2\0", version i32 = 1, points i32, start frame f32, sample rate f32, samples i32;
 * then for each sample points x 3 f32.
 */
#ifndef SINEW_POINTCACHE_H
#define SINEW_POINTCACHE_H

#include "base/out.h"

#include <stdint.h>

typedef struct pointcache {
    out *to;
    int32_t points, samples;
    int64_t first, last, step; /* frame indices; step 0: not known yet */
} pointcache;

/* points: at most 2^31 - 1. */
void pointcache_begin(pointcache *c, out *to, int32_t points);

/* Adds a frame of points x 3. Frames must be evenly spaced and coordinates within a float's range: -1 with e filled. */
int pointcache_add(pointcache *c, int64_t index, const double *position, err *e);

/* Fills the head in. */
int pointcache_end(pointcache *c, err *e);

#endif
