#include "slice/contour/contour_level.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 1 << 16, TRIES = 20 };

/* The value at or above which there are about as many samples as there should be.
 * 0 with e filled for want of memory. */
static double first_guess(const float *value, int64_t count, double wanted, err *e)
{
    int64_t *bin = mem_array(BINS + 1, sizeof *bin, "a histogram", e), above = 0;
    int at = BINS;
    if (!bin)
        return 0;
    for (int64_t i = 0; i < count; i++)
        bin[(int)(fminf(fmaxf(value[i], 0), 1) * BINS)]++;
    while (at > 1 && (double)(above + bin[at]) <= wanted)
        above += bin[at--];
    free(bin);
    return ((double)at + 1) / BINS;
}

/* A level and what it encloses, less what is wanted: `low` encloses too much, `high` too little. */
typedef struct bracket {
    double low, high, more, less;
} bracket;

/* Where a line between both ends is at nothing, or near the ends' middle while they are far apart. */
static double next_level(const bracket *b, int tries)
{
    double share = b->more / (b->more - b->less);
    if (tries % 3 == 2)
        share = .5;
    return b->low + fmin(fmax(share, .05), .95) * (b->high - b->low);
}

int contour_make_of_volume(contour *c, const float *value, const int64_t size[3], double volume, const cubes *table,
                           err *e)
{
    int64_t count = size[0] * size[1] * size[2];
    bracket b = {0, 1, (double)count - volume, -volume};
    double level = first_guess(value, count, volume, e);
    if (level == 0)
        return -1;
    for (int tries = 0;; tries++) {
        c->vertices = c->triangles = 0;
        if (contour_make(c, value, size, (float)level, table, e))
            return -1;
        double more = contour_volume(c) - volume;
        if (fabs(more) <= .005 * volume || (tries >= TRIES && c->triangles) || tries >= 2 * TRIES)
            return 0;
        if (more > 0) {
            b.low = level;
            b.more = more;
        } else {
            b.high = level;
            b.less = more;
        }
        level = next_level(&b, tries);
    }
}
