/* What poses that come are turned into before anything is done with them: --marker says where the probe's face is on
 * the marker that they are of, and --body where the model lies in the frame that they are in. A pose becomes
 * body^-1 o pose o marker, in this place alone. A value; nothing to free.
 */
#ifndef SINEW_PLACING_H
#define SINEW_PLACING_H

#include "volume/body.h"

typedef struct placing {
    bool has_body, has_marker;
    pose body, marker;
} placing;

/* Reads the files of the two options (NULL: not given; see body_open and place/transform.h). parts gets all of the
 * body, to be freed by body_free; NULL: only where the model lies is wanted. -1 with e filled. */
int placing_read(placing *p, const char *body_path, const char *marker_path, body *parts, err *e);

/* The pose of the probe's face in the model. Without a body and a marker, to the byte what came. */
pose placing_of(const placing *p, const pose *came);

#endif
