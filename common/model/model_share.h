/* Models and frames that have the arrays of another, without a copy of the numbers: for several that read one model at
 * once, each of which adds to it what the others do not see. The other must outlive them, and stay as it is.
 */
#ifndef SINEW_MODEL_SHARE_H
#define SINEW_MODEL_SHARE_H

#include "model/model.h"

/* Makes `to`, zeroed, a model with what `from` has: the arrays' data are lent, all else is its own. To be freed by
 * model_free, also where this fails: -1 with e filled. */
int model_share(model *to, const model *from, err *e);

/* The same of a frame, zeroed; frame_free. */
int frame_share(frame *to, const frame *from, err *e);

#endif
