/* The body around a case's tissue, PST figure 2: surfaces that lie beside its model, a skin that is springs of its own
 * and a skeleton that is rigid, where body.txt has them (volume/body.h), else in millimetres in the model's axes.
 */
#ifndef SINEW_AROUND_H
#define SINEW_AROUND_H

#include "console/cases.h"
#include "console/geometry.h"
#include "surface/surface.h"
#include "volume/body.h"

typedef struct around {
    body places;                       /* owned; its volume is where the model is in the body */
    char skin[SURFACE_NAME_MOST + 1];  /* the surface's name in models; "": the case has no skin of its own */
    const char *skin_path, *body_path; /* the case's; NULL: none */
} around;

/* Reads what the case has, and adds each surface to the model m, in its axes. -1 with e filled; a is to be freed all
 * the same. */
int around_read(around *a, const console_case *is, model *m, err *e);

/* Lets the scene's surfaces move with the rigid bodies of its model m that body.txt names. -1 with e filled, at the
 * file's line: the model has no such body. */
int around_attach(const around *a, const model *m, geometry *scene, err *e);
void around_free(around *a);

/* A pose in the model's axes as the tool that presses the skin is told it: in the body, where that has a place. */
pose around_pose(const around *a, const pose *at);

/* A pose in the model's axes as one in the body, where the case has one, and the way back. */
pose around_to_body(const around *a, const pose *at);
pose around_from_body(const around *a, const pose *at);

#endif
