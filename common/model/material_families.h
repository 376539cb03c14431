/* Which kind of families of fibres a material of a model has: the array material.fibre, without which none has any.
 * materials.c uses it. And what fibres and muscles of a material are in numbers, which materials.h declares. Owns
 * nothing.
 */
#ifndef SINEW_MATERIAL_FAMILIES_H
#define SINEW_MATERIAL_FAMILIES_H

#include "model/materials.h"

/* Writes row `at` of the array, which is made where a material has fibres. -1 with e filled. */
int material_families_store(model *m, int64_t at, const material *of, err *e);

/* What row i says, NULL for none. -1 with e filled: the table has no such kind. */
int material_families_kind(const model *m, int64_t i, const fibre_kind **to, err *e);

/* Removes the array if no material has fibres. */
void material_families_drop(model *m);

#endif
