/* Arrays in one piece of a card's memory: listed once, then the piece is taken and each array filled. Each begins at a
 * multiple of CARD_ALIGNMENT bytes, in the order of the list:
 *
 *     | tiles ....... | node_info ... | displacement ........ | ...
 *     0               256 n           256 m
 *
 * card_layout_place sets the pointers to the arrays that are listed: they, and what arrays are filled from, must stay
 * where they are until then. The memory is the caller's, for card_give.
 */
#ifndef SINEW_CARD_LAYOUT_CUH
#define SINEW_CARD_LAYOUT_CUH

#include <cuda_runtime.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

extern "C" {
#include "solve/card.h"
}

enum { CARD_ALIGNMENT = 256, CARD_ARRAYS = 256 /* the most in a list */ };

typedef struct card_array {
    void *pointer;    /* to the pointer that will point to it */
    const void *from; /* what it is filled from, on the host; NULL: it is not filled */
    int64_t offset;
    size_t size; /* bytes */
} card_array;

typedef struct card_layout {
    int64_t bytes; /* so far */
    int count;     /* of arrays; more than CARD_ARRAYS are counted, not listed */
    card_array array[CARD_ARRAYS];
} card_layout;

static inline void card_layout_append(card_layout *l, void *pointer, const void *from, int64_t bytes)
{
    if (l->count < CARD_ARRAYS)
        l->array[l->count] = {pointer, from, l->bytes, (size_t)bytes};
    l->count++;
    l->bytes += (bytes + CARD_ALIGNMENT - 1) / CARD_ALIGNMENT * CARD_ALIGNMENT;
}

/* Room for `count` numbers, which are not filled. */
template <class T> static void card_layout_add(card_layout *l, T **to, int64_t count)
{
    card_layout_append(l, (void *)to, NULL, count * (int64_t)sizeof(T));
}

/* A copy of `count` numbers of the host's. from NULL: the problem has no such array, and *to becomes NULL. */
template <class T, class F> static void card_layout_copy(card_layout *l, T **to, const F *from, int64_t count)
{
    static_assert(sizeof(T) == sizeof(F), "one type");
    *to = NULL;
    if (from)
        card_layout_append(l, (void *)to, (const void *)from, count * (int64_t)sizeof(T));
}

static inline int card_layout_fill(const card_array *a, char *memory, err *e)
{
    void *const at = memory + a->offset;
    memcpy(a->pointer, &at, sizeof at);
    return a->from ? card_check(cudaMemcpy(at, a->from, a->size, cudaMemcpyHostToDevice), "cudaMemcpy", -1, e) : 0;
}

/* Takes the memory for all that is listed, and fills it; is_zeroed: with zeros first. what: as card_take's. -1 with e
 * filled; *memory, NULL before, is the caller's even then. */
static inline int card_layout_place(const card_layout *l, bool is_zeroed, const char *what, char **memory, err *e)
{
    if (l->count > CARD_ARRAYS)
        return err_set(e, NULL, 0, "%d arrays for the card; expected at most %d", l->count, (int)CARD_ARRAYS);
    *memory = (char *)card_take(l->bytes, what, e);
    if (!*memory || (is_zeroed && card_check(cudaMemset(*memory, 0, (size_t)l->bytes), "cudaMemset", -1, e)))
        return -1;
    for (int i = 0; i < l->count; i++)
        if (card_layout_fill(&l->array[i], *memory, e))
            return -1;
    return 0;
}

#endif
