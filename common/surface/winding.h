/* The winding number of a closed surface of triangles about a point, which says whether the point lies inside: how many
 * times the surface goes round it, the sum of the solid angles of its triangles as seen from there over 4 pi (van
 * Oosterom & Strackee 1983). A point on the surface, to rounding, counts as inside. A view borrows the triangles, and
 * owns nothing.
 */
#ifndef SINEW_WINDING_H
#define SINEW_WINDING_H

#include <stdbool.h>
#include <stdint.h>

typedef struct winding {
    const double *position; /* vertices x 3, m */
    const int32_t *corner;  /* triangles x 3: vertices; all triangles turn the same way. NULL: 0, 1, 2, 3, ... */
    int64_t triangles;
    double near;            /* m: how far outside a point may be for rounding */
    double low[3], high[3]; /* m: the box about it, wider by that */
} winding;

winding winding_of(const double *position, const int32_t *corner, int64_t triangles);

/* Time is that of a look at each triangle if the point lies in the box, and else nothing: triangle_tree_holds() says
 * the same in less. */
bool winding_holds(const winding *s, const double point[3]);

/* Whether the point lies on the triangle of these corners, to rounding. */
bool winding_meets(const winding *s, const double *const corner[3], const double point[3]);

#endif
