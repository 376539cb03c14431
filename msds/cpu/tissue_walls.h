/* Cavities among the groups of tissue_mesh.h: their elements, which keep walls from crossing and are next to nothing
 * else, and the triangles of their walls, whose groups stand last. A group of triangles has, in place of gradients, 9
 * numbers x LANES: the unit vectors t1, t2 of the plane at rest (t1 along the edge from corner 0 to 1), and a, b, h:
 * from corner 0, corner 1 is at a t1, and corner 2 at b t1 + h t2. Corner 3 is corner 0 again, without a force. Each
 * cavity has a point of pressure. The mesh owns all.
 */
#ifndef SINEW_TISSUE_WALLS_H
#define SINEW_TISSUE_WALLS_H

#include "msds/cpu/tissue_mesh.h"

struct lanes_field;

/* Below this share of its volume an element of a cavity gets stiff. Where walls meet, about a quarter of it remains. */
#define TISSUE_WALLS_THIN .1

/* Triangles in place, and m->within; the mesh's arrays are made. -1 with e filled. */
int tissue_walls_fill(tissue_mesh *m, const msds_problem *p, const sell *s, const cavity_wall *walls, int64_t count,
                      err *e);

/* Makes m->inverse that of the tangents in m->law, as far as elements of cavities are thin there and stiff. */
void tissue_walls_brace(tissue_mesh *m);

/* Shortens a step at nodes of elements of cavities that would lose most of what they still have of their volume, so
 * that walls come near before they meet. share: nodes, for the while. m->g: where the step begins. Returns the least
 * that a node takes of it. */
double tissue_walls_spare(const tissue_mesh *m, struct lanes_field *step, float *share);

/* Moduli, Pa, of the elements of each cavity: what they resist other changes of shape with, and how hard they are when
 * thin; to: cavities each. -1 with e filled. */
int tissue_walls_moduli(const msds_problem *p, const cavity_wall *walls, int64_t count, double *mu, double *hard,
                        err *e);

#endif
