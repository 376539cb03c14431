/* Tips of a march: nodes that no sheet of it takes, and their units. march.h says what they are. */
#ifndef SINEW_MARCH_TIPS_H
#define SINEW_MARCH_TIPS_H

#include "tled/cuda/march.h"

/* Makes `tip` of a march whose order is made. sheet: nodes: SHEET_TIP, or not; special: elements: which special cell
 * each is, from 1 on, or 0. -1 with e filled, as for march_tips_add. */
int march_tips_list(march *m, const tled_problem *p, const int32_t *sheet, const int32_t *special, err *e);

/* Adds the tips' units after the others. */
int march_tips_add(march *m, err *e);

#endif
