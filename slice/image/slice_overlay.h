/* Labels over an image: for each pixel, the label of the voxel that holds its place in the undeformed
 * volume, in a colour of its own, half seen through. The label image may have a geometry of its own. Owns
 * its table and what it has seen of the last image.
 */
#ifndef SINEW_SLICE_OVERLAY_H
#define SINEW_SLICE_OVERLAY_H

#include "slice/image/slice_cutter.h"

typedef struct slice_overlay {
    int64_t size[3];            /* of the label image */
    uint8_t *voxel;             /* its labels as indices of colours, 0: none */
    double from[3], axis[3][3]; /* fixed-point places in cells to voxels of the map */
    int32_t black;
    uint8_t *seen; /* rows x columns: of the last image */
} slice_overlay;

/* Takes a volume of whole numbers, whose 0 is no label, and its voxels' memory. An artery, a vein and bone have colours
 * of their own, by the names of labels; those of the others follow their order. */
int slice_overlay_make(slice_overlay *o, volume *labels, const slice_cells *c, slice_size size, err *e);
void slice_overlay_free(slice_overlay *o);

/* A slice_more: context is the overlay. */
void slice_overlay_take(void *context, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        int64_t offset);

/* Grey and labels as red, green and blue. */
void slice_overlay_paint(const slice_overlay *o, const uint8_t *grey, int64_t count, uint8_t *to);

#endif
