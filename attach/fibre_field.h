/* Fibres that follow the bends of a muscle: the gradient of a Laplace potential that is 0 at one of its ends and 1 at
 * the other, without flux through its sides (as rule-based methods lay fibres in hearts). The creator owns the field;
 * what it is made of is borrowed.
 */
#ifndef SINEW_FIBRE_FIELD_H
#define SINEW_FIBRE_FIELD_H

#include "attachment.h"
#include "base/pool.h"

typedef struct field field;
typedef struct muscle_field muscle_field; /* one muscle in it */

/* spacing: the voxel's sides, m. b's elements must be voxels. NULL with e filled. */
field *field_create(const body *b, const double *spacing, err *e);
void field_free(field *f);

/* The nodes of a volume, with their attachments as b->part numbers them now. What is opened needs neither b->part nor
 * the field's marks on nodes any more, which are one caller's at a time. The caller closes it. NULL with e filled. */
muscle_field *field_open(field *f, int32_t volume, err *e);
void field_close(muscle_field *m);

/* Fills the fibres of the volume at its elements, toward its first end; 0 0 0 where there is no direction. Once for
 * what is opened; several muscles may be filled at a time. threads: NULL for the caller alone. Each connected piece of
 * the volume has ends of its own. of, count: the attachments that b->part numbered.
 * - The first end: the piece's largest attachment; where it has none, see below.
 * - How far along the piece a place is: with a uniform source and the first end held at 0, the potential is that of a
 *   rod, u = source (L s - s^2 / 2): s / L = 1 - sqrt(1 - u / max u), L = sqrt(2 max u / source).
 * - The second end: the largest other attachment that is half way or further along and has a tenth of the first's nodes
 *   or more. Else the free end: of the last slices, each a twentieth of the way, or the piece's radius where that is
 *   more, the middles show the way out at the end of a parabola; what lies furthest out is the end, as deep as a voxel
 *   and a half or 0.4 of the radius. (The highest potential alone would be a place on the outer side of a bend.)
 * - A piece without an attachment: the free end found from the node furthest from the middle, or furthest along the
 *   axis (unit, or NULL), becomes the first, and the second is found from that.
 * Directions are means over the elements that meet at each node, then over each element's nodes: the sides of voxels
 * are steps. Where all of an element is held, its neighbours' direction is its own. */
int field_fibres(muscle_field *m, pool *threads, const attachment *of, int64_t count, const double *axis, err *e);

#endif
