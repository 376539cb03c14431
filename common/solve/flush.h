/* Makes this thread's vector operations take denormal numbers for zero, as a card does: most processors compute with
 * them a hundred times slower, and a body at rest is soon full of them. Does nothing where the processor has no such
 * switch. Owns nothing; the caller sets back what was.
 */
#ifndef SINEW_FLUSH_H
#define SINEW_FLUSH_H

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

/* From here on, until flush_as() with what this returns. */
static inline unsigned flush_small(void)
{
#ifdef __SSE2__
    unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040); /* results that are too small, and operands */
    return before;
#else
    return 0;
#endif
}

static inline void flush_as(unsigned before)
{
#ifdef __SSE2__
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

#endif
