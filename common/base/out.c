#define _GNU_SOURCE /* F_SETPIPE_SZ */
#include "base/out.h"

#include "base/mem.h"
#include "base/path.h"
#include "base/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { CHUNK = 1 << 18 };

struct out {
    int fd;           /* -1: memory */
    char *name;       /* for messages */
    replace file;     /* no target: fd is written directly */
    replace *kept;    /* where the file goes at the end, or NULL: into its place */
    bool gzip, large; /* large: a piece of CHUNK was written */
    bool outlast;     /* it is stored before it is closed */
    z_stream z;
    unsigned char *packed;
    unsigned char *buffer;
    int64_t capacity, filled;
    int64_t count;
    err failed;
};

/* With the usual pipe of 64 KB, a tool that writes much and the tool that reads it wait for each other all the time.
 * The pipe becomes as wide as one piece and no wider: all pipes of a user share a limit (pipe-user-pages-soft, 64 MB by
 * default), and beyond it each new pipe has 8 KB. A pipe for small outputs stays as it is, as a slow reader would see
 * everything in a wide one late. */
static void widen_pipe(int fd)
{
    int size = fcntl(fd, F_GETPIPE_SZ);
    if (size > 0 && size < CHUNK)
        (void)!fcntl(fd, F_SETPIPE_SZ, (int)CHUNK);
}

static void put(out *o, const unsigned char *bytes, size_t size)
{
    while (size && !o->failed.status) {
        ssize_t n = write(o->fd, bytes, size);
        if (n >= 0) {
            bytes += n;
            size -= (size_t)n;
        } else if (errno == EPIPE) {
            temporary_end(SIGPIPE); /* someone had it ignored or blocked: end as quietly all the same */
            err_system(&o->failed, o->name, EPIPE, "cannot write");
            o->failed.silent = true;
        } else if (errno != EINTR) {
            err_system(&o->failed, o->name, errno, "cannot write");
        }
    }
}

static void pack(out *o, const unsigned char *bytes, size_t size, int flush)
{
    /* zlib's next_in is not const, but it is only read. */
    memcpy(&o->z.next_in, &bytes, sizeof bytes);
    o->z.avail_in = (uInt)size;
    do {
        o->z.next_out = o->packed;
        o->z.avail_out = CHUNK;
        if (deflate(&o->z, flush) == Z_STREAM_ERROR)
            err_set(&o->failed, o->name, 0, "zlib failed to compress");
        put(o, o->packed, CHUNK - o->z.avail_out);
    } while (!o->z.avail_out && !o->failed.status);
}

static void send(out *o, const unsigned char *bytes, size_t size, int flush)
{
    if (o->gzip)
        pack(o, bytes, size, flush);
    else
        put(o, bytes, size);
}

static void empty(out *o, int flush)
{
    if (o->fd < 0)
        return;
    send(o, o->buffer, (size_t)o->filled, flush);
    o->filled = 0;
}

static void out_free(out *o)
{
    if (o->gzip)
        deflateEnd(&o->z);
    free(o->packed);
    free(o->buffer);
    free(o->name);
    free(o);
}

static int begin_gzip(out *o, err *e)
{
    o->packed = mem_array(CHUNK, 1, "an output stream", e);
    o->gzip = o->packed && deflateInit2(&o->z, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK;
    return o->gzip ? 0 : err_memory(e, "gzip");
}

/* fd stays the caller's where this fails. */
static out *out_new(int fd, const char *name, bool gzip, err *e)
{
    out *o = mem_array(1, sizeof *o, "an output stream", e);
    if (!o)
        return NULL;
    o->fd = fd;
    o->name = mem_text(name, e);
    o->buffer = mem_array(CHUNK, 1, "an output stream", e);
    o->capacity = CHUNK;
    if (!o->name || !o->buffer || (gzip && begin_gzip(o, e))) {
        out_free(o);
        return NULL;
    }
    return o;
}

static out *open_direct(const char *path, bool gzip, err *e)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0) {
        err_system(e, path, errno, "cannot open for writing");
        return NULL;
    }
    out *o = out_new(fd, path, gzip, e);
    if (!o)
        close(fd);
    return o;
}

static out *open_replacing(const char *path, bool gzip, err *e)
{
    replace file;
    if (replace_open(&file, path, e))
        return NULL;
    out *o = out_new(file.fd, path, gzip, e);
    if (o)
        o->file = file;
    else
        replace_discard(&file);
    return o;
}

out *out_open(const char *path, bool gzip, err *e)
{
    struct stat s;
    if (!path || !strcmp(path, "-"))
        return out_new(STDOUT_FILENO, "stdout", gzip, e);
    const int there = path_look(path, &s, e);
    if (there < 0)
        return NULL;
    if (there && S_ISDIR(s.st_mode)) {
        err_set(e, path, 0, "is a folder; expected a file to write");
        return NULL;
    }
    if (there && !S_ISREG(s.st_mode))
        return open_direct(path, gzip, e);
    if (there && access(path, W_OK)) {
        err_system(e, path, errno, "cannot write");
        return NULL;
    }
    return open_replacing(path, gzip, e);
}

out *out_open_kept(const char *path, replace *to, err *e)
{
    out *o = open_replacing(path, false, e);
    if (o)
        o->kept = to;
    return o;
}

void out_outlast(out *o)
{
    o->outlast = true;
}

out *out_take(int fd, const char *name, err *e)
{
    return out_new(fd, name, false, e);
}

out *out_memory(err *e)
{
    return out_new(-1, "memory", false, e);
}

const unsigned char *out_bytes(out *o, size_t *size)
{
    *size = (size_t)o->filled;
    return o->buffer;
}

void out_write(out *o, const void *bytes, size_t size)
{
    if (o->failed.status)
        return;
    o->count += (int64_t)size;
    if (o->fd < 0) {
        if (mem_grow(&o->buffer, &o->capacity, o->filled + (int64_t)size, 1, "an output stream", &o->failed))
            return;
    } else if ((int64_t)size >= o->capacity - o->filled) {
        empty(o, Z_NO_FLUSH);
        if (size >= CHUNK && !o->large)
            widen_pipe(o->fd);
        o->large = o->large || size >= CHUNK;
        while (size >= CHUNK && !o->failed.status) {
            send(o, bytes, CHUNK, Z_NO_FLUSH);
            bytes = (const char *)bytes + CHUNK;
            size -= CHUNK;
        }
        if (o->failed.status)
            return; /* what is left may be more than the buffer holds */
    }
    if (size)
        memcpy(o->buffer + o->filled, bytes, size);
    o->filled += (int64_t)size;
}

void out_text(out *o, const char *text)
{
    out_write(o, text, strlen(text));
}

void out_format(out *o, const char *format, ...)
{
    char small[512];
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(small, sizeof small, format, args);
    if (n >= 0 && (size_t)n < sizeof small) {
        out_write(o, small, (size_t)n);
    } else if (n >= 0) {
        char *large = mem_array((int64_t)n + 1, 1, "text", &o->failed);
        if (large) {
            vsnprintf(large, (size_t)n + 1, format, again);
            out_write(o, large, (size_t)n);
        }
        free(large);
    }
    va_end(again);
    va_end(args);
}

void out_flush(out *o)
{
    empty(o, Z_SYNC_FLUSH);
}

int out_sync(out *o, err *e)
{
    out_flush(o);
    if (!o->failed.status && replace_store(o->fd))
        err_system(&o->failed, o->name, errno, "cannot write");
    return out_failed(o, e);
}

int out_failed(const out *o, err *e)
{
    return err_join(e, &o->failed);
}

int out_patch(out *o, int64_t offset, const void *bytes, size_t size, err *e)
{
    if (!o->file.target || o->gzip)
        return err_set(e, o->name, 0, "cannot go back in this output; expected -o with a file");
    empty(o, Z_NO_FLUSH);
    for (size_t done = 0; done < size && !o->failed.status;) {
        ssize_t n = pwrite(o->fd, (const char *)bytes + done, size - done, (off_t)offset + (off_t)done);
        if (n < 0 && errno != EINTR)
            return err_system(e, o->name, errno, "cannot write");
        done += n > 0 ? (size_t)n : 0;
    }
    return 0;
}

int64_t out_count(const out *o)
{
    return o->count;
}

bool out_is_file(const out *o)
{
    return o->file.target != NULL;
}

bool out_is_terminal(const out *o)
{
    return o->fd >= 0 && isatty(o->fd);
}

/* What others opened, and its name, where the system can tell which that is. */
static int store_open(const out *o, err *e)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", o->fd);
    if (replace_store(o->fd))
        return err_system(e, o->name, errno, "cannot write");
    return access(path, F_OK) ? 0 : replace_store_names(path, o->name, e);
}

int out_close(out *o, err *e)
{
    empty(o, Z_FINISH);
    int bad = err_join(e, &o->failed);
    if (!bad && o->kept) {
        bad = replace_settle(&o->file, o->name, e);
        *o->kept = (replace){0};
        if (!bad) {
            *o->kept = o->file;
            o->file = (replace){0};
        }
        o->fd = -1;
    } else if (!bad && o->file.target) {
        bad = replace_finish(&o->file, o->name, e);
        o->fd = -1;
    } else if (!bad && o->fd >= 0) {
        bad = o->outlast ? store_open(o, e) : 0;
        if (close(o->fd) && errno != EINTR && !bad)
            bad = err_system(e, o->name, errno, "cannot write");
        o->fd = -1;
    }
    out_discard(o);
    return bad;
}

void out_discard(out *o)
{
    if (!o)
        return;
    if (o->file.target)
        replace_discard(&o->file);
    else if (o->fd > STDOUT_FILENO)
        close(o->fd);
    out_free(o);
}

int out_end(out *o, int failed, err *e)
{
    if (o && !failed)
        return out_close(o, e);
    out_discard(o);
    return -1;
}
