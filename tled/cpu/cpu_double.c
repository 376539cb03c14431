/* The CPU executor in double: the reference. */
#include "tled/cpu/cpu.h"
#define CPU_EXECUTOR           tled_cpu_double
#define CPU_EXECUTOR_OF_MESHES tled_cpu_meshes_double
#define CPU_PASSES             cpu_passes_double
#include "tled/cpu/cpu_loops.h"
