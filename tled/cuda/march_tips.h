/* Tips of a march: nodes that no sheet of it takes, and their units. march.h says what they are. */
#ifndef SINEW_MARCH_TIPS_H
#define SINEW_MARCH_TIPS_H

#include "tled/cuda/march.h"

/* Makes `tip` of a march whose order is made. sheet: nodes: MARCH_TIP, or not; special: elements: which special cell
 * each is, from 1 on, or 0. -1 with e filled, as for march_tips_place. */
int march_tips_list(march *m, const tled_problem *p, const int32_t *sheet, const int32_t *special, err *e);

/* Puts the tips' units among the others. nodes: of the problem. */
int march_tips_place(march *m, int64_t nodes, err *e);

#endif
