/* Finds the samples of skin that are nearer to other skin than at rest (self_contact.h). */
#ifndef SINEW_CONTACT_TOUCH_H
#define SINEW_CONTACT_TOUCH_H

#include "tled/contact/contact_room.h"

/* Fills w->touch, in the order of the samples, where the displacements have nodes. */
void contact_touches(self_contact_work *w, pool *threads);

#endif
