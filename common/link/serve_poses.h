/* Lines of poses as a probe's TRANSFORM: the newest, as they come, read by a thread. The caller owns it.
 */
#ifndef SINEW_SERVE_POSES_H
#define SINEW_SERVE_POSES_H

#include "link/serve_board.h"
#include "live/lines.h"

typedef struct serve_poses serve_poses;

typedef struct serve_poses_plan {
    const char *path; /* "-": standard input; else a FIFO */
    int probe;        /* the board's number of the TRANSFORM */
    serve_board *board;
    void *context;
    void (*say)(void *context, const char *line); /* of lines that are wrong */
    void (*failed)(void *context, const err *e);
} serve_poses_plan;

/* NULL with e filled. */
serve_poses *serve_poses_open(const serve_poses_plan *plan, err *e);

/* Whether no more will come; and what came, once that is so, or it was ended. */
bool serve_poses_ended(serve_poses *s);
lines_counts serve_poses_count(const serve_poses *s);

/* Ends reading, and waits for that. */
void serve_poses_end(serve_poses *s);
void serve_poses_close(serve_poses *s); /* s may be NULL */

#endif
