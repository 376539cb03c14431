/* What is served: devices, each of a type and a name, with the newest message of each. Messages are put by any thread
 * and taken by one, which sends them. A message is a parcel that all who send it share: its bytes are made once, and
 * those of header version 2 when they are first asked for. The caller owns a board, and each parcel that it took.
 */
#ifndef SINEW_SERVE_BOARD_H
#define SINEW_SERVE_BOARD_H

#include "link/igtl.h"

enum { SERVE_DEVICES = 256 }; /* the most */

typedef struct serve_board serve_board;
typedef struct serve_parcel serve_parcel;

serve_board *serve_board_make(err *e);
void serve_board_free(serve_board *b);

/* A device that messages can be put for: its number. A name that its field cuts to that of another of its type gets a
 * number at its end. -1 with e filled: there are too many, or no memory. */
int serve_board_add(serve_board *b, const char *type, const char *name, err *e);

/* How many there are; a device keeps its number, type and name, which the board owns. */
int serve_board_count(serve_board *b);
const char *serve_board_type(const serve_board *b, int device);
const char *serve_board_name(const serve_board *b, int device);

/* Puts a content in the place of the device's newest. stamp: of OpenIGTLink; index: of the frame or image, metadata of
 * header version 2; -1: none. -1 with e filled. */
int serve_board_put(serve_board *b, int device, uint64_t stamp, int64_t index, const igtl_buffer *content, err *e);

/* How many messages were put for a device so far. */
uint64_t serve_board_serial(serve_board *b, int device);

/* The newest message of a device, where it is newer than *serial, which becomes its own; else NULL. */
serve_parcel *serve_board_take(serve_board *b, int device, uint64_t *serial);

/* A parcel's bytes, with the header of a version. NULL with e filled on no memory. For the one thread. */
const igtl_buffer *serve_parcel_bytes(serve_parcel *p, int version, err *e);
void serve_parcel_done(serve_parcel *p); /* p may be NULL */

/* A descriptor that can be read when something was put, or serve_board_wake was called, since serve_board_heard. */
int serve_board_bell(const serve_board *b);
void serve_board_wake(serve_board *b);
void serve_board_heard(serve_board *b);

#endif
