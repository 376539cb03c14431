/* A perceptually uniform scale of colours, dark violet over green to yellow, and distinct colours for names. Equal
 * steps of a value are equal steps in Oklab (B. Ottosson, A perceptual color space for image processing, 2020), and
 * lightness grows throughout, so that the scale reads in grey and to the colour-blind. The table is computed; its owner
 * is the caller.
 */
#ifndef SINEW_RENDER_COLOURMAP_H
#define SINEW_RENDER_COLOURMAP_H

#include <stdint.h>

enum { COLOURMAP_STEPS = 256 };

typedef struct colourmap {
    float colour[COLOURMAP_STEPS][3]; /* linear RGB */
} colourmap;

void colourmap_make(colourmap *c);

/* The colour at t of 0 to 1, linear RGB; beyond: that of the end. Grey for nan. */
void colourmap_at(const colourmap *c, double t, float colour[3]);

/* The colour of the i-th name, linear RGB: the hue goes round by the golden ratio, in three lightnesses, so
 * that many differ. */
void colourmap_name(int64_t i, float colour[3]);

#endif
