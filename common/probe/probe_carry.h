/* The shape of a probe in the model that it presses: metadata probe.shape as probe_text writes it and, of a convex one,
 * its corners and triangles (probe-vertex.position, probe-face.vertex), so that whoever draws it needs no other file;
 * and the probe of the option --probe, whose file is in the model's unit by default.
 */
#ifndef SINEW_PROBE_CARRY_H
#define SINEW_PROBE_CARRY_H

#include "model/model.h"
#include "probe/probe.h"

/* Reads --probe, and the OBJ of a convex one, in --unit or, where that is NULL, in the model's unit. anonymous: its
 * file is not named in what is written. p->file is borrowed from text. -1 with e filled; p to be freed all the same. */
int probe_read(probe *p, const char *text, const char *unit, bool anonymous, const model *m, err *e);

/* Puts a probe that is loaded into the model, in place of one that it had; notes the user's arrays over that, which go
 * with it. */
int probe_carry(const probe *p, model *m, notes *warnings, err *e);

/* Makes p of what the model carries: 1, and p to be freed; 0: it carries none; -1 with e filled: what there is is none.
 * A convex one has corners and faces and no planes: it is for drawing. p->file is borrowed from the model. */
int probe_carried(probe *p, const model *m, err *e);

#endif
