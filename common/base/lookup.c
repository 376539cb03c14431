#include "base/lookup.h"

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

static const char *name_of(const void *things, size_t size, int32_t i)
{
    const char *name;
    memcpy(&name, (const char *)things + (size_t)i * size, sizeof name);
    return name;
}

/* The slot that holds the name, or the free one where it belongs. */
static int32_t *find_slot(const lookup *l, const void *things, size_t size, const char *name)
{
    int64_t at = (int64_t)(hash(name) & (uint64_t)(l->slots - 1));
    while (l->slot[at] >= 0 && strcmp(name_of(things, size, l->slot[at]), name) != 0)
        at = (at + 1) & (l->slots - 1);
    return &l->slot[at];
}

int32_t lookup_find(const lookup *l, const void *things, size_t size, const char *name)
{
    return l->slots ? *find_slot(l, things, size, name) : -1;
}

static void take(lookup *l, const void *things, size_t size, int32_t count)
{
    for (; l->count < count; l->count++) {
        int32_t *slot = find_slot(l, things, size, name_of(things, size, l->count));
        if (*slot < 0)
            *slot = l->count;
    }
}

void lookup_again(lookup *l, const void *things, size_t size, int32_t count)
{
    if (l->slots)
        memset(l->slot, -1, (size_t)l->slots * sizeof *l->slot);
    l->count = 0;
    take(l, things, size, count);
}

/* Room for at least twice as many as there will be. */
static int grow(lookup *l, const void *things, size_t size, int32_t count, err *e)
{
    int64_t slots = l->slots ? l->slots : 16;
    while (slots < 2 * (int64_t)count)
        slots *= 4;
    int32_t *slot = mem_array(slots, sizeof *slot, "names", e);
    if (!slot)
        return -1;
    int32_t held = l->count;
    free(l->slot);
    l->slot = slot;
    l->slots = slots;
    lookup_again(l, things, size, held);
    return 0;
}

int lookup_add(lookup *l, const void *things, size_t size, int32_t count, err *e)
{
    if (2 * (int64_t)count > l->slots && grow(l, things, size, count, e))
        return -1;
    take(l, things, size, count);
    return 0;
}

void lookup_free(lookup *l)
{
    free(l->slot);
    *l = (lookup){0};
}
