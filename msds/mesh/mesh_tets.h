/* Tetrahedra on a lattice, five to a cell: one in the middle and one at each of four corners, mirrored from cell to
 * cell (alternating parity), so that neighbours cut the face they share along the same diagonal and the mesh is
 * conforming. PST section IV. Adds arrays to a model that the caller owns; keeps nothing.
 */
#ifndef SINEW_MESH_TETS_H
#define SINEW_MESH_TETS_H

#include "model/model.h"

enum { MESH_TETS = 5 }; /* of a cell */

/* Corners of a cell's tetrahedra, in VTK's order of a hexahedron, by the parity of the sum of the cell's indices; all
 * of volume above 0. Diagonals of faces go between corners whose own indices have an even sum. */
extern const int8_t mesh_five[2][MESH_TETS][4];

/* A box of nodes: node (i, j, k), whose number is (k nodes[1] + j) nodes[0] + i, lies at
 * origin + edge[0] i / (nodes[0] - 1) + edge[1] j / (nodes[1] - 1) + edge[2] k / (nodes[2] - 1), m. */
typedef struct mesh_box {
    int32_t nodes[3]; /* at least 2 each */
    double origin[3]; /* m */
    double edge[3][3];
} mesh_box;

/* Adds the axes node and element, node.position and element.node. The edges may be left-handed: the tetrahedra are
 * not. -1 with e filled: more nodes or elements than can be numbered, edges that span no volume, no memory. */
int mesh_box_add(model *m, const mesh_box *b, err *e);

/* mirrored: whether the edges are left-handed. -1 with e filled: they span no volume. */
int mesh_box_check(const mesh_box *b, bool *mirrored, err *e);

/* The hexahedra of a voxel model (element.node of 8 columns, element.lattice) become tetrahedra: five for
 * each, in its order, of its volume, fibre and fraction. Nodes stay. What else is over elements, or points
 * to them, is dropped: surfaces have to be bound again, of which notes are made. -1 with e filled, also
 * where an element is inside out or flat. */
int mesh_split(model *m, notes *warnings, err *e);

/* Six times the volume of a tetrahedron, m3: above 0 where its nodes are in order. position: of all nodes. */
double mesh_six_volumes(const int32_t *node, const double *position);

#endif
