#include "console/mailbox.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

mail *mail_make(bool text, size_t size, err *e)
{
    mail *m = mem_array(1, sizeof *m + size, "a message", e);
    if (!m)
        return NULL;
    m->users = 1;
    m->text = text;
    m->size = size;
    return m;
}

mail *mail_of_text(const char *text, err *e)
{
    mail *m = mail_make(true, strlen(text), e);
    if (m)
        memcpy(m->bytes, text, m->size);
    return m;
}

void mail_done(mail *m)
{
    if (m && atomic_fetch_sub(&m->users, 1) == 1)
        free(m);
}

int mailbox_open(mailbox *b, err *e)
{
    *b = (mailbox){0};
    int code = pthread_mutex_init(&b->lock, NULL);
    if (code)
        return err_system(e, "a mailbox", code, "cannot make it");
    code = pthread_cond_init(&b->some, NULL);
    if (!code)
        return 0;
    pthread_mutex_destroy(&b->lock);
    return err_system(e, "a mailbox", code, "cannot make it");
}

void mailbox_close(mailbox *b)
{
    for (int i = 0; i < b->count; i++)
        mail_done(b->texts[(b->first + i) % MAILBOX_TEXTS]);
    for (int i = 0; i < MAIL_SLOTS; i++)
        mail_done(b->newest[i]);
    pthread_cond_destroy(&b->some);
    pthread_mutex_destroy(&b->lock);
}

void mailbox_end(mailbox *b)
{
    pthread_mutex_lock(&b->lock);
    b->closed = true;
    pthread_cond_signal(&b->some);
    pthread_mutex_unlock(&b->lock);
}

static void put_text(mailbox *b, mail *m)
{
    if (b->count == MAILBOX_TEXTS) {
        mail_done(b->texts[b->first]);
        b->first = (b->first + 1) % MAILBOX_TEXTS;
        b->count--;
    }
    b->texts[(b->first + b->count++) % MAILBOX_TEXTS] = m;
}

void mailbox_put(mailbox *b, mail_slot slot, mail *m)
{
    pthread_mutex_lock(&b->lock);
    if (!b->closed) {
        atomic_fetch_add(&m->users, 1);
        if (slot == MAIL_SAID) {
            put_text(b, m);
        } else {
            mail_done(b->newest[slot]);
            b->newest[slot] = m;
        }
        pthread_cond_signal(&b->some);
    }
    pthread_mutex_unlock(&b->lock);
}

void mailbox_drop(mailbox *b, mail_slot slot)
{
    pthread_mutex_lock(&b->lock);
    mail_done(b->newest[slot]);
    b->newest[slot] = NULL;
    pthread_mutex_unlock(&b->lock);
}

void mailbox_got(mailbox *b, mail_slot slot)
{
    pthread_mutex_lock(&b->lock);
    b->paced[slot] = true;
    b->held[slot] = false;
    pthread_cond_signal(&b->some);
    pthread_mutex_unlock(&b->lock);
}

bool mailbox_is_free(mailbox *b, mail_slot slot)
{
    pthread_mutex_lock(&b->lock);
    const bool is = !b->held[slot] && !b->newest[slot];
    pthread_mutex_unlock(&b->lock);
    return is;
}

static mail *next_text(mailbox *b)
{
    mail *m = b->texts[b->first];
    b->first = (b->first + 1) % MAILBOX_TEXTS;
    b->count--;
    return m;
}

static mail *empty(mailbox *b, int slot)
{
    mail *m = b->held[slot] ? NULL : b->newest[slot];
    if (m) {
        b->newest[slot] = NULL;
        b->held[slot] = b->paced[slot];
    }
    return m;
}

/* What is to be sent next, or NULL. */
static mail *next(mailbox *b)
{
    enum { TURNS = MAIL_SLOTS - MAIL_FRAME };
    mail *m = b->count ? next_text(b) : NULL;
    for (int i = MAIL_STATE; i < MAIL_FRAME && !m; i++)
        m = empty(b, i);
    for (int i = 0; i < TURNS && !m; i++) {
        const int turn = (b->turn + i) % TURNS;
        m = empty(b, MAIL_FRAME + turn);
        if (m)
            b->turn = (turn + 1) % TURNS;
    }
    return m;
}

mail *mailbox_take(mailbox *b)
{
    mail *m = NULL;
    pthread_mutex_lock(&b->lock);
    while (!b->closed && !(m = next(b)))
        pthread_cond_wait(&b->some, &b->lock);
    pthread_mutex_unlock(&b->lock);
    return m;
}
