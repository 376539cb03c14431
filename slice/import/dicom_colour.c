#include "slice/import/dicom_colour.h"

#include "base/num.h"

#include <string.h>

dicom_colour dicom_colour_of(const char *name)
{
    static const struct {
        const char *name;
        dicom_colour colour;
    } known[] = {
        {"MONOCHROME2", DICOM_GREY},
        {"MONOCHROME1", DICOM_INVERTED},
        {"PALETTE COLOR", DICOM_PALETTE},
        {"RGB", DICOM_RGB},
        {"YBR_FULL", DICOM_YBR},
        {"YBR_FULL_422", DICOM_YBR_422},
        {"YBR_PARTIAL_422", DICOM_YBR_PARTIAL_422},
        {"YBR_RCT", DICOM_RGB}, /* within JPEG 2000 only, whose decoder gives RGB */
        {"YBR_ICT", DICOM_RGB},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(name, known[i].name))
            return known[i].colour;
    return DICOM_OTHER;
}

int dicom_colour_samples(dicom_colour c)
{
    return c <= DICOM_PALETTE ? 1 : 3;
}

static bool shared(dicom_colour c)
{
    return c == DICOM_YBR_422 || c == DICOM_YBR_PARTIAL_422;
}

int64_t dicom_samples_size(const dicom_samples *s)
{
    int64_t each = shared(s->colour) ? 2 : dicom_colour_samples(s->colour);
    return s->plane * s->frames * s->bytes * each;
}

int dicom_samples_bytes(const dicom_samples *s)
{
    return s->colour <= DICOM_INVERTED ? s->bytes : 1;
}

static uint8_t brightness(int red, int green, int blue)
{
    return (uint8_t)((299 * red + 587 * green + 114 * blue + 500) / 1000);
}

/* Entries of 16 bits count by their upper byte; writers that say 16 and fill 8 are known by having none above 255. */
bool dicom_palette_set(dicom_palette *p, const uint16_t *const table[3], int64_t words)
{
    bool narrow = words < p->count, wide = false;
    if (2 * words < p->count)
        return false;
    for (int32_t i = 0; !narrow && i < p->count; i++)
        for (int c = 0; c < 3; c++)
            wide |= table[c][i] > 255;
    for (int32_t i = 0; i < p->count; i++) {
        int of[3];
        for (int c = 0; c < 3; c++)
            if (narrow)
                of[c] = table[c][i / 2] >> 8 * (i % 2) & 255;
            else
                of[c] = table[c][i] >> (wide ? 8 : 0);
        p->grey[i] = brightness(of[0], of[1], of[2]);
    }
    return true;
}

/* The bits of a sample, moved down, its sign spread. */
static int32_t sample_of(const dicom_samples *s, const unsigned char *p)
{
    uint32_t bits = s->bytes == 1 ? p[0] : (uint32_t)(p[0] | p[1] << 8), all = (1U << s->stored) - 1;
    bits = bits >> (s->high + 1 - s->stored) & all;
    bool below = s->negative && bits >> (s->stored - 1) & 1;
    return below ? (int32_t)bits - (int32_t)all - 1 : (int32_t)bits;
}

static void put_greys(const dicom_samples *s, const unsigned char *from, unsigned char *to)
{
    bool inverted = s->colour == DICOM_INVERTED;
    int64_t count = s->plane * s->frames;
    if (!inverted && s->stored == 8 * s->bytes) {
        memcpy(to, from, (size_t)(count * s->bytes));
        return;
    }
    for (int64_t i = 0; i < count; i++) {
        int32_t value = sample_of(s, from + i * s->bytes);
        if (inverted)
            value = s->negative ? -1 - value : (int32_t)((1U << s->stored) - 1) - value;
        to[i * s->bytes] = (unsigned char)value;
        if (s->bytes == 2)
            to[2 * i + 1] = (unsigned char)((uint32_t)value >> 8);
    }
}

static void put_palette(const dicom_samples *s, const unsigned char *from, unsigned char *to)
{
    const dicom_palette *p = s->palette;
    for (int64_t i = 0; i < s->plane * s->frames; i++) {
        int32_t at = sample_of(s, from + i * s->bytes) - p->first;
        to[i] = p->grey[num_clamp_int(at, 0, p->count - 1)];
    }
}

static void put_colours(const dicom_samples *s, const unsigned char *from, unsigned char *to)
{
    int64_t across = s->planar ? 1 : 3;
    int64_t along = s->planar ? s->plane : 1;
    for (int64_t f = 0; f < s->frames; f++, from += 3 * s->plane)
        for (int64_t i = 0; i < s->plane; i++) {
            const unsigned char *p = from + i * across;
            *to++ = s->colour == DICOM_YBR ? p[0] : brightness(p[0], p[along], p[2 * along]);
        }
}

static void put_shared(const dicom_samples *s, const unsigned char *from, unsigned char *to)
{
    for (int64_t i = 0; i < s->plane * s->frames; i++) {
        int y = from[i / 2 * 4 + i % 2];
        if (s->colour == DICOM_YBR_PARTIAL_422)
            y = (((int)num_clamp_int(y, 16, 235) - 16) * 255 + 109) / 219;
        to[i] = (unsigned char)y;
    }
}

void dicom_samples_grey(const dicom_samples *s, const unsigned char *from, unsigned char *to)
{
    if (s->colour <= DICOM_INVERTED)
        put_greys(s, from, to);
    else if (s->colour == DICOM_PALETTE)
        put_palette(s, from, to);
    else if (shared(s->colour))
        put_shared(s, from, to);
    else
        put_colours(s, from, to);
}
