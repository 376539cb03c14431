/* Acoustic coupling: which beams of an array enter tissue, and how much darker the others are. A beam is coupled where
 * the deformed tissue comes to within a gap of the array's face, along the beam: gel fills that, and air beyond it
 * returns all sound. What a pixel's line shows is received through an aperture, of which a share s is coupled: the echo
 * goes through it twice, so its amplitude is s^2 of what it was, 40 log10(1 / s) dB less. A line without any is black.
 *
 * Beams of a linear array are the image's columns. Those of a fan are as many, at equal angles; a phased array sends
 * and receives all beams through one aperture, so that all its lines are as dark. Owns its tables; a zeroed one changes
 * nothing.
 */
#ifndef SINEW_SLICE_COUPLING_H
#define SINEW_SLICE_COUPLING_H

#include "slice/image/slice_view.h"

#define SLICE_APERTURE .004 /* m: of a line, along the face: about 13 elements */

typedef struct slice_coupling {
    int32_t beams;              /* 0: nothing changes */
    int32_t reach;              /* of an aperture: beams to either side of its middle */
    slice_size size;            /* of the image */
    double pixel[2], corner[2]; /* m: as the view's */
    double from, to;            /* rows between which all beams enter tissue, if they do */
    double range;               /* dB: that the volume was recorded with */
    double *beam;               /* beams x 4: x and z at the face, and a gap further on, m */
    uint8_t *shown;             /* beams: it begins within the image */
    uint8_t *coupled;           /* beams */
    uint8_t *loss;              /* beams: grey levels; 255: all of them */
    uint16_t *of;               /* rows x columns: a pixel's beam; NULL: its column's */
    bool dark;                  /* some beam loses some */
} slice_coupling;

/* gap: m, above 0. range: dB. -1 with e filled on no memory. */
int slice_coupling_make(slice_coupling *c, const slice_view *v, double gap, double range, err *e);
void slice_coupling_free(slice_coupling *c);

/* Which beams are coupled in the cutter's last image, and what the others lose. */
void slice_coupling_find(slice_coupling *c, const slice_cutter *from);

/* In place: rows x columns of grey levels become darker; those of what has no echo at all become 0. */
void slice_coupling_darken(const slice_coupling *c, uint8_t *image);
void slice_coupling_hide(const slice_coupling *c, uint8_t *labels);

#endif
