/* The pass in vectors of 16 bytes, which every processor has or the compiler makes do without. */
#define ELEMENT_LANES 4
#define ELEMENT_SINGLE
#define CPU_PASS      cpu_pass_base_single
#define CPU_PASS_NAME "plain"
#include "tled/cpu/cpu_lanes.h"
