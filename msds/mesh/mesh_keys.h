/* Numbers by keys: a hash table of what was put in, in the order of putting it in. Keys are places of a lattice, packed
 * with z first, so that they ascend as nodes of a lattice are numbered. The creator owns it; a zeroed one is empty.
 */
#ifndef SINEW_MESH_KEYS_H
#define SINEW_MESH_KEYS_H

#include "base/err.h"

#include <stdint.h>

enum { MESH_KEY_BITS = 20 }; /* of each coordinate: 0 to MESH_KEY_MOST */
#define MESH_KEY_MOST ((1 << MESH_KEY_BITS) - 1)

typedef struct mesh_keys {
    int64_t *key; /* count, in the order in which they came */
    int64_t count, capacity;
    int32_t *slot; /* slots: a key's number + 1; 0: free */
    int64_t slots; /* a power of 2; 0: none yet */
} mesh_keys;

static inline int64_t mesh_key(const int32_t at[3])
{
    return ((int64_t)at[2] << 2 * MESH_KEY_BITS) | ((int64_t)at[1] << MESH_KEY_BITS) | at[0];
}

static inline void mesh_key_place(int64_t key, int32_t at[3])
{
    for (int a = 0; a < 3; a++)
        at[a] = (int32_t)(key >> a * MESH_KEY_BITS & MESH_KEY_MOST);
}

/* The number of a key, from 0; -1: it is not there. */
int64_t mesh_keys_find(const mesh_keys *k, int64_t key);

/* The same; one that is not there is put in. -1 with e filled: more than can be numbered, no memory. */
int64_t mesh_keys_put(mesh_keys *k, int64_t key, err *e);
void mesh_keys_free(mesh_keys *k);

#endif
