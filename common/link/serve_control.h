/* Lines for us-slice's --control, through a FIFO that need not have a reader yet: they wait, in their order, and none
 * is lost. The caller owns it, and ignores SIGPIPE.
 */
#ifndef SINEW_SERVE_CONTROL_H
#define SINEW_SERVE_CONTROL_H

#include "base/err.h"

#include <poll.h>

typedef struct serve_control serve_control;

/* path: a FIFO that is there. NULL with e filled. */
serve_control *serve_control_open(const char *path, err *e);
void serve_control_close(serve_control *c); /* c may be NULL */

/* Adds a line, without its end. -1 with e filled: too many wait for a reader, or c is NULL, for want of --control. */
int serve_control_put(serve_control *c, const char *line, err *e);

/* Writes what can be written. Returns how many lines still wait. c may be NULL. */
int serve_control_write(serve_control *c);

/* What to poll for before the next write; fd -1: nothing, as where there is no reader, who is then looked for again. */
struct pollfd serve_control_waits(const serve_control *c);

#endif
