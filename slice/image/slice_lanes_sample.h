/* The samples of slice_lanes.h; a part of slice_lanes_loops.c, which includes it once
 * INLINE is there. Everything here is static.
 */
/* ---- samples: linear along z, x and y, in 16 bits: 8 of grey and 7 below them, each product rounded to the nearest.
 * Places past the ends of the volume are brought to them, so that no number reads what is not there. */

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
    const uint32_t at = 9 * (x >> 16) + (y >> 16 & 1) + 3 * (z >> 16 & 1);
    const uint8_t *b = c->byte + (size_t)(z >> 17) * c->layer + (size_t)(y >> 17) * c->row + at;
    int16_t v[4];
    for (int i = 0; i < 4; i++) {
        const int j = 9 * (i & 1) + (i >> 1);
        v[i] = between((int16_t)(b[j] << 7), (int16_t)(b[j + 3] << 7), fz);
    }
    return (uint8_t)((between(between(v[0], v[1], fx), between(v[2], v[3], fx), fy) + 64) >> 7);
}

#if defined(__AVX2__)

/* The bytes of a cell as four of z - 1 and four of z: (x - 1, y - 1), (x, y - 1), (x - 1, y), (x, y). */
#define CELL_BYTES 0, 9, 1, 10, 3, 12, 4, 13
#define NO_BYTES   -1, -1, -1, -1, -1, -1, -1, -1

INLINE __m128i cell(const uint8_t *byte, uint32_t at)
{
    return _mm_loadu_si128((const __m128i *)(const void *)(byte + at));
}

INLINE __m256i cells(const uint8_t *byte, uint32_t a, uint32_t b)
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(cell(byte, a)), cell(byte, b), 1);
}

#endif

#if defined(__AVX512BW__)

INLINE __m512i four_cells(const uint8_t *byte, const uint32_t *at)
{
    return _mm512_inserti64x4(_mm512_castsi256_si512(cells(byte, at[0], at[4])), cells(byte, at[8], at[12]), 1);
}

/* Cells of pixels 0 1, 4 5, 8 9 and 12 13 of `at`: with those of 2 3 and so on, one shuffle brings halves in order. A
 * gather is slower. */
INLINE __m512i words(const uint8_t *byte, const uint32_t *at)
{
    const __m512i even = _mm512_broadcast_i32x4(_mm_setr_epi8(CELL_BYTES, NO_BYTES));
    const __m512i odd = _mm512_broadcast_i32x4(_mm_setr_epi8(NO_BYTES, CELL_BYTES));
    return _mm512_or_si512(_mm512_shuffle_epi8(four_cells(byte, at), even),
                           _mm512_shuffle_epi8(four_cells(byte, at + 1), odd));
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

static void sample_near(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        uint8_t *to)
{
    const __m512i row = _mm512_set1_epi32((int32_t)c->row), layer = _mm512_set1_epi32((int32_t)c->layer);
    const __m512i second = _mm512_set1_epi32(SLICE_ONE), one = _mm512_set1_epi32(1), three = _mm512_set1_epi32(3);
    const __m512i low = _mm512_set1_epi16(0xff), half = _mm512_set1_epi16(64);
    const __m512i xe = _mm512_set1_epi32((c->size[0] + 1) * SLICE_ONE - 1);
    const __m512i ye = _mm512_set1_epi32((c->size[1] + 1) * SLICE_ONE - 1), ze = _mm512_set1_epi32(c->black);
    int64_t i = 0;
    for (; i + 16 <= count; i += 16) {
        const __m512i px = _mm512_min_epu32(_mm512_loadu_si512(x + i), xe);
        const __m512i py = _mm512_min_epu32(_mm512_loadu_si512(y + i), ye);
        const __m512i pz = _mm512_min_epu32(_mm512_loadu_si512(z + i), ze);
        const __m512i along = _mm512_srli_epi32(px, 16);
        __m512i at = _mm512_add_epi32(_mm512_add_epi32(along, _mm512_slli_epi32(along, 3)),
                                      _mm512_add_epi32(_mm512_mullo_epi32(_mm512_srli_epi32(py, 17), row),
                                                       _mm512_mullo_epi32(_mm512_srli_epi32(pz, 17), layer)));
        at = _mm512_mask_add_epi32(at, _mm512_test_epi32_mask(py, second), at, one);
        at = _mm512_mask_add_epi32(at, _mm512_test_epi32_mask(pz, second), at, three);
        uint32_t index[16];
        _mm512_storeu_si512(index, at);
        const __m512 first = _mm512_castsi512_ps(words(c->byte, index)),
                     last = _mm512_castsi512_ps(words(c->byte, index + 2));
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

/* Cells of pixels 0 1 and 4 5 of `at`. */
INLINE __m256 words(const uint8_t *byte, const uint32_t *at)
{
    const __m256i even = _mm256_broadcastsi128_si256(_mm_setr_epi8(CELL_BYTES, NO_BYTES));
    const __m256i odd = _mm256_broadcastsi128_si256(_mm_setr_epi8(NO_BYTES, CELL_BYTES));
    return _mm256_castsi256_ps(_mm256_or_si256(_mm256_shuffle_epi8(cells(byte, at[0], at[4]), even),
                                               _mm256_shuffle_epi8(cells(byte, at[1], at[5]), odd)));
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

static void sample_near(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        uint8_t *to)
{
    const __m256i row = _mm256_set1_epi32((int32_t)c->row), layer = _mm256_set1_epi32((int32_t)c->layer);
    const __m256i one = _mm256_set1_epi32(1), three = _mm256_set1_epi32(3);
    const __m256i low = _mm256_set1_epi16(0xff), half = _mm256_set1_epi16(64);
    const __m256i bytes = _mm256_setr_epi8(0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 4, 8, 12, -1,
                                           -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
    int64_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256i px = within8(x + i, (c->size[0] + 1) * SLICE_ONE - 1);
        const __m256i py = within8(y + i, (c->size[1] + 1) * SLICE_ONE - 1), pz = within8(z + i, c->black);
        const __m256i along = _mm256_srli_epi32(px, 16);
        const __m256i bricks = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srli_epi32(py, 17), row),
                                                _mm256_mullo_epi32(_mm256_srli_epi32(pz, 17), layer));
        const __m256i beside =
            _mm256_add_epi32(_mm256_and_si256(_mm256_srli_epi32(py, 16), one),
                             _mm256_and_si256(_mm256_srai_epi32(_mm256_slli_epi32(pz, 15), 31), three));
        const __m256i at =
            _mm256_add_epi32(_mm256_add_epi32(along, _mm256_slli_epi32(along, 3)), _mm256_add_epi32(bricks, beside));
        uint32_t index[8];
        _mm256_storeu_si256((__m256i *)(void *)index, at);
        const __m256 first = words(c->byte, index), last = words(c->byte, index + 2);
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

static void sample_near(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                        uint8_t *to)
{
    for (int64_t i = 0; i < count; i++)
        to[i] = sample_one(c, (uint32_t)x[i], (uint32_t)y[i], (uint32_t)z[i]);
}

#endif

/* ---- volumes whose bytes do not all have a number of 32 bits */

/* Whether all have: the layers, the black one among them. */
INLINE bool is_near(const slice_cells *c)
{
    return (uint64_t)(c->black / (2 * SLICE_ONE) + 1) * c->layer <= UINT32_MAX;
}

enum { TOGETHER = 32 }; /* places that are looked at together; pixels beside each other mostly are in the same layers */

/* The samples at up to TOGETHER places, their layers counted from the lowest of these; one by one where they lie too
 * far apart for that. */
INLINE void sample_run(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                       uint8_t *to)
{
    uint32_t low = (uint32_t)c->black, high = 0;
    int32_t from_low[TOGETHER];
    for (int64_t i = 0; i < count; i++) {
        const uint32_t at = (uint32_t)z[i] < (uint32_t)c->black ? (uint32_t)z[i] : (uint32_t)c->black;
        low = at < low ? at : low;
        high = at > high ? at : high;
    }
    low &= ~(uint32_t)(2 * SLICE_ONE - 1);
    if (((uint64_t)(high - low) / (2 * SLICE_ONE) + 1) * c->layer > UINT32_MAX) {
        for (int64_t i = 0; i < count; i++)
            to[i] = sample_one(c, (uint32_t)x[i], (uint32_t)y[i], (uint32_t)z[i]);
        return;
    }
    slice_cells near = *c;
    near.byte += (size_t)(low / (2 * SLICE_ONE)) * c->layer;
    near.black = (int32_t)((uint32_t)c->black - low);
    for (int64_t i = 0; i < count; i++)
        from_low[i] = (int32_t)((uint32_t)z[i] - low);
    sample_near(&near, x, y, from_low, count, to);
}

static void sample(const slice_cells *c, const int32_t *x, const int32_t *y, const int32_t *z, int64_t count,
                   uint8_t *to)
{
    if (is_near(c)) {
        sample_near(c, x, y, z, count, to);
        return;
    }
    for (int64_t i = 0; i < count; i += TOGETHER)
        sample_run(c, x + i, y + i, z + i, count - i < TOGETHER ? count - i : TOGETHER, to + i);
}
