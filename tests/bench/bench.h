/* What benchmarks share: times taken in rounds, a probe of the machine, commands run between pipes, and CSV. A
 * benchmark that cannot go on ends the program. The caller owns a bench and what bench_bytes point to.
 */
#ifndef SINEW_BENCH_H
#define SINEW_BENCH_H

#include "base/pool.h"
#include "model/model.h"

enum { BENCH_CASES = 64, BENCH_ROUNDS = 32 };

typedef struct bench_case {
    const char *name, *unit;
    double amount; /* of the unit, in each round */
    double took[BENCH_ROUNDS];
    int rounds;
} bench_case;

typedef struct bench {
    bench_case of[BENCH_CASES];
    int cases;
} bench;

typedef struct bench_bytes {
    unsigned char *bytes;
    size_t size, room;
} bench_bytes;

typedef struct bench_command {
    const char *bin, *tool;
    const char *argument[8]; /* ends with NULL */
} bench_command;

/* Seconds. */
double bench_clock(void);

/* Ends the program with e's text where it is not so. */
void bench_must(bool good, const err *e);

/* Least first. */
void bench_sort(double *took, int64_t count);

/* Keeps a result from being optimised away. */
void bench_use(double result);

/* Notes that one round of a case (told by its name, which must last) took so long. */
void bench_take(bench *b, const char *name, double amount, const char *unit, double took);

/* A round of the probe: copy bandwidth of one thread in memory, and its rate of multiply-adds in doubles. */
void bench_probe(bench *b);

/* The multiply-adds of all threads at once: whether they are processors, or halves of one. */
void bench_probe_threads(bench *b, pool *threads);

/* Runs the command with these bytes on standard input (NULL: none); what it writes replaces what `to` held. Returns
 * seconds from start to exit. */
double bench_run(const bench_command *c, const bench_bytes *from, bench_bytes *to);

/* The model as a binary stream. */
void bench_stream(const model *m, bench_bytes *to);

/* "case,rounds,best_s,median_s,amount,unit,best_rate": a line a case, rates in units (B: in MB) a second. */
void bench_print(const bench *b);

#endif
