/* The inside test: which centres of a column lie inside each volume, by one ray a column (W&M section 3). A centre is
 * inside where a ray to it from outside crosses the volume's triangles an odd number of times. Columns borrow the grid
 * and the triangles, and own the tree that finds the triangles near a ray; any number of threads may look at once, each
 * with its own scratch.
 */
#ifndef SINEW_COLUMNS_H
#define SINEW_COLUMNS_H

#include "mesh/candidates.h"
#include "voxelise/crossing.h"

/* Triangles of closed volumes, in the grid's unit: all borrowed. */
typedef struct columns_triangles {
    const double *position; /* vertices x 3 */
    int64_t vertices;
    const int32_t *vertex; /* triangles x 3 */
    const int32_t *volume; /* triangles: the volume that each bounds */
    int64_t triangles;
} columns_triangles;

typedef struct columns {
    const grid *g;
    columns_triangles t;
    double *local;
    crossing_mesh mesh;
    candidates *near;
    double middle[3], reach; /* of the frame that the tree stands in: cells from the grid's middle */
} columns;

/* Cells from <= i < to of a column, inside a volume. */
typedef struct columns_span {
    int32_t volume;
    int64_t from, to;
} columns_span;

typedef struct columns_scratch {
    candidates_list hits;
    columns_span *span; /* by volume, then by place; spans of one volume do not touch */
    int64_t spans, span_capacity;
    uint64_t *crossing;
    int64_t crossings, crossing_capacity;
} columns_scratch;

/* threads: to build the tree with. */
int columns_create(columns *c, const grid *g, const columns_triangles *t, int threads, err *e);
void columns_destroy(columns *c);

/* Finds the spans of the column along `axis` through cells iu along axis + 1 and iv along axis + 2 (mod 3). */
int columns_look(const columns *c, int axis, int64_t iu, int64_t iv, columns_scratch *s, err *e);

void columns_scratch_free(columns_scratch *s);

#endif
