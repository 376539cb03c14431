/* Lines for whoever listens on a local socket (AF_UNIX, SOCK_STREAM), which only its owner may connect to (mode 0600).
 * Clients come and go; each gets every line that is sent while it is there, whole, and in order. One that does not read
 * loses lines: some 8 KiB wait for it, so that what it reads then is not old; it keeps nobody waiting. What clients say
 * is thrown away. Nothing here waits: clients are taken when the caller sends or asks.
 *
 * The socket appears when it is made, takes the place of one that nobody listens on any more, and is removed at the
 * end, also when a signal ends the process. The caller owns the object, and uses it from one thread at a time.
 */
#ifndef SINEW_BROADCAST_H
#define SINEW_BROADCAST_H

#include "base/err.h"

#include <stddef.h>

enum { BROADCAST_CLIENTS = 64, BROADCAST_LINE = 4096 /* bytes, the most that a line has */ };

typedef struct broadcast broadcast;

typedef struct broadcast_counts {
    int64_t clients; /* that came */
    int64_t refused; /* when there were BROADCAST_CLIENTS already: hung up on */
    int64_t lines;   /* sent, to one client at least or to none */
    int64_t lost;    /* lines that a client did not get, as it does not read */
} broadcast_counts;

/* NULL with e filled: there is a file at `path` that is no socket, somebody listens there, or it cannot be made. */
broadcast *broadcast_open(const char *path, err *e);

/* NULL is nothing. */
void broadcast_close(broadcast *b);

/* How many clients there are now. */
int broadcast_clients(broadcast *b);

/* A line with its end, of at most BROADCAST_LINE bytes. */
void broadcast_send(broadcast *b, const char *line, size_t length);

broadcast_counts broadcast_count(const broadcast *b);

#endif
