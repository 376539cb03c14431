#define _GNU_SOURCE /* syscall */
#include "base/thread.h"

#include <signal.h>
#include <stddef.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

/* What ulimit -s is where nobody has set it. Only what is touched takes memory. */
static const size_t stack_size = (size_t)8 << 20;

int thread_start(pthread_t *thread, void *(*work)(void *), void *context)
{
    pthread_attr_t how;
    int code = pthread_attr_init(&how);
    if (code)
        return code;
    code = pthread_attr_setstacksize(&how, stack_size);
    if (!code)
        code = pthread_create(thread, &how, work, context);
    pthread_attr_destroy(&how);
    return code;
}

int thread_start_quiet(pthread_t *thread, void *(*work)(void *), void *context)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    const int code = thread_start(thread, work, context);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return code;
}

int thread_condition(pthread_cond_t *condition)
{
    pthread_condattr_t how;
    int code = pthread_condattr_init(&how);
    if (code)
        return code;
    code = pthread_condattr_setclock(&how, CLOCK_MONOTONIC);
    if (!code)
        code = pthread_cond_init(condition, &how);
    pthread_condattr_destroy(&how);
    return code;
}

/* On Linux each thread has a priority of its own, which those that it starts begin with. Where it cannot be changed,
 * work only goes on less smoothly. */
void thread_yield_to_others(void)
{
    enum { NICE = 5 };
    (void)setpriority(PRIO_PROCESS, (id_t)syscall(SYS_gettid), NICE);
}
