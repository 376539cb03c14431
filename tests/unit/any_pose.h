/* Random numbers and poses for tests, the same in every run. Each program that includes this has a state of its own.
 */
#ifndef SINEW_ANY_POSE_H
#define SINEW_ANY_POSE_H

#include "base/pose.h"

#include <math.h>
#include <stdint.h>

static uint64_t any_state = 88172645463325252u;

/* In [-1, 1). */
static inline double any(void)
{
    any_state ^= any_state << 13;
    any_state ^= any_state >> 7;
    any_state ^= any_state << 17;
    return (double)(any_state >> 11) / 4503599627370496. - 1;
}

static inline pose any_pose(void)
{
    pose at = {{any(), any(), any()}, {any(), any(), any(), any()}};
    double length = 0;
    for (int i = 0; i < 4; i++)
        length += at.quaternion[i] * at.quaternion[i];
    for (int i = 0; i < 4; i++)
        at.quaternion[i] /= sqrt(length);
    return at;
}

#endif
