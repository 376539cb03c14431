/* What the elements of a state hold, and which of them are folded: strain and hourglass energy, and J in their middles
 * and at their corners (mesh/quality.h), from the displacements of nodes, in double, whatever the executor. Sums go by
 * chunks in a fixed order: the same bytes for any number of threads. Owns nothing.
 */
#ifndef SINEW_STRAINED_H
#define SINEW_STRAINED_H

#include "base/pool.h"
#include "mesh/quality.h"
#include "tled/problem/deformed.h"

enum { STRAINED_CHUNK = 256 }; /* elements */

typedef struct strained {
    double strain,
        hourglass; /* J: strain without hourglass energy, with that of stretched muscles, without what these do */
    double scale;  /* J: the sum of mu V, beside which these may be rounding (quality_hourglass) */
    quality quality;
    int64_t twisted; /* the element that holds the most hourglass energy, -1: none does; and how much, J */
    double most;
} strained;

strained strained_none(void);

/* The displacements, and of which elements J has to be computed at the corners: those whose lower bound of J is not
 * above the J of `worst`, an element, or -1. The result is the same whichever element that is. The worst of the state
 * before is the best choice: it is nearly the worst still, and most bounds are far above its J. */
typedef struct strained_view {
    const tled_problem *p;
    const double *displacement; /* nodes x 3, m */
    quality_mesh mesh;
    double slope; /* 1/m: the largest of a box's derivatives */
    double limit; /* that element's J */
} strained_view;

strained_view strained_view_of(const tled_problem *p, const double *displacement, int64_t worst);

/* Adds an element with its deformation; and the sums of a later chunk. */
void strained_add(strained *to, const strained_view *v, int64_t element, const deformed *d);
void strained_join(strained *to, const strained *later);

/* Of all elements. part: pool_chunks(elements, STRAINED_CHUNK), to be filled. */
strained strained_of(const strained_view *v, pool *threads, strained *part);

/* Its quality alone, for a part of the time. */
quality strained_quality(const strained_view *v, pool *threads, strained *part);

#endif
