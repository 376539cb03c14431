/* See volume_bytes.h; the seeds are of this format, and so is every input: its first line stands before it. */
#include "volume_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char first[] = "NRRD0004\n";
    volume_bytes_after(first, sizeof first - 1, data, size);
    return 0;
}
