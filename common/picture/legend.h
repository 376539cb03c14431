/* Draws the legend below a picture, which says what its colours mean: a bar of the scale with numbers and a unit, or a
 * colour for each name. Keeps nothing; the font's size is set by the caller, and all measures are in pixels.
 */
#ifndef SINEW_LEGEND_H
#define SINEW_LEGEND_H

#include "picture/colourmap.h"
#include "picture/font.h"

typedef struct legend_key {
    const char *words; /* borrowed */
    float colour[3];   /* linear */
    bool round;        /* a sphere's, else a square */
} legend_key;

enum { LEGEND_TICKS = 32 };

/* Round numbers (1, 2 or 5 times a power of ten apart) within low to high, at most `most`. Returns how many. decimals:
 * what they take to be told apart. */
int legend_ticks(double low, double high, int most, double tick[LEGEND_TICKS], int *decimals);

int legend_bar_height(int size);

/* A bar with its numbers, the words above it, in [x, x + width) from y down. */
void legend_bar(image *im, font *f, int size, int x, int y, int width, const colourmap *map, double low, double high,
                const char *words);

/* Keys flow into rows; what is longer than a row is shortened. */
int legend_keys_height(font *f, int size, int width, const legend_key *key, int keys);
int legend_keys(image *im, font *f, int size, int x, int y, int width, const legend_key *key, int keys, err *e);

#endif
