/* The loops for x86-64 with AVX2: the Makefile gives this file the flags there, and only there is anything in it. */
#if defined(__AVX2__)
#define SLICE_LANES_TABLE slice_lanes_avx2
#define SLICE_LANES_NAME  "AVX2"
#include "slice/image/slice_lanes_loops.h"
#else
typedef int slice_lanes_avx2_is_not_built;
#endif
