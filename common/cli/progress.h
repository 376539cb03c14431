/* Progress on stderr with rate and time left, only where stderr is a terminal, at most ten times a second.
 * The caller owns the struct; there is nothing to free.
 */
#ifndef SINEW_PROGRESS_H
#define SINEW_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct progress {
    const char *tool, *what; /* "tled-run", "steps" */
    double total;            /* 0: not known */
    double started, shown;   /* s */
    bool on;
} progress;

void progress_start(progress *p, const char *tool, const char *what, double total, bool quiet);
void progress_at(progress *p, double done);
/* For what has no count: whether it is time to show something, and what is shown. */
bool progress_due(const progress *p);
void progress_text(progress *p, const char *text);
/* Clears the line until it is shown again: for a message. */
void progress_clear(const progress *p);
/* Clears it for good. */
void progress_stop(progress *p);

#endif
