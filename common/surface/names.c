#include "surface/names.h"

#include "base/mem.h"

#include <stdlib.h>

int32_t names_number(names *n, const char *name, err *e)
{
    int32_t at = names_find(n, name);
    if (at >= 0)
        return at;
    if (n->count == INT32_MAX)
        return err_set(e, NULL, 0, "more than %d names; expected fewer", INT32_MAX);
    if (mem_grow(&n->name, &n->room, (int64_t)n->count + 1, sizeof *n->name, "names", e))
        return -1;
    n->name[n->count] = mem_text(name, e);
    if (!n->name[n->count])
        return -1;
    if (lookup_add(&n->index, n->name, sizeof *n->name, n->count + 1, e)) {
        free(n->name[n->count]);
        return -1;
    }
    return n->count++;
}

int32_t names_find(const names *n, const char *name)
{
    return lookup_find(&n->index, n->name, sizeof *n->name, name);
}

void names_free(names *n)
{
    for (int32_t i = 0; i < n->count; i++)
        free(n->name[i]);
    free(n->name);
    lookup_free(&n->index);
    *n = (names){0};
}
