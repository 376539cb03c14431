#include "live/record.h"

#include "base/checksum.h"
#include "base/mem.h"
#include "base/num.h"
#include "model/binary.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { VERSION = 1, MOST = 2000 /* bytes that are added at once */ };

static const char format_name[] = "sinew-record";

struct record {
    char *name; /* owned */
    int fd;
    char *text; /* the lines of the next frame; owned */
    int64_t filled, capacity;
    int64_t size;  /* bytes of the file: whole lines */
    int64_t frame; /* the index of the last frame recorded, or -1 */
    err wrong;     /* why nothing is recorded any more */
    bool told;
};

void record_model(const model *m, char text[RECORD_WORD])
{
    uint32_t crc = 0;
    for (int i = 0; i < m->arrays.count; i++) {
        const item it = {.kind = ITEM_ARRAY, .array = m->arrays.v[i]};
        const uint32_t own = binary_crc(&it);
        crc = checksum_add(crc, &own, sizeof own);
    }
    snprintf(text, RECORD_WORD, "0x%08" PRIx32, crc);
}

/* ---- Writing */

SINEW_PRINTF(2, 0)
static void add(record *r, const char *format, va_list args)
{
    if (r->wrong.status || mem_grow(&r->text, &r->capacity, r->filled + MOST, 1, "the record", &r->wrong))
        return;
    const int n = vsnprintf(r->text + r->filled, MOST, format, args);
    if (n < 0 || n >= MOST)
        err_set(&r->wrong, r->name, 0, "a line of more than %d bytes", MOST);
    else
        r->filled += n;
}

SINEW_PRINTF(2, 3) static void put(record *r, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    add(r, format, args);
    va_end(args);
}

/* A text of any length, as it is. */
static void put_text(record *r, const char *text)
{
    const int64_t size = (int64_t)strlen(text);
    if (r->wrong.status || mem_grow(&r->text, &r->capacity, r->filled + size, 1, "the record", &r->wrong))
        return;
    memcpy(r->text + r->filled, text, (size_t)size);
    r->filled += size;
}

/* A text as one word. */
static void put_word(record *r, const char *text)
{
    const int64_t at = r->filled;
    put_text(r, text);
    for (int64_t i = at; i < r->filled; i++)
        if ((unsigned char)r->text[i] <= ' ' || r->text[i] == '#')
            r->text[i] = '_';
}

static int write_all(int fd, const char *bytes, int64_t size)
{
    while (size) {
        const ssize_t n = write(fd, bytes, (size_t)size);
        if (n < 0 && errno != EINTR)
            return -1;
        bytes += n > 0 ? n : 0;
        size -= n > 0 ? n : 0;
    }
    return 0;
}

/* The same of a pipe whose reader may be gone: that is an error of the record, and no signal that ends the run. */
static int write_on(int fd, const char *bytes, int64_t size)
{
    const struct timespec at_once = {0};
    sigset_t pipe, before;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, &before);
    const int failed = write_all(fd, bytes, size), code = errno;
    if (failed && code == EPIPE && !sigismember(&before, SIGPIPE))
        sigtimedwait(&pipe, NULL, &at_once);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = code;
    return failed;
}

/* Writes the lines that have gathered. Those that cannot be written are taken back. */
static void send(record *r)
{
    if (r->wrong.status)
        return;
    if (!write_on(r->fd, r->text, r->filled)) {
        r->size += r->filled;
        r->filled = 0;
        return;
    }
    const int code = errno;
    const bool is_cut = ftruncate(r->fd, r->size) != 0;
    err_system(&r->wrong, r->name, code,
               is_cut ? "cannot write the record, whose last line may be cut" : "cannot write the record");
}

static void tell(record *r, notes *warnings)
{
    if (!r->wrong.status || r->told)
        return;
    r->told = true;
    if (r->frame < 0)
        notes_add(warnings, "%s; the run goes on without a record", r->wrong.text);
    else
        notes_add(warnings, "%s; the run goes on, and its record ends after frame %" PRId64, r->wrong.text, r->frame);
}

/* A FIFO that nobody reads is refused: it would be waited for. */
static int create(record *r, const char *path, bool force, err *e)
{
    if (!strcmp(path, "-"))
        return err_usage(e, "--record -: expected the name of a file");
    const int how = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (force ? O_TRUNC : O_EXCL);
    r->fd = open(path, how | O_NONBLOCK, 0666);
    if (r->fd >= 0 && !fcntl(r->fd, F_SETFL, O_APPEND))
        return 0;
    if (errno == EEXIST)
        return err_set(e, path, 0, "exists; expected the name of a new file, or --force to write over it");
    return err_system(e, path, errno, "cannot write");
}

record *record_create(const char *path, bool force, const char *tool, const record_of *of, int count, err *e)
{
    record *r = mem_array(1, sizeof *r, "the record", e);
    if (!r)
        return NULL;
    r->fd = -1;
    r->frame = -1;
    r->name = mem_text(path, e);
    if (!r->name || create(r, path, force, e)) {
        record_close(r, NULL);
        return NULL;
    }
    put(r, "%s %d %s\n", format_name, VERSION, tool);
    for (int i = 0; i < count; i++) {
        put(r, "of %s ", of[i].key);
        put_word(r, of[i].value);
        put(r, "\n");
    }
    send(r);
    if (!err_join(e, &r->wrong))
        return r;
    record_close(r, NULL);
    return NULL;
}

void record_control(record *r, const keyfile *k)
{
    for (int i = 0; r && i < k->count; i++) {
        put_text(r, i ? " " : "");
        put_text(r, k->word[i]); /* which a reader would cut in the same places */
    }
    if (r)
        put_text(r, "\n");
}

void record_setting(record *r, const char *format, ...)
{
    va_list args;
    if (!r)
        return;
    va_start(args, format);
    add(r, format, args);
    va_end(args);
    put(r, "\n");
}

static void put_pose(record *r, const pose *at)
{
    double row[7];
    char number[NUM_TEXT];
    pose_to_row(at, row);
    for (int i = 0; i < 7; i++) {
        num_text(row[i], false, number);
        put(r, "%s%s", i ? "," : " pose=", number);
    }
}

void record_add(record *r, const record_frame *f, notes *warnings)
{
    char time[NUM_TEXT];
    if (!r)
        return;
    num_text(f->time, false, time);
    put(r, "frame %" PRId64 " %s", f->index, time);
    if (f->has_pose)
        put_pose(r, &f->at);
    if (f->steps >= 0)
        put(r, " steps=%" PRId64, f->steps);
    if (f->of >= 0)
        put(r, " of=%" PRId64, f->of);
    if (f->path[0]) {
        put(r, " path=");
        put_word(r, f->path);
    }
    put(r, "\n");
    send(r);
    tell(r, warnings);
    if (!r->wrong.status)
        r->frame = f->index;
}

void record_close(record *r, notes *warnings)
{
    if (!r)
        return;
    if (warnings) {
        put(r, "end\n");
        send(r);
        tell(r, warnings);
    }
    if (r->fd >= 0)
        close(r->fd);
    free(r->text);
    free(r->name);
    free(r);
}

/* ---- Reading */

struct replay {
    in *source;
    keyfile lines;
    bool ended, whole;
};

/* A line that was cut short is none. 1, 0 at the end, -1. */
static int next_line(replay *r, err *e)
{
    for (;;) {
        char *text;
        bool is_whole;
        const int64_t length = in_line(r->source, &text, &is_whole, e);
        if (length < 0)
            return length == -1 ? 0 : -1;
        if (!is_whole)
            return 0;
        const int got = keyfile_take(&r->lines, text, length, in_lines(r->source), e);
        if (got)
            return got;
    }
}

static int read_header(replay *r, const char *tool, err *e)
{
    const keyfile *k = &r->lines;
    const int got = next_line(r, e);
    if (got < 0)
        return -1;
    if (!got || k->count < 3 || strcmp(k->word[0], format_name) != 0)
        return err_set(e, in_name(r->source), 1, "is no record; expected '%s %d %s' first", format_name, VERSION, tool);
    int64_t version;
    if (num_int(k->word[1], 1, INT32_MAX, &version) || version != VERSION)
        return keyfile_error(k, e, "version '%.100s' of records; expected %d", k->word[1], VERSION);
    return strcmp(k->word[2], tool)
               ? keyfile_error(k, e, "is a record of %.100s; expected a record of %s", k->word[2], tool)
               : 0;
}

/* A value as a record has it. */
static bool is_same(const char *word, const char *value)
{
    for (; *word && *value; word++, value++) {
        const bool blank = (unsigned char)*value <= ' ' || *value == '#';
        if (*word != *value && !(blank && *word == '_'))
            return false;
    }
    return !*word && !*value;
}

static int compare(replay *r, const record_of *of, int count, err *e)
{
    const keyfile *k = &r->lines;
    for (int i = 0; i < count; i++) {
        const int got = next_line(r, e);
        if (got < 0)
            return -1;
        if (!got || k->count != 3 || strcmp(k->word[0], "of") != 0 || strcmp(k->word[1], of[i].key) != 0)
            return keyfile_error(k, e, "expected 'of %s VALUE' here", of[i].key);
        if (!is_same(k->word[2], of[i].value))
            return keyfile_error(k, e, "the record was made with %s %.200s, but this run has %.200s; expected the same",
                                 of[i].key, k->word[2], of[i].value);
    }
    return 0;
}

replay *replay_take(in *source, const char *tool, const record_of *of, int count, err *e)
{
    replay *r = mem_array(1, sizeof *r, "the record", e);
    if (!r) {
        in_close(source);
        return NULL;
    }
    r->source = source;
    keyfile_open(&r->lines, source);
    if (!read_header(r, tool, e) && !compare(r, of, count, e))
        return r;
    replay_close(r);
    return NULL;
}

replay *replay_open(const char *path, const char *tool, const record_of *of, int count, err *e)
{
    in *source = in_open(path, e);
    return source ? replay_take(source, tool, of, count, e) : NULL;
}

void replay_close(replay *r)
{
    if (r)
        in_close(r->source);
    free(r);
}

static int take_pair(const keyfile *k, int at, record_frame *f, err *e)
{
    double row[7];
    const char *text = k->word[at], *value = strchr(text, '=');
    value = value ? value + 1 : "";
    if (!strncmp(text, "pose=", 5) && num_list(value, row, 7) == 7) {
        f->has_pose = true;
        f->at = pose_of_row(row);
        return 0;
    }
    if (!strncmp(text, "steps=", 6) && !num_int(value, 0, INT64_MAX, &f->steps))
        return 0;
    if (!strncmp(text, "of=", 3) && !num_int(value, 0, INT64_MAX, &f->of))
        return 0;
    if (!strncmp(text, "path=", 5) && *value && strlen(value) < RECORD_WORD) {
        strcpy(f->path, value);
        return 0;
    }
    return keyfile_error(k, e, "'%.100s'; expected pose=X,Y,Z,QX,QY,QZ,QW, steps=N, of=N or path=NAME", text);
}

static int take_frame(const keyfile *k, record_frame *f, err *e)
{
    *f = (record_frame){.steps = -1, .of = -1};
    if (k->count < 3 || num_int(k->word[1], 0, INT64_MAX, &f->index) || num_double(k->word[2], &f->time))
        return keyfile_error(k, e, "expected frame INDEX TIME");
    for (int i = 3; i < k->count; i++)
        if (take_pair(k, i, f, e))
            return -1;
    return 0;
}

int replay_next(replay *r, replay_kind *kind, keyfile *k, record_frame *f, err *e)
{
    if (r->ended)
        return 0;
    const int got = next_line(r, e);
    *k = r->lines;
    r->ended = got <= 0;
    if (got <= 0)
        return got;
    if (k->count == 1 && !strcmp(k->word[0], "end")) {
        r->ended = r->whole = true;
        return 0;
    }
    *kind = strcmp(k->word[0], "frame") ? REPLAY_CONTROL : REPLAY_FRAME;
    if (!strcmp(k->word[0], "of") && k->count == 3)
        return keyfile_error(k, e, "the record was made with %.100s %.200s, but this run has none; expected the same",
                             k->word[1], k->word[2]);
    return *kind == REPLAY_FRAME && take_frame(k, f, e) ? -1 : 1;
}

bool replay_is_whole(const replay *r)
{
    return r->whole;
}
