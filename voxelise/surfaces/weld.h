/* Welds the vertices that are at one place, so that soups of polygons are as good as connected meshes. The caller owns
 * a weld.
 */
#ifndef SINEW_WELD_H
#define SINEW_WELD_H

#include "surface/obj.h"

typedef struct weld {
    int32_t *of;      /* the OBJ's vertices: the number of each place, -1 = not used */
    double *position; /* places x 3, in the order of their first vertices */
    int64_t places;
    double low[3], high[3]; /* the box of the places */
} weld;

/* Of the vertices that these faces use; a face may be there again. Coordinates too small for exact arithmetic (grid.h)
 * are taken as 0, those too large refused: -1 with e filled. */
int weld_make(weld *w, const obj *o, const int64_t *face, int64_t faces, err *e);
void weld_free(weld *w);

#endif
