/* The tables of executors that this build has, the preferred first, and the choice among them. */
#include "tled/cpu/cpu.h"
#include "tled/problem/tled_executor.h"

#ifdef SINEW_CUDA
#include "tled/cuda/cuda.h"
#endif

const tled_executor *const tled_executors_double[] = {
#ifdef SINEW_CUDA
    &tled_cuda_double,
#endif
    &tled_cpu_double,
    NULL,
};

const tled_executor *const tled_executors_single[] = {
#ifdef SINEW_CUDA
    &tled_cuda_single,
#endif
    &tled_cpu_single,
    NULL,
};

enum { EXECUTORS_MOST = 15 };

const tled_executor *tled_executor_choose(const tled_executor *const *table, const char *device, char *says,
                                          size_t size, err *e)
{
    const executor *rows[EXECUTORS_MOST + 1] = {NULL};
    for (int i = 0; table[i] && i < EXECUTORS_MOST; i++)
        rows[i] = &table[i]->is;
    const int chosen = executor_choose(rows, device, says, size, e);
    return chosen < 0 ? NULL : table[chosen];
}
