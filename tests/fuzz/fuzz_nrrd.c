/* See volume_bytes.h; the seeds are of this format, and so is every input: its first line stands before it. */
#include "volume_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char first[] = "NRRD0004\n";
    const size_t n = sizeof first - 1;
    uint8_t *all = malloc(n + size);
    if (!all)
        return 0;
    memcpy(all, first, n);
    if (size)
        memcpy(all + n, data, size);
    volume_bytes(all, n + size);
    free(all);
    return 0;
}
