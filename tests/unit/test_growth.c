/* Time grows with what is read, not with its square: 32 times as much takes 32 times as long, and not 1024. Memory that
 * is touched first costs a page fault, which takes longer than the work on a page where machines are virtual, and few
 * would fit into memory that is there already: so malloc keeps all that it once had. Of a processor's time, and the
 * least of several runs, few and many in turn: on a busy machine, where others' work takes the caches, there are more
 * rounds. */
#include "streams.h"
#include "surface/triangle_tree.h"
#include "surface/triangulate.h"
#include "tap.h"

#include <malloc.h>
#include <time.h>

enum { FEW = 1000, MANY = 32 * FEW, ROUNDS = 10 };

/* The geometric mean of 32 and 1024. */
static const double most = 181;

typedef struct text {
    char *at;
    size_t n;
} text;

SINEW_PRINTF(2, 3) static void put(text *t, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    t->n += (size_t)vsprintf(t->at + t->n, format, list);
    va_end(list);
}

/* Models of so many names. */

static void put_meta(text *t, int count)
{
    for (int i = 0; i < count; i++)
        put(t, "meta k%d \"v\"\n", i);
}

/* ---- names that agree in the low BITS of FNV-1a, which has no key: each is a row of words, and of each word there are
 * two that take the hash from one state to one other */

enum { BITS = 20, WORD = 4, WORDS = 15 }; /* 2^WORDS names */

static uint64_t fnv(uint64_t h, const char *word)
{
    for (int i = 0; i < WORD; i++)
        h = (h ^ (unsigned char)word[i]) * UINT64_C(1099511628211);
    return h & ((1u << BITS) - 1);
}

static void word_of(int number, char *word)
{
    for (int i = 0; i < WORD; i++, number /= 26)
        word[i] = (char)('a' + number % 26);
}

/* Returns the state behind both words. first: what word led to a state, + 1. */
static uint64_t find_pair(uint64_t state, char pair[2][WORD], int *first)
{
    memset(first, 0, sizeof *first << BITS);
    for (int i = 0;; i++) {
        word_of(i, pair[1]);
        uint64_t to = fnv(state, pair[1]);
        if (first[to]) {
            word_of(first[to] - 1, pair[0]);
            return to;
        }
        first[to] = i + 1;
    }
}

static void put_alike(text *t, int count)
{
    char pair[WORDS][2][WORD];
    int *first = malloc(sizeof *first << BITS);
    uint64_t state = UINT64_C(14695981039346656037) & ((1u << BITS) - 1);
    for (int i = 0; i < WORDS; i++)
        state = find_pair(state, pair[i], first);
    free(first);
    for (int i = 0; i < count; i++) {
        put(t, "meta ");
        for (int k = 0; k < WORDS; k++)
            put(t, "%.*s", WORD, pair[k][i >> k & 1]);
        put(t, " \"v\"\n");
    }
}

static void put_axes(text *t, int count)
{
    for (int i = 0; i < count; i++)
        put(t, "axis k%d/vertex 0\n", i);
}

static void put_arrays(text *t, int count)
{
    put(t, "axis n 1\n");
    for (int i = 0; i < count; i++)
        put(t, "array k%d u8 1 n 1\n1\n", i);
}

static void put_frame(text *t, int count)
{
    put(t, "axis n 1\nframe 0 0\n");
    for (int i = 0; i < count; i++)
        put(t, "array k%d u8 1 n 1\n1\n", i);
}

/* Walks over the surfaces and drops an axis: each looks at all that there is. */
static void use(const void *model_text, size_t size, err *e)
{
    char name[MODEL_NAME];
    model m = {0};
    in *s = in_memory(model_text, size, "stdin", e);
    model_reader *r = s ? model_reader_open(s, e) : NULL;
    if (r && !model_read(r, &m, e)) {
        for (int at = 0; model_surface(&m, &at, name, sizeof name);)
            model_find(&m, name);
        model_axis_drop(&m, "n", NULL);
    }
    model_reader_close(r);
    in_close(s);
    model_free(&m);
}

/* One run on so many of what a case has: its time. */
typedef double once(const void *one, int count, err *e);

typedef struct least {
    double few, many;
} least;

/* The least times of two rounds, or of more, up to ROUNDS, as long as many seem to take too long. */
static least least_of(once *run, const void *one, err *e)
{
    least t = {INFINITY, INFINITY};
    for (int round = 0; round < ROUNDS && (round < 2 || t.many >= most * t.few); round++) {
        t.few = fmin(t.few, run(one, FEW, e));
        t.many = fmin(t.many, run(one, MANY, e));
    }
    return t;
}

typedef struct names {
    const char *what;
    void (*fill)(text *t, int count);
} names;

static double read_once(const void *one, int count, err *e)
{
    text t = {malloc(80 * (size_t)count + 100), 0};
    put(&t, "%%sinew 1 text\n");
    ((const names *)one)->fill(&t, count);
    put(&t, "end\n");
    const clock_t from = clock();
    bytes b = convert(t.at, t.n, false, e);
    use(t.at, t.n, e);
    const double took = (double)(clock() - from);
    free(b.at);
    free(t.at);
    return took;
}

static void test_names(void)
{
    static const names all[] = {{"meta lines", put_meta},
                                {"meta lines that collide without a key", put_alike},
                                {"axes", put_axes},
                                {"arrays", put_arrays},
                                {"arrays of a frame", put_frame}};
    for (int i = 0; i < (int)(sizeof all / sizeof *all); i++) {
        err e = {0};
        const least t = least_of(read_once, &all[i], &e);
        ok(!e.status && t.many < most * t.few, "%d %s take %.3g times as long as %d %s", MANY, all[i].what,
           t.many / t.few, FEW, e.text);
    }
}

/* Polygons of so many corners. */

static void star(double *p, int i, int count)
{
    double r = i % 2 ? 1 : .05, angle = 2 * M_PI * i / count;
    p[0] = r * cos(angle), p[1] = r * sin(angle);
}

static void one_centre(double *p, int i, int count)
{
    double r = i % 3 ? 1 : 0, angle = 2 * M_PI * i / count;
    p[0] = r * cos(angle), p[1] = r * sin(angle);
}

static void to_and_fro(double *p, int i, int count)
{
    p[0] = (double)((int64_t)i * i % 7 + count), p[1] = 0;
}

static void scribble(double *p, int i, int count)
{
    p[0] = (double)((int64_t)i * 7919 % 10007), p[1] = (double)((int64_t)i * 104729 % (count + 1));
}

static double area(const double *p, int a, int b, int c)
{
    const double *x = &p[(size_t)a * 3], *y = &p[(size_t)b * 3], *z = &p[(size_t)c * 3];
    return (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
}

/* A thin strip of two straight sides, one place after the other, turned by an angle. */
static void slanted(double *p, int i, int count, double degrees)
{
    int half = count / 2;
    double x = i < half ? i : count - 1 - i, y = i < half ? 0 : .5, angle = degrees * M_PI / 180;
    p[0] = x * cos(angle) - y * sin(angle), p[1] = x * sin(angle) + y * cos(angle);
}

static void strip_30(double *p, int i, int count)
{
    slanted(p, i, count, 30);
}

static void strip_45(double *p, int i, int count)
{
    slanted(p, i, count, 45);
}

/* A comb along the diagonal, its back below. */
static void comb(double *p, int i, int count)
{
    double x = i == count - 2 ? count : -1, y = -1;
    if (i < count - 2) {
        x = i;
        y = i % 2 * 10;
    }
    p[0] = x - y, p[1] = x + y;
}

/* The triangles' areas sum to the polygon's: they overlap nowhere. */
static bool is_covered(const double *p, int count, const int32_t *triangle)
{
    double whole = 0, sum = 0;
    for (int i = 1; i + 1 < count; i++)
        whole += area(p, 0, i, i + 1);
    for (int i = 0; i < count - 2; i++)
        sum += fabs(area(p, triangle[3 * i], triangle[3 * i + 1], triangle[3 * i + 2]));
    return fabs(sum - fabs(whole)) <= 1e-7 * sum;
}

typedef struct shape {
    const char *what;
    void (*place)(double *p, int i, int count);
    bool simple; /* it crosses itself nowhere, and must be covered */
} shape;

static double cut_once(const void *one, int count, err *e)
{
    const shape *s = one;
    double *p = calloc((size_t)count, 3 * sizeof *p);
    int32_t *corner = malloc((size_t)count * sizeof *corner), *triangle = malloc((size_t)count * 3 * sizeof *triangle);
    for (int i = 0; i < count; i++) {
        corner[i] = i;
        s->place(&p[(size_t)i * 3], i, count);
    }
    const clock_t from = clock();
    triangulate(p, corner, count, triangle, e);
    const double took = (double)(clock() - from);
    if (s->simple && !e->status && !is_covered(p, count, triangle))
        err_set(e, NULL, 0, "%d corners are not all covered once", count);
    free(p);
    free(corner);
    free(triangle);
    return took;
}

static void test_polygons(void)
{
    static const shape all[] = {{"a star", star, true},
                                {"a strip at 30 degrees", strip_30, true},
                                {"a strip at 45 degrees", strip_45, true},
                                {"a comb at 45 degrees", comb, true},
                                {"a rosette through one place", one_centre, false},
                                {"a line to and fro", to_and_fro, false},
                                {"a scribble", scribble, false}};
    for (int i = 0; i < (int)(sizeof all / sizeof *all); i++) {
        err e = {0};
        const least t = least_of(cut_once, &all[i], &e);
        ok(!e.status && t.many < most * t.few, "%s of %d corners takes %.3g times as long as of %d%s %s", all[i].what,
           MANY, t.many / t.few, FEW, all[i].simple ? ", and all of it is covered once" : "", e.text);
    }
}

/* Two plates of so many triangles in all, which close a region but for its rim; half as many points between them, in
 * line with their edges. Returns how many lie between. */

enum { ACROSS = 50 };

static int64_t plates(int count, double *position, int32_t *corner, triangle_tree **made, err *e)
{
    const int long_ = count / 4 / ACROSS, side = (ACROSS + 1) * (long_ + 1);
    int64_t triangles = 0;
    for (int v = 0; v < 2 * side; v++) {
        position[3 * v] = v % side % (ACROSS + 1);
        position[3 * v + 1] = v % side / (ACROSS + 1);
        position[3 * v + 2] = v / side * 2 - 1;
    }
    for (int v = 0; v < 2 * side; v++) {
        const int i = v % side % (ACROSS + 1), right = v < side ? ACROSS + 1 : 1, up = v < side ? 1 : ACROSS + 1;
        if (i == ACROSS || v % side / (ACROSS + 1) == long_)
            continue;
        const int32_t both[6] = {v, v + right, v + right + up, v, v + right + up, v + up};
        memcpy(corner + 3 * triangles, both, sizeof both);
        triangles += 2;
    }
    *made = triangle_tree_create(position, corner, triangles, e);
    return side;
}

static double hold_once(const void *one, int count, err *e)
{
    double *position = malloc(12 * (size_t)count * sizeof *position);
    int32_t *corner = malloc(6 * (size_t)count * sizeof *corner);
    triangle_tree *tree = NULL;
    (void)one;
    clock_t from = clock();
    const int64_t points = plates(count, position, corner, &tree, e);
    int64_t held = 0;
    for (int64_t i = 0; tree && i < points; i++) {
        const double *x = position + 3 * i, between[3] = {x[0], x[1], -.25};
        held += triangle_tree_holds(tree, between);
    }
    double took = (double)(clock() - from);
    if (tree && held < points * 4 / 5)
        err_set(e, NULL, 0, "%lld of %lld points lie between", (long long)held, (long long)points);
    triangle_tree_destroy(tree);
    free(position);
    free(corner);
    return took;
}

static void test_insides(void)
{
    err e = {0};
    const least t = least_of(hold_once, NULL, &e);
    ok(!e.status && t.many < most * t.few,
       "%d triangles and as many points take %.3g times as long as %d: which points are inside? %s", MANY,
       t.many / t.few, FEW, e.text);
}

int main(void)
{
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, -1); /* never */
    test_names();
    test_polygons();
    test_insides();
    return done_testing();
}
