/* The log of a run: tab-separated values, for plots and for people who follow the run. Rows are held in memory until
 * the state that they are of is known to be sound; then they go to the file, whole and at once. The creator opens and
 * closes the log; the run calls the rest.
 */
#ifndef SINEW_LOG_H
#define SINEW_LOG_H

#include "base/out.h"
#include "cli/opt.h"
#include "live/growing.h"
#include "model/model.h"
#include "results/results.h"
#include "tled/loop/account.h"
#include "tled/problem/script.h"

/* What a row says besides what the account knows. */
typedef struct log_row {
    int64_t step;     /* of the run, cuts not counted */
    int64_t taken;    /* and counted */
    double time, dt;  /* s */
    double stable;    /* s: at the last check */
    double damping;   /* 1/s: on the way here */
    double remaining; /* to rest, as a share, at the last check; not finite where that is not known */
} log_row;

typedef struct run_log {
    double every; /* s, the creator's: a row at each multiple of it; 0: a row a check */
    growing *file;
    out *rows; /* not yet known to be sound */
    account *account;
    const script *script;   /* the creator's, which the problem is made of */
    const opt_list *keys;   /* node.displacement.at.X,Y,Z: three columns each, after the others; or LOG_... */
    int64_t node[64];       /* of each */
    results *results;       /* energies by material, where a key asks for them; owned */
    double *energy;         /* J: of each; owned */
    struct film_bone *bone; /* for these, of each film; owned */
    const tled_problem *p;  /* the creator's, before log_open: it decides about columns */
    const model *m;         /* that it was made of: its bodies' names */
    pool *threads;          /* the run's */
    int64_t steps;          /* of the last row, each part of a cut step for itself */
    double began;           /* when the last row was, by the clock */
    double own;             /* s: what the log itself took since then */
    bool is_pending;
    log_row last;                /* of the last reading */
    const account_sums *unshown; /* its sums, borrowed from the account; NULL: it has its row */
} run_log;

/* Where the log of a run stands at a checkpoint. */
typedef struct log_point {
    account_past past;
    int64_t length; /* bytes of the file; 0: there was none */
} log_point;

/* A key of a log may be one of these, for a column a muscle that the script drives: what a track is read from. */
#define LOG_LEVEL      "muscle.level"
#define LOG_ACTIVATION "muscle.activation"

/* And this, for a column a material: its strain energy. */
#define LOG_ENERGY "material.energy"

/* Whether it is a key of a log: a usage error, where it is not. */
int log_check_key(const char *key, err *e);

/* Finds the keys' nodes; and makes the file; from: NULL, or what to go on from: the file's rows up to there stay, which
 * must have the same columns. The keys are borrowed. -1 with e filled; log_close all the same. */
int log_open(run_log *l, const char *path, const opt_list *keys, const model *m, const log_point *from, err *e);

/* Writes the heading, but to what is gone on with, for this problem. -1 with e filled, as for all below. */
int log_begin(run_log *l, const tled_problem *p, pool *threads, err *e);

/* Reads the state into the account; with a row where it is `shown`. */
int log_read(run_log *l, const tled_executor *b, tled_state *state, const log_row *row, bool shown, err *e);

/* After log_save: waits until its rows are stored, which a checkpoint counts on. */
int log_store(run_log *l, err *e);

/* After log_save: for checkpoints, where the log stands; and goes on from there, at the same state, without a row. */
log_point log_point_of(const run_log *l);
int log_resume(run_log *l, const tled_executor *b, tled_state *state, double time, const log_point *from, err *e);

/* All since the last log_save is sound: writes the rows, and saves the account. Or it is not: drops the rows, and goes
 * back to the account that was saved. */
int log_save(run_log *l, err *e);
int log_restore(run_log *l, err *e);

/* The last reading gets a row, if it has none. */
int log_end(run_log *l, err *e);

/* l may be zeroed or half open. */
int log_close(run_log *l, err *e);

#endif
