/* The normal that a skin of triangles has next to a place: at the nearest place on it, interpolated between the
 * corners of the triangle there. A corner has the mean normal of the triangles about it, by area, where that is
 * within 30 degrees of the triangle's own; so a smooth skin has no steps, and a box keeps its edges. The creator owns
 * it, and the triangles must outlive it; once made, any number of threads may ask at once.
 */
#ifndef SINEW_OUTWARD_H
#define SINEW_OUTWARD_H

#include "surface/triangle_tree.h"

typedef struct outward outward;

/* corner: triangles x 9, at least one triangle. NULL with e filled. */
outward *outward_create(const double *corner, int64_t triangles, err *e);
void outward_free(outward *o);

/* The unit normal, or 0 0 0 where the triangle has no area; on the side from which its corners are counter-clockwise.
 * guess: as in triangle_tree.h. */
triangle_hit outward_at(const outward *o, const double place[3], int64_t guess, double normal[3]);

#endif
