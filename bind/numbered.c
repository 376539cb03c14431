#include "bind/numbered.h"

#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Reads the conversion at the pattern's first '%'. */
static bool read_conversion(numbered *n)
{
    const char *percent = strchr(n->pattern, '%'), *p = percent;
    if (!p)
        return false;
    n->zeros = *++p == '0';
    for (; *p >= '0' && *p <= '9' && n->width < 100; p++)
        n->width = 10 * n->width + (*p - '0');
    n->from = (size_t)(percent - n->pattern);
    n->to = (size_t)(p + 1 - n->pattern);
    return *p == 'd' && n->width <= 18 && !strchr(p, '%');
}

int numbered_of(numbered *n, const char *pattern, err *e)
{
    *n = (numbered){.pattern = pattern};
    if (pattern && read_conversion(n))
        return 0;
    if (!pattern)
        err_set(e, NULL, 0, "--frame all writes a file a frame; expected -o with %%04d in the name, or --format pc2");
    else
        err_set(e, NULL, 0, "-o '%s': expected one number, such as %%04d, in the name and no other '%%'", pattern);
    e->status = STATUS_USAGE;
    return -1;
}

char *numbered_name(const numbered *n, int64_t index, err *e)
{
    size_t size = strlen(n->pattern) + 32;
    char *name = mem_array((int64_t)size, 1, "a file's name", e);
    if (!name)
        return NULL;
    if (n->zeros)
        snprintf(name, size, "%.*s%0*lld%s", (int)n->from, n->pattern, n->width, (long long)index, n->pattern + n->to);
    else
        snprintf(name, size, "%.*s%*lld%s", (int)n->from, n->pattern, n->width, (long long)index, n->pattern + n->to);
    return name;
}

int numbered_add(numbered *n, int64_t index, err *e)
{
    if (mem_grow(&n->written, &n->capacity, n->count + 1, sizeof *n->written, "frames", e))
        return -1;
    n->written[n->count++] = index;
    return 0;
}

void numbered_remove(const numbered *n)
{
    for (int64_t i = 0; i < n->count; i++) {
        err ignored = {0};
        char *name = numbered_name(n, n->written[i], &ignored);
        if (name)
            unlink(name);
        free(name);
    }
}

void numbered_free(numbered *n)
{
    free(n->written);
    *n = (numbered){0};
}
