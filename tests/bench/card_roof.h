/* What a card can do at most, measured beside what is compared with it: copying in its memory and within its L2 cache,
 * and multiply-adds, in two instructions as the project computes (-fmad=false) and fused in one. Only where CUDA is
 * built in. The caller owns a card_roof.
 */
#ifndef SINEW_CARD_ROOF_H
#define SINEW_CARD_ROOF_H

#include "base/err.h"

#include <stdbool.h>

typedef struct card_roof card_roof;

/* In bytes and operations a second; a byte that is copied counts twice: read, and written; a
 * multiply-add is two operations, fused or not. */
typedef struct card_rates {
    double memory, cache; /* copies */
    double flops, fused;
} card_rates;

/* NULL with e filled. */
card_roof *card_roof_create(err *e);
void card_roof_destroy(card_roof *r);

/* Bytes of the card's L2 cache. */
int64_t card_roof_cache(const card_roof *r);

/* One round of it, in float or in double; takes some thousandths of a second. -1 with e filled. */
int card_roof_take(card_roof *r, bool single, card_rates *rates, err *e);

#endif
