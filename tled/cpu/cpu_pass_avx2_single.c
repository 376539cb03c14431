/* The pass in AVX2; built with -mavx2, and called where the processor has it. */
#include "tled/cpu/cpu_pass.h"
#ifdef __x86_64__
#define ELEMENT_LANES 8
#define ELEMENT_SINGLE
#define CPU_PASS      cpu_pass_avx2_single
#define CPU_PASS_NAME "AVX2"
#include "tled/cpu/cpu_lanes.h"
#endif
