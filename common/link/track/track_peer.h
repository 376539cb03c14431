/* One program at the other end of a connection: what it sends, as messages, and what it is asked for. The owner begins
 * it and lets it go, which closes the connection.
 */
#ifndef SINEW_TRACK_PEER_H
#define SINEW_TRACK_PEER_H

#include "link/igtl_reader.h"
#include "link/socket.h"

enum { TRACK_PLACE = SOCKET_HOST + 16, TRACK_STATUS = 200 };

typedef struct track_peer {
    int fd;
    char place[TRACK_PLACE]; /* for messages: host and port */
    igtl_reader *reader;
    bool has_spoken;         /* a message that was wanted has come */
    int status;              /* the code of its last STATUS; IGTL_OK to begin with */
    char said[TRACK_STATUS]; /* what that said */
} track_peer;

/* What a tracker is asked for. */
typedef struct track_ask {
    double rate;     /* poses a second */
    bool protocol_3; /* a peer that answers in the protocol that it was spoken to in, as PLUS, is to speak 3 */
} track_ask;

/* Takes a connection, which is closed where this fails. wants, context: as igtl_reader_make has them. NULL with e
 * filled. */
track_peer *track_peer_make(int fd, const char *place, bool (*wants)(void *context, const igtl_header *h),
                            void *context, err *e);

/* Sends STT_TDATA, and in protocol 3 a GET_STATUS before it. -1 with e filled: the connection does not take it. */
int track_peer_ask(track_peer *p, const track_ask *what, err *e);

typedef enum track_came { TRACK_BYTES, TRACK_NOTHING, TRACK_ENDED } track_came;

/* Reads what has come. TRACK_NOTHING: nothing more just now; TRACK_ENDED: also with e filled, where it was cut. */
track_came track_peer_receive(track_peer *p, err *e);

/* Whether it has sent a message at all. */
bool track_peer_speaks(const track_peer *p);

/* Sends STP_TDATA, where that can be, and closes. p may be NULL. */
void track_peer_free(track_peer *p);

#endif
