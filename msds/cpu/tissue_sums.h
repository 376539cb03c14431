/* Sums of what stands in an array, for eight takers side by side: lists of where the summands of each stand, in one
 * order, and in rows where they follow each other as the takers do (tissue_mesh.h). The creator owns them.
 */
#ifndef SINEW_TISSUE_SUMS_H
#define SINEW_TISSUE_SUMS_H

#include "base/err.h"

/* Sums of what stands in an array, eight to a slice; a slot is one summand of each. */
typedef struct tissue_sums {
    int64_t slices, slots;
    int64_t *start; /* slices + 1 */
    int32_t *first; /* slots: where lane 0's summand stands, if the others' follow; else SELL_SCATTERED */
    uint8_t *has;   /* slots: bits of the lanes that have one */
    int32_t *list;  /* slots x LANES: where they stand; what is not there stands where zeros are */
} tissue_sums;

/* Who takes what, in any order; those of one taker are summed in the order that they have here. */
typedef struct tissue_items {
    int64_t count;
    const int32_t *taker, *where;
    int32_t nothing; /* where zeros are */
} tissue_items;

/* Makes s (zeroed) for so many takers. -1 with e filled, and to be freed all the same. */
int tissue_sums_make(tissue_sums *s, int64_t takers, const tissue_items *items, err *e);
void tissue_sums_free(tissue_sums *s);

#endif
