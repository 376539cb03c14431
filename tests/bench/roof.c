#include "roof.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    COPY = 128 << 20, /* bytes: of all threads together; far more than is cached */
    PIECE = 1 << 20,  /* of which a thread takes at a time */
    CHAINS = 12,      /* as many as hide an instruction's latency, and as have registers */
    LENGTH = 1 << 19, /* multiply-adds in a chain */
    PARTS = 4,        /* chunks for a thread */
    MOST_THREADS = 1024
};

typedef struct work {
    const roof *r;
    double (*chains)(void); /* of one kind of vectors; the sum of all */
    double sum[PARTS * MOST_THREADS];
} work;

double roof_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// NOLINTBEGIN(bugprone-macro-parentheses): an attribute and types
/* Chains side by side of x = a x + b, each of as many numbers as a register has. */
#define DEFINE_CHAINS(name, number, bytes, attribute)                                                                  \
    typedef number name##_vector __attribute__((vector_size(bytes)));                                                  \
    static attribute double name(void)                                                                                 \
    {                                                                                                                  \
        const name##_vector a = (name##_vector){0} + (number)0.999, b = (name##_vector){0} + (number)0.5;              \
        name##_vector x[CHAINS];                                                                                       \
        double sum = 0;                                                                                                \
        for (int i = 0; i < CHAINS; i++)                                                                               \
            x[i] = a * (number)i;                                                                                      \
        for (int n = 0; n < LENGTH; n++)                                                                               \
            for (int i = 0; i < CHAINS; i++)                                                                           \
                x[i] = x[i] * a + b;                                                                                   \
        for (int i = 0; i < CHAINS; i++)                                                                               \
            sum += (double)x[i][0];                                                                                    \
        return sum;                                                                                                    \
    }

// NOLINTEND(bugprone-macro-parentheses)

DEFINE_CHAINS(plain_single, float, 16, )
DEFINE_CHAINS(plain_double, double, 16, )
#ifdef __x86_64__
DEFINE_CHAINS(avx2_single, float, 32, __attribute__((target("avx2"))))
DEFINE_CHAINS(avx2_double, double, 32, __attribute__((target("avx2"))))
DEFINE_CHAINS(avx512_single, float, 64, __attribute__((target("avx512f"))))
DEFINE_CHAINS(avx512_double, double, 64, __attribute__((target("avx512f"))))
#endif

typedef struct kind {
    const char *vectors;
    int bytes;
    double (*chains[2])(void); /* double, single */
} kind;

static const kind kinds[] = {
#ifdef __x86_64__
    {"AVX-512", 64, {avx512_double, avx512_single}},
    {"AVX2", 32, {avx2_double, avx2_single}},
#endif
    {"plain", 16, {plain_double, plain_single}}};

static const kind *kind_of(const char *vectors)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(kinds[i].vectors, vectors))
            return &kinds[i];
    return NULL;
}

static void copy_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        memcpy(w->r->to + i * PIECE, w->r->from + i * PIECE, PIECE);
}

static void chain_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        w->sum[i] = w->chains();
}

int roof_make(roof *r, pool *threads, const char *vectors, err *e)
{
    *r = (roof){.threads = threads, .vectors = vectors};
    if (!kind_of(vectors) || pool_threads(threads) > MOST_THREADS)
        return err_set(e, NULL, 0,
                       "a probe for %s on %d threads; expected at most %d, and a set of vectors that is known", vectors,
                       pool_threads(threads), (int)MOST_THREADS);
    r->from = mem_array(COPY, 1, "a probe", e);
    r->to = mem_array(COPY, 1, "a probe", e);
    if (!r->from || !r->to)
        return -1;
    memset(r->from, 1, COPY);
    memset(r->to, 2, COPY);
    return 0;
}

void roof_free(roof *r)
{
    free(r->from);
    free(r->to);
}

roof_rates roof_take(const roof *r, bool single)
{
    const kind *k = kind_of(r->vectors);
    const int threads = pool_threads(r->threads);
    const int chunks = PARTS * threads;
    const double each = 2. * CHAINS * LENGTH * k->bytes / (single ? sizeof(float) : sizeof(double));
    work w = {.r = r, .chains = k->chains[single]};
    const double start = roof_clock();
    pool_run(r->threads, COPY / PIECE, 1, copy_work, &w);
    const double middle = roof_clock();
    pool_run(r->threads, chunks, 1, chain_work, &w);
    const double end = roof_clock();
    volatile double kept = w.sum[0]; /* or the chains would not be computed */
    (void)kept;
    return (roof_rates){2. * COPY / (middle - start), each * chunks / (end - middle)};
}
