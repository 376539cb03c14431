/* Finds the nodes that are rigid, by W&M Algorithm 2. For each voxel near a rigid point, line or polygon, the line from
 * the voxel's centre through the primitive's closest point meets the voxel's boundary near some of its nodes; those
 * become rigid.
 */
#ifndef SINEW_ANCHOR_H
#define SINEW_ANCHOR_H

#include "base/pool.h"
#include "model/model.h"
#include "rigid.h"

/* Makes the axis anchor with anchor.name (the rigid surfaces), node.rigid and node.anchor (the first rigid surface that
 * holds the node) in a voxel model, in place of those that are there, and counts in r what each surface holds.
 *
 * strictness, in (0, 1]: a node is taken where the line meets the boundary within so many voxel sides of it along each
 * axis; 0.75 in the paper. All comparisons are inclusive, to 1e-9 of a voxel. Where the closest point is the centre
 * itself, the line is the polygon's normal, and both its ends count, so that it makes no difference which way round a
 * polygon is written; a point, a line or a polygon without area there takes all 8 nodes. Where a concave polygon has
 * several closest points, each counts.
 *
 * With element.fraction, voxels may be elements whose centres lie in the bone. Where the closest point is in a voxel of
 * which less than half is enclosed, both ends of the line count: the nodes on the tissue's side, which are the surface
 * to the nearest layer of nodes, and those behind, which nothing else would hold.
 *
 * threads: NULL for the caller alone. */
int anchor_nodes(model *m, rigid *r, double strictness, pool *threads, notes *warnings, err *e);

#endif
