/* Command lines from one table a tool: parsing, the usage text, shell completion and the manual's synopsis
 * all come from it. A table says where each value goes as an offset into the tool's own struct of options, whose
 * first member is an opt_common. Nothing here prints; texts point into argv.
 */
#ifndef SINEW_OPT_H
#define SINEW_OPT_H

#include "base/err.h"
#include "base/num.h"
#include "base/out.h"

#include <stddef.h>

/* The headings that the help has options under, in their order there. */
typedef enum opt_group {
    OPT_END,      /* no option: the end of a table */
    OPT_INPUT,    /* what is read, and how it is taken */
    OPT_ACTION,   /* what happens to it */
    OPT_NUMERICS, /* how that is computed */
    OPT_RESULT,   /* what is written, and how */
    OPT_COMMON,   /* what all tools have */
    OPT_GROUPS
} opt_group;

typedef enum opt_kind {
    OPT_FLAG,    /* bool */
    OPT_TEXT,    /* const char * */
    OPT_INT,     /* int64_t within low..high; the caller's default -1 means: not given */
    OPT_SIZE,    /* int64_t, bytes: a size such as 500MB or 2GiB; the caller's default 0 means: not given */
    OPT_NUMBER,  /* double within low..high; the caller's default NAN means: not given */
    OPT_LENGTHS, /* opt_lengths: 1 to `high` lengths between commas, each with its suffix or none */
    OPT_NUMBERS, /* opt_numbers: `low` to `high` numbers between commas */
    OPT_CHOICE,  /* int: the index in `choices` (names between '|'); below 0, of the caller's: not given */
    OPT_LIST     /* opt_list: may be given again; each value is split at its commas by whoever reads it */
} opt_kind;

typedef struct opt_lengths {
    int count; /* 0: not given */
    num_length value[6];
} opt_lengths;

typedef struct opt_numbers {
    int count;
    double value[6];
} opt_numbers;

typedef struct opt_list {
    int count;
    const char *value[64];
} opt_list;

enum {
    OPT_REQUIRED = 1, /* usage error without it (unless -h, -V) */
    OPT_OUTPUT = 2,   /* does not change the result: left out of provenance */
    OPT_HIDDEN = 4,   /* not for people: left out of every text */
    OPT_FILE = 8,     /* its text names a file: provenance has the base name only, completion offers files */
    OPT_WRITES = 16,  /* its text names a file, or files by a number in it, that are written: nothing else may be */
    OPT_ALSO = 32,    /* another name of the option before it, with the same `to`: left out of the synopsis */
    OPT_JOB = 128,    /* a job of --batch may have it (cli/batch.h) */
    OPT_ALONE = 256,  /* not with --batch, neither for all jobs nor for one */
    OPT_EITHER = 512, /* of those with this, a job's line has all or none: it replaces what the command line has */
    OPT_NAMED =
        64 /* its text is NAME=VALUE, or NAME:VALUE; one that ends in .obj or .obj.gz is a file, as with OPT_FILE */
};

typedef struct opt {
    opt_group group;
    char letter;      /* 0: none */
    const char *name; /* long, without the dashes; NULL: letter only */
    const char *arg;  /* metavariable, e.g. "SECONDS"; NULL for a flag */
    opt_kind kind;
    size_t to;        /* offsetof(options, field) */
    double low, high; /* range, inclusive; both 0: any */
    /* Names between '|'. For an OPT_TEXT or OPT_LIST: what completion offers. A word that ends in ':' or '='
     * is typed on after it. A word that begins with '@' is a key of `sinew info --get`: the names that a
     * model on the command line has under it are offered, each followed by the key's last character if that
     * is no letter or digit: "@muscle.name=". */
    const char *choices;
    int flags;
    const char *help; /* a few words; units and defaults last, in brackets: [UNIT], [default X] or [UNIT; default X] */
} opt;

typedef struct opt_common {
    bool help, version, text, gzip, anonymous, quiet, verbose;
    const char *output; /* -o */
    int64_t threads;    /* 0: not given */
    int64_t memory;     /* bytes; 0: not given */
    const char *table;  /* --table mdoc|bash|zsh: for the manual and completion */
} opt_common;

typedef struct opt_tool {
    const char *name;     /* "voxelise" */
    const char *command;  /* how it is called, "sinew bind"; NULL: by its name */
    const char *usage;    /* what follows that on a command line, its place in a pipe included; a line for each way */
    const char *purpose;  /* what it does: a sentence, in lines of 80 columns */
    const char *note;     /* what holds for several options, as units of lengths; NULL: nothing */
    const char *example;  /* one command line */
    const char *operands; /* as in messages and the synopsis, e.g. "surface.obj|-"; "" for none */
    int operands_min, operands_max;
    bool writes_model;  /* has --text, -z and --anonymous-names */
    bool threaded;      /* has --threads */
    bool reads_volumes; /* has --memory */
    const opt *options; /* ends with OPT_END */
} opt_tool;

/* Names of options and choices may have American spelling (cli/spelling.h), and are recorded as the table has them;
 * those of a list too, where a value is a choice, or NAME=CHOICE. Whoever reads a list looks it up in both spellings.
 *
 * Parses argv into options (with its defaults set by the caller) and moves the operands to the front of argv, from
 * argv[1]. Returns the count of operands, or -1 with e filled (status 2). With -h, -V or --table, nothing more is
 * required. With --batch, what is said in the lines of jobs, as -o, and what is OPT_ALONE, is refused. */
int opt_parse(const opt_tool *tool, int argc, char **argv, void *options, err *e);

/* The same for the words of a job, from argv[1] on: only options that jobs may have, over those of the command line.
 * defaults: the options where nothing is given. */
int opt_parse_job(const opt_tool *tool, int argc, char **argv, void *options, const void *defaults, err *e);

/* Sets one option by its long name, as the command line does: for values that change while a tool runs. The text must
 * last as long as the options. -1 with e filled, and that option's value may be lost. */
int opt_set(const opt_tool *tool, const char *name, const char *text, void *options, err *e);

/* The index of a word among names between '|', or -1. */
int opt_choice(const char *choices, const char *word);

/* The i-th option of the tool: its own first, then the common ones that it has; NULL past the last. opt_own: how many
 * are its own. */
const opt *opt_at(const opt_tool *tool, int i);
int opt_own(const opt_tool *tool);

/* An option as messages name it: "-o", "--log". */
const char *opt_dashed(const opt *o, char to[64]);

/* How people call the tool: "sinew bind". */
const char *opt_command(const opt_tool *tool);

/* "usage: ...", a line for each way to call the tool; and the help, which begins with these, in 80 columns. */
void opt_usage(const opt_tool *tool, out *o);
void opt_help(const opt_tool *tool, out *o);

/* kind "mdoc": the manual's SYNOPSIS; "bash", "zsh": a completion script. -1 with e filled for another kind. */
int opt_table(const opt_tool *tool, const char *kind, out *o, err *e);

/* What of the command line changes the result, for provenance: options in table order, then operands, which are files;
 * base names of files (FILE where names are to be left out), and quoted as for the shell where they have blanks or
 * quotes. The caller frees it; NULL with e filled. */
char *opt_provenance(const opt_tool *tool, const void *options, int operands, char *const *operand, err *e);

#endif
