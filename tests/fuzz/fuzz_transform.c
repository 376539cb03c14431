/* Any bytes as a file of a rigid motion, for a marker and a body, with names of frames and without: a finite place and
 * a turn of length 1, or one error with a text. */
#include "place/transform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_as(const char *bytes, size_t size, transform_use use, const char *frames)
{
    err e = {0};
    const transform_file f = {"fuzz", bytes, (int64_t)size, frames, use};
    pose p = pose_none();
    double square = 0;
    const int failed = transform_read(&f, &p, &e);
    if (failed != (e.status ? -1 : 0) || !e.status != !e.text[0])
        abort();
    for (int i = 0; i < 4; i++)
        square += p.quaternion[i] * p.quaternion[i];
    for (int i = 0; i < 3; i++)
        if (!isfinite(p.position[i]))
            abort();
    if (!(fabs(square - 1) < 1e-9))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const frames[] = {NULL, "ProbeToProbeMarker", "TransducerOriginPixelToReference", "AToB"};
    char *bytes = calloc(size + 1, 1);
    if (!bytes)
        abort();
    if (size)
        memcpy(bytes, data, size);
    for (int i = 0; i < 4; i++) {
        read_as(bytes, size, TRANSFORM_MARKER, frames[i]);
        read_as(bytes, size, TRANSFORM_BODY, frames[i]);
    }
    free(bytes);
    return 0;
}
