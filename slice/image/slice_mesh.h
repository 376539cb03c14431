/* A tetrahedral model as us-slice cuts it: its elements with their nodes in ascending order (so that a face is the same
 * from both its sides), the nodes of each SLICE_GROUP of them that follow each other, and where its nodes are at rest
 * in the volume. Owns what it made; the positions are the model's.
 */
#ifndef SINEW_SLICE_MESH_H
#define SINEW_SLICE_MESH_H

#include "model/model.h"
#include "slice/image/slice_cells.h"

typedef struct slice_mesh {
    int64_t nodes, tets;
    const double *rest; /* nodes x 3, m: the model's */
    int32_t *node;      /* tets x 4 */
    int32_t *group;     /* nodes of the groups, one group after another, each node once in a group */
    int64_t *start;     /* groups + 1: where each begins */
    double *place;      /* nodes x 3: at rest, in cells */
} slice_mesh;

/* -1 with e filled: no tetrahedra, positions that are not finite. where: the stream's name. */
int slice_mesh_of(slice_mesh *s, const model *m, const slice_cells *c, const char *where, err *e);
void slice_mesh_free(slice_mesh *s);

#endif
