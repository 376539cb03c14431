/* The rigid bodies that a model's bone consists of (body.name), and where a frame has them. Borrows; owns nothing.
 */
#ifndef SINEW_RIGID_BODY_H
#define SINEW_RIGID_BODY_H

#include "base/pose.h"
#include "model/model.h"

/* The number of the body of that name; -1 with e filled, at place:line: there is none of it. */
int32_t rigid_body_find(const model *m, const char *name, const char *place, int64_t line, err *e);

/* How the body has moved from rest, as the frame's body.pose says. At rest where f is NULL or does not say. */
pose rigid_body_pose(const frame *f, int32_t body);

#endif
