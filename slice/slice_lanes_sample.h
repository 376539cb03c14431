/* The samples of slice_lanes.h; a part of slice_lanes_loops.h, which includes it once INLINE is there. Everything here is static.
 */
/* ---- samples: linear along z, x and y, in 16 bits: 8 of grey and 7 below them, each product rounded to the nearest. Places past
 * the ends of the volume are brought to them, so that no number reads what is not there. */

INLINE int16_t between(int16_t a, int16_t b, int32_t share)
{
    return (int16_t)(a + (((b - a) * share + 0x4000) >> 15));
}

INLINE uint8_t sample_one(const slice_cells *c, uint32_t x, uint32_t y, uint32_t z)
{
    const uint32_t most[3] = {(uint32_t)(c->size[0] + 1) * SLICE_ONE - 1, (uint32_t)(c->size[1] + 1) * SLICE_ONE - 1,
                              (uint32_t)c->black};
    x = x < most[0] ? x : most[0];
    y = y < most[1] ? y : most[1];
    z = z < most[2] ? z : most[2];
    const int32_t fx = (int32_t)(x & 0xffff) >> 1, fy = (int32_t)(y & 0xffff) >> 1, fz = (int32_t)(z & 0xffff) >> 1;
    const int64_t at = (int64_t)(x >> 16) + (int64_t)(y >> 16) * c->row + (int64_t)(z >> 16) * c->layer;
    const uint64_t word = c->word[at];
    int16_t v[4];
    for (int i = 0; i < 4; i++)
        v[i] = between((int16_t)((word >> 8 * i & 0xff) << 7), (int16_t)((word >> (8 * i + 32) & 0xff) << 7), fz);
    return (uint8_t)((between(between(v[0], v[1], fx), between(v[2], v[3], fx), fy) + 64) >> 7);
}

#if defined(__AVX512BW__)

INLINE __m128i pair(const uint64_t *word, int32_t a, int32_t b)
{
    return _mm_insert_epi64(_mm_loadl_epi64((const __m128i *)(const void *)(word + a)), (long long)word[b], 1);
}

/* Words of pixels 0 1, 4 5, 8 9 and 12 13 of `at`: with those of 2 3 and so on, one shuffle brings halves in order. A gather is slower. */
INLINE __m512i words(const uint64_t *word, const int32_t *at)
{
    const __m256i low = _mm256_set_m128i(pair(word, at[4], at[5]), pair(word, at[0], at[1]));
    const __m256i high = _mm256_set_m128i(pair(word, at[12], at[13]), pair(word, at[8], at[9]));
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

INLINE __m512i share(__m512i fraction)
{
    const __m512i twice = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13));
    return _mm512_srli_epi16(_mm512_shuffle_epi8(fraction, twice), 1);
}

INLINE __m512i mix(__m512i a, __m512i b, __m512i by)
{
    return _mm512_add_epi16(a, _mm512_mulhrs_epi16(_mm512_sub_epi16(b, a), by));
}

static void sample(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                   uint8_t *to)
{
    const __m512i row = _mm512_set1_epi32(c->row), layer = _mm512_set1_epi32(c->layer);
    const __m512i low = _mm512_set1_epi16(0xff), half = _mm512_set1_epi16(64);
    const __m512i xe = _mm512_set1_epi32((c->size[0] + 1) * SLICE_ONE - 1);
    const __m512i ye = _mm512_set1_epi32((c->size[1] + 1) * SLICE_ONE - 1), ze = _mm512_set1_epi32(c->black);
    int64_t i = 0;
    for (; i + 16 <= count; i += 16) {
        const __m512i px = _mm512_min_epu32(_mm512_loadu_si512(x + i), xe);
        const __m512i py = _mm512_min_epu32(_mm512_loadu_si512(y + i), ye);
        const __m512i pz = _mm512_min_epu32(_mm512_loadu_si512(z + i), ze);
        const __m512i at = _mm512_add_epi32(_mm512_srli_epi32(px, 16),
                                            _mm512_add_epi32(_mm512_mullo_epi32(_mm512_srli_epi32(py, 16), row),
                                                             _mm512_mullo_epi32(_mm512_srli_epi32(pz, 16), layer)));
        int32_t index[16];
        _mm512_storeu_si512(index, at);
        const __m512 first = _mm512_castsi512_ps(words(c->word, index)),
                     last = _mm512_castsi512_ps(words(c->word, index + 2));
        const __m512i a = _mm512_castps_si512(_mm512_shuffle_ps(first, last, 0x88));
        const __m512i b = _mm512_castps_si512(_mm512_shuffle_ps(first, last, 0xdd));
        const __m512i fx = share(px), fy = share(py), fz = share(pz);
        const __m512i left =
            mix(_mm512_slli_epi16(_mm512_and_si512(a, low), 7), _mm512_slli_epi16(_mm512_and_si512(b, low), 7), fz);
        const __m512i right =
            mix(_mm512_slli_epi16(_mm512_srli_epi16(a, 8), 7), _mm512_slli_epi16(_mm512_srli_epi16(b, 8), 7), fz);
        const __m512i both = mix(left, right, fx);
        const __m512i value = mix(both, _mm512_srli_epi32(both, 16), fy);
        _mm_storeu_si128((void *)(to + i), _mm512_cvtepi32_epi8(_mm512_srli_epi16(_mm512_add_epi16(value, half), 7)));
    }
    for (; i < count; i++)
        to[i] = sample_one(c, (uint32_t)x[i], (uint32_t)y[i], (uint32_t)z[i]);
}

#elif defined(__AVX2__)

INLINE __m128i pair(const uint64_t *word, int32_t a, int32_t b)
{
    return _mm_insert_epi64(_mm_loadl_epi64((const __m128i *)(const void *)(word + a)), (long long)word[b], 1);
}

INLINE __m256 words(const uint64_t *word, const int32_t *at)
{
    return _mm256_castsi256_ps(_mm256_set_m128i(pair(word, at[4], at[5]), pair(word, at[0], at[1])));
}

INLINE __m256i share(__m256i fraction)
{
    const __m256i twice = _mm256_setr_epi8(0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13, 0, 1, 0, 1, 4, 5, 4, 5,
                                           8, 9, 8, 9, 12, 13, 12, 13);
    return _mm256_srli_epi16(_mm256_shuffle_epi8(fraction, twice), 1);
}

INLINE __m256i mix(__m256i a, __m256i b, __m256i by)
{
    return _mm256_add_epi16(a, _mm256_mulhrs_epi16(_mm256_sub_epi16(b, a), by));
}

INLINE __m256i within8(const int32_t *p, int32_t most)
{
    return _mm256_min_epu32(_mm256_loadu_si256((const __m256i *)(const void *)p), _mm256_set1_epi32(most));
}

static void sample(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                   uint8_t *to)
{
    const __m256i row = _mm256_set1_epi32(c->row), layer = _mm256_set1_epi32(c->layer);
    const __m256i low = _mm256_set1_epi16(0xff), half = _mm256_set1_epi16(64);
    const __m256i bytes = _mm256_setr_epi8(0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 4, 8, 12, -1,
                                           -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
    int64_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256i px = within8(x + i, (c->size[0] + 1) * SLICE_ONE - 1);
        const __m256i py = within8(y + i, (c->size[1] + 1) * SLICE_ONE - 1), pz = within8(z + i, c->black);
        const __m256i at = _mm256_add_epi32(_mm256_srli_epi32(px, 16),
                                            _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srli_epi32(py, 16), row),
                                                             _mm256_mullo_epi32(_mm256_srli_epi32(pz, 16), layer)));
        int32_t index[8];
        _mm256_storeu_si256((__m256i *)(void *)index, at);
        const __m256 first = words(c->word, index), last = words(c->word, index + 2);
        const __m256i a = _mm256_castps_si256(_mm256_shuffle_ps(first, last, 0x88));
        const __m256i b = _mm256_castps_si256(_mm256_shuffle_ps(first, last, 0xdd));
        const __m256i fx = share(px), fy = share(py), fz = share(pz);
        const __m256i left =
            mix(_mm256_slli_epi16(_mm256_and_si256(a, low), 7), _mm256_slli_epi16(_mm256_and_si256(b, low), 7), fz);
        const __m256i right =
            mix(_mm256_slli_epi16(_mm256_srli_epi16(a, 8), 7), _mm256_slli_epi16(_mm256_srli_epi16(b, 8), 7), fz);
        const __m256i both = mix(left, right, fx);
        const __m256i value = mix(both, _mm256_srli_epi32(both, 16), fy);
        const __m256i packed = _mm256_shuffle_epi8(_mm256_srli_epi16(_mm256_add_epi16(value, half), 7), bytes);
        const int32_t four[2] = {_mm256_extract_epi32(packed, 0), _mm256_extract_epi32(packed, 4)};
        memcpy(to + i, four, sizeof four);
    }
    for (; i < count; i++)
        to[i] = sample_one(c, (uint32_t)x[i], (uint32_t)y[i], (uint32_t)z[i]);
}

#else

static void sample(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                   uint8_t *to)
{
    for (int64_t i = 0; i < count; i++)
        to[i] = sample_one(c, (uint32_t)x[i], (uint32_t)y[i], (uint32_t)z[i]);
}

#endif
