#include "base/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

double progress_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_start(progress *p, const char *tool, const char *what, double total, bool quiet)
{
    *p = (progress){.tool = tool, .what = what, .total = total, .on = !quiet && isatty(STDERR_FILENO)};
    if (p->on)
        p->started = p->shown = progress_clock();
}

void progress_at(progress *p, double done)
{
    double now = p->on ? progress_clock() : 0;
    if (!p->on || now - p->shown < .1)
        return;
    double rate = done / (now - p->started);
    p->shown = now;
    if (p->total > 0 && rate > 0)
        fprintf(stderr, "\r%s: %3.0f %% of %.0f %s, %.4g/s, %.0f s left \033[K", p->tool, 100 * done / p->total,
                p->total, p->what, rate, (p->total - done) / rate);
    else
        fprintf(stderr, "\r%s: %.0f %s, %.4g/s \033[K", p->tool, done, p->what, rate);
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
