/* A freehand sweep, which is tracked B-scans, put together to a volume: every pixel is added to the voxel that it falls
 * in, or to the eight around it; voxels that got none, between others that did, are filled. (Solberg et al., Freehand
 * 3D ultrasound reconstruction algorithms, Ultrasound Med Biol 33, 2007: pixel nearest neighbour, distribution and
 * hole-filling steps.) The caller owns the list.
 */
#ifndef SINEW_SWEEP_H
#define SINEW_SWEEP_H

#include "probe/plus.h"
#include "volume/volume.h"

typedef struct sweep_frame {
    int64_t image; /* which slice of the sequence's images */
    double m[12];  /* 3 x 4, row by row: mm from (column, row, 0, 1) in pixels */
} sweep_frame;

typedef struct sweep {
    sweep_frame *one; /* owned */
    int64_t count, capacity, skipped;
    char from[LINKS_NAME],
        to[LINKS_NAME]; /* what m was made of: ImageToReference, say, or ProbeToReference and a calibration */
    bool flipped[2];    /* columns, rows: stored the other way round than m has them */
} sweep;

typedef struct sweep_wish {
    bool linear;   /* else nearest */
    int64_t fill;  /* voxels: the widest gap that is filled */
    double voxel;  /* mm; nan: as sweep_voxel says */
    double memory; /* bytes that images and volume may take at once; 0: what there is */
} sweep_wish;

/* Whether this header's text has tracked frames. */
bool sweep_is(const char *header, size_t size);

/* Where the images of a sequence lie. transform: "ImageToReference", or NULL: see poses.h. image_to_probe: 3 x 4 from
 * pixels to the probe's mm; needed, and taken, where the sequence knows the probe's place only; NULL: none. */
int sweep_read(sweep *s, in *source, const char *transform, const double *image_to_probe, err *e);
void sweep_free(sweep *s);

/* Turns m to images as they are stored, of this size. PLUS' transforms are of images whose columns go to the probe's
 * marked side and whose rows go deeper (MF), whatever the file's UltrasoundImageOrientation. */
void sweep_unflip(sweep *s, const int64_t size[3]);

/* The larger of the distance between pixels and half the median distance between the
 * middles of one frame and the next, mm. -1 with e filled for want of memory. */
double sweep_voxel(const sweep *s, const volume *images, err *e);

/* The volume, in the frame that the sequence is tracked in; its axes are along the columns and rows of the middle
 * frame; of the type of the images. filled: voxels that pixels and, after these, gaps gave a value. */
int sweep_volume(volume *v, const sweep *s, const volume *images, const sweep_wish *wish, int64_t filled[2], err *e);

#endif
