/* Images as us-slice streams them: PGM or PPM of 8 bits, with a comment that says where each lies. The caller owns the
 * stream and the image, and begins with a zeroed one.
 */
#ifndef SINEW_PNM_H
#define SINEW_PNM_H

#include "base/in.h"

enum { PNM_SIDE_MOST = 16384 };

typedef struct pnm {
    int columns, rows, channels; /* 1 or 3 */
    bool has_plane;
    double plane[9]; /* m: the centre of pixel 0 0, the step to the next column, the step to the next row */
    bool has_fan;
    double fan[4];        /* how far above the first row its tip is, radii of its face and end, m; its angle, degrees */
    unsigned char *pixel; /* rows x columns x channels */
    int64_t capacity;
} pnm;

/* The next image, in the place of the one before. 1: there is one; 0: the stream has ended; -1: e filled. */
int pnm_next(in *s, pnm *p, err *e);
void pnm_free(pnm *p);

#endif
