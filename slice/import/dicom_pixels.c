#include "slice/import/dicom_pixels.h"

#include "base/mem.h"
#include "slice/import/dicom_colour.h"
#include "slice/import/dicom_jpeg.h"
#include "slice/import/dicom_jpeg2000.h"
#include "slice/import/dicom_tags.h"

#include <stdlib.h>
#include <string.h>

static int refuse(const dicom_file *f, err *e, const char *what, const char *expected)
{
    return err_set(e, dicom_file_name(f), 0, "%s; expected %s", what, expected);
}

static double number(dicom_file *f, uint32_t tag, double otherwise)
{
    double value;
    return dicom_numbers(f, dicom_file_set(f), tag, &value, 1) ? value : otherwise;
}

/* What the samples are; read before and after they are decompressed, which may change it. */
static int read_kind(dicom_samples *s, const dicom_image *d, dicom_file *f, err *e)
{
    char colour[32];
    double samples = number(f, TAG_SAMPLES, 1), allocated = number(f, TAG_ALLOCATED, 0);
    double stored = number(f, TAG_STORED, allocated), high = number(f, TAG_HIGH_BIT, stored - 1);
    dicom_text(f, dicom_file_set(f), TAG_COLOUR, colour, sizeof colour);
    *s = (dicom_samples){.colour = dicom_colour_of(colour), .plane = d->rows * d->columns, .frames = d->frames};
    if (s->colour == DICOM_OTHER)
        return refuse(f, e, "pixels of another kind", "MONOCHROME1, MONOCHROME2, PALETTE COLOR, RGB or YBR_FULL");
    bool one = dicom_colour_samples(s->colour) == 1;
    if ((allocated != 8 && allocated != 16) || !(stored >= 1 && stored <= allocated) ||
        !(high >= stored - 1 && high < allocated) || samples != (one ? 1 : 3) || (!one && allocated != 8))
        return err_set(e, dicom_file_name(f), 0,
                       "%g samples of %g bits a pixel, %g of them used; expected 8 or 16, or 3 samples of 8", samples,
                       allocated, stored);
    s->bytes = (int)allocated / 8;
    s->stored = (int)stored;
    s->high = (int)high;
    s->negative = one && number(f, TAG_SIGNED, 0) == 1;
    s->planar = !one && number(f, TAG_PLANAR, 0) == 1;
    return 0;
}

/* The caller frees it. */
static dicom_palette *read_palette(dicom_file *f, bool negative, err *e)
{
    double kind[3];
    const uint16_t *table[3];
    int64_t words = DICOM_ENTRIES;
    dicom_palette *p = mem_array(1, sizeof *p, "a palette", e);
    if (!p)
        return NULL;
    bool whole = dicom_numbers(f, dicom_file_set(f), TAG_PALETTE, kind, 3) == 3;
    for (uint32_t c = 0; c < 3 && whole; c++) {
        int64_t count = dicom_words(f, TAG_PALETTE_DATA + c, &table[c]);
        words = count < words ? count : words;
    }
    whole = whole && kind[1] >= INT16_MIN && kind[1] <= UINT16_MAX;
    if (whole) { /* 65536 entries are written as 0 */
        p->count = kind[0] >= 1 && kind[0] < DICOM_ENTRIES ? (int32_t)kind[0] : DICOM_ENTRIES;
        p->first = negative ? (int16_t)(int32_t)kind[1] : (int32_t)kind[1] & 65535;
        whole = dicom_palette_set(p, table, words);
    }
    if (whole)
        return p;
    refuse(f, e, "a palette that is not whole", "three tables, of as many entries as their descriptor says");
    free(p);
    return NULL;
}

/* Whether a piece begins a frame: with SOC and SIZ (ISO/IEC 15444-1: A.2). A frame may be in several. */
static bool begins_frame(const unsigned char *piece, size_t size)
{
    static const unsigned char begin[] = {0xFF, 0x4F, 0xFF, 0x51};
    return size >= sizeof begin && !memcmp(piece, begin, sizeof begin);
}

/* The frame that begins with piece *at, joined; *at becomes the next's. The caller frees it; NULL with e filled. */
static unsigned char *join_frame(dicom_file *f, int64_t *at, int64_t *size, err *e)
{
    unsigned char *joined = NULL;
    int64_t room = 0, pieces = dicom_pieces(f);
    int failed = 0;
    for (*size = 0; *at < pieces && !failed; ++*at) {
        size_t length = 0;
        const unsigned char *piece = dicom_piece(f, *at, &length);
        if (!piece || !length || (*size && begins_frame(piece, length)))
            break;
        failed = mem_grow(&joined, &room, *size + (int64_t)length, 1, "a frame", e);
        if (!failed && joined)
            memcpy(joined + *size, piece, length);
        *size += (int64_t)length;
    }
    if (!failed && *size)
        return joined;
    free(joined);
    if (!failed)
        refuse(f, e, "a frame without bytes, or fewer frames than are said", "a codestream of JPEG 2000 each");
    return NULL;
}

/* By pixel. The caller frees them. */
static unsigned char *unpack_jpeg2000(dicom_samples *s, const dicom_image *d, dicom_file *f, err *e)
{
    dicom_frame frame = {d->columns, d->rows, dicom_colour_samples(s->colour), s->bytes};
    int64_t size = s->plane * frame.samples * s->bytes, at = 0, length;
    unsigned char *to = mem_array(s->frames, (size_t)size, "pixels", e);
    int failed = to ? 0 : -1;
    s->planar = false;
    for (int64_t i = 0; i < s->frames && !failed; i++) {
        unsigned char *from = join_frame(f, &at, &length, e);
        failed = from ? dicom_jpeg2000(&frame, from, (size_t)length, to + i * size, dicom_file_name(f), e) : -1;
        free(from);
    }
    if (!failed)
        return to;
    free(to);
    return NULL;
}

/* Frames of JPEG are as large as the image: a decoder believes them. (Pieces of RLE begin otherwise.) */
static int check_jpeg(const dicom_image *d, dicom_file *f, err *e)
{
    for (int64_t i = 0; i < dicom_pieces(f); i++) {
        size_t size = 0;
        const unsigned char *piece = dicom_piece(f, i, &size);
        bool frame = piece && dicom_jpeg_begins(piece, size);
        if (!i && !frame && dicom_file_is_jpeg(f))
            return refuse(f, e, "JPEG that does not begin with SOI", "a frame at the beginning of the pixels");
        if (frame && !dicom_jpeg_fits(piece, size, d->rows, d->columns))
            return err_set(e, dicom_file_name(f), 0, "JPEG of another size than the image; expected %lld x %lld pixels",
                           (long long)d->columns, (long long)d->rows);
    }
    return 0;
}

static int unpack(dicom_samples *s, const dicom_image *d, dicom_file *f, err *e)
{
    const char *syntax;
    dicom_file_packing(f, &syntax);
    if (check_jpeg(d, f, e))
        return -1;
    /* Of three samples each at most, and once more while it works. */
    if (dicom_pixels_unpack(f, 2 * 3 * s->plane * s->frames * s->bytes))
        return read_kind(s, d, f, e);
    return err_set(e, dicom_file_name(f), 0,
                   "pixels are compressed as %s, or not whole; expected none, RLE, JPEG, JPEG-LS or JPEG 2000", syntax);
}

/* Greys of the samples at `from`. */
static int take_greys(dicom_image *d, dicom_samples *s, const unsigned char *from, dicom_file *f, err *e)
{
    dicom_palette *palette = s->colour == DICOM_PALETTE ? read_palette(f, s->negative, e) : NULL;
    if (s->colour == DICOM_PALETTE && !palette)
        return -1;
    s->palette = palette;
    d->bytes = dicom_samples_bytes(s);
    d->negative = s->negative && s->colour <= DICOM_INVERTED;
    d->pixels = mem_array(s->plane * s->frames, (size_t)d->bytes, "pixels", e);
    if (d->pixels)
        dicom_samples_grey(s, from, d->pixels);
    free(palette);
    return d->pixels ? 0 : -1;
}

/* Samples that are not compressed, or no longer. */
static int take_plain(dicom_image *d, dicom_samples *s, dicom_file *f, err *e)
{
    int64_t size = dicom_pixels_size(f), need = dicom_samples_size(s);
    bool shared = s->colour == DICOM_YBR_422 || s->colour == DICOM_YBR_PARTIAL_422;
    if (shared && d->columns % 2)
        return refuse(f, e, "pixels that share their colours (YBR_..._422) in odd rows", "pairs of pixels");
    if (size < need)
        return err_set(e, dicom_file_name(f), 0, "%lld bytes of pixels; expected %lld", (long long)size,
                       (long long)need);
    const unsigned char *from = dicom_pixels(f, s->bytes);
    return from ? take_greys(d, s, from, f, e) : refuse(f, e, "pixels that cannot be read", "bytes or words");
}

int dicom_pixels_read(dicom_image *d, dicom_file *f, err *e)
{
    dicom_samples s;
    dicom_packing packing = dicom_file_packing(f, NULL);
    if (read_kind(&s, d, f, e) || (packing == DICOM_DCMTK && unpack(&s, d, f, e)))
        return -1;
    if (packing != DICOM_JPEG2000)
        return take_plain(d, &s, f, e);
    unsigned char *from = unpack_jpeg2000(&s, d, f, e);
    int code = from ? take_greys(d, &s, from, f, e) : -1;
    free(from);
    return code;
}
