/* Distance fields of what skin may not enter (tled/contact/bone_contact.h): of rigid surfaces that hold nodes, which
 * --contact names, and of those of a file of their own, which hold none. Surfaces that move with one body are in one
 * field, and those that stay in another. Keeps nothing.
 */
#ifndef SINEW_BONE_CONTACT_H
#define SINEW_BONE_CONTACT_H

#include "bone_field.h"

typedef struct bone_contact_options {
    const opt_list *in;    /* values of --contact: SURFACE,...[:REGION] */
    const opt_list *parts; /* of --part: which body a surface that holds no node moves with */
    const rigid *held, *loose;
} bone_contact_options;

/* Adds the fields; node.rigid, node.anchor and node.body must be there, before nodes are let slide. Triangles are
 * turned so that the tissue beside the nodes that they hold is in front of them; those that hold none face the tissue.
 * Coordinates of regions are in the model's source.unit. -1 with e filled. */
int bone_contact_make(const model *m, const bone_contact_options *o, pool *threads, bone_fields *fields,
                      notes *warnings, err *e);

#endif
