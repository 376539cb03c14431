/* The fibres of a model's elements as the maths of an element takes them: the direction of each, and the curves of the
 * muscle that it belongs to. An element of two volumes may have one of each. Borrows the arrays of the model and of the
 * map.
 */
#ifndef SINEW_ELEMENT_FIBRES_H
#define SINEW_ELEMENT_FIBRES_H

#include "model/materials.h"
#include "physics/element.h"

typedef struct element_fibres {
    const materials_map *map;
    const float *first, *second; /* elements x 3; NULL: none */
    /* elements, of a frame: of muscles in series with springs, c - 1 (physics/muscle_series.h). NULL: not known, so
     * their stress is that where nothing moves. The caller's to set. */
    const double *contractile, *mixcontractile;
} element_fibres;

element_fibres element_fibres_of(const model *m, const materials_map *map);

/* Of its volume, and of the one that it is mixed with. activation: of the muscle that each volume is, 0 to 1, NULL or
 * not finite: 0. */
element_fibre element_fibres_first(const element_fibres *of, int64_t element, const double *activation);
element_fibre element_fibres_second(const element_fibres *of, int64_t element, const double *activation);

#endif
