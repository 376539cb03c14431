/* Makes a convex probe of an OBJ: its corners, triangles between them, and the planes of its faces. First it checks
 * that the surface is closed and convex, which probe_at takes for granted. Faces may be polygons, of either
 * orientation; vertices at one place are one; faces in one plane give one plane. A plane is moved out to the corner
 * that is farthest, within a tolerance of 1e-5 of the shape's size: OBJ files have few digits. The probe owns what is
 * made.
 */
#ifndef SINEW_CONVEX_H
#define SINEW_CONVEX_H

#include "probe/probe.h"
#include "surface/obj.h"

enum { CONVEX_FACES = 20000 /* at most: each node near the probe is asked of each plane */ };

/* Fills a convex probe from o, its coordinates times scale. -1 with e filled, p to be freed all the same, for points
 * and lines, open edges, edges of more than two faces, what is not convex, what is flat, too many faces. */
int convex_of(probe *p, const obj *o, double scale, err *e);

#endif
