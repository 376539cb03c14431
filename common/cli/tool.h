/* The beginning and the end of every main: the command line, and messages on stderr. No other file prints messages. A
 * main calls tool_run() with a function that begins with tool_begin, works, and ends with tool_end.
 */
#ifndef SINEW_TOOL_H
#define SINEW_TOOL_H

#include "base/err.h"
#include "cli/opt.h"
#include "cli/text_table.h"

#include <pthread.h>

/* A whole tool, from the command line to the exit status: work(argc, argv). Where ulimit -s leaves the process little
 * stack, it runs on a thread that has enough. A main is this alone. */
int tool_run(int (*work)(int argc, char **argv), int argc, char **argv);

/* Of all tools. debian/changelog and CHANGELOG.md name it too; tests/cli/package.t compares them. */
#define SINEW_VERSION "0.2.0"

/* What several threads give warnings of. The creator owns it. */
typedef struct tool_told {
    pthread_mutex_t lock;
    notes lines;
} tool_told;

typedef struct tool {
    const opt_tool *table;
    opt_common *common; /* the head of the tool's options */
    int operands;       /* argv[1] to argv[operands] */
    char *const *operand;
    bool done;         /* -h, -V or --table was answered: nothing more to do */
    char *provenance;  /* owned */
    const char *about; /* what messages are of: "jobs:3", of a job of --batch; borrowed; NULL: of the whole tool */
    tool_told *told;   /* warnings that jobs have given, each of which is given once; borrowed; NULL: all are given */
} tool;

/* Sees to it that descriptors 0 to 2 are open (no file may become one of them) and that a limit on the size of files
 * fails what writes, not the process; parses the command line and answers -h, -V and --table. Returns 0; -1 with e
 * filled (status 2). When t->done, go straight to tool_end. */
int tool_begin(tool *t, const opt_tool *table, int argc, char **argv, void *options, err *e);

/* Makes t of a job of another tool's command line, by options of its own: its files are checked, and its provenance is
 * that of a run with these options. about: see above. -1 with e filled (status 2); tool_free in both cases. */
int tool_begin_job(tool *t, const tool *of, void *options, const char *about, err *e);
void tool_free(tool *t);

/* The file that an option names, or NULL. */
const char *tool_file(const tool *t, const opt *o);

/* Refuses (status 2) a file that is to be written, as the option says that has its name ("-o", "--log"), where it is an
 * operand or a file that another option names, by whatever links; or what standard input or output is, unless it is
 * -o's, which replaces it only when all is read. tool_begin() asks for what the options name; this is for names that
 * are made of those: of numbered files, of checkpoints. */
int tool_check_written(const tool *t, const char *option, const char *path, err *e);

/* Adds to the options in the provenance what else decides the result, as it was found on the way. -1 with e filled. */
int tool_provenance(tool *t, err *e, const char *format, ...) SINEW_PRINTF(3, 4);

/* Prints e, unless it is empty or was printed already, with the help it asks for (e->help), and frees t. Returns the
 * exit status. Every message is one line in one write; control characters in it become '?'. */
int tool_end(tool *t, const err *e);

/* Where standard input is a terminal: what is read from it ("a model") is not typed, so status 2 and ERR_SHOW_USAGE. */
int tool_need_stdin(const char *what, err *e);

/* Prints e, without help: of a part of the work that failed while the rest goes on. */
void tool_failed(const tool *t, const err *e);

/* "tool: text" on stderr, unless -q. */
void tool_say(const tool *t, const char *format, ...) SINEW_PRINTF(2, 3);

/* The same, only with -v. */
void tool_detail(const tool *t, const char *format, ...) SINEW_PRINTF(2, 3);

/* "tool: title" and the table's lines, if it has rows, on stderr in one write, unless
 * -q. -1 with e filled for want of memory. */
int tool_table(const tool *t, const text_table *rows, err *e, const char *title, ...) SINEW_PRINTF(4, 5);

/* "tool: warning: text" for each note, of jobs for each that no job has given; frees them. Not silenced by -q. */
void tool_warn(const tool *t, notes *n);

/* --threads, else SINEW_THREADS, else all processors that the process may run on. At least 1; -1
 * with e filled for a bad SINEW_THREADS. */
int tool_threads(const tool *t, err *e);

#endif
