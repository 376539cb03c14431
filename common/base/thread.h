/* Starts threads whose stack has one size, whatever ulimit -s says: by default a thread's stack is as large as that
 * limit, and computations, or a library that they call, may need more.
 */
#ifndef SINEW_THREAD_H
#define SINEW_THREAD_H

#include <pthread.h>

/* pthread_create() with a stack of 8 MiB. Returns 0, or an errno value. */
int thread_start(pthread_t *thread, void *(*work)(void *), void *context);

/* The same of a thread that gets no signals: these stay the main thread's, so that a handler never runs beside what it
 * looks at. */
int thread_start_quiet(pthread_t *thread, void *(*work)(void *), void *context);

/* pthread_cond_init() of a condition whose waits end by clock_now (base/clock.h), which only goes forward. Returns 0,
 * or an errno value. */
int thread_condition(pthread_cond_t *condition);

/* Lets other threads go first where processors are few: this one, and those that it starts from here on. */
void thread_yield_to_others(void);

#endif
