/* A closed surface such as a scanner gives, from equations: a head with a nose, ears, a neck and wrinkles, whose
 * vertices stand unevenly and are jittered along and across the surface, so that no two triangles are alike. Every
 * vertex lies at one distance from the middle in its own direction, and directions keep their order, so the surface
 * never meets itself. About 200 high, in the unit of whoever asks. The caller owns the arrays.
 */
#ifndef SINEW_SCAN_H
#define SINEW_SCAN_H

#include "base/err.h"

typedef struct scan {
    double *position; /* vertices x 3 */
    int64_t vertices;
    int32_t *vertex; /* triangles x 3, seen from outside against the clock */
    int64_t triangles;
} scan;

/* About so many triangles, at least 100. -1 with e filled on no memory. */
int scan_make(scan *s, int64_t triangles, err *e);
void scan_free(scan *s);

#endif
