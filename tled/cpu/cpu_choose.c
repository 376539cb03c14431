#include "tled/cpu/cpu_pass.h"

#include "solve/vectors.h"

const cpu_pass *cpu_pass_choose(const cpu_pass *const *passes, err *e)
{
    for (int i = 0; passes[i]; i++)
        if (vectors_are(passes[i]->name))
            return passes[i];
    vectors_none(e);
    return NULL;
}

const cpu_pass *const cpu_passes_double[] = {
#ifdef __x86_64__
    &cpu_pass_avx512_double, &cpu_pass_avx2_double,
#endif
    &cpu_pass_base_double, NULL};

const cpu_pass *const cpu_passes_single[] = {
#ifdef __x86_64__
    &cpu_pass_avx512_single, &cpu_pass_avx2_single,
#endif
    &cpu_pass_base_single, NULL};
