/* Messages out of a stream of bytes that comes in pieces. Bodies that nobody wants are skipped by their size, never
 * stored; one that is wanted takes memory as its bytes come, not as its header announces. The caller owns a reader.
 */
#ifndef SINEW_IGTL_READER_H
#define SINEW_IGTL_READER_H

#include "link/igtl.h"

typedef struct igtl_reader igtl_reader;

typedef enum igtl_got {
    IGTL_MORE,    /* bytes are wanted */
    IGTL_MESSAGE, /* there is one */
    IGTL_WRONG,   /* one was wrong, and is skipped: e filled */
    IGTL_LOST     /* where messages begin is not known any more: e filled, and nothing more can be read */
} igtl_got;

/* Wants says whether a message's body is to be stored. Bodies of more than `most` bytes are wrong where they are
 * wanted; of more than IGTL_READER_SKIP, always, and then the stream is lost. place: the sender's name, borrowed. NULL
 * with e filled. */
enum { IGTL_READER_SKIP = 1 << 30 };
igtl_reader *igtl_reader_make(bool (*wants)(void *context, const igtl_header *h), void *context, int64_t most,
                              const char *place, err *e);
void igtl_reader_free(igtl_reader *r);

/* Begins anew, with another stream. */
void igtl_reader_begin(igtl_reader *r);

/* Where the next bytes of the stream go, *room of them at most (more than 0 after IGTL_MORE), and how many came. */
unsigned char *igtl_reader_room(igtl_reader *r, size_t *room);
void igtl_reader_took(igtl_reader *r, size_t size);

/* The next message, which is valid until the next call on r. Messages that are not wanted are passed over. */
igtl_got igtl_reader_next(igtl_reader *r, igtl_message *m, err *e);

/* Whether the stream stands inside a message: where it ends now, that one was cut. */
bool igtl_reader_inside(const igtl_reader *r);

/* Messages that were not wanted so far. */
int64_t igtl_reader_skipped(const igtl_reader *r);

#endif
