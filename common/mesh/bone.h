/* The vertices that bone carries: those of a face on a rigid surface (one that attach wrote to anchor.name). Such a
 * vertex moves with a node that its surface holds, not between the eight nodes of an element, some of which are free:
 * so that bone does not bend with the tissue. Where the node belongs to a rigid body, and the frame says how that has
 * moved, the vertex moves with the body, as it turns about the same place. Bone that holds the tissue by films
 * (bone.element) has no nodes of its own: without a body, its vertices move with the tissue that is there. This is
 * ours; W&M bind every vertex alike. The caller owns a bone.
 */
#ifndef SINEW_BONE_H
#define SINEW_BONE_H

#include "base/pose.h"
#include "mesh/motion.h"

typedef struct bone {
    int32_t *node;       /* vertices: the node that carries it, -1 = none does */
    int64_t count;       /* vertices carried */
    const int32_t *body; /* nodes: the rigid body, or -1 (borrowed); NULL: the model has none */
    pose *moved;         /* bodies: how each has moved from rest */
    int64_t bodies;
    bool is_known; /* whether the frame says how they have */
    bool by_films; /* nodes do not tell how bone moves, as it holds the tissue by films: bodies alone do */
} bone;

/* Finds the carried vertices of a bound surface and, for each, the nearest node that its anchor holds. A model without
 * anchors carries none. */
int bone_find(bone *b, const bound *of, const model *m, err *e);
void bone_free(bone *b);

/* Takes from a frame how the bodies have moved. Before, vertices move with nodes alone. */
void bone_set(bone *b, const frame *f);

/* The displacement of a vertex, m: that of the body or node that carries it, else that of its surface's motion. */
void bone_displacement(const bone *b, const motion *of, int64_t vertex, double *d);

/* The deformation gradient at a vertex (row i, column j at 3 i + j): a body's turn, I where a node carries it, else
 * that of its surface's motion. */
void bone_gradient(const bone *b, const motion *of, int64_t vertex, double *f);

#endif
