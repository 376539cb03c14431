/* A square part of a picture, traced on its own with a rim around it, so that tiles can be done in any order and by any
 * thread. A tile's memory is made once a thread; its creator owns it.
 */
#ifndef SINEW_RENDER_TILE_H
#define SINEW_RENDER_TILE_H

#include "render/shade.h"

enum { TILE_SIDE = 88, TILE_RIM = 4, TILE_WIDTH = TILE_SIDE + 2 * TILE_RIM };

typedef struct tile tile;

typedef struct tile_count {
    int64_t rays, covered;
} tile_count;

tile *tile_create(err *e);
void tile_destroy(tile *t);

/* Draws the tile whose upper left pixel is (left, top) into the image. */
tile_count tile_draw(tile *t, const view *v, int left, int top, image *im);

#endif
