/* TAP for unit tests in C: each test_NAME.c is a program that includes this once, calls ok() and near_(), and ends with
 * `return done_testing();`. The counts are this header's own.
 */
#ifndef SINEW_TAP_H
#define SINEW_TAP_H

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct tap {
    int count, failed;
} tap;

/* The one object of a test program that may change: which test it is at. */
static tap tap_state;

static inline void tap_line(bool passed, const char *format, va_list list) __attribute__((format(printf, 2, 0)));

static inline void tap_line(bool passed, const char *format, va_list list)
{
    tap_state.count++;
    tap_state.failed += !passed;
    printf("%sok %d - ", passed ? "" : "not ", tap_state.count);
    vprintf(format, list);
    printf("\n");
    fflush(stdout);
}

static inline bool tap_ok(bool passed, const char *file, int line, const char *what, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

static inline bool tap_ok(bool passed, const char *file, int line, const char *what, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    tap_line(passed, format, list);
    va_end(list);
    if (!passed)
        printf("# %s:%d: %s\n", file, line, what);
    return passed;
}

static inline bool tap_near(double got, double want, double tolerance, const char *file, int line, const char *format,
                            ...) __attribute__((format(printf, 6, 7)));

static inline bool tap_near(double got, double want, double tolerance, const char *file, int line, const char *format,
                            ...)
{
    bool passed = fabs(got - want) <= tolerance; /* false for a nan */
    va_list list;
    va_start(list, format);
    tap_line(passed, format, list);
    va_end(list);
    if (!passed)
        printf("# %s:%d: got %.17g, wanted %.17g to within %g\n", file, line, got, want, tolerance);
    return passed;
}

/* ok(condition, format, ...): one test. Returns whether it passed. */
#define ok(condition, ...) tap_ok((condition), __FILE__, __LINE__, #condition, __VA_ARGS__)

/* near_(got, want, tolerance, format, ...): |got - want| <= tolerance, absolute. Returns whether it passed. */
#define near_(got, want, tolerance, ...) tap_near((got), (want), (tolerance), __FILE__, __LINE__, __VA_ARGS__)

/* n tests that cannot be made here. */
static inline void skip(int n, const char *why)
{
    while (n-- > 0)
        printf("ok %d # skip %s\n", ++tap_state.count, why);
}

/* The plan, last: main returns what this returns. */
static inline int done_testing(void)
{
    printf("1..%d\n", tap_state.count);
    return tap_state.failed != 0;
}

#endif
