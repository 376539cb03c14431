#include "base/err.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The end of a long path stands for it, so that what is wrong has room. Returns how much of the text is the place's
 * name. */
static size_t put_place(char *to, size_t size, const char *place)
{
    enum { MOST = 500 };
    const size_t n = strlen(place);
    const int put = n > MOST ? snprintf(to, size, "...%s", place + n - MOST) : snprintf(to, size, "%s", place);
    return put < 0 ? 0 : (size_t)put;
}

SINEW_PRINTF(5, 0)
static int fill(err *e, int status, const char *place, int64_t line, const char *format, va_list args)
{
    if (e->status)
        return -1;
    e->status = status;
    e->form = format;
    size_t at = place ? put_place(e->text, sizeof e->text, place) : 0;
    e->place = (int)at;
    if (place && line > 0)
        at += (size_t)snprintf(e->text + at, sizeof e->text - at, ":%lld: ", (long long)line);
    else if (place)
        at += (size_t)snprintf(e->text + at, sizeof e->text - at, ": ");
    vsnprintf(e->text + at, sizeof e->text - at, format, args);
    return -1;
}

int err_set(err *e, const char *place, int64_t line, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(e, STATUS_BAD, place, line, format, args);
    va_end(args);
    return -1;
}

int err_set_as(err *e, const char *form, const char *place, int64_t line, const char *text)
{
    const bool fresh = !e->status;
    err_set(e, place, line, "%s", text);
    if (fresh)
        e->form = form;
    return -1;
}

int err_usage(err *e, const char *format, ...)
{
    va_list args;
    e->help = e->status ? e->help : ERR_TRY_HELP;
    va_start(args, format);
    fill(e, STATUS_USAGE, NULL, 0, format, args);
    va_end(args);
    return -1;
}

int err_option(err *e, const char *option, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(e, STATUS_USAGE, option, 0, format, args);
    va_end(args);
    return -1;
}

int err_diverged(err *e, const char *place, int64_t line, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(e, STATUS_DIVERGED, place, line, format, args);
    va_end(args);
    return -1;
}

int err_system(err *e, const char *place, int code, const char *what)
{
    return err_set(e, place, 0, "%s: %s", what, strerror(code));
}

int err_memory(err *e, const char *what)
{
    return err_set(e, NULL, 0, "out of memory for %s; a smaller model or a larger machine is needed", what);
}

int err_join(err *e, const err *held)
{
    if (!held->status)
        return 0;
    if (!e->status)
        *e = *held;
    return -1;
}

void notes_add(notes *n, const char *format, ...)
{
    char text[1000];
    if (!n)
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    char **grown = realloc(n->line, ((size_t)n->count + 1) * sizeof *grown);
    if (!grown)
        return;
    n->line = grown;
    n->line[n->count] = strdup(text);
    if (n->line[n->count])
        n->count++;
}

void notes_free(notes *n)
{
    for (int i = 0; i < n->count; i++)
        free(n->line[i]);
    free(n->line);
    *n = (notes){0};
}
