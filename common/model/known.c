#include "model/known.h"

#include <stdio.h>
#include <string.h>

#define ROW(name, type, unit, axis, low, high, flags, maker, meaning)                                                  \
    {name, type, unit, axis, low, high, flags, maker, meaning},

static const known rows[] = {KNOWN_ARRAYS(ROW)};

enum { ROWS = sizeof rows / sizeof *rows };

/* The length of S in "S/vertex.position": what stands before the last slash. 0: the name is no surface's. */
static size_t surface_length(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? (size_t)(slash - name) : 0;
}

bool known_users(const char *name)
{
    return !strncmp(name, "x-", 2);
}

const known *known_find(const char *name)
{
    if (known_users(name))
        return NULL;
    size_t surface = surface_length(name);
    for (int i = 0; i < ROWS; i++) {
        bool any = rows[i].name[0] == '*';
        if (any ? surface && !strcmp(rows[i].name + 1, name + surface) : !strcmp(rows[i].name, name))
            return &rows[i];
    }
    return NULL;
}

const known *known_row(int i)
{
    return i >= 0 && i < ROWS ? &rows[i] : NULL;
}

void known_expand(const char *pattern, const char *name, char *to, size_t size)
{
    const char *star = strchr(pattern, '*');
    if (!star)
        snprintf(to, size, "%s", pattern);
    else
        snprintf(to, size, "%.*s%.*s%s", (int)(star - pattern), pattern, (int)surface_length(name), name, star + 1);
}
