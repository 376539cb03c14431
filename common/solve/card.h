/* A CUDA card, for the executors of any solver: whether there is one, its memory in one piece, and its errors. Only
 * what is built with CUDA has it; C++ includes it as extern "C", as every header here. Owns nothing.
 */
#ifndef SINEW_CARD_H
#define SINEW_CARD_H

#include "base/err.h"

#include <stddef.h>

/* Why no card can be used here, or NULL: the first that the driver shows is the one that is. Looks once. */
const char *card_unusable(void);

/* Fills e (status 1) where code, a cudaError_t, is not 0: "CUDA: CALL failed[ at step N]: why". step < 0: none.
 * Returns -1 then, else 0. */
int card_check(int code, const char *call, int64_t step, err *e);

/* Takes `bytes` of the card's memory; what: "the solver of 24316 elements", for the message where the card has not
 * so much free, which says how much it has. NULL with e filled. */
void *card_take(int64_t bytes, const char *what, err *e);
void card_give(void *memory);

#endif
