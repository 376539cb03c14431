/* The tables of back ends that this build has, the preferred first. */
#include "tled/cpu.h"
#include "tled/state.h"

const backend *const tled_backends_double[] = {&tled_cpu_double, NULL};
const backend *const tled_backends_single[] = {&tled_cpu_single, NULL};
