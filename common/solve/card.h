/* A CUDA card, for the executors of any solver: whether there is one, its memory in one piece, and its errors. Only
 * what is built with CUDA has it; C++ includes it as extern "C", as every header here. Owns nothing.
 */
#ifndef SINEW_CARD_H
#define SINEW_CARD_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

/* Why no card can be used here, or NULL: the first that the driver shows is the one that is. Looks once. */
const char *card_unusable(void);

/* Fills e (status 1) where code, a cudaError_t, is not 0: "CUDA: CALL failed[ at step N]: why". step < 0: none.
 * Returns -1 then, else 0. */
int card_check(int code, const char *call, int64_t step, err *e);

/* Takes `bytes` of the card's memory; what: "the solver of 24316 elements", for the message where the card has not
 * so much free, which says how much it has. NULL with e filled. */
void *card_take(int64_t bytes, const char *what, err *e);
void card_give(void *memory); /* none of it is in use on the card; NULL: nothing */

/* The host's memory, that the card copies from and to by itself. NULL with e filled. */
void *card_host_take(int64_t bytes, err *e);
void card_host_give(void *memory); /* as card_give */

/* From now on many states are made and freed, by several threads at once. What is given back of both kinds of memory
 * stays for who asks for as many bytes next, until the card is short of it: the driver waits for all that a card does
 * before it takes memory back. And kernels whose blocks wait for each other start one after another, whatever streams
 * they are in, so that two of them never have half of the card each. Again: nothing. */
void card_share(void);

/* Around the start of such a kernel in a stream (a cudaStream_t); nothing unless the card is shared. Each start has an
 * end. A cudaError_t. */
int card_turn_begin(void *stream);
int card_turn_end(void *stream);

#endif
