/* What a client asks for: GET_, STT_ and STP_ of what is served, COMMAND, and commands as STRING of old clients. Owns
 * nothing but the answers that wait, which are the caller's.
 */
#ifndef SINEW_SERVE_REQUEST_H
#define SINEW_SERVE_REQUEST_H

#include "link/igtl.h"
#include "link/serve_board.h"
#include "link/serve_us.h"

/* How a client wants a device, or all of a type. Zeroed: each message, as it comes. */
typedef struct serve_wish {
    bool is_said;    /* else a device is wanted as its type is */
    bool is_off;     /* not at all */
    bool is_asked;   /* the newest, once, whether it is new or not */
    double interval; /* s: the least between two */
} serve_wish;

enum { SERVE_TYPES = 6 };

typedef struct serve_wishes {
    int version; /* of headers that it is sent */
    serve_wish device[SERVE_DEVICES], type[SERVE_TYPES];
    igtl_buffer answers; /* whole messages */
} serve_wishes;

/* The wish that counts for a device. */
const serve_wish *serve_request_wish(const serve_wishes *w, const serve_board *board, int device);

/* Whether a message with this header is to be read. */
bool serve_request_is(const igtl_header *h);

/* Acts on one. -1 with e filled: it is wrong, or memory is short. */
int serve_request_take(const igtl_message *m, serve_board *board, serve_us *us, serve_wishes *w, err *e);

#endif
