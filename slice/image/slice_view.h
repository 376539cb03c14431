/* The part of the probe's image plane that an image shows: for a linear array a rectangle, the width of the face by the
 * depth; for a curved or phased array the fan of its beams, with black around it. Each pixel samples the plane itself,
 * so that no scan conversion of beams is needed. A view owns its rows; a zeroed one is empty.
 *
 * The probe's frame is that of probe.h: the image lies in its x-z plane, columns along +x, rows along +z.
 */
#ifndef SINEW_SLICE_VIEW_H
#define SINEW_SLICE_VIEW_H

#include "probe/probe.h"
#include "slice/image/slice_cutter.h"

typedef enum slice_array { SLICE_LINEAR, SLICE_CURVED, SLICE_PHASED } slice_array;

/* The array that makes the image. */
typedef struct slice_probe {
    slice_array array;
    double width;  /* m: of a linear one */
    double radius; /* m: of a curved one's face; 0: phased, all beams from one point */
    double angle;  /* radians: of the fan, at most pi */
} slice_probe;

typedef struct slice_view {
    slice_probe probe;
    slice_size size;
    double depth;       /* m: along a beam */
    double pixel[2];    /* m: from a column to the next, and from a row to the next */
    double corner[2];   /* m: x and z of the centre of pixel (0, 0) */
    slice_shown *shown; /* rows */
} slice_view;

/* Reads "linear:4cm,1cm", "curved:6cm,60,1cm" or "phased:90" (degrees). 1: a probe that makes no image (a sphere, a
 * convex body), *p is as it was; -1 with e filled (status 2) where it is none. */
int slice_probe_of(slice_probe *p, const char *text, err *e);

/* Whether two probes make the same image: to a thousandth of their lengths and angle. */
bool slice_probe_same(const slice_probe *a, const slice_probe *b);

enum { SLICE_COLUMNS = 512 };

/* "512x400"; "512" or "x400", whose other side is 0: it follows from the first; NULL: SLICE_COLUMNS. */
int slice_size_of(slice_size *s, const char *text, err *e);

/* width: m, of the image; 0: the array's, or all of its fan. A side of size that is 0 becomes the even number (films
 * want one) whose pixels are nearest to squares. -1 with e filled: more than SLICE_SIDE_MOST, or no memory. */
int slice_view_make(slice_view *v, const slice_probe *p, slice_size size, double depth, double width, err *e);
void slice_view_free(slice_view *v);

/* The plane, for a probe at this pose, moved by `off` along its y (m). */
slice_plane slice_view_plane(const slice_view *v, const pose *at, double off);

/* How far a pixel is from the array's face, along its beam; m. */
double slice_view_range(const slice_view *v, int32_t column, int32_t row);

#endif
