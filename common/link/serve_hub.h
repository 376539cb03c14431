/* All clients, and who connects: one thread waits for everything at once, so that nobody who is slow makes others
 * wait. A client that has taken nothing for SERVE_PATIENCE seconds though something waits is dropped, and so is one
 * that sends what is no OpenIGTLink; each is told in a line. The caller owns a hub.
 */
#ifndef SINEW_SERVE_HUB_H
#define SINEW_SERVE_HUB_H

#include "link/serve_client.h"
#include "link/serve_control.h"

enum { SERVE_CLIENTS = 128, SERVE_PATIENCE = 10 /* s */ };

typedef struct serve_hub serve_hub;

typedef struct serve_hub_plan {
    int listening; /* the hub's from then on */
    serve_common common;
    serve_control *control; /* borrowed, as all here; NULL: none */
    void *context;
    void (*say)(void *context, const char *line);
    bool (*over)(void *context); /* asked each time that something was put on the board, or a signal came */
} serve_hub_plan;

typedef struct serve_hub_counts {
    int64_t clients, refused, dropped; /* connected so far */
    int64_t sent, lost;                /* messages */
} serve_hub_counts;

/* NULL with e filled. */
serve_hub *serve_hub_open(const serve_hub_plan *plan, err *e);

/* Serves until it is over, then sends what waits, for at most so many seconds. -1 with e filled. */
int serve_hub_run(serve_hub *h, double seconds, err *e);

serve_hub_counts serve_hub_count(const serve_hub *h);
void serve_hub_close(serve_hub *h); /* h may be NULL */

#endif
