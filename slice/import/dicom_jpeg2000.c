#include "slice/import/dicom_jpeg2000.h"

#include <openjpeg.h>
#include <string.h>

typedef struct source {
    const unsigned char *bytes;
    size_t size, at;
} source;

static OPJ_SIZE_T read_some(void *to, OPJ_SIZE_T count, void *data)
{
    source *s = data;
    size_t left = s->size - s->at, some = count < left ? count : left;
    if (!some)
        return (OPJ_SIZE_T)-1;
    memcpy(to, s->bytes + s->at, some);
    s->at += some;
    return some;
}

static OPJ_OFF_T skip_some(OPJ_OFF_T count, void *data)
{
    source *s = data;
    if (count < 0 || (uint64_t)count > s->size - s->at)
        return -1;
    s->at += (size_t)count;
    return count;
}

static OPJ_BOOL seek_to(OPJ_OFF_T place, void *data)
{
    source *s = data;
    if (place < 0 || (uint64_t)place > s->size)
        return OPJ_FALSE;
    s->at = (size_t)place;
    return OPJ_TRUE;
}

static opj_stream_t *open_source(source *s)
{
    opj_stream_t *stream = opj_stream_default_create(OPJ_TRUE);
    if (!stream)
        return NULL;
    opj_stream_set_read_function(stream, read_some);
    opj_stream_set_skip_function(stream, skip_some);
    opj_stream_set_seek_function(stream, seek_to);
    opj_stream_set_user_data(stream, s, NULL);
    opj_stream_set_user_data_length(stream, s->size);
    return stream;
}

static uint64_t big(const unsigned char *p, int bytes)
{
    uint64_t n = 0;
    for (int i = 0; i < bytes; i++)
        n = n << 8 | p[i];
    return n;
}

/* How large the image is, and how many tiles it says that it has, each of which takes 14 bytes at least (SOT, SOD) and
 * 10 KB of OpenJPEG's: looked at before OpenJPEG asks for these. (ISO/IEC 15444-1: A.5.1) */
static bool is_sane(const dicom_frame *f, const unsigned char *from, size_t size)
{
    enum { SIZ = 4, TILE = 14 };
    if (size < SIZ + 38 || big(from, 4) != 0xFF4FFF51U)
        return false;
    uint64_t end[2], first[2], tile[2], tile_first[2], tiles = 1;
    for (int a = 0; a < 2; a++) {
        end[a] = big(from + SIZ + 4 + 4 * a, 4);
        first[a] = big(from + SIZ + 12 + 4 * a, 4);
        tile[a] = big(from + SIZ + 20 + 4 * a, 4);
        tile_first[a] = big(from + SIZ + 28 + 4 * a, 4);
        if (!tile[a] || tile_first[a] > first[a] || end[a] <= first[a] ||
            end[a] - first[a] != (uint64_t)(a ? f->rows : f->columns))
            return false;
        tiles *= (end[a] - tile_first[a] + tile[a] - 1) / tile[a];
        if (tiles > size / TILE)
            return false;
    }
    return big(from + SIZ + 36, 2) == (uint64_t)f->samples;
}

/* What was announced is what DICOM said. */
static bool has_shape(const opj_image_t *image, const dicom_frame *f)
{
    bool same = image->numcomps == (OPJ_UINT32)f->samples && image->x1 - image->x0 == (OPJ_UINT32)f->columns &&
                image->y1 - image->y0 == (OPJ_UINT32)f->rows;
    for (OPJ_UINT32 c = 0; same && c < image->numcomps; c++)
        same = image->comps[c].dx == 1 && image->comps[c].dy == 1 && image->comps[c].prec <= (OPJ_UINT32)(8 * f->bytes);
    return same;
}

static bool put(const opj_image_t *image, const dicom_frame *f, unsigned char *to)
{
    int64_t count = f->columns * f->rows;
    for (int c = 0; c < f->samples; c++) {
        const opj_image_comp_t *from = &image->comps[c];
        if (!from->data || from->w != (OPJ_UINT32)f->columns || from->h != (OPJ_UINT32)f->rows)
            return false;
        for (int64_t i = 0; i < count; i++) {
            uint32_t value = (uint32_t)from->data[i];
            unsigned char *p = to + (i * f->samples + c) * f->bytes;
            p[0] = (unsigned char)value;
            if (f->bytes == 2)
                p[1] = (unsigned char)(value >> 8);
        }
    }
    return true;
}

static int decode(const dicom_frame *f, opj_codec_t *codec, opj_stream_t *stream, unsigned char *to, const char *name,
                  err *e)
{
    opj_dparameters_t how;
    opj_image_t *image = NULL;
    int result = 0;
    opj_set_default_decoder_parameters(&how);
    if (!opj_setup_decoder(codec, &how) || !opj_decoder_set_strict_mode(codec, OPJ_TRUE) ||
        !opj_read_header(stream, codec, &image))
        result = err_set(e, name, 0, "damaged JPEG 2000; expected a codestream");
    else if (!has_shape(image, f))
        result = err_set(e, name, 0,
                         "JPEG 2000 whose samples are not as large as the image's; expected %d bits each, at most",
                         8 * f->bytes);
    else if (!opj_decode(codec, stream, image) || !put(image, f, to))
        result = err_set(e, name, 0, "damaged JPEG 2000; expected a whole codestream");
    opj_image_destroy(image);
    return result;
}

int dicom_jpeg2000(const dicom_frame *f, const unsigned char *from, size_t size, unsigned char *to, const char *name,
                   err *e)
{
    source s = {from, size, 0};
    if (!is_sane(f, from, size))
        return err_set(e, name, 0,
                       "JPEG 2000 of another shape than the image; expected %lld x %lld pixels of %d samples",
                       (long long)f->columns, (long long)f->rows, f->samples);
    opj_stream_t *stream = open_source(&s);
    opj_codec_t *codec = opj_create_decompress(OPJ_CODEC_J2K);
    const int result =
        stream && codec ? decode(f, codec, stream, to, name, e) : err_memory(e, "decompressing JPEG 2000");
    opj_destroy_codec(codec);
    opj_stream_destroy(stream);
    return result;
}
