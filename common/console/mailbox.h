/* What waits to be sent to one client: texts in their order, and of each other kind the newest alone, so that a client
 * that reads slowly, or not at all, costs little memory and stalls nobody. A client may say what it is done with: from
 * then on the next of that slot is sent only when it is done with the one before, so that what it gets is the newest
 * when it can use it. A mail is shared by all boxes that it lies in, and freed with the last. Any thread may put; one
 * takes.
 */
#ifndef SINEW_MAILBOX_H
#define SINEW_MAILBOX_H

#include "base/err.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>

/* The first three are taken in this order before all else, and of texts all are; the others by turns, so that none is
 * left waiting. */
typedef enum mail_slot {
    MAIL_SAID,
    MAIL_STATE,
    MAIL_GEOMETRY,
    MAIL_FRAME,
    MAIL_IMAGE,
    MAIL_POSITIONS,
    MAIL_SLOTS
} mail_slot;

enum { MAILBOX_TEXTS = 64 }; /* that wait; of more the oldest are dropped */

typedef struct mail {
    atomic_int users;
    bool text; /* of WebSocket: text, or binary */
    size_t size;
    unsigned char bytes[];
} mail;

/* A mail that its maker uses; mail_done once it was put everywhere. NULL with e filled. */
mail *mail_make(bool text, size_t size, err *e);
mail *mail_of_text(const char *text, err *e);
void mail_done(mail *m);

typedef struct mailbox {
    pthread_mutex_t lock;
    pthread_cond_t some;
    mail *texts[MAILBOX_TEXTS];
    int first, count;
    mail *newest[MAIL_SLOTS]; /* of MAIL_SAID: none */
    int turn;                 /* which of the others is asked first */
    bool paced[MAIL_SLOTS];   /* the client says when it is done with one */
    bool held[MAIL_SLOTS];    /* and has not yet said so of the one that was taken last */
    bool closed;
} mailbox;

/* 0, or -1 with e filled. */
int mailbox_open(mailbox *b, err *e);
void mailbox_close(mailbox *b); /* no thread may wait in it any more */

/* From now on nothing is put into the box or taken from it; mailbox_take returns NULL, also where it waits. */
void mailbox_end(mailbox *b);

void mailbox_put(mailbox *b, mail_slot slot, mail *m);

/* What waits in a slot is not to be sent any more. */
void mailbox_drop(mailbox *b, mail_slot slot);

/* The client is done with the last mail of a slot. */
void mailbox_got(mailbox *b, mail_slot slot);

/* Whether what is put into the slot now would be taken next, before anything newer. */
bool mailbox_is_free(mailbox *b, mail_slot slot);

/* Waits for a mail, which is then the caller's to mail_done(). NULL: the box was ended. */
mail *mailbox_take(mailbox *b);

#endif
