#include "cli/numbered.h"

#include "base/mem.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

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

int numbered_of(numbered *n, const char *pattern, const char *otherwise, err *e)
{
    *n = (numbered){.pattern = pattern};
    if (pattern && read_conversion(n))
        return 0;
    if (!pattern)
        return err_usage(e, "--frame all writes a file a frame; expected -o with %%04d in the name%s", otherwise);
    return err_usage(e, "-o '%s': expected one number, such as %%04d, in the name and no other '%%'", pattern);
}

bool numbered_is(const char *name)
{
    return name && read_conversion(&(numbered){.pattern = name});
}

char *numbered_name(const numbered *n, int64_t index, err *e)
{
    size_t size = strlen(n->pattern) + 32;
    char *name = mem_array((int64_t)size, 1, "a file's name", e);
    if (!name)
        return NULL;
    if (n->zeros)
        snprintf(name, size, "%.*s%0*" PRId64 "%s", (int)n->from, n->pattern, n->width, index, n->pattern + n->to);
    else
        snprintf(name, size, "%.*s%*" PRId64 "%s", (int)n->from, n->pattern, n->width, index, n->pattern + n->to);
    return name;
}
