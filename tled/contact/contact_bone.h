/* Finds the samples of skin that are in bone which they may not enter (field.contact of the model; attach --contact).
 * The bone is known by distance fields, as it is to nodes that slide (sliding_node.h). At x, with B the bone's motion
 * at the end of the step,
 *     g = phi(B^-1 x)/|grad phi|,   n = B grad phi/|grad phi|.
 */
#ifndef SINEW_CONTACT_BONE_H
#define SINEW_CONTACT_BONE_H

#include "tled/contact/contact_room.h"

/* Adds to w->touch, in the order of the samples, where w->x has nodes; the bone has a side that nothing moves. was, is:
 * the curves' values at the beginning and the end of the step; NULL: all bone is at rest. */
void contact_bones(self_contact_work *w, pool *threads, const double *was, const double *is);

#endif
