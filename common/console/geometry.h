/* What a page draws of a model: its bound surfaces, a mesh a group, and the outside of its elements; and where their
 * vertices are in a frame, as 16-bit fractions of a box, with the length of the displacement as 8 bits of a scale. The
 * layout of both messages is in page/protocol.js. A geometry borrows from the model it was made of.
 */
#ifndef SINEW_GEOMETRY_H
#define SINEW_GEOMETRY_H

#include "console/mailbox.h"
#include "model/model.h"

typedef struct geometry geometry;

/* face: muscles and bone, upright; else what a probe presses, whose skin is away from what is fixed. NULL with e
 * filled. */
geometry *geometry_make(const model *m, bool face, err *e);
void geometry_free(geometry *g);

/* low x y z, high x y z, m: of the model at rest; and the unit vector that points up from it. */
const double *geometry_box(const geometry *g);
const double *geometry_up(const geometry *g);

/* The meshes at rest. NULL with e filled. */
mail *geometry_mail(const geometry *g, err *e);

/* Where they are with these displacements of the nodes (x 3, m). NULL with e filled. */
mail *geometry_positions(const geometry *g, int64_t index, const double *u, err *e);

#endif
