/* The connections of a track: one that is made, and made again when it ends, or those of all who connect. The caller
 * owns it.
 */
#ifndef SINEW_TRACK_NET_H
#define SINEW_TRACK_NET_H

#include "link/track/track.h"

enum { TRACK_PEERS = 128 };

typedef struct track_net {
    const tool *t;
    track_ask ask;
    bool listens;
    int listening;          /* a descriptor, or -1 */
    char host[SOCKET_HOST]; /* to connect to */
    char digits[8];
    char place[TRACK_PLACE];
    track_peer *peer[TRACK_PEERS];
    int peers;
    double next, pause;  /* s: when to try to connect, by clock_now, and how long after that to try again */
    double ended;        /* s: when the last connection ended; 0: there was none yet */
    bool told;           /* that it cannot connect */
    bool is_mute;        /* connections that end before a message came are told once */
    bool told_many;      /* that one was turned away */
    int64_t connections; /* so far */
} track_net;

/* Listens at [ADDRESS:]PORT, or is to connect to HOST[:PORT], whose name must be known. The address is told. -1 with e
 * filled. */
int track_net_listen(track_net *n, const char *text, err *e);
int track_net_connect_to(track_net *n, const char *text, err *e);

/* Waits for at most so many s until something comes, and gives it to k. -1 with e filled: what is connected to does not
 * speak OpenIGTLink, or the lines cannot be written. */
int track_net_round(track_net *n, track *k, double wait, err *e);

/* Tells all that nothing more is wanted, and closes. */
void track_net_close(track_net *n);

#endif
