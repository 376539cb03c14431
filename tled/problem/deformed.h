/* An element at given displacements: its gradient, its law and its energies, whatever its shape. In double, for
 * monitors and reports. Owns nothing.
 */
#ifndef SINEW_DEFORMED_H
#define SINEW_DEFORMED_H

#include "physics/element.h"
#include "physics/stability.h"
#include "tled/problem/cut.h"
#include "tled/problem/state.h"

typedef struct deformed {
    element_tensor h; /* grad u at the centre; of an element that is cut its mean over the part */
    tled_law law;     /* its coefficients with what hourglass energy adds to the tangent */
    double rest;      /* m3: volume at rest */
    double dilation;  /* J - 1 */
    double energy; /* J/m3, by volume at rest: of its strain and of muscles that are stretched, without what these do */
    double hourglass; /* J */
    hourglass_modes modes;
    stability_stiffening stiffening; /* how hourglass control follows the law */
    const double *border;            /* of a laminate (cut.h), or NULL; then: */
    border_parts parts;              /* whose law, as `law` above, has no moduli but what it stiffens by */
    laminate_state laminate;
} deformed;

/* The modes of one component of the displacement, nodes x 3. */
static inline element_modes deformed_modes(const tled_problem *p, int64_t element, const double *displacement, int axis)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = displacement[3 * (int64_t)p->element_node[8 * element + i] + axis];
    return element_modes_of(c);
}

/* box: of elements that are a lattice's. displacement: nodes x 3. */
deformed deformed_of(const tled_problem *p, int64_t element, element_shape box, const double *displacement);

#endif
