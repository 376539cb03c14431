/* Reads which frames of a model the option --frame names, by one syntax for all tools that have it. Owns nothing.
 */
#ifndef SINEW_FRAMES_H
#define SINEW_FRAMES_H

#include "base/err.h"

/* Of the option's table. */
#define FRAMES_ARG "N|last|all|rest|undeformed"

typedef enum frames_which { FRAMES_LAST, FRAMES_ALL, FRAMES_REST, FRAMES_ONE } frames_which;

/* Reads a frame's index, last, all, rest, or undeformed, which is the same as rest. index: set for FRAMES_ONE.
 * -1 with e filled (status 2). */
int frames_asked(const char *text, frames_which *which, int64_t *index, err *e);

#endif
