/* The outside of a set of elements: those of their faces that no other element of the set shares, for hexahedra and
 * tetrahedra. The caller owns a boundary.
 */
#ifndef SINEW_BOUNDARY_H
#define SINEW_BOUNDARY_H

#include "model/model.h"

typedef struct boundary {
    int corners; /* of a face: 4 (hexahedra) or 3 (tetrahedra) */
    int64_t faces;
    int32_t *node;    /* faces x corners, in order round the face, seen from outside against the clock */
    int32_t *element; /* faces: whose face it is */
    int64_t capacity, element_capacity;
} boundary;

/* keep: elements, those of the set (NULL: all). beside (may be NULL): elements that are not of it, but cover the faces
 * that they share with it. -1 with e filled: no element.node, or neither 8 nor 4 columns, or no memory. */
int boundary_of(boundary *b, const model *m, const bool *keep, const bool *beside, err *e);
void boundary_free(boundary *b);

#endif
