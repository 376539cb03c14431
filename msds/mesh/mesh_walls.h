/* Smooth borders of volumes in a mesh of tetrahedra. Of each edge between two regions of the label image
 * (mesh_regions.h), one end becomes a node of the border, and is moved onto it; the nodes around it give way, so that
 * tetrahedra stay good (mesh_warp.h). So a tetrahedron has no edge that crosses a border, and is of the region that its
 * other nodes are in. Where nodes do not reach the border, others are chosen. Keeps nothing.
 */
#ifndef SINEW_MESH_WALLS_H
#define SINEW_MESH_WALLS_H

#include "msds/mesh/mesh_regions.h"
#include "msds/mesh/mesh_warp.h"

typedef struct mesh_smoothed {
    int64_t nodes;   /* of the border */
    int64_t off;     /* of these, that are not on a border of the image, as tetrahedra are in the way */
    double farthest; /* m: from the border */
    double largest;  /* m: that one was moved by */
    double kept;     /* the least share of its quality that a tetrahedron has kept */
} mesh_smoothed;

/* Moves nodes of g: those on the box's sides stay on them, those of its skin elsewhere do not move. label: tets,
 * becomes the label of each. b: the box of c. -1 with e filled: no memory. */
int mesh_walls_smooth(mesh_graded *g, const mesh_box *b, const mesh_cells *c, const mesh_regions *r,
                      const volume *labels, int64_t *label, mesh_smoothed *to, err *e);

#endif
