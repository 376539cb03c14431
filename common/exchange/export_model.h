/* Writes a model as it is, in either encoding. Nothing is added to its provenance and what is read back is the same,
 * unless frames are salvaged: then the provenance says so.
 */
#ifndef SINEW_EXPORT_MODEL_H
#define SINEW_EXPORT_MODEL_H

#include "model/source.h"
#include "model/stage.h"

/* Copies the model at path (NULL or "-": standard input; salvage: see source.h) to the output of t's options, a frame
 * in memory at a time. from and to are the caller's, zeroed, to be closed in every case (stage_close: a pipe gets
 * `fail` where this fails). */
int export_model(source *from, const char *path, bool salvage, stage *to, const tool *t, err *e);

#endif
