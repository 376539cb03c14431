/* Hashing for open-addressed tables of numbers: sizes are powers of two, at least twice what they will hold. */
#ifndef SINEW_HASH_H
#define SINEW_HASH_H

#include <stdint.h>

/* Spreads every bit of x over all bits (the finaliser of splitmix64, Steele et al. 2014). */
static inline uint64_t hash_mix(uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* The hash of what went before and one number more. */
static inline uint64_t hash_next(uint64_t before, uint64_t x)
{
    return hash_mix(before * 0x9e3779b97f4a7c15u + x + 1);
}

/* A table's size for so many entries. */
static inline int64_t hash_size(int64_t entries)
{
    int64_t size = 16;
    while (size < 2 * entries)
        size *= 2;
    return size;
}

#endif
