#include "base/tool.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Answers -h, -V and --table on stdout. */
static int answer(tool *t, err *e)
{
    const opt_common *c = t->common;
    out *o = out_open(NULL, false, e);
    if (!o)
        return -1;
    t->done = true;
    if (c->help)
        opt_usage(t->table, o);
    else if (c->version)
        out_format(o, "%s (Sinew) %s\n", t->table->name, SINEW_VERSION);
    else if (opt_table(t->table, c->table, o, e)) {
        out_discard(o);
        return -1;
    }
    return out_close(o, e);
}

int tool_begin(tool *t, const opt_tool *table, int argc, char **argv, void *options, err *e)
{
    *t = (tool){.table = table, .common = options};
    t->operands = opt_parse(table, argc, argv, options, e);
    if (t->operands < 0)
        return -1;
    if (t->common->help || t->common->version || t->common->table)
        return answer(t, e);
    t->provenance = opt_provenance(table, options, t->operands, argv + 1, e);
    return t->provenance ? 0 : -1;
}

int tool_end(tool *t, const err *e)
{
    if (e->status && !e->silent)
        fprintf(stderr, "%s: %s\n", t->table->name, e->text);
    free(t->provenance);
    t->provenance = NULL;
    return e->status;
}

SINEW_PRINTF(2, 0) static void say(const tool *t, const char *format, va_list args)
{
    fprintf(stderr, "%s: ", t->table->name);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
}

void tool_say(const tool *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (!t->common->quiet)
        say(t, format, args);
    va_end(args);
}

void tool_detail(const tool *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (t->common->verbose && !t->common->quiet)
        say(t, format, args);
    va_end(args);
}

void tool_warn(const tool *t, notes *n)
{
    for (int i = 0; i < n->count; i++)
        fprintf(stderr, "%s: warning: %s\n", t->table->name, n->line[i]);
    notes_free(n);
}

int tool_threads(const tool *t, err *e)
{
    if (t->common->threads > 0)
        return (int)t->common->threads;
    const char *text = getenv("SINEW_THREADS");
    int64_t threads;
    if (text && *text) {
        if (!num_int(text, 1, 1024, &threads))
            return (int)threads;
        return err_set(e, NULL, 0, "SINEW_THREADS '%s': expected a whole number from 1 to 1024", text);
    }
    long all = sysconf(_SC_NPROCESSORS_ONLN);
    return all < 1 ? 1 : all > 1024 ? 1024 : (int)all;
}
