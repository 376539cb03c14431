/* The rigid motion that takes points to others, which were measured, in the sum of squares (Horn, J Opt Soc Am A 4,
 * 1987), and what that says of its errors (Fitzpatrick, West and Maurer, IEEE Trans Med Imaging 17, 1998): the fiducial
 * registration error (FRE) is the root mean square of what is left between pairs; the fiducial localisation error (FLE)
 * is that of the measured points, which FRE tells, and the target registration error (TRE) is that of any other place.
 * A value; nothing to free.
 */
#ifndef SINEW_REGISTRATION_H
#define SINEW_REGISTRATION_H

#include "base/err.h"
#include "base/pose.h"

typedef struct registration {
    int64_t count, worst;        /* pairs; the one that is left farthest apart */
    pose at;                     /* from -> to */
    double fre, largest, fle;    /* m; rms, of one pair, rms */
    double middle[3];            /* of `from` */
    double axis[3][3], apart[3]; /* the principal axes of `from`, as rows; the mean square distance from each, m2 */
    double spread;               /* m: rms distance from the middle */
} registration;

/* from, to: count x 3, m; left: count x 3, m, gets what each pair is apart: from, moved, to `to`. place: for messages.
 * -1 with e filled: fewer than three pairs, points on a line, points that fit better mirrored, or that do not fit. */
int registration_fit(const double *from, const double *to, int64_t count, const char *place, registration *r,
                     double *left, err *e);

/* The expected TRE at a place of `from`, m (rms):
 *     TRE^2 = FLE^2 / N (1 + 1/3 sum over the axes of d^2 / f^2),   FLE^2 = N / (N - 2) FRE^2,
 * with d the place's distance from a principal axis and f the rms distance of the points from it. */
double registration_tre(const registration *r, const double at[3]);

#endif
