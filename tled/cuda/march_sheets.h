/* Sheets (lattice_sheet.h) of a problem with slits, for a march, and tips: nodes at the end of a slit, which none takes. Fills
 * an array that the caller owns.
 *
 *      a   a'  slit      sheet 0: a, and all that is not near the slit
 *      |   |             sheet 1: a', and the nodes beside it, whose elements touch a'
 *      +-t-+             tip: t
 */
#ifndef SINEW_MARCH_SHEETS_H
#define SINEW_MARCH_SHEETS_H

#include "tled/problem/state.h"

enum { MARCH_TIP = -1 };

/* group, at: as places_shared takes them. sheet: nodes: which it is in, or MARCH_TIP. Returns how many sheets there
 * are, or -1 with e filled. A node is looked at once for each sheet up to its own: few, as there are few copies of a
 * place. */
int32_t march_sheets_find(const tled_problem *p, const int32_t *group, const int32_t *at, int32_t *sheet, err *e);

#endif
