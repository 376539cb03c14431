/* Says whether a surface of level 0 lies between two samples that are not next to each other along an axis: where
 * cells touch at an edge or a corner only, or where samples on either side of a face do not lie opposite each other.
 * Triangles near the line are found by a bounding volume hierarchy. They are sheared so that the line becomes an axis;
 * signs of what is so rounded are exact, and corners and edges that the line meets are as if it were moved by (e, e^2),
 * so that closed surfaces stay closed. Owned by the creator; any number of threads may ask at once.
 */
#ifndef SINEW_SIGHT_H
#define SINEW_SIGHT_H

#include "voxelise/inside.h"

typedef struct sight sight;

/* t: the triangles of level 0, borrowed. g: the lattice of samples, of which `samples` make a side of a voxel. NULL
 * with e filled on no memory. */
sight *sight_create(const inside_triangles *t, const grid *g, int samples, err *e);
void sight_destroy(sight *s);

/* Whether the line from one sample to another, both inside of level 0, leaves it, and so does each of some lines by way
 * of a third place: about a corner of bone, tissue is one piece. */
bool sight_blocked(const sight *s, const int64_t *from, const int64_t *to);

#endif
