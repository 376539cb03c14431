#include "solve/vectors.h"

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

bool vectors_are(const char *name)
{
    const char *wanted = getenv("SINEW_VECTORS");
    return can(name) && (!wanted || !*wanted || !strcmp(wanted, name));
}

void vectors_none(err *e)
{
    const char *wanted = getenv("SINEW_VECTORS");
    err_set(e, "SINEW_VECTORS", 0, "'%.100s' is not available here; expected plain, AVX2 or AVX-512",
            wanted ? wanted : "");
}
