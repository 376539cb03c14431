/* A picture of floats: premultiplied linear RGBA, rows from the top. The creator owns it.
 */
#ifndef SINEW_RENDER_IMAGE_H
#define SINEW_RENDER_IMAGE_H

#include "base/pool.h"

typedef struct image {
    int width, height;
    float *pixel; /* [height][width][4], owned */
} image;

enum { IMAGE_SIDE_MOST = 32768 };

/* A transparent one, all zeros. -1 with e filled: sides outside 1 to IMAGE_SIDE_MOST, or no memory. */
int image_create(image *im, int width, int height, err *e);
void image_free(image *im);

/* Fills all with one colour (premultiplied). */
void image_fill(image *im, const float rgba[4]);

/* Lays another over this one with its upper left at (x, y); what falls outside is left out. */
void image_over(image *im, const image *other, int x, int y);

/* Into 8-bit sRGB, as PNG keeps it: out has [height][width][channels] bytes; 4: with alpha, not premultiplied;
 * 3: alpha is left out, as over black. Rounded to the nearest, so that bytes never depend on the threads. */
void image_bytes(const image *im, int channels, uint8_t *out, pool *p);

/* One sRGB colour of 0 to 255 as linear. */
void image_linear(const uint8_t srgb[3], float linear[3]);

#endif
