/* Which elements the samples of an element may be in, where nodes are: by a table of the cells of space that the
 * middles of elements are in, made anew when any node has moved by more than its margin (contact_maths.h).
 */
#ifndef SINEW_CONTACT_NEAR_H
#define SINEW_CONTACT_NEAR_H

#include "tled/contact/contact_room.h"

/* Moves w->x to the displacements, and lists candidates and the samples that have any. */
void contact_near_list(self_contact_work *w, pool *threads);

#endif
