/* From a mesh of all cells that have tissue to the mesh of tissue: its nodes are moved onto the border, what is
 * outside is left out, and so are parts that hang together with no other. Nodes on the box's own sides stay on them,
 * and no tetrahedron becomes inverted or a sliver (mesh_warp.h). Keeps nothing.
 */
#ifndef SINEW_MESH_BORDER_H
#define SINEW_MESH_BORDER_H

#include "msds/mesh/mesh_around.h"
#include "msds/mesh/mesh_mask.h"

typedef struct mesh_moved {
    mesh_left left;
    int64_t nodes;  /* of the skin: the border, the box's sides aside */
    int64_t off;    /* of these, that are not on the border of tissue, as tetrahedra are in the way */
    double largest; /* m: that a node of the skin was moved by */
} mesh_moved;

/* b: the box of the mask's image, and of c. -1 with e filled: no memory, no tetrahedron that is tissue. */
int mesh_border_fit(mesh_graded *g, const mesh_box *b, const mesh_cells *c, const mesh_mask *mask, mesh_moved *moved,
                    err *e);

#endif
