/* The console's server: the page's files by HTTP, and WebSockets at /live, each with a mailbox and a thread that sends
 * from it, so that a client that does not read stalls nobody. A client that says "got image" or "got positions" gets
 * the next of these only when it has said so again: see mailbox.h; one that says "pixels raw" can take images that are
 * not compressed. What is not asked for by our own page, at our own address, is refused: see origin.h. web.c is the
 * only user of civetweb. The caller owns a web.
 */
#ifndef SINEW_WEB_H
#define SINEW_WEB_H

#include "console/mailbox.h"
#include "console/origin.h"

enum { WEB_CLIENTS = 8, WEB_PATH = 4096 };

typedef struct web web;

/* What is borrowed must last as long as the web. The functions are called by its threads. */
typedef struct web_plan {
    address at;
    const char *token; /* NULL: none is asked for */
    const char *page;  /* the folder of index.html */
    const char *three; /* the folder served as /three/ */
    void *context;
    void (*said)(void *context, int client, const char *text, size_t size);
    /* The path of the file that a request below /case/ or /save/ gets (uri: without the first slash). -1: there is
     * none. */
    int (*file)(void *context, const char *uri, char path[WEB_PATH]);
} web_plan;

/* Listens. at->port gets the port, where any was asked for. NULL with e filled. */
web *web_open(const web_plan *plan, err *e);

/* Ends all connections, and the threads. w may be NULL. */
void web_close(web *w);

/* The port that it listens on. */
int web_port(const web *w);

/* Puts a mail into the box of client `to`, or into everyone's (-1), and takes over the caller's use of it. m may be
 * NULL: nothing is put. A client that connects later gets of each slot the last mail that went to everyone, but no
 * texts. */
void web_send(web *w, int to, mail_slot slot, mail *m);

/* Waits until a client would get what is put into this slot now, at most so many seconds; not at all where there are no
 * clients. */
void web_wait(web *w, mail_slot slot, double seconds);

/* Takes what waits in this slot out of every client's box, and sends it to no client that connects later. */
void web_drop(web *w, mail_slot slot);

/* How many clients there are. */
int web_clients(web *w);

/* Whether there are clients, and all of them said "pixels raw". */
bool web_all_raw(web *w);

#endif
