/* The fibres of an element that resist being stretched as the maths of an element takes them, in double: for results,
 * monitors, reports and the stable step. Owns nothing.
 */
#ifndef SINEW_FIBRE_SETS_H
#define SINEW_FIBRE_SETS_H

#include "mesh/fibres.h"
#include "physics/fibre.h"

typedef struct fibre_sets {
    fibre_set of[2]; /* by shares of the tissue */
    int second[2];   /* whether it is the volume's that the element's own is mixed with */
    int count;
} fibre_sets;

/* Those of its volume and of a second that it is mixed of, where these have any. */
static inline fibre_sets fibre_sets_at(const fibres_view *f, int64_t element)
{
    fibre_local at[2];
    fibre_sets to = {.count = f->of ? fibres_at(f, element, at) : 0};
    for (int i = 0; i < to.count; i++) {
        to.of[i] = fibre_set_of(&at[i], at[i].share);
        to.second[i] = at[i].is_second;
    }
    return to;
}

/* Their energy at H = grad u, J/m3 at rest. */
static inline double fibre_sets_energy(const fibre_sets *of, element_tensor h)
{
    double w = 0;
    for (int i = 0; i < of->count; i++)
        w += fibre_energy(h, &of->of[i]);
    return w;
}

#endif
