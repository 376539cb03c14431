/* Records of live runs: written and read back to the last bit, whole to the last line when cut anywhere, not written
 * over, compared with what they are of, and a disk that is full.
 */
#include "live/record.h"

#include "tap.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static const record_of of[] = {{"model", "0x1234"}, {"probe", "linear:4cm 1cm"}};
enum { LONG = 5000 };

static const pose where = {{.1, 1. / 3, -2e-17}, {.5, -.5, .5, .5}};

static int words(keyfile *k, char *text)
{
    err e = {0};
    *k = (keyfile){.name = "t"};
    return keyfile_take(k, text, (int64_t)strlen(text), 1, &e);
}

/* A line with a word of 5000 bytes, and one with a # inside, which begins no comment. */
static char *make_long(void)
{
    static char text[LONG + 20];
    memset(text, 'x', LONG);
    strcpy(text + LONG, " a#b a_b");
    return text;
}

static void write_one(const char *path)
{
    err e = {0};
    notes warnings = {0};
    keyfile k;
    char text[] = "set  repulsion   2 # more";
    record *r = record_create(path, false, "toy", of, 2, &e);
    ok(r != NULL, "created: %s", e.text);
    keyfile long_line;
    words(&long_line, make_long());
    words(&k, text);
    record_control(r, &k);
    record_setting(r, "set rate %g", 60.);
    record_control(r, &long_line);
    record_add(r,
               &(record_frame){
                   .index = 3, .time = 1. / 3, .has_pose = true, .at = where, .steps = 20, .of = -1, .path = "fem"},
               &warnings);
    record_add(r, &(record_frame){.index = 4, .time = .5, .steps = -1, .of = 7}, &warnings);
    record_close(r, &warnings);
    ok(!warnings.count, "without a warning");
}

static void read_one(const char *path)
{
    err e = {0};
    keyfile k;
    replay_kind kind;
    record_frame f;
    replay *r = replay_open(path, "toy", of, 2, &e);
    ok(r != NULL, "opened: %s", e.text);
    if (!r)
        return;
    ok(replay_next(r, &kind, &k, &f, &e) == 1 && kind == REPLAY_CONTROL && k.count == 3 && !strcmp(k.word[2], "2"),
       "a control");
    ok(replay_next(r, &kind, &k, &f, &e) == 1 && kind == REPLAY_CONTROL && !strcmp(k.word[1], "rate"), "a setting");
    ok(replay_next(r, &kind, &k, &f, &e) == 1 && k.count == 3 && strlen(k.word[0]) == LONG &&
           !strcmp(k.word[1], "a#b") && !strcmp(k.word[2], "a_b"),
       "words as they came");
    ok(replay_next(r, &kind, &k, &f, &e) == 1 && kind == REPLAY_FRAME, "a frame: %s", e.text);
    ok(f.index == 3 && f.time == 1. / 3 && f.steps == 20 && f.of == -1 && !strcmp(f.path, "fem"), "its numbers");
    ok(f.has_pose && !memcmp(&f.at, &where, sizeof where), "its pose, to the last bit");
    ok(replay_next(r, &kind, &k, &f, &e) == 1 && !f.has_pose && f.steps == -1 && f.of == 7, "one without a pose");
    ok(replay_next(r, &kind, &k, &f, &e) == 0 && replay_is_whole(r), "its end");
    ok(replay_next(r, &kind, &k, &f, &e) == 0 && !e.status, "and no more");
    replay_close(r);
}

static void refused(const char *path)
{
    static const record_of other[] = {{"model", "0x1235"}, {"probe", "linear:4cm 1cm"}};
    err e = {0};
    ok(!record_create(path, false, "toy", of, 2, &e) && strstr(e.text, "--force"), "%s", e.text);
    e = (err){0};
    ok(!replay_open(path, "toy", other, 2, &e) && strstr(e.text, "0x1235") && strstr(e.text, ":2:"), "%s", e.text);
    e = (err){0};
    ok(!replay_open(path, "other", of, 2, &e) && strstr(e.text, "record of toy"), "%s", e.text);
    e = (err){0};
    ok(!replay_open("/dev/null", "toy", of, 2, &e) && strstr(e.text, "no record"), "%s", e.text);
}

/* How many frames a record of so many bytes has, or -1. */
static int frames_of(const char *path, const char *bytes, size_t size)
{
    err e = {0};
    keyfile k;
    replay_kind kind;
    record_frame f;
    int frames = 0, got = -1;
    FILE *to = fopen(path, "w");
    fwrite(bytes, 1, size, to);
    fclose(to);
    replay *r = replay_open(path, "toy", of, 2, &e);
    while (r && (got = replay_next(r, &kind, &k, &f, &e)) > 0)
        frames += kind == REPLAY_FRAME;
    replay_close(r);
    return got < 0 ? -1 : frames;
}

/* Cut at any byte, it has the frames whose lines are whole. */
static void cut_anywhere(const char *path)
{
    char bytes[LONG + 2000];
    FILE *from = fopen(path, "r");
    const size_t size = fread(bytes, 1, sizeof bytes, from);
    fclose(from);
    bytes[size] = '\0';
    size_t header = (size_t)(strstr(bytes, "set") - bytes), wrong = 0;
    for (size_t n = 0; n <= size; n++) {
        int want = 0;
        for (const char *p = bytes; (p = strstr(p, "\nframe ")) && strchr(p + 1, '\n') < bytes + n; p++)
            want++;
        wrong += frames_of(path, bytes, n) != (n < header ? -1 : want);
    }
    ok(size > 100 && !wrong, "cut at each of %zu bytes: %zu wrong", size, wrong);
}

/* A limit on the size of files is a full disk. */
static void full(const char *path)
{
    err e = {0};
    notes warnings = {0};
    struct rlimit was, low;
    char text[4000] = "";
    unlink(path);
    record *r = record_create(path, false, "toy", of, 2, &e);
    getrlimit(RLIMIT_FSIZE, &was);
    low = was;
    low.rlim_cur = 300;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &low);
    for (int i = 0; r && i < 20; i++)
        record_add(r, &(record_frame){.index = i, .time = i, .has_pose = true, .at = where, .steps = 1, .of = -1},
                   &warnings);
    record_close(r, &warnings);
    setrlimit(RLIMIT_FSIZE, &was);
    ok(warnings.count == 1 && strstr(warnings.line[0], "its record ends after frame"), "%s",
       warnings.count ? warnings.line[0] : "no warning");
    FILE *from = fopen(path, "r");
    const size_t size = fread(text, 1, sizeof text - 1, from);
    fclose(from);
    ok(size && text[size - 1] == '\n' && strstr(text, "frame 0 "), "what was written is whole");
    notes_free(&warnings);
}

/* A pipe whose reader goes away: the record ends, and the process goes on. */
static void left(const char *path)
{
    err e = {0};
    notes warnings = {0};
    unlink(path);
    ok(!mkfifo(path, 0600), "a FIFO");
    const int reader = open(path, O_RDONLY | O_NONBLOCK);
    record *r = record_create(path, true, "toy", of, 2, &e);
    ok(r != NULL, "a record into a pipe: %s", e.text);
    close(reader);
    for (int i = 0; r && i < 3; i++)
        record_add(r, &(record_frame){.index = i, .time = i, .steps = 1, .of = -1}, &warnings);
    record_close(r, &warnings);
    ok(warnings.count == 1 && strstr(warnings.line[0], "without a record"), "%s",
       warnings.count ? warnings.line[0] : "no warning");
    notes_free(&warnings);
    e = (err){0};
    ok(!record_create("-", true, "toy", of, 2, &e) && e.status == STATUS_USAGE, "%s", e.text);
}

int main(void)
{
    char folder[] = "/tmp/sinew-record-XXXXXX", path[100];
    if (!mkdtemp(folder))
        return 1;
    snprintf(path, sizeof path, "%s/record", folder);
    write_one(path);
    read_one(path);
    refused(path);
    cut_anywhere(path);
    full(path);
    left(path);
    unlink(path);
    rmdir(folder);
    return done_testing();
}
