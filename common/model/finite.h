/* Whether what is to be calculated with is numbers: a model may hold nan anywhere, and in some places it says that there
 * is none; in places and displacements it is a slip, not to be passed on.
 */
#ifndef SINEW_FINITE_H
#define SINEW_FINITE_H

#include "model/model.h"

/* -1 with e naming the array and its first row that is not finite. Strings and whole numbers pass, as does NULL. where: the
 * stream's name, or NULL; with one, the row's line is said where it was text. */
int finite_array(const model_array *a, const char *where, err *e);

/* element.node of the model: -1 with e naming the first row with fewer than 4 different nodes, which encloses nothing. */
int finite_elements(const model *m, const char *where, err *e);

#endif
