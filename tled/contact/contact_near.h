/* Which elements the samples of an element may be in, where nodes are: by a table of the cells of space that the
 * middles of elements are in, made anew when any node has moved by more than its margin.
 */
#ifndef SINEW_CONTACT_NEAR_H
#define SINEW_CONTACT_NEAR_H

#include "tled/contact/contact_room.h"

/* Of an element's shortest side: how much wider boxes of elements are than these. */
#define CONTACT_MARGIN .5
/* By how much of its sides a place may be outside of an element: beyond stairs of voxels. */
#define CONTACT_BEYOND .5

/* Moves w->x to the displacements, and lists candidates and the samples that have any. */
void contact_near_list(self_contact_work *w, pool *threads);

/* Where an element and a sample are. */
deformed_map contact_map(const self_contact_work *w, int32_t element);
void contact_place(const self_contact_work *w, int64_t sample, double x[3]);

/* Tells whether x lies in the box of an element, with its margins. */
bool contact_in_box(const self_contact_work *w, int32_t element, const double x[3]);

/* Tells whether some element has a node of each of the two. */
bool contact_have_neighbour(const self_contact_work *w, int32_t one, int32_t other);

#endif
