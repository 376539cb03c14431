/* Laying out a piece of the card's memory: once without it, to count its bytes, and once to fill it. Owns nothing.
 */
#ifndef SINEW_CUDA_ROOM_CUH
#define SINEW_CUDA_ROOM_CUH

#include <cuda_runtime.h>
#include <stdint.h>

extern "C" {
#include "base/mem.h"
#include "solve/card.h"
}

#define CARD_TRY(call) card_check(call, #call, -1, e)

/* Room for so many things; with no memory yet, counts only. */
template <class T> static T *room(char *memory, int64_t *used, int64_t count)
{
    T *at = memory ? (T *)(memory + *used) : NULL;
    *used += (count * (int64_t)sizeof(T) + 255) / 256 * 256;
    return at;
}

/* The same, filled. */
template <class T, class F> static int put(char *memory, int64_t *used, T **to, const F *from, int64_t count, err *e)
{
    static_assert(sizeof(T) == sizeof(F), "one type");
    T *at = room<T>(memory, used, count);
    *to = at;
    return at ? CARD_TRY(cudaMemcpy((void *)at, from, (size_t)count * sizeof(T), cudaMemcpyHostToDevice)) : 0;
}

#endif
