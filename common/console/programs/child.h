/* A tool that the console runs: a process with its own group, which ends when the console does, however that ends.
 * The console reads its output, writes lines to it through a pipe that is its descriptor 3, and passes on what it says
 * on standard error. child.c is the only file that starts programs. All functions but child_told_end are for the thread
 * that starts them: the kernel ends a child with the thread that started it. The caller owns a child.
 */
#ifndef SINEW_CHILD_H
#define SINEW_CHILD_H

#include "base/err.h"

#include <pthread.h>
#include <sys/types.h>

enum { CHILD_PATH = 4096, CHILD_SAID = 1000 };

#define CHILD_CONTROL "/dev/fd/3" /* what a child calls its pipe of lines */

typedef struct child_plan {
    const char *tool; /* borrowed as long as the child lives */
    char **argv;      /* ends with NULL */
    int in;           /* becomes its standard input, and is closed here; -1: /dev/null */
    void *context;
    /* A line that it said, by a thread of the child's own. */
    void (*said)(void *context, const char *tool, const char *line);
} child_plan;

typedef struct child {
    child_plan plan;
    pid_t pid;   /* 0: there is none, or it has ended */
    int out;     /* its standard output: the caller's to read, and to close; -1: none */
    int control; /* -1: none */
    int errors;
    int status; /* as wait(2) has it, once it has ended */
    bool listens, stuck;
    pthread_t listener;
} child;

/* The path of a tool: beside this program, else on PATH. -1 with e filled. */
int child_find(const char *tool, char path[CHILD_PATH], err *e);

/* Starts it. -1 with e filled; plan->in is closed in any case. */
int child_start(child *c, const child_plan *plan, err *e);

/* Writes a line to the tool's pipe, without waiting. Where the pipe is full, as the tool does not read, the line is
 * lost: -1 with e filled for the first such line, 0 for those after it, until one is written again. To a tool that has
 * ended nothing is written: 0. -1 with e filled for a line that is longer than a pipe takes whole. */
int child_tell(child *c, const char *line, err *e);

/* Whether it has ended; then c->status is how. */
bool child_has_ended(child *c);

/* "ended with status 3", "was killed by signal 9". */
void child_how(const child *c, char *to, size_t size);

/* Stops it, or lets it go on. */
void child_pause(const child *c, bool on);

/* Asks it to end as at the end of its input. */
void child_ask(const child *c);

/* Waits until it has ended, at most so many seconds, then kills it. A zeroed child has ended. */
void child_end(child *c, double seconds);

#endif
