/* Refuses elements that cannot be calculated with because they enclose nothing. That all numbers are finite is checked
 * where a model is read (values.h).
 */
#ifndef SINEW_FINITE_H
#define SINEW_FINITE_H

#include "model/model.h"

/* element.node of the model: -1 with e naming the first row with fewer than 4 different nodes, which encloses nothing.
 * where: the stream's name, or NULL; with one, the row's line is said where it was text. */
int finite_elements(const model *m, const char *where, err *e);

#endif
