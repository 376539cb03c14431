/* On which side of a surface of triangles a point lies, from its nearest point there: by the pseudonormal of what the
 * nearest point lies on. That is a triangle's normal, the sum of the unit normals of the triangles at an edge, and at a
 * corner the sum of those about it, each times its angle there (Baerentzen & Aanaes 2005, IEEE Transactions on
 * Visualization and Computer Graphics 11:243). Corners at one place are one. The outward side of a triangle is the one
 * from which its corners are counter-clockwise. Borrows the triangles, and owns the rest.
 */
#ifndef SINEW_PSEUDONORMAL_H
#define SINEW_PSEUDONORMAL_H

#include "surface/triangle_tree.h"

typedef struct pseudonormal {
    const int32_t *corner; /* triangles x 3, borrowed */
    int32_t *place;        /* vertices: the number of each one's place */
    double *face;          /* triangles x 3: unit normals; 0 0 0 where there is no area */
    double *side;          /* triangles x 3 x 3: of the edges ab, bc and ca */
    double *at;            /* places x 3 */
    uint8_t *side_border;  /* triangles x 3: whether only one triangle has that edge */
    uint8_t *place_border; /* places: whether such an edge ends there */
    int64_t border;        /* edges of the border */
    int64_t turned;        /* edges between two triangles that face different sides */
    double volume;         /* inside of a closed surface; below 0 where it faces inward */
} pseudonormal;

/* position: vertices x 3. -1 with e filled on no memory. */
int pseudonormal_of(pseudonormal *n, const double *position, int64_t vertices, const int32_t *corner, int64_t triangles,
                    err *e);
void pseudonormal_free(pseudonormal *n);

/* Whether q, whose nearest point is the hit, lies outside (or on the surface); nothing is meant by it where the hit
 * lies on the border. */
bool pseudonormal_outside(const pseudonormal *n, const triangle_hit *hit, const double q[3]);

/* The pseudonormal where the hit lies, of any length; 0 0 0 where there is no area. */
void pseudonormal_at(const pseudonormal *n, const triangle_hit *hit, double normal[3]);

/* Whether the hit lies on the border of an open surface. */
bool pseudonormal_on_border(const pseudonormal *n, const triangle_hit *hit);

#endif
