/* What tled-run reads beside its model: the script, expressions, levels over time and poses of bodies, as one script;
 * the probe and its poses. All is the session's.
 */
#ifndef SINEW_TLED_INPUTS_H
#define SINEW_TLED_INPUTS_H

#include "tled/run/options.h"
#include "tled/run/tled_session.h"

/* The script of --script, --contract and their like. -1 with e filled. */
int tled_inputs_script(session *s, const struct options *o, err *e);

/* What presses, and where; its stiffness is part of the stable step. -1 with e filled. */
int tled_inputs_collider(session *s, const struct options *o, err *e);

#endif
