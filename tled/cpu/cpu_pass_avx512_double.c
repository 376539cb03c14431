/* The pass in AVX-512; built for it, and called where the processor has it. */
#include "tled/cpu/cpu_pass.h"
#ifdef __x86_64__
#define ELEMENT_LANES 8
#define CPU_PASS      cpu_pass_avx512_double
#define CPU_PASS_NAME "AVX-512"
#include "tled/cpu/cpu_lanes.h"
#endif
