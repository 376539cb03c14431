/* How far nodes are from the skin that may touch itself, above 0 outside of the tissue: those of all elements within
 * DEPTH_VOXELS voxels of a sample. Where slits part the tissue, each part has nodes of its own there, and a node's
 * distance is from the skin of its own part: it is outside where the places that its elements enclose do not see it.
 * What is trilinear between the nodes' distances is then brought nearer to 0 at the samples, which lie on the skin.
 */
#ifndef SINEW_TOUCH_DEPTH_H
#define SINEW_TOUCH_DEPTH_H

#include "bind/touch_skin.h"

enum { DEPTH_VOXELS = 2 };

typedef struct touch_depth {
    int32_t *element; /* samples: that each is bound to */
    double *weight;   /* samples x 3 */
    int32_t *node;    /* nodes, ascending */
    double *distance; /* nodes, m */
    int64_t nodes;
    double worst; /* m: the most that what is trilinear is off at a sample */
} touch_depth;

/* -1 with e filled, and d to be freed all the same. */
int touch_depth_make(touch_depth *d, const model *m, const side *sides, const touch_skin *skin, int threads, pool *by,
                     err *e);
void touch_depth_free(touch_depth *d);

#endif
