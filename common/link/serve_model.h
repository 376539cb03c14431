/* Frames of a model as messages: POLYDATA of each surface that moves with them, bound or a skin; the force on the probe
 * as SENSOR and STRING; and its pose as TRANSFORM. One thread uses it, of the feed that frames come from; it borrows
 * the body that frames are of, and the board.
 */
#ifndef SINEW_SERVE_MODEL_H
#define SINEW_SERVE_MODEL_H

#include "link/serve_board.h"
#include "model/model.h"

typedef struct serve_model serve_model;

/* probe: the board's number of the probe's TRANSFORM; -1: frames do not give it. NULL with e filled. */
serve_model *serve_model_make(serve_board *board, int probe, err *e);
void serve_model_free(serve_model *s);

/* Puts what a frame of the body says on the board. -1 with e filled. */
int serve_model_show(serve_model *s, const model *body, const frame *f, err *e);

/* The surfaces that move, "" before the first frame. */
const char *serve_model_names(const serve_model *s);

#endif
