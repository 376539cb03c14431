/* Asks libccd, by the support functions of the shapes: how far a probe is from a triangle (GJK), which moves that bone
 * may stop are made of; and what probe_at answers: how deep a small ball about a point is in a probe, and which way is
 * out (GJK to see whether they meet, then EPA). This is the one user of libccd.
 *
 * Solvers do not ask it the latter. All shapes have a closed form for points, convex polyhedra too: the plane that is
 * farthest. On a point inside it gives libccd's answer, without its tolerance, and in 40 ns, or 150 of 128
 * planes, where EPA takes microseconds to fractions of a millisecond (`make bench-msds` prints both); and a
 * processor and a card compute the same. So libccd is the reference that tests hold the closed forms to, over
 * random points and poses of every shape. Nothing is kept.
 */
#ifndef SINEW_NARROW_H
#define SINEW_NARROW_H

#include "probe/probe.h"

enum { NARROW_STARTS = 8 };

/* Whether a ball of radius `ball`, m, about x meets the probe; t gets by how much, and the way out: the deepest of what
 * is found from so many directions to start from, since EPA (libccd 2.1) ends too early from some, one in twenty on a
 * sphere, and then always says too little. */
bool narrow_at(const probe_placed *p, const double x[3], double ball, int starts, probe_touch *t);

/* How far the probe is from a triangle, corners x 3, m: at most `most`, by up to `fine` too little, never too much; 0:
 * they meet. libccd (2.1) says whether two bodies meet, and no distance: this is how thick the triangle may become
 * until they do, by halving. */
double narrow_gap(const probe_placed *p, const double triangle[9], double most, double fine);

#endif
