#include "slice/import/dicom_jpeg.h"

enum {
    SOI = 0xD8,
    EOI = 0xD9,
    SOF0 = 0xC0,
    SOF15 = 0xCF,
    DHT = 0xC4,
    JPG = 0xC8,
    DAC = 0xCC,
    SOF55 = 0xF7,
    RST0 = 0xD0,
    RST7 = 0xD7,
    TEM = 0x01
};

bool dicom_jpeg_begins(const unsigned char *bytes, size_t size)
{
    return size >= 2 && bytes[0] == 0xFF && bytes[1] == SOI;
}

static unsigned two(const unsigned char *p)
{
    return (unsigned)p[0] << 8 | p[1];
}

static bool is_frame(unsigned char marker)
{
    return marker == SOF55 || (marker >= SOF0 && marker <= SOF15 && marker != DHT && marker != JPG && marker != DAC);
}

/* The marker at or after *at, which becomes what follows it; 0: there is none. As
 * decoders do, steps over what is none. */
static unsigned char next_marker(const unsigned char *bytes, size_t size, size_t *at)
{
    while (size - *at >= 2) {
        unsigned char code = bytes[*at + 1];
        if (bytes[(*at)++] != 0xFF || code == 0 || code == 0xFF)
            continue;
        ++*at;
        return code;
    }
    return 0;
}

bool dicom_jpeg_fits(const unsigned char *bytes, size_t size, int64_t rows, int64_t columns)
{
    size_t at = 2;
    unsigned char marker;
    if (!dicom_jpeg_begins(bytes, size))
        return false;
    while ((marker = next_marker(bytes, size, &at))) {
        /* Markers without a length have no place before it; DCMTK 3.6.7 never comes past TEM. */
        if ((marker >= RST0 && marker <= RST7) || marker == TEM || marker == EOI)
            return false;
        if (size - at < 7 || marker == SOI)
            return false;
        if (is_frame(marker))
            return two(bytes + at + 3) == rows && two(bytes + at + 5) == columns;
        if (two(bytes + at) > size - at)
            return false;
        at += two(bytes + at);
    }
    return false;
}
