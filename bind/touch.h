/* Readies skin for contact with itself (tled/contact/self_contact.h): writes samples of it and how far nodes about it
 * are from it, the axes contact and skin of the model. Keeps nothing.
 */
#ifndef SINEW_TOUCH_H
#define SINEW_TOUCH_H

#include "bind/touch_skin.h"

typedef struct touch_found {
    int64_t samples, nodes;
    double worst; /* m: the most that the distance is off at a sample */
} touch_found;

/* In place of what was there. o->apart: m; 0: a voxel's shortest side. -1 with e filled. */
int touch_make(model *m, const side *sides, const touch_skin_options *o, int threads, pool *by, touch_found *found,
               notes *warnings, err *e);

#endif
