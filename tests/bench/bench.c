#include "bench.h"

#include "base/mem.h"
#include "model/stream.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

double bench_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void bench_must(bool good, const err *e)
{
    if (good)
        return;
    fprintf(stderr, "bench: %s\n", e->text[0] ? e->text : "something failed");
    exit(1);
}

void bench_use(double result)
{
    volatile double kept = result;
    (void)kept;
}

void bench_take(bench *b, const char *name, double amount, const char *unit, double took)
{
    int i = 0;
    while (i < b->cases && strcmp(b->of[i].name, name) != 0)
        i++;
    if (i == BENCH_CASES)
        return;
    bench_case *c = &b->of[i];
    if (i == b->cases)
        b->of[b->cases++] = (bench_case){.name = name, .unit = unit};
    c->amount = amount;
    if (c->rounds < BENCH_ROUNDS)
        c->took[c->rounds++] = took;
}

/* ---- the machine */

enum { COPY = 64 << 20, CHAINS = 64, LENGTH = 400000 };

static double copy_memory(void)
{
    err e = {0};
    char *from = mem_array(COPY, 1, "a probe", &e), *to = from ? mem_array(COPY, 1, "a probe", &e) : NULL;
    bench_must(to != NULL, &e);
    if (!to)
        exit(1);
    memset(from, 1, COPY);
    memset(to, 2, COPY);
    double start = bench_clock();
    memcpy(to, from, COPY);
    double took = bench_clock() - start;
    bench_use(to[COPY / 2]);
    free(from);
    free(to);
    return took;
}

/* Chains side by side, so that a compiler can lay them in vectors and none waits for another. */
static double multiply_add(void)
{
    double x[CHAINS], sum = 0;
    for (int i = 0; i < CHAINS; i++)
        x[i] = i;
    double start = bench_clock();
    for (int n = 0; n < LENGTH; n++)
        for (int i = 0; i < CHAINS; i++)
            x[i] = x[i] * 0.999 + 0.5;
    double took = bench_clock() - start;
    for (int i = 0; i < CHAINS; i++)
        sum += x[i];
    bench_use(sum);
    return took;
}

void bench_probe(bench *b)
{
    bench_take(b, "probe: copy in memory", COPY, "B", copy_memory());
    bench_take(b, "probe: multiply-add", (double)CHAINS * LENGTH, "multiply-add", multiply_add());
}

static void multiply_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)context, (void)chunk;
    for (int64_t i = from; i < to; i++)
        multiply_add();
}

void bench_probe_threads(bench *b, pool *threads)
{
    const int count = 4 * pool_threads(threads);
    double start = bench_clock();
    pool_run(threads, count, 1, multiply_work, NULL);
    bench_take(b, "probe: multiply-add, all threads", (double)CHAINS * LENGTH * count, "multiply-add",
               bench_clock() - start);
}

/* ---- commands */

typedef struct feed_end {
    int fd;
    const bench_bytes *from;
} feed_end;

static void *feed(void *argument)
{
    const feed_end *f = argument;
    for (size_t at = 0; f->from && at < f->from->size;) {
        size_t left = f->from->size - at;
        ssize_t n = write(f->fd, f->from->bytes + at, left < 1 << 18 ? left : 1 << 18);
        if (n <= 0)
            break;
        at += (size_t)n;
    }
    close(f->fd);
    return NULL;
}

static void drain(int fd, bench_bytes *to)
{
    err e = {0};
    ssize_t n = 1;
    for (to->size = 0; n > 0; to->size += n > 0 ? (size_t)n : 0) {
        int64_t room = (int64_t)to->room;
        bench_must(!mem_grow(&to->bytes, &room, (int64_t)to->size + (1 << 18), 1, "a model", &e), &e);
        to->room = (size_t)room;
        n = read(fd, to->bytes + to->size, 1 << 18);
    }
    close(fd);
}

/* In the child: the ends of the pipes become its standard streams. */
static void run_tool(const bench_command *c, const int given[2], const int taken[2])
{
    char path[1024];
    const char *word[10] = {c->tool};
    char *argv[10] = {NULL};
    for (int i = 0; i < 8 && c->argument[i]; i++)
        word[i + 1] = c->argument[i];
    memcpy(argv, word, sizeof argv);
    snprintf(path, sizeof path, "%s/%s", c->bin, c->tool);
    dup2(given[0], 0);
    dup2(taken[1], 1);
    close(given[0]);
    close(given[1]);
    close(taken[0]);
    close(taken[1]);
    execv(path, argv);
    perror(path);
    _exit(127);
}

double bench_run(const bench_command *c, const bench_bytes *from, bench_bytes *to)
{
    err e = {0};
    int given[2], taken[2], status = 0;
    pthread_t thread;
    bench_must(!pipe(given) && !pipe(taken), &e);
    double start = bench_clock();
    pid_t child = fork();
    bench_must(child >= 0, &e);
    if (!child)
        run_tool(c, given, taken);
    close(given[0]);
    close(taken[1]);
    feed_end f = {given[1], from};
    bench_must(!pthread_create(&thread, NULL, feed, &f), &e);
    drain(taken[0], to);
    pthread_join(thread, NULL);
    waitpid(child, &status, 0);
    double took = bench_clock() - start;
    err_set(&e, NULL, 0, "%s failed", c->tool);
    bench_must(WIFEXITED(status) && !WEXITSTATUS(status), &e);
    return took;
}

void bench_stream(const model *m, bench_bytes *to)
{
    err e = {0};
    size_t size;
    out *o = out_memory(&e);
    model_writer *w = o ? model_writer_open(o, false, &e) : NULL;
    bench_must(w && !model_write(w, m, &e) && !model_write_end(w, &e), &e);
    const unsigned char *bytes = out_bytes(o, &size);
    to->bytes = mem_array((int64_t)size, 1, "a model", &e);
    bench_must(to->bytes != NULL, &e);
    memcpy(to->bytes, bytes, size);
    to->size = to->room = size;
    model_writer_close(w);
    out_discard(o);
}

/* ---- the table */

static int by_size(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

void bench_sort(double *took, int64_t count)
{
    qsort(took, (size_t)count, sizeof *took, by_size);
}

void bench_print(const bench *b)
{
    puts("case,rounds,best_s,median_s,amount,unit,best_rate");
    for (int i = 0; i < b->cases; i++) {
        bench_case c = b->of[i];
        bench_sort(c.took, c.rounds);
        double rate = c.amount / c.took[0] / (strcmp(c.unit, "B") ? 1 : 1e6);
        printf("\"%s\",%d,%.6g,%.6g,%.6g,%s,%.6g\n", c.name, c.rounds, c.took[0], c.took[c.rounds / 2], c.amount,
               c.unit, rate);
    }
}
