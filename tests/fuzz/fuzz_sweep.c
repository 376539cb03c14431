// needs: slice/import/sweep.c
/* A sweep of any bytes is read or refused, and put together, or not, with images of a few pixels.
 */
#include "slice/import/sweep.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void put_together(const sweep *s, bool linear)
{
    unsigned char pixel[4 * 3 * 8];
    volume images = {.type = VOLUME_U8, .size = {4, 3, 8}, .data = pixel}, v = {0};
    int64_t filled[2] = {0};
    err e = {0};
    for (int i = 0; i < 4 * 3 * 8; i++)
        pixel[i] = (unsigned char)(i * 7);
    /* Voxels so large that there are few. */
    sweep_wish wish = {linear, 3, 4 * sweep_voxel(s, &images, &e), 0};
    int code = sweep_volume(&v, s, &images, &wish, filled, &e);
    if ((code != 0) != (e.status != 0) || (!code && filled[0] + filled[1] > volume_count(&v)))
        abort();
    volume_free(&v);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const double calibration[12] = {.5, 0, 0, 0, 0, .5, 0, 0, 0, 0, 1, 0};
    sweep s = {0};
    err e = {0};
    in *source = in_memory(bytes, size, "fuzz.mha", &e);
    int code = source ? sweep_read(&s, source, NULL, calibration, &e) : -1;
    if ((code != 0) != (e.status != 0))
        abort();
    sweep_unflip(&s, (const int64_t[3]){4, 3, 1});
    if (!code && s.count < 1000) {
        put_together(&s, true);
        put_together(&s, false);
    }
    in_close(source);
    sweep_free(&s);
    return 0;
}
