#include "link/serve_client.h"

#include "base/clock.h"
#include "base/mem.h"
#include "link/igtl_reader.h"
#include "link/serve_request.h"

#include <errno.h>
#include <math.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum {
    BODY = 1 << 16,    /* bytes of a body that is read */
    ANSWERS = 1 << 18, /* bytes of answers that wait: then it is not read on */
    UNSENT = 1 << 17   /* bytes that the system keeps besides: what is there gets old */
};

struct serve_client {
    int fd;
    char from[SERVE_FROM];
    const serve_common *common;
    igtl_reader *reader;
    serve_wishes wishes;
    serve_parcel *now;     /* is being sent; NULL: none */
    const igtl_buffer *as; /* its bytes */
    int64_t done;          /* bytes of it, or of the answers, that are sent */
    uint64_t serial[SERVE_DEVICES];
    double last[SERVE_DEVICES]; /* s: when it was sent */
    int turn;                   /* which device is asked first */
    bool is_full;
    double moved; /* s: when the connection last took something, or nothing waited */
    double due;
    int64_t sent, lost;
};

/* Messages of header version 2 are from one who knows it. */
static bool wants(void *context, const igtl_header *h)
{
    serve_client *c = context;
    if (h->version > c->wishes.version)
        c->wishes.version = h->version;
    return serve_request_is(h);
}

/* The connection holds little that is not on its way. */
static void keep_short(int fd)
{
    const int most = UNSENT;
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most, sizeof most); /* else what is sent is older */
}

serve_client *serve_client_make(int fd, const char *from, const serve_common *common, err *e)
{
    serve_client *c = mem_array(1, sizeof *c, "a client", e);
    if (!c) {
        close(fd);
        return NULL;
    }
    c->fd = fd;
    c->common = common;
    c->wishes.version = 1;
    c->moved = clock_now();
    c->due = (double)INFINITY;
    snprintf(c->from, sizeof c->from, "client %.*s", ADDRESS_MOST + 16, from);
    for (int i = serve_board_count(common->board) - 1; i >= 0; i--) {
        const uint64_t serial = serve_board_serial(common->board, i);
        c->serial[i] = serial ? serial - 1 : 0;
    }
    c->reader = igtl_reader_make(wants, c, BODY, c->from, e);
    if (!c->reader) {
        serve_client_free(c);
        return NULL;
    }
    keep_short(fd);
    return c;
}

void serve_client_free(serve_client *c)
{
    if (!c)
        return;
    close(c->fd);
    igtl_reader_free(c->reader);
    igtl_buffer_free(&c->wishes.answers);
    serve_parcel_done(c->now);
    free(c);
}

int serve_client_fd(const serve_client *c)
{
    return c->fd;
}

const char *serve_client_from(const serve_client *c)
{
    return c->from;
}

/* ---- reading */

static bool reads(const serve_client *c)
{
    return c->wishes.answers.size < ANSWERS;
}

/* 0; -1: e says what is wrong. */
static int act(serve_client *c, err *e)
{
    igtl_message m;
    igtl_got got;
    while ((got = igtl_reader_next(c->reader, &m, e)) == IGTL_MESSAGE)
        if (serve_request_take(&m, c->common->board, c->common->us, &c->wishes, e))
            return -1;
    return got == IGTL_MORE ? 0 : -1;
}

int serve_client_read(serve_client *c, err *e)
{
    while (reads(c)) {
        size_t room;
        unsigned char *to = igtl_reader_room(c->reader, &room);
        const ssize_t n = recv(c->fd, to, room, 0);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0 && errno == EAGAIN)
            return 0;
        if (n <= 0)
            return igtl_reader_inside(c->reader) ? err_set(e, c->from, 0, "went away within a message") : 1;
        igtl_reader_took(c->reader, (size_t)n);
        if (act(c, e))
            return -1;
    }
    return 0;
}

/* ---- writing */

/* All that is left of these bytes. 1: it is sent; 0: the connection is full; -1: it is gone. */
static int send_rest(serve_client *c, const igtl_buffer *b)
{
    while (c->done < b->size) {
        const ssize_t n = send(c->fd, b->at + c->done, (size_t)(b->size - c->done), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0) {
            c->is_full = errno == EAGAIN;
            return c->is_full ? 0 : -1;
        }
        c->done += n;
        c->moved = clock_now();
    }
    c->done = 0;
    return 1;
}

/* Whether a device's message may go now; what is due later is kept in mind. */
static bool may_go(serve_client *c, int i, double now, bool last)
{
    const serve_wish *w = serve_request_wish(&c->wishes, c->common->board, i);
    const bool asked = c->wishes.device[i].is_asked;
    const double due = c->last[i] + fmax(w->interval, c->common->interval);
    if (asked || last || now >= due)
        return asked || !w->is_off;
    if (!w->is_off && serve_board_serial(c->common->board, i) > c->serial[i])
        c->due = fmin(c->due, due);
    return false;
}

/* The next message to send, of the devices in turn. */
static serve_parcel *next(serve_client *c, bool last)
{
    const int count = serve_board_count(c->common->board);
    const double now = clock_now();
    c->due = (double)INFINITY;
    for (int k = 0; k < count; k++) {
        const int i = (c->turn + k) % count;
        uint64_t serial = c->wishes.device[i].is_asked ? 0 : c->serial[i];
        serve_parcel *p = may_go(c, i, now, last) ? serve_board_take(c->common->board, i, &serial) : NULL;
        if (!p)
            continue;
        c->lost += serial > c->serial[i] ? (int64_t)(serial - c->serial[i] - 1) : 0;
        c->serial[i] = serial;
        c->last[i] = now;
        c->wishes.device[i].is_asked = false;
        c->turn = i + 1;
        return p;
    }
    return NULL;
}

/* As send_rest, of the answers; where there are none, or a message is being sent, 1. */
static int send_answers(serve_client *c)
{
    if (c->now || !c->wishes.answers.size)
        return 1;
    const int sent = send_rest(c, &c->wishes.answers);
    if (sent > 0)
        c->wishes.answers.size = 0;
    return sent;
}

/* Begins with the next message. 1: there is one; 0: none; -1: e filled. */
static int begin_next(serve_client *c, bool last, err *e)
{
    if (c->now)
        return 1;
    c->now = next(c, last);
    c->as = c->now ? serve_parcel_bytes(c->now, c->wishes.version, e) : NULL;
    if (!c->now)
        return 0;
    return c->as ? 1 : -1;
}

int serve_client_write(serve_client *c, bool last, err *e)
{
    int sent;
    c->is_full = false;
    while ((sent = send_answers(c)) > 0) {
        const int begun = begin_next(c, last, e);
        if (begun < 0)
            return -1;
        if (!begun) {
            c->moved = clock_now();
            return 0;
        }
        sent = send_rest(c, c->as);
        if (sent <= 0)
            break;
        serve_parcel_done(c->now);
        c->now = NULL;
        c->sent++;
    }
    return sent < 0;
}

short serve_client_events(const serve_client *c)
{
    int events = reads(c) ? POLLIN : 0;
    if (c->is_full)
        events |= POLLOUT;
    return (short)events;
}

bool serve_client_is_full(const serve_client *c)
{
    return c->is_full;
}

double serve_client_due(const serve_client *c)
{
    return c->due;
}

double serve_client_stuck(const serve_client *c)
{
    return c->is_full ? clock_now() - c->moved : 0;
}

int64_t serve_client_sent(const serve_client *c)
{
    return c->sent;
}

int64_t serve_client_lost(const serve_client *c)
{
    return c->lost;
}
