/* What is around each node of a mesh of tetrahedra, and beyond each of their faces; and the parts that hang together by
 * faces. Borrows the mesh; the creator owns the lists.
 */
#ifndef SINEW_MESH_AROUND_H
#define SINEW_MESH_AROUND_H

#include "msds/mesh/mesh_graded.h"

typedef struct mesh_around {
    int64_t *start;   /* nodes + 1 */
    int32_t *element; /* the tetrahedra of each node, ascending */
} mesh_around;

/* Makes a (zeroed) of g as it is. -1 with e filled, and to be freed all the same: no memory. */
int mesh_around_make(mesh_around *a, const mesh_graded *g, err *e);
void mesh_around_free(mesh_around *a);

/* The nodes of the face opposite a corner, counter-clockwise seen from outside. */
void mesh_around_face(const mesh_graded *g, int64_t tet, int corner, int32_t face[3]);

/* The tetrahedron beyond that face; -1: there is none. */
int64_t mesh_around_beyond(const mesh_graded *g, const mesh_around *a, int64_t tet, int corner);

/* Keeps the largest part of g that hangs together by faces, by its count of tetrahedra (of equals, the one with the
 * first), and its nodes. left: what was not kept. -1 with e filled: no memory. */
typedef struct mesh_left {
    int64_t tets, parts;
} mesh_left;

int mesh_around_largest(mesh_graded *g, mesh_left *left, err *e);

#endif
