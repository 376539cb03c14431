/* Finds the samples of skin that are nearer to other skin than at rest (self_contact.h). */
#ifndef SINEW_CONTACT_TOUCH_H
#define SINEW_CONTACT_TOUCH_H

#include "tled/contact/contact_room.h"

/* Fills w->touch, in the order of the samples, where the displacements have nodes. */
void contact_touches(self_contact_work *w, pool *threads);

/* The skin's normal at a sample, where it is: 0 where it has none. Returns how far it is to be trusted, 0 to 1. */
double contact_normal(const self_contact_work *w, int64_t sample, double normal[3]);

#endif
