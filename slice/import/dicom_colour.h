/* Samples as DICOM stores them, to how bright each pixel is: greys of any bits, inverted or signed,
 * palettes, and colours by pixel, by plane, or with colours that two pixels share (PS3.3: C.7.6.3.1.2,
 * C.7.6.3.1.5). The caller owns both arrays.
 */
#ifndef SINEW_DICOM_COLOUR_H
#define SINEW_DICOM_COLOUR_H

#include <stdbool.h>
#include <stdint.h>

typedef enum dicom_colour {
    DICOM_GREY,
    DICOM_INVERTED, /* MONOCHROME1: 0 is white */
    DICOM_PALETTE,
    DICOM_RGB,
    DICOM_YBR,
    DICOM_YBR_422,         /* Y, Y, B, R of two pixels */
    DICOM_YBR_PARTIAL_422, /* and Y from 16 to 235 */
    DICOM_OTHER
} dicom_colour;

enum { DICOM_ENTRIES = 65536 };

typedef struct dicom_palette {
    int32_t first, count; /* the sample that has the first entry; those beyond the ends have the end's */
    uint8_t grey[DICOM_ENTRIES];
} dicom_palette;

typedef struct dicom_samples {
    dicom_colour colour;
    int bytes, stored, high; /* of a sample: 1 or 2; bits used of them; the highest of those */
    bool negative, planar;
    int64_t plane, frames; /* pixels of a frame */
    const dicom_palette *palette;
} dicom_samples;

/* By PhotometricInterpretation. */
dicom_colour dicom_colour_of(const char *name);

/* Samples a pixel, as SamplesPerPixel counts them. */
int dicom_colour_samples(dicom_colour c);

/* The bytes that hold all frames. */
int64_t dicom_samples_size(const dicom_samples *s);

/* The bytes of a pixel when it is grey: 1, or 2 for greys of 2. */
int dicom_samples_bytes(const dicom_samples *s);

/* Sets a palette from its three tables of `words` 16-bit words each: an entry a
 * word, or two. False: fewer than count. */
bool dicom_palette_set(dicom_palette *p, const uint16_t *const table[3], int64_t words);

/* Brightness (ITU-R BT.601, as YBR_FULL has it), little-endian. */
void dicom_samples_grey(const dicom_samples *s, const unsigned char *from, unsigned char *to);

#endif
