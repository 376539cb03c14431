/* Finds the element that a point is in, or the nearest one, among tetrahedra or among hexahedra off a lattice, by a
 * tree of boxes over them. Owns its tables, borrows the model's; searches may run in several threads.
 */
#ifndef SINEW_TETRA_H
#define SINEW_TETRA_H

#include "model/model.h"

typedef struct tetra_box {
    double low[3], high[3];
    int32_t first, count; /* of a leaf, in order; of others count is 0 */
    int32_t right;        /* the second half's box; the first half's is the next */
} tetra_box;

typedef struct tetra {
    const int32_t *node;    /* elements x corners */
    int32_t corners;        /* 4 or 8 */
    const double *position; /* nodes x 3, m */
    int32_t *order;         /* elements that have a volume, by boxes */
    tetra_box *box;
    int32_t boxes;
    int64_t flat; /* elements without a volume, which take no part */
    double tie;   /* distances that differ by no more are equal, m: a billionth of the mean element's size */
} tetra;

/* m: with node.position, finite, and element.node; one element at least has a volume. -1 with e filled. */
int tetra_build(tetra *t, const model *m, err *e);
void tetra_free(tetra *t);

/* point: finite, m. Of equally near elements (all that hold it are) the one of the lowest index. */
int32_t tetra_element(const tetra *t, const double *point);

#endif
