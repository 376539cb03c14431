/* What a page asks for: one line of text a message, in the words of sinew-lines(5), as a struct. What is to be passed
 * on to a tool stands in `line`, made of words that were looked at: it has no control character, no comment and no
 * second line. Owns nothing.
 */
#ifndef SINEW_MESSAGE_H
#define SINEW_MESSAGE_H

#include "base/err.h"
#include "base/pose.h"

#include <stddef.h>

enum { MESSAGE_MOST = 4096 }; /* bytes of a message */

typedef enum message_kind {
    MESSAGE_OPEN,   /* the case named `line` */
    MESSAGE_POSE,   /* of the probe: `at` */
    MESSAGE_TOOL,   /* `line` is for the tool that computes: method, set, now, pull, release */
    MESSAGE_IMAGE,  /* `line` is for us-slice: set KEY VALUE */
    MESSAGE_COLOUR, /* what surfaces are coloured by: `line` */
    MESSAGE_PAUSE,  /* `on` */
    MESSAGE_STEP,   /* one frame while it is paused */
    MESSAGE_RESET,  /* the case from its beginning */
    MESSAGE_RECORD, /* `on` */
    MESSAGE_SAVE,   /* `line`: "image" or "model" */
    MESSAGE_REPLAY, /* what was recorded last */
    MESSAGE_KINDS
} message_kind;

typedef struct message {
    message_kind kind;
    bool on;
    pose at;
    char line[MESSAGE_MOST + 1];
} message;

/* Reads a message of `size` bytes, which need not end with a NUL; one line end at its end is let be. -1 with e filled
 * where it is none, without a place. */
int message_read(const char *text, size_t size, message *to, err *e);

#endif
