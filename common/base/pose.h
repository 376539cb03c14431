/* A rigid body's place: where its frame's origin is, and how it is turned. What the body has at x is at q x q* +
 * position. Functions that say so are for cards too. It owns nothing.
 */
#ifndef SINEW_POSE_H
#define SINEW_POSE_H

#ifdef __CUDACC__
#define POSE_FUNCTION static __host__ __device__ inline
#else
#define POSE_FUNCTION static inline
#endif

/* How far from 1 the length of a quaternion that is read may be; it is then made 1. */
#define POSE_LENGTH 0.01

typedef struct pose {
    double position[3];   /* m */
    double quaternion[4]; /* unit; x y z w */
} pose;

/* At the origin, not turned. */
pose pose_none(void);

/* From a row of numbers, x y z qx qy qz qw, as models have it, and into one. */
pose pose_of_row(const double row[7]);
void pose_to_row(const pose *p, double row[7]);

/* Makes a quaternion's length 1 and returns what it was; where that is further from 1 than POSE_LENGTH, or not finite,
 * the quaternion stays. */
double pose_unit(double quaternion[4]);
int pose_is_unit(double length);

/* The rotation as a matrix: row i, column j at 3 i + j. */
void pose_matrix(const double quaternion[4], double r[9]);

/* The unit quaternion that turns x, y and z to these three axes, which are of length 1, at right angles and
 * right-handed. */
void pose_axes(double axis[3][3], double turn[4]);

/* A place in the body's frame as one of the frame that the pose is in, and the way back. to may be from. */
void pose_apply(const pose *p, const double from[3], double to[3]);
void pose_apply_inverse(const pose *p, const double from[3], double to[3]);

/* A pose in the frame of another as one in that frame's own surroundings, and the way back. */
pose pose_compose(const pose *frame, const pose *in_frame);
pose pose_relative(const pose *frame, const pose *at);

/* A share (0 to 1) of the way from a to b, turning the shorter way round. */
pose pose_between(const pose *a, const pose *b, double share);

/* The same at a constant angular velocity (slerp), however far apart they are. */
pose pose_slerp(const pose *a, const pose *b, double share);

/* v turned by a unit quaternion. Without a matrix, so in the last digit it is not what pose_apply gives. */
POSE_FUNCTION void pose_turn(const double q[4], const double v[3], double to[3])
{
    double a[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]), 2 * (q[0] * v[1] - q[1] * v[0])};
    to[0] = v[0] + q[3] * a[0] + (q[1] * a[2] - q[2] * a[1]);
    to[1] = v[1] + q[3] * a[1] + (q[2] * a[0] - q[0] * a[2]);
    to[2] = v[2] + q[3] * a[2] + (q[0] * a[1] - q[1] * a[0]);
}

#endif
