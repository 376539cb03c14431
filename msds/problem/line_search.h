/* The line search of Newton's steps in the method tissue, for gcc and nvcc: which share of a step is tried next. It
 * looks at slopes, what is left times the step: `gain`, above 0, is what conjugate gradients saw at its beginning. A
 * share is taken where the slope there does not pull back by more than half of that; but not where a longer share
 * pulled back, and this one still pulls on by more than half. Owns nothing.
 */
#ifndef SINEW_LINE_SEARCH_H
#define SINEW_LINE_SEARCH_H

#include <math.h>
#include <stdbool.h>

#ifdef __CUDACC__
#define LINE_SEARCH_FUNCTION static __host__ __device__ inline
#else
#define LINE_SEARCH_FUNCTION static inline
#endif

enum { LINE_SEARCH_MOST = 6 /* shares that are tried */ };

typedef struct line_search {
    double gain, share;   /* share: to be tried */
    double low, at_low;   /* a share that is near enough, and the slope there */
    double high, at_high; /* one that is too far; 0: none */
    int tried;
} line_search;

LINE_SEARCH_FUNCTION line_search line_search_begin(double gain, double share)
{
    line_search s = {gain, share, 0, gain, 0, 0, 0};
    return s;
}

/* Takes the slope at s->share. False: that share is the one. */
LINE_SEARCH_FUNCTION bool line_search_next(line_search *s, double slope)
{
    const double enough = .5;
    const bool too_far = !(slope >= -enough * s->gain), too_near = s->high > 0 && slope > enough * s->gain;
    if (++s->tried == LINE_SEARCH_MOST || !(too_far || too_near))
        return false;
    if (too_far) {
        s->high = s->share;
        s->at_high = slope;
    } else {
        s->low = s->share;
        s->at_low = slope;
    }
    const double to = isfinite(s->at_high) ? s->at_low / (s->at_low - s->at_high) : 0;
    s->share = s->low + (s->high - s->low) * fmin(fmax(to, .1), .7);
    return true;
}

#endif
