/* Whether elements are folded: J = det F, the volume now over that at rest, of the map that the element's shape
 * functions make of its nodes; in its middle, where a solver with one integration point sees it, and at its corners,
 * where it sees nothing. A hexahedron's map is trilinear: at a corner, J is the triple product of the three edges
 * there, now over at rest. A tetrahedron has one J. Owns nothing, and nothing here allocates.
 */
#ifndef SINEW_QUALITY_H
#define SINEW_QUALITY_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* The elements of a model, borrowed. */
typedef struct quality_mesh {
    const int32_t *node; /* elements x corners, in VTK's order */
    int corners;         /* of an element: 8 or 4 */
    int64_t elements;
    const double *rest; /* nodes x 3, m */
    const double *side; /* 3, m: of every element, where all are boxes along the axes; NULL: any shape */
} quality_mesh;

/* Of one element: J in the middle, and the smallest at its corners. nan where it is flat or inside out at rest, or
 * where a displacement is no number. */
typedef struct quality_j {
    double centre, corner;
} quality_j;

/* Of several. */
typedef struct quality {
    double centre, corner; /* the smallest of each, nan left out; nan: there is none */
    int64_t folded;        /* elements whose J is not above 0 in the middle or at a corner */
    int64_t element; /* the one with the smallest at a corner, one with nan before all others; -1: there is none */
    double worst;    /* its smallest J at a corner */
} quality;

/* Hourglass energy as a share of strain energy, which is without it. What is at most 1e-15 of `scale`, the sum of mu V
 * (J), is rounding: 0 where both are, inf where strain energy alone is. Past QUALITY_HOURGLASS, elements are too coarse
 * for how they bend, or the coefficient is wrong. */
#define QUALITY_HOURGLASS .1
static inline double quality_hourglass(double hourglass, double strain, double scale)
{
    const double rounding = 1e-15 * scale;
    if (strain <= rounding)
        return hourglass <= rounding ? 0 : (double)INFINITY;
    return hourglass / strain;
}

/* u: displacement, nodes x 3, m; NULL: at rest. */
quality_j quality_of(const quality_mesh *m, int64_t element, const double *u);

bool quality_is_folded(quality_j j);

/* Of no element; one more; and those of a later part of the mesh. */
quality quality_none(void);
void quality_add(quality *to, int64_t element, quality_j j);
void quality_join(quality *to, const quality *later);

/* Of elements `from` to `to` - 1. */
quality quality_look(const quality_mesh *m, const double *u, int64_t from, int64_t to);

#endif
