#include "model/source.h"

#include "base/num.h"
#include "cli/tool.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A `fail` in standard input was said by the tool that wrote it just now; one in a file was not. */
static int tell(const source *s, err *e)
{
    if (!e->silent || s->from_stdin)
        return -1;
    err said = *e;
    *e = (err){0};
    err_set(e, in_name(s->stream), 0, "the run that wrote it failed: %.900s", said.text);
    e->status = said.status;
    return -1;
}

/* Adds to the text of an e. */
SINEW_PRINTF(2, 3) static void add(err *e, const char *format, ...)
{
    const size_t n = strlen(e->text);
    va_list args;
    va_start(args, format);
    vsnprintf(e->text + n, sizeof e->text - n, format, args);
    va_end(args);
}

static int open_and_read(source *s, const char *path, err *e)
{
    s->from_stdin = !path || !strcmp(path, "-");
    if (s->from_stdin && tool_need_stdin("a model", e))
        return -1;
    s->stream = in_open(path, e);
    if (!s->stream)
        return -1;
    int first = in_peek(s->stream, e);
    if (first == -2)
        return -1;
    s->text = first == '%';
    s->reader = model_reader_open(s->stream, e);
    if (s->reader && s->offers)
        model_reader_give_cut(s->reader);
    if (s->reader && s->names)
        model_reader_names(s->reader);
    if (s->reader && !model_read(s->reader, &s->body, e))
        return 0;
    tell(s, e);
    if (s->salvages && s->reader && !e->silent)
        add(e, "; nothing can be salvaged before the first frame");
    return -1;
}

int source_open(source *s, const char *path, err *e)
{
    *s = (source){0};
    return open_and_read(s, path, e);
}

int source_open_part(source *s, const char *path, bool salvage, err *e)
{
    *s = (source){.offers = true, .salvages = salvage};
    return open_and_read(s, path, e);
}

int source_open_names(source *s, const char *path, err *e)
{
    *s = (source){.names = true};
    return open_and_read(s, path, e);
}

/* The stream has no more frames that are whole: its end, where that is asked for. */
static int stop(source *s, err *e)
{
    tell(s, e);
    if (s->salvages) {
        s->lost = *e;
        *e = (err){0};
        return 0;
    }
    if (s->offers && s->frames && !e->silent)
        add(e, "; --salvage takes the %" PRId64 " frame%s before that", s->frames, s->frames == 1 ? "" : "s");
    return -1;
}

void source_end(const source *s, err *e)
{
    const char *name = source_name(s), *why = s->lost.text;
    const size_t n = strlen(name);
    const bool first = !e->status;
    if (!s->lost.status)
        return;
    if (first && s->frames)
        err_set(e, name, 0, "salvaged %" PRId64 " frame%s, up to index %" PRId64 " at %.9g s", s->frames,
                s->frames == 1 ? "" : "s", s->frame.index, s->frame.time);
    else if (first)
        err_set(e, name, 0, "salvaged the model, and no frame");
    why += !strncmp(why, name, n) && !strncmp(why + n, ": ", 2) ? n + 2 : 0;
    add(e, "; reading stopped at byte %" PRId64 "%s: %s", in_taken(s->stream),
        in_is_gzip(s->stream) ? " of what gunzip gives" : "", why);
}

int source_next(source *s, err *e)
{
    if (s->lost.status)
        return 0;
    int got = model_read_frame(s->reader, &s->body, &s->spare, e);
    if (got < 0)
        return stop(s, e);
    if (!got)
        return 0;
    frame last = s->frame;
    s->frame = s->spare;
    s->spare = last;
    if (!s->frames++)
        s->first = s->frame.index;
    return 1;
}

int source_no_frame(const source *s, const char *asked, err *e)
{
    const char *option = asked ? "--frame " : "";
    const char *colon = asked ? ": " : "";
    if (!s->frames)
        return err_set(e, source_name(s), 0, "%s%.40s%sthe model has no frames; expected results, from tled-run",
                       option, asked ? asked : "", colon);
    return err_set(e, source_name(s), 0,
                   "%s%.40s%sno such frame; expected one of the %" PRId64 " there, of index %" PRId64 " to %" PRId64,
                   option, asked ? asked : "", colon, s->frames, s->first, s->frame.index);
}

void source_close(source *s)
{
    frame_free(&s->frame);
    frame_free(&s->spare);
    model_free(&s->body);
    if (s->reader)
        model_reader_close(s->reader);
    in_close(s->stream);
    *s = (source){0};
}

const char *source_name(const source *s)
{
    return s->stream ? in_name(s->stream) : "stdin";
}

const model_array *source_find(const source *s, const char *name)
{
    const model_array *a = s->frames ? frame_find(&s->frame, name) : NULL;
    return a ? a : model_find(&s->body, name);
}

void source_put_text(const char *text, out *to)
{
    for (const char *p = text; *p; p++)
        out_write(to, (unsigned char)*p < 0x20 || *p == 0x7f ? "?" : p, 1);
}

static void put_string(const char *text, bool quoted, out *to)
{
    if (!quoted) {
        out_text(to, text);
        return;
    }
    out_text(to, "'");
    source_put_text(text, to);
    out_text(to, "'");
}

void source_put_row(const model_array *a, int64_t row, bool quoted, out *to)
{
    char number[NUM_TEXT];
    for (int64_t at = row * a->columns; at < (row + 1) * a->columns; at++) {
        out_text(to, at % a->columns ? " " : "");
        if (a->type == MODEL_STR)
            put_string(a->str[at], quoted, to);
        else if (a->type == MODEL_I64)
            out_format(to, "%" PRId64, a->i64[at]);
        else {
            num_text(source_value(a, at), a->type == MODEL_F32, number);
            out_text(to, number);
        }
    }
}
