/* --batch FILE: many jobs of one tool, side by side, for which it reads its model once. A line of the file is a job:
 * the options that it has beside those of the command line, as words; blank lines and comments (# at a word's
 * beginning) are none. A word with blanks stands between quotes, ' or "; within ", and outside of quotes, a backslash
 * takes the next character as it is.
 *
 * All lines are looked at before the first job runs. A job that fails, or whose line is wrong, says so, with FILE:LINE,
 * and the others go on; a line is wrong too that writes what one before it reads or writes, or reads what one before it
 * writes. What jobs need while they run is as much as those that run at once need; of the others only the
 * lines are kept.
 */
#ifndef SINEW_BATCH_H
#define SINEW_BATCH_H

#include "cli/tool.h"

enum { BATCH_SAID = 400 };

/* What a tool does with a job. Its options are the tool's struct, the head of which is an opt_common. */
typedef struct batch_use {
    size_t size;          /* bytes of that struct */
    const void *defaults; /* it, where nothing is given */
    const void *given;    /* it, as the command line fills it */
    /* Checks the options together, as it does those of a command line. -1 with e filled. */
    int (*check)(void *options, err *e);
    /* Does a job, in any thread, on t->common->threads threads; *said: what is said of it in the end. -1 with e
     * filled. */
    int (*work)(void *context, tool *t, void *options, char said[BATCH_SAID], err *e);
    void *context;
} batch_use;

/* Reads the file and does all its jobs. -1 with e filled: the file cannot be read, or has no job; or jobs failed, which
 * have been told. */
int batch_go(const tool *t, const char *path, const batch_use *use, err *e);

#endif
