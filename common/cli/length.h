/* Lengths on the command lines of tools for volumes, in mm. A volume's own numbers are mm where a model's are metres,
 * so that a length has to say which.
 */
#ifndef SINEW_LENGTH_H
#define SINEW_LENGTH_H

#include "cli/opt.h"

/* The lengths of an option in mm; where only the last has a unit, it is all of theirs. -1 with e filled (status 2)
 * where none has one. option: its name, for the message. */
int length_mm(const opt_lengths *l, const char *option, double *mm, err *e);

#endif
