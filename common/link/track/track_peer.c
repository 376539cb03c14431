#include "link/track/track_peer.h"

#include "base/mem.h"
#include "link/igtl_content.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

enum { BODY = 1 << 20 /* bytes: of TDATA with 14,000 tools */ };

track_peer *track_peer_make(int fd, const char *place, bool (*wants)(void *context, const igtl_header *h),
                            void *context, err *e)
{
    track_peer *p = mem_array(1, sizeof *p, "a connection", e);
    if (!p) {
        close(fd);
        return NULL;
    }
    p->fd = fd;
    p->status = IGTL_OK;
    snprintf(p->place, sizeof p->place, "%s", place);
    p->reader = igtl_reader_make(wants, context, BODY, p->place, e);
    if (p->reader)
        return p;
    track_peer_free(p);
    return NULL;
}

/* These are few bytes, for which a connection that is alive has room. */
static int send_all(const track_peer *p, const igtl_buffer *b, err *e)
{
    const ssize_t n = send(p->fd, b->at, (size_t)b->size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0)
        return err_system(e, p->place, errno, "cannot send");
    return n < b->size ? err_set(e, p->place, 0, "takes no bytes; expected room for %d", (int)b->size) : 0;
}

static int add_message(igtl_buffer *to, int version, const char *type, const igtl_buffer *content, err *e)
{
    const igtl_about about = {.version = version, .type = type, .device = "Sinew", .stamp = igtl_now()};
    const igtl_buffer none = {0};
    content = content ? content : &none;
    return igtl_write(to, &about, content->at, content->size, e);
}

int track_peer_ask(track_peer *p, const track_ask *what, err *e)
{
    igtl_buffer content = {0}, all = {0};
    const int version = what->protocol_3 ? 2 : 1;
    const uint32_t interval = (uint32_t)(1000 / what->rate);
    int failed = igtl_write_start_tools(&content, interval, "", e);
    if (!failed && what->protocol_3)
        failed = add_message(&all, version, "GET_STATUS", NULL, e);
    if (!failed)
        failed = add_message(&all, version, "STT_TDATA", &content, e) || send_all(p, &all, e);
    igtl_buffer_free(&content);
    igtl_buffer_free(&all);
    return failed ? -1 : 0;
}

track_came track_peer_receive(track_peer *p, err *e)
{
    size_t room;
    unsigned char *to = igtl_reader_room(p->reader, &room);
    const ssize_t n = recv(p->fd, to, room, MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
        return TRACK_NOTHING;
    if (n < 0 && errno != ECONNRESET) /* so ends one that has not read what it was asked for */
        err_system(e, p->place, errno, "the connection is lost");
    if (n <= 0)
        return TRACK_ENDED;
    igtl_reader_took(p->reader, (size_t)n);
    return TRACK_BYTES;
}

bool track_peer_speaks(const track_peer *p)
{
    return p->has_spoken || igtl_reader_skipped(p->reader) > 0;
}

void track_peer_free(track_peer *p)
{
    igtl_buffer b = {0};
    err ignored = {0};
    if (!p)
        return;
    /* One that has gone, or takes nothing, need not be told. */
    if (p->reader && !add_message(&b, 1, "STP_TDATA", NULL, &ignored))
        (void)send_all(p, &b, &ignored);
    igtl_buffer_free(&b);
    igtl_reader_free(p->reader);
    close(p->fd);
    free(p);
}
