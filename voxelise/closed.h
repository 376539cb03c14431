/* Whether polygons close: every edge is used an even number of times, edges being pairs of welded vertices, so that soups
 * of polygons are as good as connected meshes. Polygons given more than once are found on the way. Everything is
 * borrowed but the result, which the caller frees.
 */
#ifndef SINEW_CLOSED_H
#define SINEW_CLOSED_H

#include "mesh/obj.h"

/* The polygons of one volume. */
typedef struct closed_polygons {
    const obj *o;
    const int32_t *weld;    /* the OBJ's vertices: one number for all of the same place */
    const int64_t *face;    /* polygons: faces of the OBJ */
    const int32_t *surface; /* polygons: the surface that each is of */
    int64_t polygons;
    int32_t surfaces;
} closed_polygons;

typedef struct closed_result {
    bool *drop;       /* polygons: given before, and to be left out; owned */
    int64_t *open_of; /* surfaces: open edges of each; owned */
    int64_t open;     /* edges used an odd number of times, by polygons not dropped */
    int64_t repeated; /* polygons that were given before */
    bool cancel;      /* none of those is dropped: in pairs they bound nothing, as where two solids touch */
} closed_result;

/* A polygon given again is dropped, unless the surface closes only with it. */
int closed_check(const closed_polygons *p, closed_result *r, err *e);
void closed_free(closed_result *r);

#endif
