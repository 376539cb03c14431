/* An error and its place. The caller owns the struct (mostly one on main's stack); a library function
 * that fails fills it and returns -1 or NULL. Only mains print: tool_end() in tool.h. Notes are the
 * warnings that a library gathers on the way; the main prints them and frees the list.
 */
#ifndef SINEW_ERR_H
#define SINEW_ERR_H

#include <stdbool.h>
#include <stdint.h>

enum { STATUS_OK = 0, STATUS_BAD = 1, STATUS_USAGE = 2, STATUS_DIVERGED = 3 };

/* After errors of the command line: "try TOOL --help"; and, on lines of their own, how the tool is called. */
enum { ERR_TRY_HELP = 1, ERR_SHOW_USAGE };

typedef struct err {
    int status;       /* the exit status it asks for; 0: no error */
    bool silent;      /* the tool before us in the pipe has said it already */
    int help;         /* what is said after the text: one of the ERR_ below */
    int place;        /* bytes of text that are the place's name */
    const char *form; /* the format of the text, borrowed: errors of one kind have the same; NULL: no error */
    char text[1000];  /* "place:line: what is wrong; what was expected" */
} err;

typedef struct notes {
    char **line; /* owned */
    int count;
} notes;

#if defined(__GNUC__)
#define SINEW_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define SINEW_PRINTF(f, a)
#endif

/* Fills e with status 1. place NULL: no place; line 0: no line. Always returns -1. The first error stands:
 * a second call on a filled err changes nothing. */
int err_set(err *e, const char *place, int64_t line, const char *format, ...) SINEW_PRINTF(4, 5);

/* The same for what the command line asks, without a place: status 2, and ERR_TRY_HELP. */
int err_usage(err *e, const char *format, ...) SINEW_PRINTF(2, 3);

/* The same for the value of one option: "option: what is wrong", where only the input shows that it is wrong, so that
 * --help would not tell. NULL: no option is named. */
int err_option(err *e, const char *option, const char *format, ...) SINEW_PRINTF(3, 4);

/* err_set of a text that is made by `form`, for a function that words errors for others. */
int err_set_as(err *e, const char *form, const char *place, int64_t line, const char *text);

/* err_set with status 3: the simulation diverged. */
int err_diverged(err *e, const char *place, int64_t line, const char *format, ...) SINEW_PRINTF(4, 5);

/* err_set for a failed system call: appends strerror of the given errno value. */
int err_system(err *e, const char *place, int code, const char *what);

/* Out of memory, naming what for. Returns -1. */
int err_memory(err *e, const char *what);

/* The error that something holds for itself (a stream, a thread), where it has one: e takes it, unless e is filled.
 * Returns -1 where there is one, else 0. */
int err_join(err *e, const err *held);

/* Adds a warning. A note that cannot be stored for want of memory is lost. n may be NULL. */
void notes_add(notes *n, const char *format, ...) SINEW_PRINTF(2, 3);
void notes_free(notes *n);

#endif
