#include "base/lookup.h"

#include "base/mem.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

enum { START = 16 }; /* slots */

/* ---- SipHash-1-3 (Aumasson & Bernstein 2012): whoever does not know the key cannot make names that collide */

static uint64_t rotated(uint64_t x, int by)
{
    return x << by | x >> (64 - by);
}

static void mix(uint64_t v[4])
{
    v[0] += v[1], v[2] += v[3];
    v[1] = rotated(v[1], 13) ^ v[0], v[3] = rotated(v[3], 16) ^ v[2];
    v[0] = rotated(v[0], 32);
    v[2] += v[1], v[0] += v[3];
    v[1] = rotated(v[1], 17) ^ v[2], v[3] = rotated(v[3], 21) ^ v[0];
    v[2] = rotated(v[2], 32);
}

static void take_word(uint64_t v[4], uint64_t word)
{
    v[3] ^= word;
    mix(v);
    v[0] ^= word;
}

static uint64_t hash(const uint64_t key[2], const char *text)
{
    uint64_t v[4] = {key[0] ^ UINT64_C(0x736f6d6570736575), key[1] ^ UINT64_C(0x646f72616e646f6d),
                     key[0] ^ UINT64_C(0x6c7967656e657261), key[1] ^ UINT64_C(0x7465646279746573)};
    uint64_t word = 0, size = 0;
    for (; text[size]; size++) {
        word |= (uint64_t)(unsigned char)text[size] << size % 8 * 8;
        if (size % 8 == 7) {
            take_word(v, word);
            word = 0;
        }
    }
    take_word(v, word | size << 56);
    v[2] ^= 0xff;
    for (int i = 0; i < 3; i++)
        mix(v);
    return v[0] ^ v[1] ^ v[2] ^ v[3];
}

/* ---- the index */

static const char *name_of(const void *things, size_t size, int32_t i)
{
    const char *name;
    memcpy(&name, (const char *)things + (size_t)i * size, sizeof name);
    return name;
}

/* The slot that holds the name of that hash, or the free one where it belongs. */
static lookup_slot *find_slot(const lookup *l, const void *things, size_t size, const char *name, uint64_t h)
{
    lookup_slot *s = &l->slot[h & (uint64_t)(l->slots - 1)];
    while (s->place >= 0 && (s->hash != h || strcmp(name_of(things, size, s->place), name) != 0))
        s = s + 1 < l->slot + l->slots ? s + 1 : l->slot;
    return s;
}

int32_t lookup_find(const lookup *l, const void *things, size_t size, const char *name)
{
    return l->slots ? find_slot(l, things, size, name, hash(l->key, name))->place : -1;
}

static void take(lookup *l, const void *things, size_t size, int32_t count)
{
    for (; l->count < count; l->count++) {
        const char *name = name_of(things, size, l->count);
        uint64_t h = hash(l->key, name);
        lookup_slot *slot = find_slot(l, things, size, name, h);
        if (slot->place < 0)
            *slot = (lookup_slot){h, l->count};
    }
}

void lookup_again(lookup *l, const void *things, size_t size, int32_t count)
{
    for (int64_t i = 0; i < l->slots; i++)
        l->slot[i].place = -1;
    l->count = 0;
    take(l, things, size, count);
}

static int choose_key(lookup *l, err *e)
{
    if (getrandom(l->key, sizeof l->key, 0) != (ssize_t)sizeof l->key)
        return err_set(e, NULL, 0, "no random numbers for an index of names: %s", strerror(errno));
    return 0;
}

/* Room for at least twice as many as there will be. */
static int grow(lookup *l, const void *things, size_t size, int32_t count, err *e)
{
    int64_t slots = l->slots ? l->slots : START;
    while (slots < 2 * (int64_t)count)
        slots *= 4;
    if (!l->slots && choose_key(l, e))
        return -1;
    lookup_slot *slot = mem_array(slots, sizeof *slot, "names", e);
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
