#include "tled/cpu/cpu_pass.h"

#define CPU_PASS_EXTERN(set, NAME, ...)                                                                                \
    extern const cpu_pass cpu_pass_double_##NAME##_##set, cpu_pass_single_##NAME##_##set;
#define CPU_PASS_DECLARE(set, ...)      FORMS_WITH(CPU_PASS_EXTERN, set)
#define CPU_PASS_DOUBLE(set, NAME, ...) [FORM_##NAME] = &cpu_pass_double_##NAME##_##set,
#define CPU_PASS_DOUBLES(set, ...)      [VECTORS_##set] = {FORMS_WITH(CPU_PASS_DOUBLE, set)},
#define CPU_PASS_SINGLE(set, NAME, ...) [FORM_##NAME] = &cpu_pass_single_##NAME##_##set,
#define CPU_PASS_SINGLES(set, ...)      [VECTORS_##set] = {FORMS_WITH(CPU_PASS_SINGLE, set)},

VECTORS_SETS(CPU_PASS_DECLARE)
const cpu_pass *const cpu_passes_double[VECTORS_COUNT][FORM_STEPPED] = {VECTORS_SETS(CPU_PASS_DOUBLES)};
const cpu_pass *const cpu_passes_single[VECTORS_COUNT][FORM_STEPPED] = {VECTORS_SETS(CPU_PASS_SINGLES)};

const cpu_pass *cpu_pass_choose(const cpu_pass *const passes[][FORM_STEPPED], form f, err *e)
{
    const int set = vectors_choose(e);
    return set < 0 ? NULL : passes[set][f];
}
