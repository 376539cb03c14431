/* Lets allocations fail: preloaded into a program (LD_PRELOAD), it counts them from the beginning of main on, and the
 * one whose number SINEW_FAULT_AT gives, from 1, gets nothing; with SINEW_FAULT_ON set, so do all after it. Where
 * SINEW_FAULT_COUNT names a file, it gets their number at the end. Where SINEW_FAULT_DEATH names one, that gets the
 * program's and libraries' names that a program which dies by SIGSEGV, SIGBUS or SIGABRT was in, the innermost first, a
 * line a call. For the GNU C library, whose own names for these functions it uses.
 */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1 /* Dl_info, RTLD_NEXT */
#endif
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of the C library begin with __
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *p, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
int __libc_start_main(int (*begin)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end);
void *memalign(size_t alignment, size_t size);

static struct {
    atomic_llong count;
    long long at;
    bool on, counting;
    int (*begin)(int, char **, char **);
} fault;

static bool fails(void)
{
    if (!fault.counting)
        return false;
    const long long n = atomic_fetch_add(&fault.count, 1) + 1;
    if (!fault.at || (fault.on ? n < fault.at : n != fault.at))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *p, size_t size)
{
    return fails() ? NULL : __libc_realloc(p, size);
}

void *memalign(size_t alignment, size_t size)
{
    return fails() ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **p, size_t alignment, size_t size)
{
    if (fails())
        return ENOMEM;
    *p = __libc_memalign(alignment, size);
    return *p ? 0 : ENOMEM;
}

/* Without stdio, which allocates. */
static void tell(void)
{
    const char *path = getenv("SINEW_FAULT_COUNT");
    char text[40];
    fault.counting = false;
    if (!path)
        return;
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    int n = snprintf(text, sizeof text, "%lld\n", (long long)atomic_load(&fault.count));
    if (fd >= 0 && write(fd, text, (size_t)n) != n)
        abort();
    close(fd);
}

enum { CALLS = 100 };

/* Whose code it was in. */
static void tell_death(int signal_number)
{
    void *call[CALLS];
    Dl_info at;
    fault.counting = false;
    signal(signal_number, SIG_DFL);
    const char *path = getenv("SINEW_FAULT_DEATH");
    int fd = path ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    int calls = backtrace(call, CALLS);
    for (int i = 1; fd >= 0 && i < calls; i++)
        if (dladdr(call[i], &at) && at.dli_fname)
            dprintf(fd, "%s\n", at.dli_fname);
    raise(signal_number);
}

static void watch_deaths(void)
{
    static char stack[1 << 16];
    void *call[1];
    const stack_t own = {.ss_sp = stack, .ss_size = sizeof stack};
    if (!getenv("SINEW_FAULT_DEATH") || !backtrace(call, 1)) /* it loads what it needs, the first time */
        return;
    sigaltstack(&own, NULL);
    const int signals[] = {SIGSEGV, SIGBUS, SIGABRT};
    for (int i = 0; i < 3; i++)
        sigaction(signals[i], &(struct sigaction){.sa_handler = tell_death, .sa_flags = SA_ONSTACK}, NULL);
}

static int begin_counting(int argc, char **argv, char **environment)
{
    const char *at = getenv("SINEW_FAULT_AT");
    fault.at = at ? atoll(at) : 0;
    fault.on = getenv("SINEW_FAULT_ON") != NULL;
    atexit(tell);
    watch_deaths();
    fault.counting = true;
    return fault.begin(argc, argv, environment);
}

int __libc_start_main(int (*begin)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*rtld_fini)(void), void *stack_end)
{
    int (*next)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);
    void *found = dlsym(RTLD_NEXT, "__libc_start_main");
    memcpy(&next, &found, sizeof next);
    fault.begin = begin;
    return next(begin_counting, argc, argv, init, fini, rtld_fini, stack_end);
}
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
