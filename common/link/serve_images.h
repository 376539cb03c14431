/* Images as us-slice streams them, as messages: IMAGE, with where it lies; the same as TRANSFORM ImageToReference; and,
 * of a stream that alone tells it, the probe's pose. A thread reads them, as fast as they come. The caller owns it.
 */
#ifndef SINEW_SERVE_IMAGES_H
#define SINEW_SERVE_IMAGES_H

#include "link/serve_board.h"
#include "link/serve_us.h"
#include "picture/pnm.h"

typedef struct serve_images serve_images;

typedef struct serve_images_plan {
    const char *path; /* "-": standard input; a FIFO need not have a writer yet */
    int probe;        /* the board's number of the probe's TRANSFORM; -1: images do not give it */
    int stop;         /* a descriptor: once it can be read or is hung up, nothing more is read */
    serve_board *board;
    serve_us *us;
    void *context;
    void (*failed)(void *context, const err *e);
} serve_images_plan;

/* What takes pixels (columns, rows, 0) to mm, in RAS, row by row; and the probe's pose: columns run along its x, rows
 * along its z from the middle of its face. The image has a plane. */
void serve_images_matrix(const pnm *p, double matrix[16]);
void serve_images_probe(const pnm *p, double matrix[16]);

/* NULL with e filled. */
serve_images *serve_images_open(const serve_images_plan *plan, err *e);

/* Whether the stream has ended; and how many images came. */
bool serve_images_ended(serve_images *s);
int64_t serve_images_count(serve_images *s);

/* Waits for the end of the stream, or `stop`. s may be NULL. */
void serve_images_close(serve_images *s);

#endif
