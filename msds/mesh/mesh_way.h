/* Where one region of space ends and another begins: along a line, and the nearest place. Keeps nothing.
 */
#ifndef SINEW_MESH_WAY_H
#define SINEW_MESH_WAY_H

#include <stdbool.h>

/* The region of a place, m: any number. */
typedef struct mesh_field {
    int (*region)(const void *context, const double place[3]);
    const void *context;
} mesh_field;

/* How often `along` (any length but 0) fits between a place and the first of so many steps, to at most `most`, at whose
 * end the region is another: halved until it is exact. Infinite: there is none. */
double mesh_way(const mesh_field *f, const double from[3], const double along[3], double most, int steps);

/* The place on the border of the region that is nearest, as if the border were the plane through where it crosses the
 * axes (of length 1), but those that stay. way: m, to some place on it. False: none is near by. */
bool mesh_way_foot(const mesh_field *f, const double unit[3][3], const bool stays[3], const double from[3], double way,
                   double to[3]);

#endif
