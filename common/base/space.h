/* The axes and units in which places are written: LPS (x to the patient's left, y to the back, z to the head), as
 * models, poses and Sinew's files have them, and RAS (to the right, to the front, to the head), as 3D Slicer and
 * OpenIGTLink have them; metres in a pose, millimetres in a matrix. This module alone converts between these; the table
 * in sinew(7) says which file has which. A matrix is 4 x 4, row by row, and takes a place in a frame to one in the
 * space. It owns nothing.
 */
#ifndef SINEW_SPACE_H
#define SINEW_SPACE_H

#include "base/err.h"
#include "base/pose.h"

typedef enum space { SPACE_LPS, SPACE_RAS } space;

/* How far the lengths of a rotation's axes may be from 1, and the cosines between these from 0: what numbers with three
 * digits after the point need. */
#define SPACE_SCALE  0.001
#define SPACE_COSINE 0.001

/* The first three columns of a matrix: their lengths, and these columns made of length 1. -1: one has no length, they
 * are not at right angles (SPACE_COSINE), or they are left-handed; the lengths are there even then. */
int space_axes(const double m[16], double axis[3][3], double length[3]);

/* A matrix, in mm, which takes a place in the body's own frame to one of the space, as the pose of that body in LPS, in
 * metres. The body's own axes stay as they are, in either space: a probe's +z is a probe's +z. -1 with e filled,
 * without a place, and *p as it was: a last row that is not 0 0 0 1, scale, shear, a mirror, a number that is not
 * finite. */
int space_pose_of_matrix(const double m[16], space s, pose *p, err *e);

/* The way back. */
void space_matrix_of_pose(const pose *p, space s, double m[16]);

/* A motion in one of the spaces, from places of it to places of it, as the same motion in the other. (The pose of a
 * body whose own frame is in that space too, as a volume's.) */
pose space_motion(const pose *p);

/* A place of the space, in mm, as one in LPS, in metres, and the way back. to may be from. */
void space_point_of_mm(const double from[3], space s, double to[3]);
void space_point_to_mm(const double from[3], space s, double to[3]);

/* Of affine matrices: a after b; to must be neither. And what undoes m; -1: nothing does. */
void space_product(const double a[16], const double b[16], double to[16]);
int space_inverse(const double m[16], double to[16]);

#endif
