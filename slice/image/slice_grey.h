/* What a scanner's knobs do to grey levels. A B-mode image holds the logarithm of the echo: level g stands for
 * (g / 255 - 1) R dB, R the range that it was recorded with. Gain and time-gain compensation add decibels; the
 * image shows the D dB below the strongest:
 *
 *     g' = 255 (1 + ((g / 255 - 1) R + gain + tgc(range)) / D), rounded, within 0 and 255.
 *
 * Level 0 stands for all that is weaker, and stays 0. Owns a table of a number for
 * each pixel; a zeroed one changes nothing.
 */
#ifndef SINEW_SLICE_GREY_H
#define SINEW_SLICE_GREY_H

#include "slice/image/slice_view.h"

#define SLICE_RANGE 60 /* dB: shown, and recorded, where nothing else is said */

typedef struct slice_knobs {
    double gain;            /* dB */
    const double *tgc;      /* dB: at equal steps from the face to the depth, linear between them */
    int slides;             /* how many; 0: none */
    double shown, recorded; /* dB: D and R */
} slice_knobs;

typedef struct slice_grey {
    int32_t slope;   /* of g, x 65536; 0: nothing changes */
    int32_t *offset; /* rows x columns, x 65536 */
} slice_grey;

int slice_grey_make(slice_grey *g, const slice_view *v, const slice_knobs *k, err *e);
void slice_grey_free(slice_grey *g);

/* In place, `count` pixels from `at` on. */
void slice_grey_apply(const slice_grey *g, uint8_t *image, int64_t at, int64_t count);

#endif
