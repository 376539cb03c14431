/* Any bytes as an image that says where it lies: as many pixels as its sides say, or one error with a text; no more
 * memory than there are bytes. */
#include "render/placed.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    err e = {0};
    placed p;
    int sum = 0;
    in *s = in_memory(data, size, "fuzz", &e);
    if (s && !placed_read(&p, s, &e)) {
        if (p.columns < 1 || p.rows < 1 || (p.channels != 1 && p.channels != 3))
            abort();
        for (int64_t i = 0; i < (int64_t)p.columns * p.rows * p.channels; i++)
            sum += p.pixel[i];
        sum += placed_shows(&p, 0, 0) + placed_shows(&p, p.columns - 1, p.rows - 1);
        for (int a = 0; a < 3; a++)
            if (!isfinite(p.origin[a]) || !isfinite(p.column[a]) || !isfinite(p.row[a]) || sum < 0)
                abort();
        placed_free(&p);
    }
    if (!e.status != !e.text[0])
        abort();
    in_close(s);
    return 0;
}
