#include "place/tum.h"

#include "base/num.h"

#include <string.h>

int tum_take(const keyfile *k, double *time, pose *to, err *e)
{
    double v[TUM_WORDS];
    for (int i = 0; i < TUM_WORDS; i++)
        if (num_double(k->word[i], &v[i]))
            return keyfile_error(k, e, "'%.100s' is not a finite number; expected " TUM_LINE, k->word[i]);
    const double length = pose_unit(v + 4);
    if (!pose_is_unit(length))
        return keyfile_error(k, e, "a quaternion of length %.6g; expected 1, to within %g", length, POSE_LENGTH);
    *time = v[0];
    memcpy(to->position, v + 1, sizeof to->position);
    memcpy(to->quaternion, v + 4, sizeof to->quaternion);
    return 0;
}
