/* Which nodes are fixed: sides of the mesh, and volumes by name. Adds to node.rigid of a model that the caller owns.
 */
#ifndef SINEW_MESH_FIX_H
#define SINEW_MESH_FIX_H

#include "model/model.h"
#include "msds/mesh/mesh_sides.h"

/* list: words between commas: xmin, xmax, ymin, ymax, zmin, zmax (the first and last nodes along the mesh's own axes),
 * sides (the four of x and y), none, or the name of a volume, all of whose elements' nodes are fixed. nodes: along the
 * axes of a box (mesh_tets.h); NULL: the lattice of a voxel model says, node.lattice. What was fixed stays so. -1 with
 * e filled: a word that is none of these (near names are offered). */
int mesh_fix(model *m, const char *list, const int32_t *nodes, err *e);

/* The same for a mesh of cells, whose sides are those of mesh_sides.h. */
int mesh_fix_made(model *m, const char *list, const mesh_made *of, err *e);

/* How many nodes are fixed. */
int64_t mesh_fixed(const model *m);

#endif
