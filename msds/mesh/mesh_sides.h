/* The sides of a mesh of cells, of which some may have been left out: for each side of the box, the nodes of the border
 * that faces it and that one sees from there. Of a whole box, these are the nodes on its side. Keeps nothing.
 */
#ifndef SINEW_MESH_SIDES_H
#define SINEW_MESH_SIDES_H

#include "msds/mesh/mesh_graded.h"

/* What was meshed. */
typedef struct mesh_made {
    const mesh_graded *g;
    const mesh_box *box;
    const mesh_cells *cells;
} mesh_made;

/* Sets bytes of nodes. sides: bits of xmin, xmax, ymin, ymax, zmin, zmax. A face of the border is of the side that its
 * normal is nearest to, of both if it is between two, if no other cell of the mesh is before all of its cell. -1 with e
 * filled: no memory. */
int mesh_sides_mark(const mesh_made *of, unsigned sides, uint8_t *node, err *e);

#endif
