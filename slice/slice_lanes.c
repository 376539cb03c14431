#include "slice/slice_lanes.h"

#include <stdlib.h>
#include <string.h>

static bool can(const slice_lanes *l)
{
#if defined(__x86_64__)
    if (l == &slice_lanes_avx512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    if (l == &slice_lanes_avx2)
        return __builtin_cpu_supports("avx2");
#endif
    return l == &slice_lanes_plain;
}

const slice_lanes *slice_lanes_choose(err *e)
{
    static const slice_lanes *const all[] = {
#if defined(__x86_64__)
        &slice_lanes_avx512,
        &slice_lanes_avx2,
#endif
        &slice_lanes_plain
    };
    const char *wanted = getenv("SINEW_VECTORS");
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (can(all[i]) && (!wanted || !*wanted || !strcmp(wanted, all[i]->name)))
            return all[i];
    err_set(e, "SINEW_VECTORS", 0, "'%s' is not to be had here; expected plain, AVX2 or AVX-512", wanted);
    return NULL;
}
