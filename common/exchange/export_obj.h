/* Wavefront OBJ of a surface that the model carries, or of the outer boundary of its elements. The out is the
 * caller's.
 */
#ifndef SINEW_EXPORT_OBJ_H
#define SINEW_EXPORT_OBJ_H

#include "base/num.h"
#include "base/out.h"
#include "exchange/export_shape.h"

/* Writes the shape, moved where deformed, in `unit`. A surface keeps its groups and its vertices' order; of elements,
 * the faces that belong to one element only, outward, in a group for each volume, with the nodes that they use. */
int export_obj(const export_shape *x, bool deformed, num_unit unit, out *to, err *e);

#endif
