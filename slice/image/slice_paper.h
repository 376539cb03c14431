/* PST section IV as printed: of the tetrahedra in a region's list, the one that holds a pixel is found by its
 * barycentric coordinates; an interval of a row whose two ends fall in one is sampled along a line, since a tetrahedron
 * is convex; any other is halved. Stateless: memory is the caller's.
 */
#ifndef SINEW_SLICE_PAPER_H
#define SINEW_SLICE_PAPER_H

#include "slice/image/slice_lanes.h"

/* How far below 0 a barycentric coordinate may be: what is on a face is in both of
 * its tetrahedra, whatever was rounded. */
#define SLICE_PAPER_ON 1e-9

typedef struct slice_paper_tet {
    slice_piece piece;
    double share[4][3]; /* barycentric coordinates: at pixel (0, 0), and how they grow a column and a row */
    int32_t low, high;  /* columns that it may hold: low to high - 1 */
} slice_paper_tet;

/* The tetrahedra of a list. */
void slice_paper_make(const slice_tets *t, const slice_cells *c, const int32_t *list, int64_t count,
                      const double last[2], slice_paper_tet *to);

/* As slice_lanes.fill, from tet[list[...]]. */
void slice_paper_fill(const slice_lanes *l, const slice_fill *f, const slice_paper_tet *tet, const int32_t *list,
                      int64_t count, int32_t first, int32_t end, slice_places *to);

#endif
