/* The table of executors that this build has, the preferred first, and the choice among them. */
#include "msds/cpu/msds_cpu.h"
#include "msds/problem/msds_executor.h"

#ifdef SINEW_CUDA
#include "msds/cuda/msds_cuda.h"
#endif

const msds_executor *const msds_executors[] = {
#ifdef SINEW_CUDA
    &msds_cuda,
#endif
    &msds_cpu,
    NULL,
};

enum { EXECUTORS_MOST = 15 };

const msds_executor *msds_executor_choose(const msds_executor *const *table, const char *device,
                                          const executor_need *need, char *says, size_t size, err *e)
{
    const executor *rows[EXECUTORS_MOST + 1] = {NULL};
    for (int i = 0; i < EXECUTORS_MOST && table[i]; i++)
        rows[i] = &table[i]->is;
    const int chosen = executor_choose(rows, device, need, says, size, e);
    return chosen < 0 ? NULL : table[chosen];
}
