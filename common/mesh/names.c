#include "mesh/names.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* FNV-1a */
static uint64_t hash(const char *text)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (; *text; text++)
        h = (h ^ (unsigned char)*text) * UINT64_C(1099511628211);
    return h;
}

/* The slot that holds the name, or the free one where it belongs. */
static int32_t *find_slot(const names *n, const char *name)
{
    int64_t at = (int64_t)(hash(name) & (uint64_t)(n->slots - 1));
    while (n->slot[at] >= 0 && strcmp(n->name[n->slot[at]], name) != 0)
        at = (at + 1) & (n->slots - 1);
    return &n->slot[at];
}

static int grow_slots(names *n, err *e)
{
    int64_t slots = n->slots ? n->slots * 4 : 64;
    int32_t *slot = mem_array(slots, sizeof *slot, "names", e);
    if (!slot)
        return -1;
    memset(slot, -1, (size_t)slots * sizeof *slot);
    free(n->slot);
    n->slot = slot;
    n->slots = slots;
    for (int32_t i = 0; i < n->count; i++)
        *find_slot(n, n->name[i]) = i;
    return 0;
}

int32_t names_number(names *n, const char *name, err *e)
{
    if (2 * (int64_t)n->count >= n->slots && grow_slots(n, e))
        return -1;
    int32_t *slot = find_slot(n, name);
    if (*slot >= 0)
        return *slot;
    if (n->count == INT32_MAX)
        return err_set(e, NULL, 0, "more than %d names; expected fewer", INT32_MAX);
    if (mem_grow(&n->name, &n->room, (int64_t)n->count + 1, sizeof *n->name, "names", e))
        return -1;
    n->name[n->count] = mem_text(name, e);
    if (!n->name[n->count])
        return -1;
    return *slot = n->count++;
}

int32_t names_find(const names *n, const char *name)
{
    return n->slots ? *find_slot(n, name) : -1;
}

void names_free(names *n)
{
    for (int32_t i = 0; i < n->count; i++)
        free(n->name[i]);
    free(n->name);
    free(n->slot);
    *n = (names){0};
}
