/* PNG files: 8-bit RGB or RGBA (not premultiplied), sRGB. The one user of libpng. Nothing is kept.
 */
#ifndef SINEW_PNG_H
#define SINEW_PNG_H

#include "base/out.h"

#include <stdint.h>

/* Writes [height][width][channels] bytes, channels 3 or 4, as one PNG. -1 with e filled. */
int png_put(const uint8_t *pixel, int width, int height, int channels, out *to, err *e);

/* The same, and says how many pixels a metre has along x and y (pHYs), where these are numbers that a PNG can hold. */
int png_put_scaled(const uint8_t *pixel, int width, int height, int channels, const double each[2], out *to, err *e);

#endif
