#include "link/serve_board.h"

#include "base/mem.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

struct serve_parcel {
    atomic_int users;
    const char *type, *name; /* the board's */
    uint64_t stamp;
    int64_t index;
    uint32_t id;
    igtl_buffer bytes[2]; /* of header version 1 and 2 */
};

typedef struct slot {
    char type[IGTL_TYPE + 1], name[IGTL_DEVICE + 1];
    serve_parcel *newest; /* NULL: none yet */
    uint64_t serial;
} slot;

struct serve_board {
    pthread_mutex_t lock; /* of what follows; a device's type and name stay as they are */
    slot slot[SERVE_DEVICES];
    int count;
    uint32_t id;
    int bell;
};

serve_board *serve_board_make(err *e)
{
    serve_board *b = mem_array(1, sizeof *b, "messages", e);
    if (!b)
        return NULL;
    b->bell = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (b->bell < 0) {
        err_system(e, NULL, errno, "cannot make a descriptor");
        free(b);
        return NULL;
    }
    pthread_mutex_init(&b->lock, NULL);
    return b;
}

void serve_board_free(serve_board *b)
{
    if (!b)
        return;
    for (int i = 0; i < b->count; i++)
        serve_parcel_done(b->slot[i].newest);
    pthread_mutex_destroy(&b->lock);
    close(b->bell);
    free(b);
}

static bool is_taken(const serve_board *b, const slot *d)
{
    for (int i = 0; i < b->count; i++)
        if (!strcmp(b->slot[i].type, d->type) && !strcmp(b->slot[i].name, d->name))
            return true;
    return false;
}

/* A name that no other device of the type has. */
static void name_device(const serve_board *b, slot *d, const char *name)
{
    snprintf(d->name, sizeof d->name, "%s", name);
    for (int i = 2; is_taken(b, d); i++) {
        char end[12];
        const int n = snprintf(end, sizeof end, "~%d", i);
        snprintf(d->name, sizeof d->name, "%.*s%s", IGTL_DEVICE - n, name, end);
    }
}

int serve_board_add(serve_board *b, const char *type, const char *name, err *e)
{
    pthread_mutex_lock(&b->lock);
    const int at = b->count < SERVE_DEVICES ? b->count : -1;
    if (at >= 0) {
        slot *d = &b->slot[at];
        snprintf(d->type, sizeof d->type, "%s", type);
        name_device(b, d, name);
        b->count++;
    }
    pthread_mutex_unlock(&b->lock);
    return at >= 0 ? at : err_set(e, NULL, 0, "%s '%s': more than %d devices", type, name, SERVE_DEVICES);
}

int serve_board_count(serve_board *b)
{
    pthread_mutex_lock(&b->lock);
    const int count = b->count;
    pthread_mutex_unlock(&b->lock);
    return count;
}

const char *serve_board_type(const serve_board *b, int device)
{
    return b->slot[device].type;
}

const char *serve_board_name(const serve_board *b, int device)
{
    return b->slot[device].name;
}

static int write_parcel(serve_parcel *p, int version, const void *content, int64_t size, err *e)
{
    char text[24];
    const char *const pair[1][2] = {{"FrameNumber", text}};
    const igtl_about about = {version, p->type, p->name, p->stamp, p->id, pair, p->index >= 0};
    snprintf(text, sizeof text, "%" PRId64, p->index);
    return igtl_write(&p->bytes[version - 1], &about, content, size, e);
}

static serve_parcel *make_parcel(const slot *d, uint64_t stamp, int64_t index, uint32_t id, err *e)
{
    serve_parcel *p = mem_array(1, sizeof *p, "a message", e);
    if (!p)
        return NULL;
    p->users = 1;
    p->type = d->type;
    p->name = d->name;
    p->stamp = stamp;
    p->index = index;
    p->id = id;
    return p;
}

int serve_board_put(serve_board *b, int device, uint64_t stamp, int64_t index, const igtl_buffer *content, err *e)
{
    pthread_mutex_lock(&b->lock);
    const uint32_t id = ++b->id;
    pthread_mutex_unlock(&b->lock);
    serve_parcel *p = make_parcel(&b->slot[device], stamp, index, id, e);
    if (!p || write_parcel(p, 1, content->at, content->size, e)) {
        serve_parcel_done(p);
        return -1;
    }
    pthread_mutex_lock(&b->lock);
    serve_parcel *before = b->slot[device].newest;
    b->slot[device].newest = p;
    b->slot[device].serial++;
    pthread_mutex_unlock(&b->lock);
    serve_parcel_done(before);
    serve_board_wake(b);
    return 0;
}

uint64_t serve_board_serial(serve_board *b, int device)
{
    pthread_mutex_lock(&b->lock);
    const uint64_t serial = b->slot[device].serial;
    pthread_mutex_unlock(&b->lock);
    return serial;
}

serve_parcel *serve_board_take(serve_board *b, int device, uint64_t *serial)
{
    serve_parcel *p = NULL;
    pthread_mutex_lock(&b->lock);
    if (b->slot[device].serial > *serial) {
        *serial = b->slot[device].serial;
        p = b->slot[device].newest;
        atomic_fetch_add(&p->users, 1);
    }
    pthread_mutex_unlock(&b->lock);
    return p;
}

const igtl_buffer *serve_parcel_bytes(serve_parcel *p, int version, err *e)
{
    const igtl_buffer *first = &p->bytes[0];
    if (!p->bytes[version - 1].size && write_parcel(p, version, first->at + IGTL_HEADER, first->size - IGTL_HEADER, e))
        return NULL;
    return &p->bytes[version - 1];
}

void serve_parcel_done(serve_parcel *p)
{
    if (!p || atomic_fetch_sub(&p->users, 1) != 1)
        return;
    igtl_buffer_free(&p->bytes[0]);
    igtl_buffer_free(&p->bytes[1]);
    free(p);
}

int serve_board_bell(const serve_board *b)
{
    return b->bell;
}

void serve_board_wake(serve_board *b)
{
    const uint64_t one = 1;
    const ssize_t n = write(b->bell, &one, sizeof one);
    (void)n; /* a bell that is full rings all the same */
}

void serve_board_heard(serve_board *b)
{
    uint64_t rings;
    const ssize_t n = read(b->bell, &rings, sizeof rings);
    (void)n; /* nothing to read: it had not rung */
}
