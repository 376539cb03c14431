#include "base/in.h"

#include "base/inputs.h"
#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { CHUNK = 1 << 18, MUCH = 1 << 15, MARK = 3 }; /* bytes */

struct in {
    char *name;
    int fd;      /* -1: memory */
    int watched; /* see in_watch; -1: none */
    const unsigned char *memory;
    size_t memory_left;
    bool gzip, member_ended, ended;
    bool begun; /* it is past the place where a byte order mark may be */
    z_stream z;
    unsigned char *raw; /* compressed bytes, where gzip */
    unsigned char *buffer;
    size_t at, filled; /* the plain bytes not yet taken: buffer[at..filled) */
    char *line;
    int64_t line_capacity, lines;
    int64_t taken; /* bytes */
};

static int wait_for_bytes(const in *s, err *e)
{
    struct pollfd list[2] = {{.fd = s->fd, .events = POLLIN}, {.fd = s->watched, .events = POLLIN}};
    while (poll(list, 2, -1) < 0)
        if (errno != EINTR && errno != EAGAIN)
            return err_system(e, s->name, errno, "cannot wait");
    return list[1].revents ? err_set(e, s->name, 0, "reading was told to end") : 0;
}

/* Bytes as they come from the file or memory. Returns how many, 0 at the end, -1 on failure. */
static int64_t fetch(in *s, unsigned char *to, size_t size, err *e)
{
    if (s->fd < 0) {
        size_t n = size < s->memory_left ? size : s->memory_left;
        if (n)
            memcpy(to, s->memory, n);
        s->memory += n;
        s->memory_left -= n;
        return (int64_t)n;
    }
    for (;;) {
        if (s->watched >= 0 && wait_for_bytes(s, e))
            return -1;
        ssize_t n = read(s->fd, to, size);
        if (n >= 0)
            return n;
        if (errno != EINTR)
            return err_system(e, s->name, errno, "cannot read");
    }
}

static int gzip_start(in *s, err *e)
{
    s->raw = mem_array(CHUNK, 1, "reading gzip", e);
    if (!s->raw)
        return -1;
    memcpy(s->raw, s->buffer, s->filled);
    s->z.next_in = s->raw;
    s->z.avail_in = (uInt)s->filled;
    s->filled = 0;
    if (inflateInit2(&s->z, 15 + 16) != Z_OK)
        return err_memory(e, "reading gzip");
    s->gzip = true;
    return 0;
}

/* Zeros after a member are padding (of tapes and blocks), as gzip(1) has it. */
static void skip_padding(in *s)
{
    for (; s->z.avail_in && !*s->z.next_in; s->z.next_in++)
        s->z.avail_in--;
}

/* Inflates into the empty buffer until at least a byte came, of the first so many that a byte order mark shows, or the
 * data ended. */
static int gzip_fill(in *s, err *e)
{
    const uInt least = s->begun ? 1 : MARK;
    s->z.next_out = s->buffer;
    s->z.avail_out = CHUNK;
    while (CHUNK - s->z.avail_out < least) {
        if (!s->z.avail_in) {
            int64_t n = fetch(s, s->raw, CHUNK, e);
            if (n < 0)
                return -1;
            if (!n && !s->member_ended)
                return err_set(e, s->name, 0, "gzip data is cut short; expected its end");
            if (!n)
                break;
            s->z.next_in = s->raw;
            s->z.avail_in = (uInt)n;
        }
        if (s->member_ended) {
            skip_padding(s);
            if (!s->z.avail_in)
                continue;
            if (inflateReset(&s->z) != Z_OK)
                return err_memory(e, "reading gzip");
        }
        int code = inflate(&s->z, Z_NO_FLUSH);
        s->member_ended = code == Z_STREAM_END;
        if (code != Z_OK && code != Z_STREAM_END && s->z.avail_out < CHUNK)
            break; /* what came out is good; the next call says that no more does */
        if (code != Z_OK && code != Z_STREAM_END)
            return err_set(e, s->name, 0, "gzip data is damaged (%s)", s->z.msg ? s->z.msg : "no reason given");
    }
    s->filled = CHUNK - s->z.avail_out;
    return 0;
}

/* Refills the empty buffer; `ended` is set where nothing more comes. */
static int fill(in *s, err *e)
{
    s->at = s->filled = 0;
    if (s->gzip) {
        if (gzip_fill(s, e))
            return -1;
    } else {
        int64_t n = fetch(s, s->buffer, CHUNK, e);
        if (n < 0)
            return -1;
        s->filled = (size_t)n;
    }
    s->ended = !s->filled;
    return 0;
}

/* The first bytes say whether it is gzip, or begins with a byte order mark; a pipe may give them one at a time. */
static int sniff(in *s, err *e)
{
    while (s->filled < MARK) {
        int64_t n = fetch(s, s->buffer + s->filled, CHUNK - s->filled, e);
        if (n < 0)
            return -1;
        if (!n)
            break;
        s->filled += (size_t)n;
    }
    if (s->filled >= 2 && s->buffer[0] == 0x1f && s->buffer[1] == 0x8b)
        return gzip_start(s, e);
    return 0;
}

static void in_free(in *s)
{
    if (s->gzip)
        inflateEnd(&s->z);
    free(s->raw);
    free(s->buffer);
    free(s->line);
    free(s->name);
    free(s);
}

/* fd stays the caller's where this fails. */
static in *in_new(int fd, const char *name, const void *memory, size_t size, bool plain, err *e)
{
    in *s = mem_array(1, sizeof *s, "a stream", e);
    if (!s)
        return NULL;
    s->fd = fd;
    s->watched = -1;
    s->memory = memory;
    s->memory_left = size;
    s->name = mem_text(name, e);
    s->buffer = mem_array(CHUNK, 1, "a stream", e);
    if (!s->name || !s->buffer || (!plain && sniff(s, e))) {
        in_free(s);
        return NULL;
    }
    return s;
}

static in *open_file(const char *path, bool plain, err *e)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        err_system(e, path, errno, "cannot open");
        return NULL;
    }
    in *s = in_new(fd, path, NULL, 0, plain, e);
    if (!s)
        close(fd);
    return s;
}

in *in_open(const char *path, err *e)
{
    if (!path || !strcmp(path, "-"))
        return in_new(STDIN_FILENO, "stdin", NULL, 0, false, e);
    in *file = open_file(path, false, e);
    if (!file || !inputs_note(file->fd, e))
        return file;
    in_close(file);
    return NULL;
}

in *in_open_plain(const char *path, err *e)
{
    return open_file(path, true, e);
}

in *in_take(int fd, const char *name, err *e)
{
    return in_new(fd, name, NULL, 0, false, e);
}

in *in_memory(const void *bytes, size_t size, const char *name, err *e)
{
    return in_new(-1, name, bytes, size, false, e);
}

void in_close(in *s)
{
    if (!s)
        return;
    if (s->fd > STDIN_FILENO)
        close(s->fd);
    in_free(s);
}

void in_watch(in *s, int descriptor)
{
    s->watched = descriptor;
}

const char *in_name(const in *s)
{
    return s->name;
}

bool in_is_gzip(const in *s)
{
    return s->gzip;
}

int64_t in_lines(const in *s)
{
    return s->lines;
}

int64_t in_taken(const in *s)
{
    return s->taken;
}

/* Reads straight into the caller's memory: a large read needs no buffer, which is empty here; nor does what is left of
 * a very large one, behind which there may be another: else each would go through the buffer. Returns how many bytes
 * came; sets `ended` where none did. */
static int64_t fetch_past(in *s, void *bytes, size_t size, err *e)
{
    int64_t n = fetch(s, bytes, size < CHUNK ? size : CHUNK, e);
    s->ended = !n;
    return n;
}

size_t in_rest(in *s, void *bytes, size_t size)
{
    const size_t left = s->filled - s->at, n = left < size ? left : size;
    if (n)
        memcpy(bytes, s->buffer + s->at, n);
    s->at += n;
    s->taken += (int64_t)n;
    return n;
}

int64_t in_read(in *s, void *bytes, size_t size, err *e)
{
    size_t got = 0;
    s->begun = true;
    while (got < size) {
        if (s->at == s->filled && s->ended)
            break;
        if (s->at == s->filled && !s->gzip && (size - got >= MUCH || size >= CHUNK)) {
            int64_t n = fetch_past(s, (char *)bytes + got, size - got, e);
            if (n < 0)
                return -1;
            got += (size_t)n;
            s->taken += n;
            continue;
        }
        if (s->at == s->filled) {
            if (fill(s, e))
                return -1;
            continue;
        }
        size_t n = s->filled - s->at < size - got ? s->filled - s->at : size - got;
        memcpy((char *)bytes + got, s->buffer + s->at, n);
        s->at += n;
        s->taken += (int64_t)n;
        got += n;
    }
    return (int64_t)got;
}

/* Editors on some systems begin a text with this mark, and nobody sees it. */
static void skip_mark(in *s)
{
    if (s->filled - s->at >= MARK && !memcmp(s->buffer + s->at, "\xef\xbb\xbf", MARK))
        s->at += MARK;
    s->begun = true;
}

int in_peek(in *s, err *e)
{
    for (;;) {
        if (s->at == s->filled && !s->ended && fill(s, e))
            return -2;
        if (s->begun)
            return s->at < s->filled ? s->buffer[s->at] : -1;
        skip_mark(s);
    }
}

int64_t in_line(in *s, char **line, bool *ended, err *e)
{
    int64_t n = 0;
    bool whole = false;
    while (!whole) {
        int next = in_peek(s, e);
        if (next == -2)
            return -2;
        if (next == -1)
            break;
        const unsigned char *from = s->buffer + s->at;
        const unsigned char *lf = memchr(from, '\n', s->filled - s->at);
        int64_t part = lf ? lf - from : (int64_t)(s->filled - s->at);
        if (n + part > IN_LINE_MOST) {
            err_set(e, s->name, s->lines + 1, "a line of more than %d MiB; expected text in lines", IN_LINE_MOST >> 20);
            return -2;
        }
        if (mem_grow(&s->line, &s->line_capacity, n + part + 1, 1, "a line", e))
            return -2;
        memcpy(s->line + n, from, (size_t)part);
        n += part;
        whole = lf != NULL;
        s->at += (size_t)part + whole;
        s->taken += part + whole;
    }
    if (!whole && !n)
        return -1;
    s->lines++;
    if (memchr(s->line ? s->line : "", 0, (size_t)n)) {
        err_set(e, s->name, s->lines, "a NUL byte in text; expected a text file");
        return -2;
    }
    if (!s->line && mem_grow(&s->line, &s->line_capacity, 1, 1, "a line", e))
        return -2;
    n -= n && s->line[n - 1] == '\r';
    s->line[n] = 0;
    *line = s->line;
    if (ended)
        *ended = whole;
    return n;
}

int64_t in_all(in *s, char **bytes, err *e)
{
    int64_t capacity = 0, n = 0;
    *bytes = NULL;
    for (;;) {
        int64_t got = -1;
        if (!mem_grow(bytes, &capacity, n + CHUNK + 1, 1, s->name, e))
            got = in_read(s, *bytes + n, (size_t)(capacity - n - 1), e);
        if (got < 0) {
            free(*bytes);
            *bytes = NULL;
            return -1;
        }
        n += got;
        if (!got)
            break;
    }
    (*bytes)[n] = 0;
    return n;
}
