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

executor_need tled_need(const tled_problem *p)
{
#define FORM_WORDS(NAME, name, coefficients, history, directions) "form of energy " #name,
    static const char *const words[FORM_COUNT] = {FORMS(FORM_WORDS) "form of energy linear"};
#undef FORM_WORDS
    const uint32_t meshes = p->conforming ? EXECUTOR_MESHES : 0, contact = p->collider ? EXECUTOR_CONTACT : 0;
    return (executor_need){.features = meshes | contact, .form = p->form, .law = words[p->form]};
}

enum { EXECUTORS_MOST = 15 };

const tled_executor *tled_executor_choose(const tled_executor *const *table, const char *device,
                                          const executor_need *need, char *says, size_t size, err *e)
{
    const executor *rows[EXECUTORS_MOST + 1] = {NULL};
    for (int i = 0; table[i] && i < EXECUTORS_MOST; i++)
        rows[i] = &table[i]->is;
    const int chosen = executor_choose(rows, device, need, says, size, e);
    return chosen < 0 ? NULL : table[chosen];
}
