#include "tled/cpu_pass.h"

#include <stdlib.h>
#include <string.h>

static bool can(const char *name)
{
#ifdef __x86_64__
    if (!strcmp(name, "AVX2"))
        return __builtin_cpu_supports("avx2");
    if (!strcmp(name, "AVX-512"))
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
    return !strcmp(name, "plain");
}

const cpu_pass *cpu_pass_choose(const cpu_pass *const *passes, err *e)
{
    const char *wanted = getenv("SINEW_VECTORS");
    for (int i = 0; passes[i]; i++)
        if (can(passes[i]->name) && (!wanted || !*wanted || !strcmp(wanted, passes[i]->name)))
            return passes[i];
    err_set(e, "SINEW_VECTORS", 0, "'%s' is not to be had here; expected plain, AVX2 or AVX-512", wanted);
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
