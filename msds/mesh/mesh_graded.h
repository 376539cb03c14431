/* Tetrahedra of cells that are graded 2:1 (mesh_cells.h): a conforming mesh, each of whose faces is one of at most
 * two tetrahedra. A cell beside none that is finer is divided into five tetrahedra, as mesh_tets.h has them. One with
 * a finer cell at an edge is divided from its middle to its faces, which are divided as the cells beyond them need
 * it:
 *
 *     +-----------+   +-----------+   +-----+-----+   no finer cell beyond it, nor at one of its edges; one at
 *     | \         |   | \       / |   | \   |   / |   the right edge; finer cells beyond it
 *     |   \       |   |   \   /   |   |   \ | /   |
 *     |     \     |   |     +-----+   +-----+-----+
 *     |       \   |   |   /   \   |   |   / | \   |
 *     |         \ |   | /       \ |   | /   |   \ |
 *     +-----------+   +-----------+   +-----+-----+
 *
 * The diagonals go between corners whose places sum to an even number of the cell's sides, and such are all corners
 * of a cell that is twice as large, and its faces' middles: so a diagonal is the same for both cells at a face. Cubes
 * give six shapes; their dihedral angles are 45 to 120 degrees.
 */
#ifndef SINEW_MESH_GRADED_H
#define SINEW_MESH_GRADED_H

#include "msds/mesh/mesh_cells.h"
#include "msds/mesh/mesh_tets.h"

/* A mesh of cells. The creator owns it; a zeroed one is empty. */
typedef struct mesh_graded {
    int64_t nodes, tets;
    double *position; /* nodes x 3, m */
    int32_t *at;      /* nodes x 3: where they were made, in units of cells */
    int32_t *node;    /* tets x 4, in VTK's order */
    int32_t *cell;    /* tets: which cell each is of */
} mesh_graded;

/* Makes g (zeroed) of the cells of a box. Nodes are numbered along x, then y, then z; tetrahedra cell by cell: of
 * cells that are not halved, and all there, what mesh_box_add makes. -1 with e filled, and to be freed all the same:
 * more than can be numbered, no memory, edges that span no volume. */
int mesh_graded_make(mesh_graded *g, const mesh_box *b, const mesh_cells *c, err *e);
void mesh_graded_free(mesh_graded *g);

/* A place in units of cells, m. */
void mesh_graded_place(const mesh_box *b, const mesh_cells *c, const int32_t at[3], double to[3]);

/* Keeps the tetrahedra that are marked (bytes, tets), and their nodes. -1 with e filled: no memory. */
int mesh_graded_keep(mesh_graded *g, const uint8_t *marked, err *e);

/* Adds the axes node and element, node.position and element.node to a model, as mesh_box_add does. */
int mesh_graded_add(const mesh_graded *g, model *m, err *e);

#endif
