/* Finds which of many things has a name, in a time that does not depend on how many there are, nor on who chose their
 * names: an index beside an array of structs, each of which begins with a pointer to its name. The things stay the
 * caller's, in the caller's order; the index holds their places, by a hash whose key is drawn at random for each index:
 * nothing may depend on the order of the slots. Begin with a zeroed one, and call lookup_add after things were added.
 * The creator owns it.
 */
#ifndef SINEW_LOOKUP_H
#define SINEW_LOOKUP_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

typedef struct lookup_slot {
    uint64_t hash; /* of the name */
    int32_t place; /* -1: free */
} lookup_slot;

typedef struct lookup {
    lookup_slot *slot;
    int64_t slots;   /* a power of two, or 0 */
    int32_t count;   /* how many things it holds: the first ones */
    uint64_t key[2]; /* of the hash */
} lookup;

/* The place of the first thing of that name, or -1. A thing has `size` bytes. */
int32_t lookup_find(const lookup *l, const void *things, size_t size, const char *name);

/* Takes in the things that were added behind those that it holds, so that it holds `count`. */
int lookup_add(lookup *l, const void *things, size_t size, int32_t count, err *e);

/* Things have moved: takes in the `count` that are there anew. Fewer than before need no memory, so this cannot
 * fail. */
void lookup_again(lookup *l, const void *things, size_t size, int32_t count);

void lookup_free(lookup *l);

#endif
