/* What --salvage takes of a stream that is cut at each of its bytes, damaged, or ended by `fail`, in either encoding:
 * every frame that is whole before that, as it was written, and nothing else. Of the first frame nothing says how many
 * arrays it has: cut right behind one, it is taken with those before the cut.
 */
#include "model/source.h"

#include "tap.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 4, NODES = 5, PART = 100 }; /* PART: one frame, with its first array alone */

/* A stream, and where its parts end. */
typedef struct made {
    unsigned char bytes[16384];
    size_t size;
    size_t first;        /* the end of the first frame's heading: the body is known to be whole from here on */
    size_t part[2];      /* the end of the first array of the first frame, without its checksum's line and with it */
    size_t end[FRAMES];  /* of each frame */
    size_t bare[FRAMES]; /* text: and where its last line, a checksum, is not needed */
} made;

static double value_of(int k, int i, bool velocity)
{
    return velocity ? 100 * k + i : .001 * k * i;
}

static void put_frame(model_writer *w, const model *m, int k, err *e)
{
    frame f = {.index = 2 * k, .time = .1 * k};
    double u[3 * NODES], v[3 * NODES];
    for (int i = 0; i < 3 * NODES; i++) {
        u[i] = value_of(k, i, false);
        v[i] = value_of(k, i, true);
    }
    frame_lend(&f, m, "node.displacement", "m", "node", 3, u, e);
    frame_lend(&f, m, "node.velocity", "m/s", "node", 3, v, e);
    model_write_frame(w, &f, e);
    frame_free(&f);
}

/* The end of the item of some lines of text that begins at a byte. */
static size_t item_end(const made *s, size_t at, bool text, int lines)
{
    uint64_t length;
    while (text && lines--)
        at += strcspn((const char *)s->bytes + at, "\n") + 1;
    if (text)
        return at;
    memcpy(&length, s->bytes + at + 8, sizeof length);
    return at + 16 + (size_t)length + 4;
}

static void make(made *s, bool text, const char *fail, err *e)
{
    model m = {0};
    out *o = out_memory(e);
    model_writer *w = model_writer_open(o, text, e);
    model_meta_set(&m, "name", "salvage", e);
    model_axis_add(&m, "node", NODES, e);
    model_array *a = model_add(&m, "node.position", e);
    for (int i = 0; a && i < 3 * NODES; i++)
        a->f64[i] = i;
    model_write(w, &m, e);
    const size_t body = (size_t)out_count(o);
    for (int k = 0; k < FRAMES; k++) {
        put_frame(w, &m, k, e);
        s->end[k] = (size_t)out_count(o);
        s->bare[k] = s->end[k] - (text ? strlen("crc 01234567\n") : 0);
    }
    if (fail)
        model_write_fail(w, STATUS_DIVERGED, fail, e);
    else
        model_write_end(w, e);
    const unsigned char *bytes = out_bytes(o, &s->size);
    memcpy(s->bytes, bytes, s->size < sizeof s->bytes ? s->size : sizeof s->bytes - 1);
    s->first = item_end(s, body, text, 1);
    s->part[0] = item_end(s, s->first, text, 1 + NODES);
    s->part[1] = item_end(s, s->first, text, 1 + NODES + 1);
    model_writer_close(w);
    out_discard(o);
    model_free(&m);
}

/* What came out: how many frames, of what was written; -1: refused. */
static int salvage(const char *path, err *e)
{
    source s = {0};
    int count = -1, parts = 0;
    if (!source_open_part(&s, path, true, e)) {
        bool same = true;
        for (count = 0; source_next(&s, e) > 0; count++) {
            const model_array *u = source_find(&s, "node.displacement"), *v = source_find(&s, "node.velocity");
            same = same && u && (v || !count) && s.frame.index == 2 * count && fabs(s.frame.time - .1 * count) < 1e-15;
            for (int i = 0; same && i < 3 * NODES; i++)
                same = u->f64[i] == value_of(count, i, false) && (!v || v->f64[i] == value_of(count, i, true));
            parts += !v;
        }
        source_end(&s, e);
        if (!same)
            count = -2;
        else if (parts && count == 1)
            count = PART;
    }
    source_close(&s);
    return count;
}

static int expected(const made *s, size_t size)
{
    int count = 0;
    if (size < s->first)
        return -1;
    if (size == s->part[0] || size == s->part[1])
        return PART;
    while (count < FRAMES && (size >= s->end[count] || size == s->bare[count]))
        count++;
    return count;
}

static void put_file(const char *path, const unsigned char *bytes, size_t size)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ok(fd >= 0 && write(fd, bytes, size) == (ssize_t)size && !close(fd), "a stream of %zu bytes", size);
}

static void cuts(const char *path, const made *s, const char *name)
{
    int wrong = 0;
    put_file(path, s->bytes, s->size);
    for (size_t size = s->size - 1; size > 0; size--) {
        err e = {0};
        const int fine = truncate(path, (off_t)size), got = salvage(path, &e);
        const char *want = expected(s, size) ? ": salvaged " : "and no frame";
        if (expected(s, size) < 0)
            want = "cut short";
        if (fine || got != expected(s, size) || e.status != STATUS_BAD || !strstr(e.text, want)) {
            printf("# %zu bytes: %d frames, expected %d: %s\n", size, got, expected(s, size), e.text);
            wrong++;
        }
    }
    ok(!wrong, "%s: cut at each of %zu bytes", name, s->size - 1);
}

/* A byte that is changed in the third frame, and after it. */
static void flips(const char *path, made *s)
{
    int wrong = 0, tried = 0;
    for (size_t at = s->end[1]; at < s->size; at++, tried++) {
        err e = {0};
        s->bytes[at] ^= 0x10;
        const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const bool put = write(fd, s->bytes, s->size) == (ssize_t)s->size && !close(fd);
        const int got = salvage(path, &e), want = 2 + (at >= s->end[2]) + (at >= s->end[3]);
        if (!put || got != want || e.status != STATUS_BAD || !strstr(e.text, "reading stopped at byte ")) {
            printf("# byte %zu: %d frames, expected %d: %s\n", at, got, want, e.text);
            wrong++;
        }
        s->bytes[at] ^= 0x10;
    }
    ok(!wrong, "binary: %d bytes changed, one at a time: all frames before", tried);
}

int main(void)
{
    char path[] = "/tmp/sinew-salvage-XXXXXX";
    static made s;
    const int fd = mkstemp(path);
    if (fd < 0)
        return 1;
    close(fd);
    for (int text = 0; text < 2; text++) {
        err e = {0};
        make(&s, text, NULL, &e);
        ok(!e.status && s.size < sizeof s.bytes, "a stream %s", e.text);
        put_file(path, s.bytes, s.size);
        ok(salvage(path, &e) == FRAMES && !e.status, "of a whole one all is taken, and no word is said %s", e.text);
        cuts(path, &s, text ? "text" : "binary");
        if (!text)
            flips(path, &s);
        e = (err){0};
        make(&s, text, "tled-run: diverged", &e);
        put_file(path, s.bytes, s.size);
        ok(salvage(path, &e) == FRAMES && e.status == STATUS_BAD &&
               strstr(e.text, "salvaged 4 frames, up to index 6 at 0.3 s; reading stopped at byte ") &&
               strstr(e.text, ": the run that wrote it failed: tled-run: diverged"),
           "one that failed: %s", e.text);
    }
    unlink(path);
    return done_testing();
}
