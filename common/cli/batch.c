#include "cli/batch.h"

#include "base/chars.h"
#include "base/clock.h"
#include "base/in.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/pool.h"
#include "cli/progress.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS = 64, LINE = 65536, ABOUT = 400 }; /* the most words and bytes of a line */

typedef struct job {
    int64_t line;
    char *text; /* as it stands in the file; owned */
    bool failed;
} job;

/* A file that a job reads or writes. */
typedef struct used {
    char *where; /* links followed; owned */
    int64_t line;
    bool is_written;
} used;

typedef struct batch {
    const tool *t;
    const batch_use *use;
    const char *path;
    job *job;
    int64_t jobs, job_room;
    used *file;
    int64_t files, file_room;
    int threads;
    pthread_mutex_t lock; /* of what follows */
    int64_t done, failed;
    progress progress;
    tool_told told;
} batch;

/* A job's line as options; what they point to is the line's. */
typedef struct ready {
    tool t;
    char *text;    /* owned, as is */
    void *options; /* the tool's */
    char about[ABOUT];
} ready;

/* ---- Lines */

/* Ends a quoted part. Returns what follows it, or NULL. */
static char *take_quoted(char *from, char **to)
{
    const char quote = *from++;
    for (; *from && *from != quote; from++) {
        if (quote == '"' && from[0] == '\\' && from[1])
            from++;
        *(*to)++ = *from;
    }
    return *from ? from + 1 : NULL;
}

/* Takes the word at *from, in place. Returns what follows it, or NULL where a quote has no end. */
static char *take_word(char *from, char **to)
{
    while (from && *from && !chars_blank(*from)) {
        if (*from == '\'' || *from == '"') {
            from = take_quoted(from, to);
            continue;
        }
        if (from[0] == '\\' && from[1])
            from++;
        *(*to)++ = *from++;
    }
    return from;
}

/* Cuts a line into words, in place. Returns how many, or -1. */
static int cut(char *text, char *word[WORDS], err *e)
{
    int count = 0;
    for (char *p = text;;) {
        while (chars_blank(*p))
            p++;
        if (!*p || *p == '#')
            return count;
        if (count == WORDS)
            return err_set(e, NULL, 0, "more than %d words on a line", WORDS);
        char *end = p;
        word[count++] = p;
        p = take_word(p, &end);
        if (!p)
            return err_set(e, NULL, 0, "a quote has no end; expected another on the line");
        const bool ends = !*p;
        *end = '\0';
        if (ends)
            return count;
        p++;
    }
}

static int check_text(const char *text, err *e)
{
    if (strlen(text) > LINE)
        return err_set(e, NULL, 0, "a line of %zu bytes; expected at most %d", strlen(text), LINE);
    for (const char *p = text; *p; p++)
        if (((unsigned char)*p < 0x20 && *p != '\t') || *p == 0x7f)
            return err_set(e, NULL, 0, "control character 0x%02x; expected a line of text", (unsigned)*p);
    return 0;
}

/* ---- Jobs */

/* Checks that a job names its files: standard input has the model, and standard output is no place for a job. */
static int check_files(const tool *t, err *e)
{
    const opt *o;
    const char *output = t->common->output;
    if (!output)
        return err_set(e, NULL, 0, "a job without -o; expected -o FILE, for its result");
    for (int i = 0; (o = opt_at(t->table, i)); i++) {
        const char *path = o->flags & OPT_JOB ? tool_file(t, o) : NULL;
        if (path && !strcmp(path, "-"))
            return err_set(e, NULL, 0, "--%s -; expected the name of a file", o->name);
    }
    return 0;
}

static int take_options(const batch *b, ready *r, err *e)
{
    char *word[WORDS + 2] = {r->text}; /* the first is none of the words */
    const int count = cut(r->text, word + 1, e);
    if (count < 0 || opt_parse_job(b->t->table, count + 1, word, r->options, e) < 0 || b->use->check(r->options, e))
        return -1;
    opt_common *common = r->options;
    common->quiet = common->quiet || !common->verbose;
    common->threads = b->threads;
    r->t.told = NULL;
    const tool of = *b->t;
    if (tool_begin_job(&r->t, &of, r->options, r->about, e) || check_files(&r->t, e))
        return -1;
    return 0;
}

/* Writes where a job's line is, as messages begin. */
static void say_place(const batch *b, const job *j, char about[ABOUT])
{
    snprintf(about, ABOUT, "%.300s:%lld", b->path, (long long)j->line);
}

/* -1 with e filled; release() in both cases. */
static int make_ready(const batch *b, const job *j, ready *r, err *e)
{
    *r = (ready){.text = mem_text(j->text, e), .options = mem_array(1, (int64_t)b->use->size, "a job", e)};
    say_place(b, j, r->about);
    if (!r->text || !r->options)
        return -1;
    memcpy(r->options, b->use->given, b->use->size);
    return check_text(j->text, e) || take_options(b, r, e) ? -1 : 0;
}

static void release(ready *r)
{
    tool_free(&r->t);
    free(r->options);
    free(r->text);
}

static void say_failed(batch *b, job *j, const err *why)
{
    char about[ABOUT];
    tool t = *b->t;
    say_place(b, j, about);
    t.about = about;
    pthread_mutex_lock(&b->lock);
    progress_clear(&b->progress);
    tool_failed(&t, why);
    j->failed = true;
    b->failed++;
    pthread_mutex_unlock(&b->lock);
}

/* ---- Files of several jobs */

/* Where a file is, or would be. */
static char *where(const char *path, err *e)
{
    char real[PATH_MAX];
    err ignored = {0};
    char *target = path_target(path, &ignored);
    const char *of = target ? target : path;
    const size_t n = path_folder(of);
    char *folder = n ? path_join(of, n, "", e) : path_join(".", 1, "", e), *to = NULL;
    if (folder && realpath(folder, real)) {
        const size_t size = strlen(real) + strlen(of + n) + 2;
        to = mem_array((int64_t)size, 1, "a path", e);
        if (to)
            snprintf(to, size, "%s/%s", real, of + n);
    } else if (folder) {
        to = mem_text(of, e);
    }
    free(folder);
    free(target);
    return to;
}

static int note_file(batch *b, const char *path, int64_t line, bool is_written, err *e)
{
    if (MEM_ROOM(&b->file, &b->file_room, b->files + 1, "the jobs' files", e))
        return -1;
    used *f = &b->file[b->files];
    *f = (used){where(path, e), line, is_written};
    b->files += f->where != NULL;
    return f->where ? 0 : -1;
}

static int note_files(batch *b, const job *j, const ready *r, err *e)
{
    const opt *o;
    for (int i = 0; (o = opt_at(b->t->table, i)); i++) {
        const char *path = o->flags & OPT_JOB ? tool_file(&r->t, o) : NULL;
        if (path && note_file(b, path, j->line, o->flags & OPT_WRITES, e))
            return -1;
    }
    return 0;
}

static int by_place(const void *a, const void *b)
{
    const used *x = a, *y = b;
    const int places = strcmp(x->where, y->where);
    return places ? places : (x->line > y->line) - (x->line < y->line);
}

/* Refuses a file that one job writes and another job writes or reads. */
static int check_shared(batch *b, err *e)
{
    if (b->files)
        qsort(b->file, (size_t)b->files, sizeof *b->file, by_place);
    for (int64_t i = 1, first = 0; i < b->files; i++) {
        const used *f = &b->file[i], *before = &b->file[first];
        if (strcmp(f->where, before->where) != 0) {
            first = i;
            continue;
        }
        if (f->line != before->line && (f->is_written || before->is_written))
            return err_set(e, b->path, f->line, "%s '%.400s', which the job of line %lld %s; expected another file",
                           f->is_written ? "writes" : "reads", f->where, (long long)before->line,
                           before->is_written ? "writes" : "reads");
    }
    return 0;
}

/* ---- All of them */

static int add_line(batch *b, const char *text, int64_t line, err *e)
{
    const char *p = text;
    while (chars_blank(*p))
        p++;
    if (!*p || *p == '#')
        return 0;
    if (MEM_ROOM(&b->job, &b->job_room, b->jobs + 1, "the jobs", e))
        return -1;
    b->job[b->jobs] = (job){.line = line, .text = mem_text(text, e)};
    return b->job[b->jobs].text ? (b->jobs++, 0) : -1;
}

static int read_lines(batch *b, err *e)
{
    char *text;
    int64_t length = 0;
    in *source = in_open(b->path, e);
    if (!source)
        return -1;
    while ((length = in_line(source, &text, NULL, e)) >= 0)
        if (add_line(b, text, in_lines(source), e)) {
            length = -2;
            break;
        }
    in_close(source);
    if (length == -2)
        return -1;
    return b->jobs ? 0 : err_set(e, b->path, 0, "no job; expected lines of options, each with -o FILE");
}

/* Looks at a line before any job runs. -1 with e filled where the batch cannot go on. */
static int look(batch *b, job *j, err *e)
{
    err why = {0};
    ready r;
    int failed = 0;
    if (make_ready(b, j, &r, &why))
        say_failed(b, j, &why);
    else
        failed = note_files(b, j, &r, e);
    release(&r);
    return failed;
}

static void say_done(batch *b, const ready *r, const char *said, double took)
{
    tool t = *b->t;
    t.about = r->about;
    pthread_mutex_lock(&b->lock);
    progress_clear(&b->progress);
    tool_say(&t, "%s: %s; %.3g s", r->t.common->output, said, took);
    progress_at(&b->progress, (double)++b->done);
    pthread_mutex_unlock(&b->lock);
}

static void work(batch *b, job *j, ready *r)
{
    const double began = clock_now();
    char said[BATCH_SAID] = "";
    err why = {0};
    r->t.told = &b->told;
    if (b->use->work(b->use->context, &r->t, r->options, said, &why))
        say_failed(b, j, &why);
    else
        say_done(b, r, said, clock_now() - began);
}

static void do_job(batch *b, job *j)
{
    err why = {0};
    ready r;
    if (make_ready(b, j, &r, &why))
        say_failed(b, j, &why);
    else
        work(b, j, &r);
    release(&r);
}

static void do_jobs(void *context, int64_t chunk, int64_t from, int64_t to)
{
    batch *b = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (!b->job[i].failed)
            do_job(b, &b->job[i]);
}

/* A job a thread; where there are fewer jobs, more threads for each. */
static int do_all(batch *b, err *e)
{
    const int threads = tool_threads(b->t, e);
    if (threads < 0)
        return -1;
    const int workers = b->jobs < threads ? (int)b->jobs : threads;
    b->threads = threads / workers;
    pool *p = pool_create(workers, e);
    if (!p)
        return -1;
    progress_start(&b->progress, b->t->table->name, "jobs", (double)b->jobs,
                   b->t->common->quiet || b->t->common->verbose);
    pool_run(p, b->jobs, 1, do_jobs, b);
    progress_stop(&b->progress);
    pool_destroy(p);
    if (b->failed)
        return err_set(e, b->path, 0, "%lld of %lld job%s failed", (long long)b->failed, (long long)b->jobs,
                       b->jobs == 1 ? "" : "s");
    return 0;
}

static void free_all(batch *b)
{
    for (int64_t i = 0; i < b->jobs; i++)
        free(b->job[i].text);
    for (int64_t i = 0; i < b->files; i++)
        free(b->file[i].where);
    free(b->job);
    free(b->file);
    notes_free(&b->told.lines);
    pthread_mutex_destroy(&b->told.lock);
    pthread_mutex_destroy(&b->lock);
}

int batch_go(const tool *t, const char *path, const batch_use *use, err *e)
{
    batch b = {.t = t, .use = use, .path = path, .threads = 1};
    pthread_mutex_init(&b.lock, NULL);
    pthread_mutex_init(&b.told.lock, NULL);
    int failed = read_lines(&b, e);
    for (int64_t i = 0; !failed && i < b.jobs; i++)
        failed = look(&b, &b.job[i], e);
    failed = failed || check_shared(&b, e) || do_all(&b, e);
    free_all(&b);
    return failed ? -1 : 0;
}
