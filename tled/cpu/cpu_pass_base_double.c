/* The pass in vectors of 16 bytes, which every processor has or the compiler makes do without. */
#define ELEMENT_LANES 2
#define CPU_PASS      cpu_pass_base_double
#define CPU_PASS_NAME "plain"
#include "tled/cpu/cpu_lanes.h"
