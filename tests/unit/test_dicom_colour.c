// needs: slice/import/dicom_colour.c
/* Samples to greys: bits, signs, planes, shared colours, palettes of both widths.
 */
#include "slice/import/dicom_colour.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void greys(const char *name, const dicom_samples *s, const unsigned char *from, const unsigned char *want)
{
    unsigned char got[16] = {0};
    size_t size = (size_t)(s->plane * s->frames * dicom_samples_bytes(s));
    dicom_samples_grey(s, from, got);
    ok(!memcmp(got, want, size), "%s: %d %d %d %d", name, got[0], got[1], got[2], got[3]);
}

#define BYTES(...) ((const unsigned char[]){__VA_ARGS__})

static void test_greys(void)
{
    dicom_samples s = {.colour = DICOM_GREY, .bytes = 2, .stored = 12, .high = 13, .plane = 2, .frames = 1};
    greys("12 bits of 16, two up", &s, BYTES(0xFF, 0xFF, 4, 0), BYTES(0xFF, 0x0F, 1, 0));
    s.negative = true;
    greys("with a sign", &s, BYTES(0xFC, 0x3F, 4, 0), BYTES(0xFF, 0xFF, 1, 0));
    s.colour = DICOM_INVERTED;
    greys("inverted", &s, BYTES(0xFC, 0x3F, 4, 0), BYTES(0, 0, 0xFE, 0xFF));
    s = (dicom_samples){.colour = DICOM_INVERTED, .bytes = 1, .stored = 6, .high = 5, .plane = 3, .frames = 1};
    greys("6 bits, inverted", &s, BYTES(0, 63, 0xC1), BYTES(63, 0, 62));
}

static void test_colours(void)
{
    dicom_samples s = {.colour = DICOM_RGB, .bytes = 1, .stored = 8, .high = 7, .plane = 2, .frames = 2};
    greys("RGB, by pixel", &s, BYTES(255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9), BYTES(76, 150, 29, 9));
    s.planar = true;
    greys("RGB, by plane", &s, BYTES(255, 0, 0, 255, 0, 0, 0, 9, 0, 9, 255, 9), BYTES(76, 150, 29, 9));
    s.colour = DICOM_YBR;
    greys("YBR, by plane", &s, BYTES(1, 2, 128, 128, 128, 128, 3, 4, 128, 128, 128, 128), BYTES(1, 2, 3, 4));
    s = (dicom_samples){.colour = DICOM_YBR_422, .bytes = 1, .stored = 8, .high = 7, .plane = 4, .frames = 1};
    ok(dicom_samples_size(&s) == 8 && dicom_colour_samples(s.colour) == 3, "shared colours take two bytes a pixel");
    greys("shared colours", &s, BYTES(1, 2, 99, 99, 3, 4, 99, 99), BYTES(1, 2, 3, 4));
    s.colour = DICOM_YBR_PARTIAL_422;
    greys("brightness from 16 to 235", &s, BYTES(16, 235, 99, 99, 0, 126, 99, 99), BYTES(0, 255, 0, 128));
}

static void test_palette(void)
{
    static dicom_palette p = {.first = 10, .count = 4};
    static const uint16_t wide[] = {0, 100 << 8, 200 << 8, 255 << 8}, low[] = {0, 100, 200, 255};
    static const uint16_t narrow[] = {0 | 100 << 8, 200 | 255 << 8};
    dicom_samples s = {
        .colour = DICOM_PALETTE, .bytes = 1, .stored = 8, .high = 7, .plane = 4, .frames = 1, .palette = &p};
    ok(dicom_palette_set(&p, (const uint16_t *const[]){wide, wide, wide}, 4), "a palette of 16 bits");
    greys("whose ends go on", &s, BYTES(0, 11, 12, 99), BYTES(0, 100, 200, 255));
    ok(dicom_palette_set(&p, (const uint16_t *const[]){low, low, low}, 4), "16 bits, of which the lower are used");
    greys("as if they were 8", &s, BYTES(10, 11, 12, 13), BYTES(0, 100, 200, 255));
    ok(dicom_palette_set(&p, (const uint16_t *const[]){narrow, narrow, narrow}, 2), "a palette of 8 bits");
    greys("two a word", &s, BYTES(10, 11, 12, 13), BYTES(0, 100, 200, 255));
    ok(!dicom_palette_set(&p, (const uint16_t *const[]){narrow, narrow, narrow}, 1), "one that is too short");
    s.negative = true;
    p.first = -2;
    dicom_palette_set(&p, (const uint16_t *const[]){wide, wide, wide}, 4);
    greys("samples with a sign", &s, BYTES(0xFE, 0xFF, 0, 0x80), BYTES(0, 100, 200, 0));
}

int main(void)
{
    ok(dicom_colour_of("YBR_FULL_422") == DICOM_YBR_422 && dicom_colour_of("CMYK") == DICOM_OTHER, "names");
    test_greys();
    test_colours();
    test_palette();
    return done_testing();
}
