/* The CPU executor in float: what a GPU computes, at half the memory. */
#include "tled/cpu/cpu.h"
#define CPU_EXECUTOR           tled_cpu_single
#define CPU_EXECUTOR_OF_MESHES tled_cpu_meshes_single
#define ELEMENT_SINGLE
#define CPU_PASSES cpu_passes_single
#include "tled/cpu/cpu_loops.h"
