/* Values that single elements have in place of those of their volume's material: the arrays element.E, element.c10 and
 * so on, one for each key of a law and one for the density, nan where an element has the material's. A value must be
 * one that the material could have, and of a key that it has; fibres have none of their own. Borrowed from the model.
 * What materials.h declares of elements is here too.
 */
#ifndef SINEW_MATERIAL_ELEMENTS_H
#define SINEW_MATERIAL_ELEMENTS_H

#include "model/materials.h"

enum { MATERIAL_ELEMENT_KEYS = LAW_density + 1 }; /* those of laws, and the density */

/* "element.E" and so on, by key. */
extern const char *const material_elements_arrays[MATERIAL_ELEMENT_KEYS];

/* Whether an element has a value of its own. */
bool material_elements_has(const material_elements *of, int64_t element);

/* Puts an element's own values in place of its material's; unchecked, as materials_of_volumes has checked them. */
void material_elements_put(const material_elements *of, int64_t element, material *to);

/* Checks those of all elements; of_volume: of each volume. -1 with e filled. */
int material_elements_check(const model *m, const material *of_volume, err *e);

#endif
