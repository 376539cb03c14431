/* A tool's place in a pipe: a small filter, run as a process of its own on pipes, files and terminals. */
#include "base/mem.h"
#include "model/stage.h"

#include "tap.h"

#include <fcntl.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- the filter ---- */

struct options {
    opt_common common;
    bool drop, late;   /* drop the frames; fail after the model was written */
    bool ahead, array; /* write node.rigid ahead, before the axis; add an array after that */
    const char *axis;
};

static const opt options_table[] = {
    {.group = OPT_RESULT,
     .name = "drop",
     .kind = OPT_FLAG,
     .to = offsetof(struct options, drop),
     .help = "drop the frames"},
    {.group = OPT_RESULT, .name = "late", .kind = OPT_FLAG, .to = offsetof(struct options, late), .help = "fail late"},
    {.group = OPT_RESULT,
     .name = "ahead",
     .kind = OPT_FLAG,
     .to = offsetof(struct options, ahead),
     .help = "write ahead"},
    {.group = OPT_RESULT,
     .name = "array",
     .kind = OPT_FLAG,
     .to = offsetof(struct options, array),
     .help = "add an array"},
    {.group = OPT_RESULT,
     .name = "axis",
     .arg = "NAME",
     .kind = OPT_TEXT,
     .to = offsetof(struct options, axis),
     .help = "add an axis"},
    {.group = OPT_END},
};

static const opt_tool filter_table = {.name = "filter",
                                      .usage = "[options] < model",
                                      .purpose = "Copy a model",
                                      .operands = "",
                                      .writes_model = true,
                                      .options = options_table};

static const opt_tool looker_table = {.name = "looker",
                                      .usage = "[options] < model",
                                      .purpose = "Look at a model",
                                      .operands = "",
                                      .options = options_table};

static bool is_user(const model_array *a)
{
    return a->name[0] == 'x';
}

static int work(stage *s, model *m, const struct options *o, notes *warnings, err *e)
{
    if (o->ahead && stage_write_ahead(s, m, is_user, e))
        return -1;
    if (o->array) {
        model_array *a = model_add_as(m, "x-late", MODEL_U8, "1", "node", 1, e);
        if (!a)
            return -1;
        a->u8[0] = 9;
    }
    if (o->axis && model_axis_add(m, o->axis, 1, e))
        return -1;
    if (!s->writer)
        return 0;
    if (stage_write(s, m, e))
        return -1;
    if (o->late)
        return err_set(e, NULL, 0, "too late");
    return o->drop ? stage_drop_frames(s, m, warnings, e) : stage_copy_frames(s, m, e);
}

static int filter(const opt_tool *table, int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    notes warnings = {0};
    if (tool_begin(&t, table, argc, argv, &o, &e) || t.done)
        goto out;
    if ((table->writes_model && stage_open_output(&s, &t, &e)) || stage_read(&s, &m, &e))
        goto out;
    work(&s, &m, &o, &warnings, &e);
out:
    tool_warn(&t, &warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    model_free(&m);
    return tool_end(&t, &e);
}

/* ---- running it ---- */

enum { MOST = 8, ROOM = 4000 };

typedef struct result {
    int status;
    char out[ROOM], say[ROOM]; /* stdout (a pipe or file), stderr */
} result;

static void slurp(int fd, char *to)
{
    size_t n = 0;
    for (ssize_t got = 1; got > 0 && n<ROOM - 1; n += got> 0 ? (size_t)got : 0)
        got = pread(fd, to + n, ROOM - 1 - n, (off_t)n);
    to[n] = 0;
}

/* A file of its own without a name, with text in it. */
static int scratch(const char *text)
{
    FILE *f = tmpfile();
    if (!f)
        return -1;
    fputs(text, f);
    rewind(f);
    int fd = dup(fileno(f));
    fclose(f);
    return fd;
}

/* The slave of a new terminal. */
static int terminal(int *master)
{
    *master = posix_openpt(O_RDWR | O_NOCTTY);
    if (*master < 0 || grantpt(*master) || unlockpt(*master))
        return -1;
    return open(ptsname(*master), O_RDWR | O_NOCTTY);
}

/* Runs the filter with options (words between spaces); in and to are closed. */
static result run_on(const opt_tool *table, const char *options, int from, int to)
{
    result r = {0};
    char name[20], words[200], *argv[MOST + 1] = {name};
    int argc = 1, say = scratch("");
    snprintf(name, sizeof name, "%s", table->name);
    snprintf(words, sizeof words, "%s", options);
    for (char *p = strtok(words, " "); p && argc < MOST; p = strtok(NULL, " "))
        argv[argc++] = p;
    fflush(stdout);
    pid_t child = fork();
    if (!child) {
        dup2(from, 0);
        dup2(to, 1);
        dup2(say, 2);
        exit(filter(table, argc, argv));
    }
    waitpid(child, &r.status, 0);
    r.status = WIFEXITED(r.status) ? WEXITSTATUS(r.status) : -1;
    if (!isatty(to))
        slurp(to, r.out);
    slurp(say, r.say);
    close(from);
    close(to);
    close(say);
    return r;
}

static result run(const char *options, const char *input)
{
    return run_on(&filter_table, options, scratch(input), scratch(""));
}

static bool text_is(const char *got, const char *want)
{
    if (!strcmp(got, want))
        return true;
    printf("# got '%s'\n# wanted '%s'\n", got, want);
    return false;
}

static bool gives(const result *r, int status, const char *written, const char *say)
{
    if (r->status != status)
        printf("# status %d, wanted %d\n", r->status, status);
    bool same_out = text_is(r->out, written), same_say = text_is(r->say, say);
    return same_out && same_say && r->status == status;
}

#define HEAD  "%sinew 1 text\n"
#define BODY  "axis node 1\narray node.rigid u8 1 node 1\n1\n"
#define CRC   "crc 3a88e8d9\n"
#define FRAME "frame 4 0.5\narray x-a u8 1 node 1\n7\n"
#define NEXT  "frame 5 1\narray x-a u8 1 node 1\n7\n"
#define FCRC  "crc 28a4775e\n"

static void test_copies(void)
{
    result r = run("--text", HEAD BODY FRAME "end\n");
    ok(gives(&r, 0, HEAD "prov filter " SINEW_VERSION " \"\"\n" BODY CRC FRAME FCRC "end\n", ""),
       "a model and its frames");
    r = run("--text --axis x-b --threads 1", HEAD BODY "end\n");
    ok(r.status == STATUS_USAGE, "an option that the tool has not");
    r = run("--text --axis x-b", HEAD BODY "end\n");
    ok(gives(&r, 0,
             HEAD "prov filter " SINEW_VERSION " \"--axis x-b\"\naxis node 1\naxis x-b 1\n"
                  "array node.rigid u8 1 node 1\n1\n" CRC "end\n",
             ""),
       "provenance has what changes the result");
    r = run("--text --drop", HEAD BODY FRAME NEXT "end\n");
    ok(gives(&r, 0, HEAD "prov filter " SINEW_VERSION " \"--drop\"\n" BODY CRC "end\n",
             "filter: warning: 2 frames are dropped: the model that they belong to changes\n"),
       "frames that are dropped are counted");
    r = run("", HEAD BODY "end\n");
    ok(r.status == 0 && !memcmp(r.out, "\x89sinew", 6), "binary is the default");
    r = run("-z", HEAD BODY "end\n");
    ok(r.status == 0 && !memcmp(r.out, "\x1f\x8b", 2), "gzipped with -z");
}

static void test_failures(void)
{
    result r = run("--text", HEAD BODY);
    ok(gives(&r, 1,
             HEAD "fail 1 \"filter: stdin:4: the model is cut short; expected `end` (did the tool before this one "
                  "stop early?)\"\n",
             "filter: stdin:4: the model is cut short; expected `end` (did the tool before this one stop early?)\n"),
       "a cut model is said once and sent on as a failure");
    r = run("--text", HEAD BODY "fail 3 \"tled-run: diverged\"\n");
    ok(gives(&r, 3, HEAD "fail 3 \"tled-run: diverged\"\n", ""), "a failure before us is copied, silently");
    r = run("--text", HEAD BODY FRAME "fail 3 \"tled-run: diverged\"\n");
    ok(gives(&r, 3, HEAD "prov filter " SINEW_VERSION " \"\"\n" BODY CRC FRAME FCRC "fail 3 \"tled-run: diverged\"\n",
             ""),
       "one after the frames too");
    r = run("--text --drop", HEAD BODY FRAME "fail 3 \"tled-run: diverged\"\n");
    ok(r.status == 3 && strstr(r.out, CRC "fail 3") && !*r.say, "and where the frames are dropped");
    r = run("--text --late", HEAD BODY "end\n");
    ok(gives(&r, 1, HEAD "prov filter " SINEW_VERSION " \"--late\"\n" BODY CRC "fail 1 \"filter: too late\"\n",
             "filter: too late\n"),
       "a failure after the model was written");
    r = run("--text --bogus", HEAD BODY "end\n");
    ok(r.status == 2 && strstr(r.out, "fail 2 \"filter: ") && !strncmp(r.say, "filter: ", 8), "a usage error: %s",
       r.say);
    r = run("", "");
    ok(r.status == 1 && !strcmp(r.say, "filter: no model on stdin (0 bytes); if bash's builtin bind ran, write 'sinew "
                                       "bind'\n"),
       "nothing on stdin");
}

/* Part of a model on a thread of its own: the bytes are the same. */
static void test_ahead(void)
{
    result r = run("--text --ahead --array", HEAD BODY FRAME "end\n");
    ok(gives(&r, 0,
             HEAD "prov filter " SINEW_VERSION " \"--ahead --array\"\n" BODY CRC
                  "array x-late u8 1 node 1\n9\ncrc e4b37a37\n" FRAME FCRC "end\n",
             ""),
       "an array is added while those before it are written");
    r = run("--text --ahead --late", HEAD BODY "end\n");
    ok(r.status == 1 && strstr(r.out, CRC "fail 1 \"filter: too late\""), "a failure later");
    r = run("--text --ahead --axis x-b", HEAD BODY "end\n");
    ok(gives(&r, 1,
             HEAD "prov filter " SINEW_VERSION " \"--ahead --axis x-b\"\n" BODY CRC
                  "fail 1 \"filter: model: 2 axes; expected the 1 that were written already\"\n",
             "filter: model: 2 axes; expected the 1 that were written already\n"),
       "an axis that comes too late is refused: %s", r.out);
}

/* A reader is not done before the end was seen: what comes late still counts. */
static void test_looker(void)
{
    result r = run_on(&looker_table, "", scratch(HEAD BODY FRAME NEXT "end\n"), scratch(""));
    ok(gives(&r, 0, "", ""), "a tool that writes no model");
    r = run_on(&looker_table, "", scratch(HEAD BODY FRAME "fail 3 \"tled-run: diverged\"\n"), scratch(""));
    ok(gives(&r, 3, "", ""), "takes the status of a failure that comes after what it read");
    r = run_on(&looker_table, "", scratch(HEAD BODY FRAME), scratch(""));
    ok(r.status == 1 && !*r.out && strstr(r.say, "cut short"), "and sees a cut there");
}

static void test_files(void)
{
    char folder[] = P_tmpdir "/sinew-test-XXXXXX", options[100], file[60];
    if (!mkdtemp(folder))
        return;
    snprintf(file, sizeof file, "%s/x", folder);
    snprintf(options, sizeof options, "--text -o %s", file);
    result r = run(options, HEAD BODY "fail 3 \"tled-run: diverged\"\n");
    ok(r.status == 3 && access(file, F_OK) && !*r.out, "a failure leaves no file and writes nothing elsewhere");
    snprintf(options, sizeof options, "--text --late -o %s", file);
    r = run(options, HEAD BODY "end\n");
    ok(r.status == 1 && access(file, F_OK), "a late one neither");
    snprintf(options, sizeof options, "--text -o %s", file);
    r = run(options, HEAD BODY "end\n");
    in *s = in_open(file, &(err){0});
    char *text = NULL;
    ok(r.status == 0 && s && in_all(s, &text, &(err){0}) > 0 &&
           text_is(text, HEAD "prov filter " SINEW_VERSION " \"\"\n" BODY CRC "end\n"),
       "a file");
    free(text);
    in_close(s);
    r = run(options, HEAD);
    ok(r.status == 1 && !access(file, F_OK), "a failure keeps the file that was there");
    r = run("--text -o -", HEAD "fail 3 \"a: b\"\n");
    ok(r.status == 3 && text_is(r.out, HEAD "fail 3 \"a: b\"\n"), "-o - is standard output, failures too");
    unlink(file);
    rmdir(folder);
}

static void test_terminals(void)
{
    int master, tty = terminal(&master);
    if (tty < 0) {
        skip(5, "no pseudo-terminals here");
        return;
    }
    result r = run_on(&filter_table, "--text", dup(tty), scratch(""));
    ok(r.status == 2 &&
           strstr(r.say,
                  "reads a model on stdin, which is a terminal; try filter --help\nusage: filter [options] < model\n"),
       "stdin is a terminal");
    ok(strstr(r.out, "fail 2 \"filter: reads a model"), "the next tool hears of it");
    r = run_on(&filter_table, "", scratch(HEAD BODY "end\n"), dup(tty));
    ok(r.status == 1 && strstr(r.say, "stdout: is a terminal") && strstr(r.say, "expected --text"),
       "binary to a terminal");
    r = run_on(&filter_table, "--bogus", scratch(""), dup(tty));
    ok(r.status == 2 && !strstr(r.say, "terminal"), "a usage error at a terminal is only said");
    r = run_on(&filter_table, "--text", scratch(HEAD "end\n"), dup(tty));
    ok(r.status == 0 && !*r.say, "text to a terminal");
    close(tty);
    close(master);
}

/* ---- written beside ---- */

/* A model with an array of 8 MB of numbers, and one of indices, of which the last is wrong where that is asked for. */
static void make_large(model *m, bool wrong, err *e)
{
    enum { ROWS = 1000000 };
    model_array *numbers = NULL, *indices = NULL;
    if (!model_axis_add(m, "mark", ROWS, e))
        numbers = model_add_as(m, "mark.number", MODEL_F64, "1", "mark", 1, e);
    if (numbers)
        indices = model_add_as(m, "mark.next", MODEL_I32, "@mark", "mark", 1, e);
    for (int32_t i = 0; indices && i < ROWS; i++) {
        model_find(m, "mark.number")->f64[i] = 1. / (i + 1);
        indices->i32[i] = ROWS - 1 - i;
    }
    if (indices && wrong)
        indices->i32[ROWS - 1] = ROWS;
}

/* Writes it, two frames and an end into memory, the caller's to discard; NULL with e filled. */
static out *written(int write(stage *s, model *m, err *e), bool wrong, err *e)
{
    opt_common common = {0};
    const tool t = {.table = &filter_table, .common = &common};
    const frame frames[2] = {{.index = 1, .time = 0}, {.index = 2, .time = 1}};
    frame last = {0};
    model m = {0};
    out *to = out_memory(e);
    stage s = {.t = &t, .sink = to, .kept = frames, .kept_count = 2};
    make_large(&m, wrong, e);
    s.writer = to ? model_writer_open(to, false, e) : NULL;
    bool done = s.writer && !write(&s, &m, e) && stage_last_frame(&s, &m, true, &last, e) == 2;
    done = done && !model_write_end(s.writer, e);
    model_writer_close(s.writer);
    frame_free(&last);
    model_free(&m);
    if (done)
        return to;
    out_discard(to);
    return NULL;
}

static void test_beside(void)
{
    err e = {0}, said[2] = {{0}};
    size_t size[2] = {0};
    out *alone = written(stage_write, false, &e), *beside = written(stage_write_beside, false, &e);
    const unsigned char *one = alone ? out_bytes(alone, &size[0]) : NULL;
    const unsigned char *other = beside ? out_bytes(beside, &size[1]) : NULL;
    ok(one && other && size[0] > 12000000 && size[0] == size[1] && !memcmp(one, other, size[0]),
       "a model of %zu bytes that a thread writes, and frames behind it: the same bytes %s", size[1], e.text);
    out_discard(alone);
    out_discard(beside);
    ok(!written(stage_write, true, &said[0]) && !written(stage_write_beside, true, &said[1]), "an index is wrong");
    ok(strstr(said[0].text, "mark.next, row 999999") && !strcmp(said[0].text, said[1].text) && said[1].status == 1,
       "a thread that writes says so alike: %s", said[1].text);
}

int main(void)
{
    test_beside();
    test_copies();
    test_failures();
    test_ahead();
    test_looker();
    test_files();
    test_terminals();
    return done_testing();
}
