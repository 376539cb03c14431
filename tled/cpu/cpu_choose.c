#include "tled/cpu/cpu_pass.h"

#define CPU_PASS_DECLARE(set, name, bytes, has) extern const cpu_pass cpu_pass_double_##set, cpu_pass_single_##set;
#define CPU_PASS_DOUBLE(set, name, bytes, has)  [VECTORS_##set] = &cpu_pass_double_##set,
#define CPU_PASS_SINGLE(set, name, bytes, has)  [VECTORS_##set] = &cpu_pass_single_##set,

VECTORS_SETS(CPU_PASS_DECLARE)
const cpu_pass *const cpu_passes_double[VECTORS_COUNT] = {VECTORS_SETS(CPU_PASS_DOUBLE)};
const cpu_pass *const cpu_passes_single[VECTORS_COUNT] = {VECTORS_SETS(CPU_PASS_SINGLE)};

const cpu_pass *cpu_pass_choose(const cpu_pass *const *passes, err *e)
{
    const int set = vectors_choose(e);
    return set < 0 ? NULL : passes[set];
}
