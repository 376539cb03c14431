/* The images that us-slice streams: each becomes a message with its place in space and its pixels, as a JPEG or as they
 * came; the newest is kept as it came, to be saved. A thread reads them. The caller owns it.
 */
#ifndef SINEW_IMAGES_H
#define SINEW_IMAGES_H

#include "console/mailbox.h"

typedef struct images images;

typedef struct images_plan {
    int from;         /* the tool's output; its from then on */
    const char *tool; /* borrowed */
    void *context;
    double (*time)(void *context);        /* s: of the newest frame */
    bool (*wants)(void *context);         /* whether the next image is to be shown */
    bool (*raw)(void *context);           /* and its pixels as they came */
    void (*show)(void *context, mail *m); /* which is show's from then on */
    void (*failed)(void *context, const char *tool, const err *e);
} images_plan;

/* NULL with e filled; the descriptor is closed in any case. */
images *images_open(const images_plan *plan, err *e);

/* Waits for the output's end: the tool must have ended. i may be NULL. */
void images_close(images *i);

/* Writes the newest image as PNG to path. -1 with e filled. */
int images_save(images *i, const char *path, err *e);

#endif
