/* Images that know where they lie, as us-slice writes them: PGM or PPM of 8 bits with the comment `# us-slice:` and
 * nine numbers, m: the centre of pixel 0 0, the step to the next column and the step to the next row; where the image
 * is a fan, then the word fan, how far above the first row its tip is, the radii of its face and its end, m, and the
 * angle by which it opens, degrees. The caller owns what is read.
 */
#ifndef SINEW_PLACED_H
#define SINEW_PLACED_H

#include "base/in.h"

enum { PLACED_SIDE_MOST = 16384 };

typedef struct placed {
    int columns, rows, channels; /* channels: 1 or 3 */
    double origin[3], column[3], row[3];
    bool fan;
    double tip, radius[2], angle; /* of a fan; m, and degrees */
    uint8_t *pixel;               /* rows x columns x channels */
} placed;

/* The first image of a stream. -1 with e filled: file and line. */
int placed_read(placed *p, in *s, err *e);
void placed_free(placed *p);

/* Whether a pixel is of the image: those around a fan are not. */
bool placed_shows(const placed *p, int column, int row);

#endif
