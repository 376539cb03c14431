/* The loops for x86-64 with AVX-512: the Makefile gives this file the flags there, and only there is anything in it. */
#if defined(__AVX512BW__)
#define SLICE_LANES_TABLE slice_lanes_avx512
#define SLICE_LANES_NAME  "AVX-512"
#include "slice/image/slice_lanes_loops.h"
#else
typedef int slice_lanes_avx512_is_not_built;
#endif
