/* Where an element of a model rests: its middle, and that in words, for people and as keys of sinew info take it. Owns
 * nothing.
 */
#ifndef SINEW_ELEMENT_PLACE_H
#define SINEW_ELEMENT_PLACE_H

#include "model/model.h"

enum { ELEMENT_PLACE = 300 }; /* bytes of its text */

/* The mean of its nodes at rest, m. The model has element.node and node.position. */
void element_place(const model *m, int64_t element, double middle[3]);

/* "element 12 (volume 'skin') at 1mm,2mm,3mm", in the unit of the model's source, in metres where that is not known;
 * without the volume where the model names none. */
void element_place_text(const model *m, int64_t element, char to[ELEMENT_PLACE]);

#endif
