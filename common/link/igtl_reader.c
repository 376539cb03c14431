#include "link/igtl_reader.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 65536 };

struct igtl_reader {
    bool (*wants)(void *context, const igtl_header *h);
    void *context;
    int64_t most;
    const char *place;
    unsigned char piece[PIECE]; /* as it came; of it, [from, size) was not looked at */
    size_t from, size;
    unsigned char head[IGTL_HEADER];
    size_t head_size;
    bool has_header, wanted, lost;
    igtl_header header;
    uint64_t skip; /* bytes of a body that is not wanted, still to come */
    igtl_buffer body;
    int64_t skipped;
};

igtl_reader *igtl_reader_make(bool (*wants)(void *context, const igtl_header *h), void *context, int64_t most,
                              const char *place, err *e)
{
    igtl_reader *r = mem_array(1, sizeof *r, "messages", e);
    if (!r)
        return NULL;
    r->wants = wants;
    r->context = context;
    r->most = most;
    r->place = place;
    return r;
}

void igtl_reader_free(igtl_reader *r)
{
    if (r)
        igtl_buffer_free(&r->body);
    free(r);
}

/* The next message begins. */
static void begin_message(igtl_reader *r)
{
    r->head_size = 0;
    r->has_header = false;
    r->body.size = 0;
    r->skip = 0;
}

void igtl_reader_begin(igtl_reader *r)
{
    r->from = r->size = 0;
    r->lost = false;
    begin_message(r);
}

unsigned char *igtl_reader_room(igtl_reader *r, size_t *room)
{
    if (r->from == r->size)
        r->from = r->size = 0;
    *room = PIECE - r->size;
    return r->piece + r->size;
}

void igtl_reader_took(igtl_reader *r, size_t size)
{
    r->size += size;
}

/* Up to `most` of the bytes that have come. */
static size_t take(igtl_reader *r, unsigned char *to, uint64_t most)
{
    const uint64_t left = r->size - r->from;
    const size_t n = (size_t)(left < most ? left : most);
    if (to)
        memcpy(to, r->piece + r->from, n);
    r->from += n;
    return n;
}

/* A header is there: what becomes of its body. */
static igtl_got begin_body(igtl_reader *r, err *e)
{
    igtl_header *h = &r->header;
    r->lost = true;
    if (igtl_read_header(h, r->head, r->place, e))
        return IGTL_LOST;
    if (h->size > IGTL_READER_SKIP) {
        err_set(e, r->place, 0, "%s '%s': a body of %llu bytes; expected %d at most", h->type, h->device,
                (unsigned long long)h->size, IGTL_READER_SKIP);
        return IGTL_LOST;
    }
    r->lost = false;
    r->has_header = true;
    r->wanted = r->wants(r->context, h);
    r->skipped += !r->wanted;
    if (r->wanted && h->size > (uint64_t)r->most) {
        r->wanted = false;
        r->skip = h->size;
        err_set(e, r->place, 0, "%s '%s': a body of %llu bytes; expected %lld at most", h->type, h->device,
                (unsigned long long)h->size, (long long)r->most);
        return IGTL_WRONG;
    }
    r->skip = r->wanted ? 0 : h->size;
    return IGTL_MORE;
}

static igtl_got take_header(igtl_reader *r, err *e)
{
    r->head_size += take(r, r->head + r->head_size, IGTL_HEADER - r->head_size);
    return r->head_size == IGTL_HEADER ? begin_body(r, e) : IGTL_MORE;
}

/* Stores what has come of the body. */
static igtl_got take_body(igtl_reader *r, igtl_message *m, err *e)
{
    const uint64_t left = r->header.size - (uint64_t)r->body.size, there = r->size - r->from;
    const int64_t n = (int64_t)(left < there ? left : there);
    unsigned char *to = igtl_add(&r->body, n, e);
    if (!to) {
        r->lost = true;
        return IGTL_LOST;
    }
    take(r, to, (uint64_t)n);
    if ((uint64_t)n < left)
        return IGTL_MORE;
    const int64_t size = r->body.size;
    begin_message(r);
    r->body.size = 0;
    return igtl_read_body(m, &r->header, size ? r->body.at : r->head, r->place, e) ? IGTL_WRONG : IGTL_MESSAGE;
}

igtl_got igtl_reader_next(igtl_reader *r, igtl_message *m, err *e)
{
    while (!r->lost) {
        igtl_got got = IGTL_MORE;
        if (!r->has_header && r->from == r->size)
            return IGTL_MORE;
        if (!r->has_header)
            got = take_header(r, e);
        else if (r->wanted)
            got = take_body(r, m, e);
        else
            r->skip -= take(r, NULL, r->skip);
        if (got != IGTL_MORE)
            return got;
        if (r->has_header && !r->wanted && !r->skip)
            begin_message(r);
        else if (r->from == r->size && (!r->has_header || !r->wanted || (uint64_t)r->body.size < r->header.size))
            return IGTL_MORE;
    }
    return IGTL_LOST;
}

bool igtl_reader_inside(const igtl_reader *r)
{
    return r->has_header || r->head_size > 0;
}

int64_t igtl_reader_skipped(const igtl_reader *r)
{
    return r->skipped;
}
