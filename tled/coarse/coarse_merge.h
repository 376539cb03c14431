/* What merged elements are made of: eight cells of tissue become one element, with arrays of the model as voxelise and
 * attach make them. Owns nothing.
 */
#ifndef SINEW_COARSE_MERGE_H
#define SINEW_COARSE_MERGE_H

#include "tled/problem/state.h"

struct coarse;

/* Adds to `to`, whose axes it has, element.volume, element.fraction and, where the finer model has fibres,
 * element.fibre; and what mixes two volumes. element: by place, the coarser element; place: of a cell of the finer
 * lattice. -1 with e filled. */
int coarse_merge(const tled_problem *fine, const model *m, int64_t elements, const int32_t *element,
                 int64_t (*place)(const struct coarse *c, const int32_t *ijk), const struct coarse *c, model *to,
                 err *e);

#endif
