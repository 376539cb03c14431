/* The order in which blocks take a march's units, where it is cut into sheets. A unit waits for those near it in the
 * pass before; a pass has hardly more units than blocks take at once (march_units.c), so that each is to have its turn
 * long after theirs. Those of one sheet do, in the order of its columns and layers. A unit of a further sheet, or of
 * tips, after all of these, would be waited for by the first of the next pass: it is put among those near it.
 */
#ifndef SINEW_MARCH_TURNS_H
#define SINEW_MARCH_TURNS_H

#include "tled/cuda/march.h"

/* sheet: nodes: sheets_find's. -1 with e filled: no memory. */
int march_turns_order(march *m, const int32_t *sheet, int64_t nodes, err *e);

#endif
