#include "cli/batch.h"

#include "base/chars.h"
#include "base/clock.h"
#include "base/in.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/pool.h"
#include "cli/batch_files.h"
#include "cli/batch_words.h"
#include "cli/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ABOUT = 400 };

typedef struct job {
    int64_t line;
    char *text; /* as it stands in the file; owned */
    bool failed;
} job;

typedef struct batch {
    const tool *t;
    const batch_use *use;
    const char *path;
    job *job;
    int64_t jobs, job_room;
    batch_files files;
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

/* ---- Jobs */

/* Standard input has the model, standard output is no place for a job, and a pipe's bytes come once, for whichever job
 * reads them. */
static int check_file(const opt *o, const char *path, err *e)
{
    struct stat s;
    char name[64];
    opt_dashed(o, name);
    if (!strcmp(path, "-"))
        return err_set(e, NULL, 0, "%s -; expected the name of a file", name);
    if (o->flags & OPT_WRITES && path_is_open(path, STDIN_FILENO))
        return err_set(e, NULL, 0, "%s '%.400s' would overwrite the model on standard input; expected another file",
                       name, path);
    if (!(o->flags & OPT_WRITES) && !stat(path, &s) && (S_ISFIFO(s.st_mode) || S_ISSOCK(s.st_mode)))
        return err_set(e, NULL, 0, "%s '%.400s' is a pipe; expected a file", name, path);
    return 0;
}

static int check_files(const tool *t, err *e)
{
    const opt *o;
    if (!t->common->output)
        return err_set(e, NULL, 0, "a job without -o; expected -o FILE, for its result");
    for (int i = 0; (o = opt_at(t->table, i)); i++) {
        const char *path = o->flags & OPT_JOB ? tool_file(t, o) : NULL;
        if (path && check_file(o, path, e))
            return -1;
    }
    return 0;
}

static int take_options(const batch *b, ready *r, err *e)
{
    char *word[BATCH_WORDS + 2] = {r->text}; /* the first is none of the words */
    const int count = batch_words_cut(r->text, word + 1, e);
    if (count < 0 || opt_parse_job(b->t->table, count + 1, word, r->options, b->use->defaults, e) < 0 ||
        b->use->check(r->options, e))
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
    return batch_words_check(j->text, e) || take_options(b, r, e) ? -1 : 0;
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

static int note_files(batch *b, const job *j, const ready *r, err *e)
{
    const opt *o;
    for (int i = 0; (o = opt_at(b->t->table, i)); i++) {
        const char *path = o->flags & OPT_JOB ? tool_file(&r->t, o) : NULL;
        if (path && batch_files_note(&b->files, path, j->line, o->flags & OPT_WRITES, e))
            return -1;
    }
    return 0;
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

/* At all of them: what is wrong with a line by itself, then with its files beside those of the lines before. */
static int look_at_all(batch *b, err *e)
{
    for (int64_t i = 0; i < b->jobs; i++)
        if (look(b, &b->job[i], e))
            return -1;
    if (batch_files_sort(&b->files, e))
        return -1;
    for (int64_t i = 0; i < b->jobs; i++) {
        err why = {0};
        if (!b->job[i].failed && batch_files_take(&b->files, b->job[i].line, &why))
            say_failed(b, &b->job[i], &why);
    }
    batch_files_free(&b->files);
    return 0;
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
    free(b->job);
    batch_files_free(&b->files);
    notes_free(&b->told.lines);
    pthread_mutex_destroy(&b->told.lock);
    pthread_mutex_destroy(&b->lock);
}

int batch_go(const tool *t, const char *path, const batch_use *use, err *e)
{
    batch b = {.t = t, .use = use, .path = path, .threads = 1};
    pthread_mutex_init(&b.lock, NULL);
    pthread_mutex_init(&b.told.lock, NULL);
    const int failed = read_lines(&b, e) || look_at_all(&b, e) || do_all(&b, e) ? -1 : 0;
    free_all(&b);
    return failed;
}
