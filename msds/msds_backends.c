/* The table of back ends that this build has, the preferred first. */
#include "msds/msds_cpu.h"
#include "msds/problem.h"

const backend *const msds_backends[] = {&msds_cpu, NULL};
