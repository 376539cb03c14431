/* The loops of us-slice that take the time, as a table of functions: one source, slice_lanes_loops.c, compiled for
 * each set of solve/vectors.h, chosen at run time. Samples are taken in fixed point, and nothing else depends on the
 * width of vectors: all give the same bytes. All memory is the caller's.
 *
 * An image lies in a plane, its columns along u and its rows along v, with pixel (c, r)'s centre at u = c,
 * v = r. The plane cuts a tetrahedron in a triangle or a quadrangle: a slice_piece. Within it the place in
 * the undeformed volume is affine in u and v.
 */
#ifndef SINEW_SLICE_LANES_H
#define SINEW_SLICE_LANES_H

#include "slice/image/slice_cells.h"
#include "solve/vectors.h"

enum {
    SLICE_LANES = 16, /* rows of places are padded to a multiple of it */
    SLICE_GROUP = 16, /* tetrahedra that are looked at together */
    SLICE_CUT_BEFORE = 1,
    SLICE_CUT_BEHIND = 2,
    SLICE_CUT_OUTSIDE = 60 /* left, right, above, below: a bit each */
};

/* From metres to (u, v, d): d is the distance along the normal, m. */
typedef struct slice_projection {
    double origin[3], axis[3][3];
    double last[2]; /* the last column and row */
} slice_projection;

/* A node in the image's frame. */
typedef struct slice_node {
    double at[3]; /* u, v, d */
} slice_node;

/* Tetrahedra as the loops want them. */
typedef struct slice_tets {
    const int32_t *node;  /* tetrahedra x 4, ascending */
    const int32_t *group; /* nodes of groups of SLICE_GROUP tetrahedra, */
    const int64_t *start; /* groups + 1: and where each begins */
    const double *place;  /* nodes x 3: at rest, in cells */
    const slice_node *at; /* nodes: deformed */
    const uint8_t *code;  /* nodes: SLICE_CUT_ */
} slice_tets;

typedef struct slice_piece {
    int32_t tet, corners;
    int32_t first, end;                        /* rows */
    bool inside;                               /* all of it within the volume */
    double u[4], v[4];                         /* corners, around */
    double from[4], to[4], start[4], slope[4]; /* edges: from v to v, and u where v is 0, growing a row */
    double place[4], across[4],
        down[4]; /* in fixed point: at pixel (0, 0), and how it grows a column and a row; [3] is 0 */
} slice_piece;

typedef struct slice_shown {
    int32_t from[2],
        to[2]; /* columns of a row that are within the image's fan: two runs, either of which may be empty */
} slice_shown;

/* Places of the pixels of some rows, in fixed point, and which piece they were found in. */
typedef struct slice_places {
    int32_t stride; /* of a row: columns, padded */
    int32_t *at[3]; /* rows x stride */
    int32_t *owner; /* rows x stride: the tetrahedron or -1; or NULL: not asked for */
} slice_places;

/* What the rows of an image are filled from. */
typedef struct slice_fill {
    const slice_piece *piece;
    const slice_shown *shown; /* rows */
    bool all;                 /* all columns of all rows are shown */
    double end[3];            /* the volume's far sides, in fixed point */
    int32_t black;
} slice_fill;

typedef struct slice_lanes {
    const char *name;
    /* Nodes [from, to) from their rest positions and displacements (nodes x 3, m; NULL: none). */
    void (*project)(const slice_projection *p, const double *rest, const double *displacement, int64_t from, int64_t to,
                    slice_node *at, uint8_t *code);
    /* Which of the tetrahedra [from, to) may meet the image: their numbers to `list`;
     * returns how many. from: a group's first. */
    int64_t (*meet)(const slice_tets *t, int64_t from, int64_t to, int32_t *list);
    /* The pieces of the tetrahedra in a list. */
    void (*cut)(const slice_tets *t, const slice_cells *c, const int32_t *list, int64_t count, int32_t rows,
                slice_piece *to);
    /* Every place black, and nobody's. */
    void (*clear)(int32_t black, int64_t size, slice_places *to);
    /* Columns [from, end) of a row, all in one piece, at an offset into the places;
     * but for those outside the volume. */
    void (*line)(const slice_fill *f, const slice_piece *p, int32_t row, int32_t from, int32_t end, int64_t offset,
                 slice_places *to);
    /* Clears, then fills the places of rows [first, end), from the pieces in a list, of
     * which the first that holds a pixel has it. */
    void (*fill)(const slice_fill *f, const int32_t *list, int64_t count, int32_t first, int32_t end, slice_places *to);
    /* Trilinear samples at `count` places. */
    void (*sample)(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                   uint8_t *to);
} slice_lanes;

#define SLICE_LANES_DECLARE(set, name, bytes, has) extern const slice_lanes slice_lanes_##set;
VECTORS_SETS(SLICE_LANES_DECLARE)

/* The widest that the processor has, or the one that SINEW_VECTORS names: plain, AVX2, AVX-512. NULL with e filled
 * where that is not to be had. */
const slice_lanes *slice_lanes_choose(err *e);

#endif
