/* Instruction sets that a solver's loops are compiled for: one source becomes an object for each set (the Makefile's
 * variants, which define VECTORS), all give the same bytes, and the fastest that the processor has is chosen at run
 * time. The environment's SINEW_VECTORS names one, for tests. Owns nothing.
 */
#ifndef SINEW_VECTORS_H
#define SINEW_VECTORS_H

#include "base/err.h"

#include <stdbool.h>

/* A set a row: its identifier in C and in the Makefile, its name, the bytes of a vector, and whether this processor
 * has it. */
#define VECTORS_SET_avx512(X)                                                                                          \
    X(avx512, "AVX-512", 64,                                                                                           \
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") && \
          __builtin_cpu_supports("avx512bw"))
#define VECTORS_SET_avx2(X)  X(avx2, "AVX2", 32, __builtin_cpu_supports("avx2"))
#define VECTORS_SET_plain(X) X(plain, "plain", 16, true)

/* Those that are compiled for this machine, the fastest first; the Makefile's SETS. */
#ifndef __x86_64__
#define VECTORS_SETS(X) VECTORS_SET_plain(X)
#elif defined VECTORS_WITHOUT_AVX512
#define VECTORS_SETS(X) VECTORS_SET_avx2(X) VECTORS_SET_plain(X)
#else
#define VECTORS_SETS(X) VECTORS_SET_avx512(X) VECTORS_SET_avx2(X) VECTORS_SET_plain(X)
#endif

/* A table of a solver has a row for each set, in this order. */
#define VECTORS_INDEX(set, name, bytes, has) VECTORS_##set,
enum { VECTORS_SETS(VECTORS_INDEX) VECTORS_COUNT };
#undef VECTORS_INDEX

/* Of the set that a source is being compiled for; of plain, if it is none that is compiled for each. */
#ifndef VECTORS
#define VECTORS plain
#endif
#define VECTORS_PASTE(a, b)                       a##b
#define VECTORS_JOIN(a, b)                        VECTORS_PASTE(a, b)
#define VECTORS_PICK_NAME(set, name, bytes, has)  name
#define VECTORS_PICK_BYTES(set, name, bytes, has) bytes
#define VECTORS_NAME                              VECTORS_JOIN(VECTORS_SET_, VECTORS)(VECTORS_PICK_NAME)
#define VECTORS_BYTES                             VECTORS_JOIN(VECTORS_SET_, VECTORS)(VECTORS_PICK_BYTES)
#define VECTORS_OF(prefix)                        VECTORS_JOIN(prefix, VECTORS) /* prefix_avx2, say, of prefix_ */

/* Whether this processor has the set at an index, and SINEW_VECTORS names no other. */
bool vectors_can(int set);

/* The index of the first such set; -1 with e filled if SINEW_VECTORS names none that is available. */
int vectors_choose(err *e);

#endif
