/* Images out of a volume that a mesh deforms, or that lies rigid: one slice after another with the same memory, over
 * threads. PST section IV, in its steps: the tetrahedra that meet the slice, a list of them for each of R regions (runs
 * of rows), and the rows, each filled from its region's list. A pixel is what the undeformed volume has at the place
 * that its centre had, linearly between voxels; it is black where no tetrahedron holds it and outside the volume. The
 * cutter owns its memory and borrows the rest.
 */
#ifndef SINEW_SLICE_CUTTER_H
#define SINEW_SLICE_CUTTER_H

#include "slice/image/slice_lanes.h"
#include "slice/image/slice_mesh.h"
#include "slice/image/slice_paper.h"

typedef enum slice_method {
    SLICE_SPANS, /* each tetrahedron fills the rows' runs that it covers */
    SLICE_PAPER  /* each row is halved until an interval falls in one tetrahedron */
} slice_method;

enum { SLICE_REGIONS = 32, SLICE_SIDE_MOST = 16384 };

typedef struct slice_size {
    int32_t columns, rows;
} slice_size;

/* Where the image is: the centre of pixel (0, 0), and the steps to the next column and row, at right angles; m. */
typedef struct slice_plane {
    double origin[3], column[3], row[3];
} slice_plane;

typedef struct slice_setup {
    const slice_cells *cells;
    const slice_mesh *mesh; /* NULL: the volume lies rigid */
    slice_size size;
    const slice_shown *shown; /* rows */
    const slice_lanes *lanes;
    slice_method method;
    int regions; /* 1 or more */
    pool *threads;
} slice_setup;

typedef struct slice_cutter slice_cutter;

/* NULL with e filled. */
slice_cutter *slice_cutter_make(const slice_setup *s, err *e);
void slice_cutter_free(slice_cutter *c);

/* One image: rows x columns. displacement: nodes x 3, m, finite; NULL: at rest. owner (may be NULL): rows x columns,
 * which tetrahedron each pixel within the volume fell in, -1 for none. -1 with e filled on no memory. */
int slice_cutter_image(slice_cutter *c, const slice_plane *at, const double *displacement, uint8_t *image,
                       int32_t *owner, err *e);

/* Of the last image: the tetrahedra that may meet it, ascending. */
int64_t slice_cutter_list(const slice_cutter *c, const int32_t **list);

/* Piece i of that list: how the plane cuts the tetrahedron, its corners above all. It is the cutter's, or *room. */
const slice_piece *slice_cutter_piece(const slice_cutter *c, int64_t i, slice_piece *room);

/* The pieces of the last image's list, whatever the method: how the plane cuts each tetrahedron that may meet the
 * image. The caller frees them; NULL with e filled. */
slice_piece *slice_cutter_pieces(const slice_cutter *c, int64_t *count, err *e);

/* What is done with each row of places as it is sampled, beside: offset is of the row's first pixel in the image. */
typedef void slice_more(void *context, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        int64_t offset);
void slice_cutter_also(slice_cutter *c, slice_more *more, void *context);

#endif
