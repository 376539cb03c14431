#include "msds/mesh/mesh_keys.h"

#include "base/mem.h"

#include <stdlib.h>

enum { SLOTS_LEAST = 1024 };

/* Where a key stands, or the free slot where it would (Fibonacci hashing, linear probing). */
static int64_t slot_of(const mesh_keys *k, int64_t key)
{
    int64_t at = (int64_t)(((uint64_t)key * 0x9E3779B97F4A7C15ULL) >> 24) & (k->slots - 1);
    while (k->slot[at] && k->key[k->slot[at] - 1] != key)
        at = (at + 1) & (k->slots - 1);
    return at;
}

int64_t mesh_keys_find(const mesh_keys *k, int64_t key)
{
    return k->slots ? (int64_t)k->slot[slot_of(k, key)] - 1 : -1;
}

/* At most half of the slots are taken. */
static int widen(mesh_keys *k, err *e)
{
    const int64_t slots = k->slots ? 2 * k->slots : SLOTS_LEAST;
    int32_t *slot = mem_array(slots, sizeof *slot, "nodes of cells", e);
    if (!slot)
        return -1;
    free(k->slot);
    k->slot = slot;
    k->slots = slots;
    for (int64_t i = 0; i < k->count; i++)
        k->slot[slot_of(k, k->key[i])] = (int32_t)(i + 1);
    return 0;
}

int64_t mesh_keys_put(mesh_keys *k, int64_t key, err *e)
{
    if (2 * (k->count + 1) > k->slots && widen(k, e))
        return -1;
    const int64_t at = slot_of(k, key);
    if (k->slot[at])
        return k->slot[at] - 1;
    if (k->count >= INT32_MAX - 1)
        return err_set(e, NULL, 0, "more cells or nodes than can be numbered; expected at most %d", INT32_MAX - 1);
    if (MEM_ROOM(&k->key, &k->capacity, k->count + 1, "nodes of cells", e))
        return -1;
    k->key[k->count++] = key;
    k->slot[at] = (int32_t)k->count;
    return k->count - 1;
}

void mesh_keys_free(mesh_keys *k)
{
    free(k->key);
    free(k->slot);
    *k = (mesh_keys){0};
}
