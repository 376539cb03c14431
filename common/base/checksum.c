#include "base/checksum.h"

#include <zlib.h>

/* By folding (Gopal et al., Fast CRC Computation for Generic Polynomials Using PCLMULQDQ, 2009): a message is a
 * polynomial over GF(2), its checksum the rest modulo P. 16 bytes d bits before the end of a stretch may be replaced by
 * any that are equal modulo P: their halves times x^(d+32) mod P and x^(d-32) mod P, added to those that stand there.
 * Four such sums side by side, 512 bits apart; then each onto the next, 128 apart. What is left, 16 bytes, goes through
 * zlib, as does what follows. Where the processor multiplies four pairs at once, sixteen sums come before, 2048 bits
 * apart. Bits are reflected, as in this checksum the first bit of a byte is its lowest. */
#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

/* Bytes: fewer go through zlib alone; by four sums alone. */
enum { LEAST = 256, LEAST_WIDE = 2048 };

/* x^n mod P, P = x^32 + x^26 + x^23 + x^22 + x^16 + x^12 + x^11 + x^10 + x^8 + x^7 + x^5 + x^4 + x^2 + x + 1, its bits
 * reflected and moved up by one, since a product of reflected numbers is short of one bit. */
#define X_2080 0x11542778a
#define X_2016 0x1322d1430
#define X_544  0x154442bd4
#define X_480  0x1c6e41596
#define X_160  0x1751997d0
#define X_96   0x0ccaa009e

#define FOLDS __attribute__((target("pclmul,sse4.1")))

FOLDS static inline __m128i fold(__m128i from, __m128i by, __m128i onto)
{
    __m128i first = _mm_clmulepi64_si128(from, by, 0x00), second = _mm_clmulepi64_si128(from, by, 0x11);
    return _mm_xor_si128(onto, _mm_xor_si128(first, second));
}

FOLDS static inline __m128i load(const unsigned char *p)
{
    return _mm_loadu_si128((const __m128i *)(const void *)p);
}

/* The checksum of what four sums stand for, and of what follows them. */
FOLDS static uint32_t fold_rest(__m128i sum[4], const unsigned char *p, size_t size)
{
    const __m128i far = _mm_set_epi64x(X_480, X_544), near = _mm_set_epi64x(X_96, X_160);
    unsigned char left[16];
    for (; size >= 64; p += 64, size -= 64)
        for (int i = 0; i < 4; i++)
            sum[i] = fold(sum[i], far, load(p + 16 * i));
    for (int i = 1; i < 4; i++)
        sum[i] = fold(sum[i - 1], near, sum[i]);
    for (; size >= 16; p += 16, size -= 16)
        sum[3] = fold(sum[3], near, load(p));
    _mm_storeu_si128((__m128i *)(void *)left, sum[3]);
    /* ~0: a register of zeros. */
    return (uint32_t)crc32_z(crc32_z(UINT32_MAX, left, sizeof left), p, size);
}

/* size: at least 64. */
FOLDS static uint32_t by_folding(uint32_t crc, const unsigned char *p, size_t size)
{
    __m128i sum[4];
    for (int i = 0; i < 4; i++)
        sum[i] = load(p + 16 * i);
    sum[0] = _mm_xor_si128(sum[0], _mm_cvtsi32_si128((int)~crc));
    return fold_rest(sum, p + 64, size - 64);
}

#define FOLDS_WIDE __attribute__((target("vpclmulqdq,avx512f,pclmul")))

/* size: at least 256. */
FOLDS_WIDE static uint32_t by_folding_wide(uint32_t crc, const unsigned char *p, size_t size)
{
    const __m512i far = _mm512_set4_epi64(X_2016, X_2080, X_2016, X_2080);
    const __m128i nearer = _mm_set_epi64x(X_480, X_544);
    unsigned char left[256];
    __m512i wide[4];
    __m128i sum[4];
    for (int i = 0; i < 4; i++)
        wide[i] = _mm512_loadu_si512(p + 64 * i);
    wide[0] = _mm512_xor_si512(wide[0], _mm512_zextsi128_si512(_mm_cvtsi32_si128((int)~crc)));
    for (p += 256, size -= 256; size >= 256; p += 256, size -= 256)
        for (int i = 0; i < 4; i++) {
            const __m512i first = _mm512_clmulepi64_epi128(wide[i], far, 0x00),
                          second = _mm512_clmulepi64_epi128(wide[i], far, 0x11);
            wide[i] = _mm512_xor_si512(_mm512_loadu_si512(p + 64 * i), _mm512_xor_si512(first, second));
        }
    for (int i = 0; i < 4; i++)
        _mm512_storeu_si512(left + 64 * i, wide[i]);
    for (int i = 0; i < 4; i++)
        sum[i] = load(left + 16 * i);
    for (int i = 4; i < 16; i++)
        sum[i % 4] = fold(sum[i % 4], nearer, load(left + 16 * i));
    return fold_rest(sum, p, size);
}

uint32_t checksum_add(uint32_t crc, const void *bytes, size_t size)
{
    if (!size) /* of no bytes at NULL zlib would begin anew */
        return crc;
    if (size >= LEAST_WIDE && __builtin_cpu_supports("vpclmulqdq") && __builtin_cpu_supports("avx512f"))
        return by_folding_wide(crc, bytes, size);
    if (size >= LEAST && __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("sse4.1"))
        return by_folding(crc, bytes, size);
    return (uint32_t)crc32_z(crc, bytes, size);
}

#else

uint32_t checksum_add(uint32_t crc, const void *bytes, size_t size)
{
    if (!size)
        return crc;
    return (uint32_t)crc32_z(crc, bytes, size);
}

#endif
