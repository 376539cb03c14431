/* The loops for x86-64 with AVX2: the Makefile gives this file -mavx2 there, and only there is anything in it. */
#if defined(__AVX2__)
#define LANES_TABLE lanes_avx2
#define LANES_NAME  "AVX2"
#include "msds/cpu/lanes_loops.h"
#else
typedef int lanes_avx2_is_not_built;
#endif
