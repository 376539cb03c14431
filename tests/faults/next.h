/* For libraries that are preloaded: the C library's own functions, behind the library's of the same names. */
#ifndef SINEW_FAULTS_NEXT_H
#define SINEW_FAULTS_NEXT_H

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

static void *real_function(const char *name)
{
    void *found = dlsym(RTLD_NEXT, name);
    if (!found)
        abort();
    return found;
}

/* Declares `next`, the C library's function of that name. */
#define NEXT(type, name, ...)                                                                                          \
    type (*next)(__VA_ARGS__);                                                                                         \
    void *found = real_function(name);                                                                                 \
    memcpy(&next, &found, sizeof next)

#endif
