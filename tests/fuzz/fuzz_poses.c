/* Any bytes as poses: each event is finite, its rotation is one and its time does
 * not go back; or one error with a text. */
#include "probe/poses.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_pose(const poses_event *v, double last)
{
    double square = 0, r[9];
    for (int i = 0; i < 4; i++)
        square += v->at.quaternion[i] * v->at.quaternion[i];
    for (int i = 0; i < 3; i++)
        if (!isfinite(v->at.position[i]))
            abort();
    if (!(fabs(square - 1) < 1e-9) || !isfinite(v->time) || v->time < last)
        abort();
    pose_matrix(v->at.quaternion, r);
    for (int i = 0; i < 9; i++)
        if (!(fabs(r[i]) <= 1 + 1e-9))
            abort();
}

static void read_all(const uint8_t *data, size_t size, const char *transform, bool marker)
{
    err e = {0};
    poses p;
    poses_event v;
    double last = -(double)INFINITY;
    in *s = in_memory(data, size, "fuzz", &e);
    int more = s ? poses_open(&p, s, transform, &e) : -1;
    if (!more && marker)
        poses_of_marker(&p);
    while (!more || more == 1) {
        more = poses_next(&p, &v, &e);
        if (more <= 0)
            break;
        if (v.kind != POSES_POSE)
            continue;
        check_pose(&v, last);
        last = v.time;
    }
    if ((more < 0) != (e.text[0] != '\0'))
        abort();
    in_close(s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (int marker = 0; marker < 2; marker++) {
        read_all(data, size, NULL, marker);
        read_all(data, size, "ImageToTracker", marker);
    }
    return 0;
}
