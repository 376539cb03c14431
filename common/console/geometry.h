/* What a page draws of a model: its bound surfaces, a mesh a group, and the outside of its elements; and where their
 * vertices are in a frame, as 16-bit fractions of a box, with a value as 8 bits of a scale. The
 * layout of both messages is in page/protocol.js. A geometry borrows from the model it was made of.
 */
#ifndef SINEW_GEOMETRY_H
#define SINEW_GEOMETRY_H

#include "console/mailbox.h"
#include "model/model.h"

typedef struct geometry geometry;

/* face: muscles and bone, upright; else what a probe presses, whose skin is away from what is fixed. skin: the name of
 * a surface that moves by itself, as frames have it; "": none. NULL with e filled. */
geometry *geometry_make(const model *m, bool face, const char *skin, err *e);
void geometry_free(geometry *g);

/* The surface named so moves with this rigid body of the model (mesh/rigid_body.h), unless it is bound or moves by
 * itself. */
void geometry_attach(geometry *g, const char *name, int32_t body);

/* low x y z, high x y z, m: of the model at rest; and the unit vector that points up from it. */
const double *geometry_box(const geometry *g);
const double *geometry_up(const geometry *g);

/* The same of its nodes alone. */
const double *geometry_tissue(const geometry *g);

/* Vertices of the skin that moves by itself; 0: there is none. */
int64_t geometry_skin(const geometry *g);

/* The meshes at rest. NULL with e filled. */
mail *geometry_mail(const geometry *g, err *e);

/* Holds what is drawn of a frame. Its arrays are borrowed. */
typedef struct geometry_frame {
    int64_t index;
    const frame *rigid;  /* whose body.pose moves what moves with rigid bodies; NULL: they are at rest */
    const double *u;     /* nodes x 3, m: displacements */
    const double *skin;  /* vertices x 3, m: displacements of the skin that moves by itself; NULL: at rest */
    const double *value; /* nodes: what colours tell of, `low` to `high`; NULL: the lengths of displacements */
    double low, high;
} geometry_frame;

/* Where the meshes are in a frame. NULL with e filled. */
mail *geometry_positions(const geometry *g, const geometry_frame *is, err *e);

#endif
