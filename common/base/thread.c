#include "base/thread.h"

#include <stddef.h>

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
