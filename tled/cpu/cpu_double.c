/* The CPU back end in double: the reference. */
#include "tled/cpu/cpu.h"
#define CPU_BACKEND tled_cpu_double
#define CPU_PASSES  cpu_passes_double
#include "tled/cpu/cpu_loops.h"
