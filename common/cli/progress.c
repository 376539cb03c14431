#include "cli/progress.h"

#include "base/clock.h"

#include <stdio.h>
#include <unistd.h>

void progress_start(progress *p, const char *tool, const char *what, double total, bool quiet)
{
    *p = (progress){.tool = tool, .what = what, .total = total, .on = !quiet && isatty(STDERR_FILENO)};
    if (p->on)
        p->started = p->shown = clock_now();
}

bool progress_due(const progress *p)
{
    return p->on && clock_now() - p->shown >= .1;
}

void progress_text(progress *p, const char *text)
{
    p->shown = clock_now();
    fprintf(stderr, "\r%s: %s \033[K", p->tool, text);
}

void progress_at(progress *p, double done)
{
    char text[200];
    if (!progress_due(p))
        return;
    double rate = done / (clock_now() - p->started);
    if (p->total > 0 && rate > 0)
        snprintf(text, sizeof text, "%3.0f %% of %.0f %s, %.4g/s, %.0f s left", 100 * done / p->total, p->total,
                 p->what, rate, (p->total - done) / rate);
    else
        snprintf(text, sizeof text, "%.0f %s, %.4g/s", done, p->what, rate);
    progress_text(p, text);
}

void progress_clear(const progress *p)
{
    if (p->on)
        fputs("\r\033[K", stderr);
}

void progress_stop(progress *p)
{
    progress_clear(p);
    p->on = false;
}
