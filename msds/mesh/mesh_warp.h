/* Nodes of a mesh on their way to the border of tissue, and what both steps there ask: how much tissue there is at a
 * place, which way a node may go, and whether its tetrahedra stay good. Borrows the mesh, the box and the mask.
 *
 * The first step: where an edge goes from tissue to air, the node that is nearer to the border goes there along the
 * edge, the nearest ones first. What is then still outside is not meshed (as the lattice of Labelle and Shewchuk,
 * Isosurface Stuffing, SIGGRAPH 2007, is warped, but no tetrahedron is cut). The second step: mesh_border.h.
 */
#ifndef SINEW_MESH_WARP_H
#define SINEW_MESH_WARP_H

#include "msds/mesh/mesh_around.h"
#include "msds/mesh/mesh_mask.h"

/* A tetrahedron keeps so much of its quality in the lattice: volume over the cube of its edges' root mean square. */
#define MESH_QUALITY_KEPT .35

typedef struct mesh_warp {
    const mesh_box *box;
    const mesh_cells *cells;
    const mesh_mask *mask;
    mesh_graded *g;
    mesh_around around; /* of g; owned */
    volume_finder finder;
    double unit[3][3]; /* vectors of length 1 along the box's edges */
    double *rest;      /* tets: quality as made; owned */
    double *edge;      /* nodes, m: the shortest as made; owned */
} mesh_warp;

/* w: zeroed. mask: NULL: nobody asks for tissue. -1 with e filled, and to be freed all the same: no memory. */
int mesh_warp_make(mesh_warp *w, const mesh_box *b, const mesh_cells *c, const mesh_mask *mask, mesh_graded *g, err *e);
void mesh_warp_free(mesh_warp *w);

/* Above 0 in tissue, 0 at its border. */
double mesh_warp_tissue(const mesh_warp *w, const double place[3]);

/* Whether a node lies on the low or the high side of the box along an axis. One in tissue has to stay there. */
bool mesh_warp_on_side(const mesh_warp *w, int64_t node, int axis);
bool mesh_warp_stays(const mesh_warp *w, int64_t node, int axis);

/* Whether all of a face is on one of the box's sides. */
bool mesh_warp_face_on_side(const mesh_warp *w, const int32_t face[3]);

/* The share of its quality that a tetrahedron has kept, and whether it is enough. */
double mesh_warp_kept(const mesh_warp *w, int64_t tet);
bool mesh_warp_good(const mesh_warp *w, int64_t tet);

/* Whether all tetrahedra of a node have kept so much. */
bool mesh_warp_all_good(const mesh_warp *w, int64_t node, double least);

/* The first step: moves nodes, and marks the tetrahedra that are tissue (tets bytes, zeroed). -1 with e filled: no
 * memory. */
int mesh_warp_edges(mesh_warp *w, uint8_t *tissue, err *e);

#endif
