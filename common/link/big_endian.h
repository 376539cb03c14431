/* Numbers of the network's byte order, the most significant byte first, in bytes of any alignment. Owns nothing.
 */
#ifndef SINEW_BIG_ENDIAN_H
#define SINEW_BIG_ENDIAN_H

#include <stdint.h>
#include <string.h>

/* The number in `size` (1 to 8) bytes. */
static inline uint64_t big_endian_get(const unsigned char *from, int size)
{
    uint64_t v = 0;
    for (int i = 0; i < size; i++)
        v = v << 8 | from[i];
    return v;
}

/* Writes the lowest `size` bytes of v, and returns the place after them. */
static inline unsigned char *big_endian_put(unsigned char *to, uint64_t v, int size)
{
    for (int i = 0; i < size; i++)
        to[i] = (unsigned char)(v >> (8 * (size - 1 - i)));
    return to + size;
}

static inline double big_endian_get_float(const unsigned char *from)
{
    const uint32_t bits = (uint32_t)big_endian_get(from, 4);
    float v;
    memcpy(&v, &bits, sizeof v);
    return (double)v;
}

static inline unsigned char *big_endian_put_float(unsigned char *to, double value)
{
    const float v = (float)value;
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    return big_endian_put(to, bits, 4);
}

static inline double big_endian_get_double(const unsigned char *from)
{
    const uint64_t bits = big_endian_get(from, 8);
    double v;
    memcpy(&v, &bits, sizeof v);
    return v;
}

static inline unsigned char *big_endian_put_double(unsigned char *to, double v)
{
    uint64_t bits;
    memcpy(&bits, &v, sizeof bits);
    return big_endian_put(to, bits, 8);
}

/* Copies text into a field of `size` bytes, which zeros fill up, cut where it is longer; the place after the field. */
static inline unsigned char *big_endian_put_text(unsigned char *to, const char *text, size_t size)
{
    const size_t n = strnlen(text, size);
    memcpy(to, text, n);
    memset(to + n, 0, size - n);
    return to + size;
}

/* The text of a field of `size` bytes, which may end with zeros; to has size + 1 bytes. */
static inline void big_endian_get_text(char *to, const unsigned char *from, size_t size)
{
    memcpy(to, from, size);
    to[size] = '\0';
}

#endif
