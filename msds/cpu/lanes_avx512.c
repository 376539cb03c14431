/* The loops for x86-64 with AVX-512: as lanes_avx2.c. */
#if defined(__AVX512F__)
#define LANES_TABLE lanes_avx512
#define LANES_NAME  "AVX-512"
#include "msds/cpu/lanes_loops.h"
#else
typedef int lanes_avx512_is_not_built;
#endif
