/* Tests whether polygons form closed surfaces: every edge must be used an even number of times. Edges are pairs of
 * welded vertices, so that soups of polygons are as good as connected meshes. Polygons given more than once are found
 * on the way. Everything is borrowed but the result, which the caller frees.
 */
#ifndef SINEW_CLOSED_H
#define SINEW_CLOSED_H

#include "surface/obj.h"

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
    bool *drop;  /* polygons: to be left out; owned */
    bool *sheet; /* polygons: the first of those that cancel, all of which are dropped: two sides meet there; owned */
    int64_t *open_of;  /* surfaces: open edges of each; owned */
    int32_t first[2];  /* of an open surface: the first open edge, from one of the welded vertices to the other */
    int64_t open;      /* edges used an odd number of times, by polygons not dropped */
    int64_t once;      /* polygons that were given before, and dropped */
    int64_t cancelled; /* polygons that were given before, and cancel in pairs: they bound nothing */
} closed_result;

/* A polygon given again counts once, unless that part of the surface (what edges join) closes only where such polygons
 * cancel in pairs, as where two solids touch; or is less open then. Where an even number cancels all are dropped, where
 * an odd number does all but the first. */
int closed_check(const closed_polygons *p, closed_result *r, err *e);
void closed_free(closed_result *r);

#endif
