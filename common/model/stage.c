#include "model/stage.h"

#include "base/mem.h"
#include "base/thread.h"
#include "model/model_share.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int stage_open_output(stage *s, const tool *t, err *e)
{
    const opt_common *c = t->common;
    s->t = t;
    s->sink = out_open(c->output, c->gzip, e);
    if (!s->sink)
        return -1;
    if (out_is_terminal(s->sink) && (!c->text || c->gzip)) {
        out_discard(s->sink);
        s->sink = NULL;
        e->help = e->status ? e->help : ERR_SHOW_USAGE;
        return err_set(e, "stdout", 0,
                       "is a terminal, and a binary model is not for reading; expected --text, -o FILE or a pipe");
    }
    s->writer = model_writer_open(s->sink, c->text, e);
    return s->writer ? 0 : -1;
}

int stage_read(stage *s, model *m, err *e)
{
    if (tool_need_stdin("a model", e))
        return -1;
    s->source = in_open(NULL, e);
    s->reader = s->source ? model_reader_open(s->source, e) : NULL;
    if (s->reader && s->lines_follow)
        model_reader_let_follow(s->reader);
    return s->reader ? model_read(s->reader, m, e) : -1;
}

const char *stage_name(const stage *s)
{
    return s->source ? in_name(s->source) : "stdin";
}

static int add_provenance(stage *s, model *m, err *e)
{
    if (s->has_provenance)
        return 0;
    s->has_provenance = true;
    return model_prov_add(m, s->t->table->name, SINEW_VERSION, s->t->provenance ? s->t->provenance : "", e);
}

/* What is written on a thread. The model is shared: it is as it was when this began. */
struct stage_ahead {
    pthread_t thread;
    model_writer *w;
    model m;
    bool whole;
    int arrays; /* where it is not the whole: its first */
    err *failed;
};

static void *write_some(void *context)
{
    stage_ahead *a = context;
    if (a->whole)
        model_write(a->w, &a->m, a->failed);
    else
        model_write_ahead(a->w, &a->m, a->arrays, a->failed);
    return NULL;
}

static void free_ahead(stage *s)
{
    model_free(&s->ahead->m);
    free(s->ahead);
    s->ahead = NULL;
}

int stage_written(stage *s, err *e)
{
    if (s->ahead) {
        pthread_join(s->ahead->thread, NULL);
        free_ahead(s);
    }
    return err_join(e, &s->ahead_failed);
}

bool stage_is_large(const model *m)
{
    enum { LARGE = 1 << 22 }; /* bytes: fewer are written in a few milliseconds */
    int64_t bytes = 0;
    for (int i = 0; i < m->arrays.count; i++)
        bytes += m->arrays.v[i].rows * m->arrays.v[i].columns * (int64_t)model_type_size(m->arrays.v[i].type);
    return bytes >= LARGE;
}

/* Begins to write the whole, or the first arrays. */
static int begin_ahead(stage *s, const model *m, bool whole, int arrays, err *e)
{
    stage_ahead *a = s->ahead = mem_array(1, sizeof *a, "writing a model", e);
    if (!a)
        return -1;
    a->w = s->writer;
    a->whole = whole;
    a->arrays = arrays;
    a->failed = &s->ahead_failed;
    if (!model_share(&a->m, m, e)) {
        const int code = thread_start_quiet(&a->thread, write_some, a);
        if (!code)
            return 0;
        err_system(e, NULL, code, "cannot start a thread");
    }
    free_ahead(s);
    return -1;
}

int stage_write_ahead(stage *s, model *m, bool changes(const model_array *a), err *e)
{
    int arrays = 0;
    if (add_provenance(s, m, e))
        return -1;
    while (arrays < m->arrays.count && !changes(&m->arrays.v[arrays]))
        arrays++;
    return begin_ahead(s, m, false, arrays, e);
}

int stage_write_beside(stage *s, model *m, err *e)
{
    if (!stage_is_large(m))
        return stage_write(s, m, e);
    return add_provenance(s, m, e) ? -1 : begin_ahead(s, m, true, 0, e);
}

int stage_write(stage *s, model *m, err *e)
{
    return stage_written(s, e) || add_provenance(s, m, e) ? -1 : model_write(s->writer, m, e);
}

/* Those that came before, and were kept for several stages. */
static int64_t pass_kept(stage *s, model_writer *w, frame *last, err *e)
{
    for (int64_t i = 0; w && i < s->kept_count; i++)
        if (stage_written(s, e) || model_write_frame(w, &s->kept[i], e))
            return -1;
    if (last && s->kept_count && frame_share(last, &s->kept[s->kept_count - 1], e))
        return -1;
    return s->kept_count;
}

/* Reads the frames that are left, and writes them where w is not NULL; last, where it is not NULL, gets the last one.
 * Returns how many, or -1. */
static int64_t pass_frames(stage *s, const model *m, model_writer *w, frame *last, err *e)
{
    frame f = {0};
    int64_t count = 0;
    int got = s->reader ? 1 : 0;
    if (s->kept)
        return pass_kept(s, w, last, e);
    while (got > 0) {
        got = model_read_frame(s->reader, m, &f, e);
        if (got > 0 && w && (stage_written(s, e) || model_write_frame(w, &f, e)))
            got = -1;
        count += got > 0;
        if (got > 0 && last) {
            const frame before = *last;
            *last = f;
            f = before;
        }
    }
    frame_free(&f);
    return got < 0 ? -1 : count;
}

int stage_copy_frames(stage *s, const model *m, err *e)
{
    return pass_frames(s, m, s->writer, NULL, e) < 0 ? -1 : 0;
}

int64_t stage_last_frame(stage *s, const model *m, bool copied, frame *last, err *e)
{
    return pass_frames(s, m, copied ? s->writer : NULL, last, e);
}

int stage_drop_frames(stage *s, const model *m, notes *warnings, err *e)
{
    (void)m; /* it may have changed: what is dropped need only fit the model that came in */
    int64_t count = pass_frames(s, NULL, NULL, NULL, e);
    if (count > 0)
        notes_add(warnings, "%" PRId64 " frame%s dropped: the model that they belong to changes", count,
                  count == 1 ? " is" : "s are");
    return count < 0 ? -1 : 0;
}

static bool to_stdout(const opt_common *c)
{
    return !c->output || !strcmp(c->output, "-");
}

/* `fail` goes where someone reads on: a file is not left behind. */
static void close_failed(stage *s, const tool *t, const err *e)
{
    err ignored = {0};
    char text[sizeof e->text + 64];
    if (!s->sink && t->table->writes_model && to_stdout(t->common) && !isatty(STDOUT_FILENO))
        stage_open_output(s, t, &ignored);
    if (!s->writer || out_is_file(s->sink)) {
        out_discard(s->sink);
        s->sink = NULL;
        return;
    }
    if (e->silent)
        snprintf(text, sizeof text, "%s", e->text);
    else
        snprintf(text, sizeof text, "%s: %s", t->table->name, e->text);
    model_write_fail(s->writer, e->status, text, &ignored);
    out_close(s->sink, &ignored);
    s->sink = NULL;
}

void stage_close(stage *s, const tool *t, err *e)
{
    stage_written(s, e);
    /* A model counts only once its end was seen: what is left in the pipe is read, and may yet say `fail`. */
    if (!e->status && s->reader)
        pass_frames(s, NULL, NULL, NULL, e);
    if (!e->status && s->writer)
        model_write_end(s->writer, e);
    if (!e->status && s->sink) {
        out_close(s->sink, e);
        s->sink = NULL;
    } else if (e->status) {
        close_failed(s, t, e);
    }
    model_writer_close(s->writer);
    stage_close_input(s);
}

void stage_close_input(stage *s)
{
    model_reader_close(s->reader);
    in_close(s->source);
    *s = (stage){0};
}

/* ---- One model for several */

int stage_shared_read(stage_shared *s, err *e)
{
    int64_t room = 0;
    int got;
    do {
        frame f = {0};
        got = model_read_frame(s->stage.reader, &s->m, &f, e);
        if (got > 0 && MEM_ROOM(&s->frame, &room, s->frames + 1, "the frames", e))
            got = -1;
        if (got > 0)
            s->frame[s->frames++] = f;
        else
            frame_free(&f);
    } while (got > 0);
    return got;
}

int stage_shared_lend(const stage_shared *s, stage *to, model *m, err *e)
{
    to->kept = s->frames ? s->frame : NULL;
    to->kept_count = s->frames;
    return model_share(m, &s->m, e);
}

void stage_shared_free(stage_shared *s)
{
    for (int64_t i = 0; i < s->frames; i++)
        frame_free(&s->frame[i]);
    free(s->frame);
    stage_close_input(&s->stage);
    model_free(&s->m);
    *s = (stage_shared){.frames = 0};
}
