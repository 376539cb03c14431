/* Warns of a body that is larger or smaller than any body is, since its file is then in another unit. Keeps nothing.
 */
#ifndef SINEW_EXTENT_H
#define SINEW_EXTENT_H

#include "base/err.h"
#include "base/num.h"

/* Notes what is larger than any body, beyond 3 m, or smaller than 3 mm in this unit, with the unit that it may be in.
 * of: the file. d: the sides of the box about it, in this unit. */
void extent_note(notes *n, const char *of, const double d[3], num_unit unit);

#endif
