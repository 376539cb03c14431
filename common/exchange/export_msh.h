/* Gmsh's MSH file, version 2.2 in ASCII, which Gmsh and whatever else reads MSH takes: nodes, elements,
 * a physical group for each volume, points in a group `rigid`, and each frame's displacement as
 * $NodeData. SI units. The out is the caller's.
 */
#ifndef SINEW_EXPORT_MSH_H
#define SINEW_EXPORT_MSH_H

#include "base/out.h"
#include "exchange/export_shape.h"

/* The elements at rest. */
void export_msh(const export_shape *x, out *to);

/* The displacement by the shape's frame; nothing where it has none. */
void export_msh_frame(const export_shape *x, out *to);

#endif
