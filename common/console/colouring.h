/* What a page may colour surfaces by: their own colours, or numbers of a frame at the nodes. Owns nothing.
 */
#ifndef SINEW_COLOURING_H
#define SINEW_COLOURING_H

#include "base/out.h"
#include "console/geometry.h"

typedef enum colouring {
    COLOURING_OWN,
    COLOURING_DISPLACEMENT, /* its length */
    COLOURING_SPEED,        /* m/s: of node.velocity */
    COLOURING_QUALITY,      /* the smallest J = det F at a corner of a node's elements (mesh/quality.h) */
    COLOURINGS
} colouring;

const char *colouring_name(colouring is);

/* -1: no such name. */
int colouring_find(const char *name);

/* "colours":[...],"units":{...}: what there is beside their own. */
void colouring_put(out *to);

/* Fills value (nodes of m), and points to->value at it with its range, where colours need more than displacements and
 * the frame has it; else leaves to as it is. The range's ends are round, so that colours hold still. */
void colouring_fill(colouring is, const model *m, const frame *f, double *value, geometry_frame *to);

#endif
