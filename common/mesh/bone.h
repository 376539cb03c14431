/* The vertices that bone carries: those of a face on a rigid surface (one that attach wrote to anchor.name). Such a
 * vertex moves with a node that its surface holds, not between the eight nodes of an element, some of which are free:
 * so that bone does not bend with the tissue. This is ours; W&M bind every vertex alike. The caller owns a bone.
 */
#ifndef SINEW_BONE_H
#define SINEW_BONE_H

#include "mesh/bound.h"

typedef struct bone {
    int32_t *node; /* vertices: the node that carries it, -1 = none does */
    int64_t count; /* vertices carried */
} bone;

/* Finds the carried vertices of a bound surface and, for each, the nearest node that its anchor holds. A model without
 * anchors carries none. */
int bone_find(bone *b, const bound *of, const model *m, err *e);
void bone_free(bone *b);

/* The displacement of a vertex, m: that of the node that carries it, else by its weights. u: of the nodes (x 3, m). */
void bone_displacement(const bone *b, const bound *of, int64_t vertex, const double *u, double *d);

#endif
