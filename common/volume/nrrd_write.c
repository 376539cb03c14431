#include "volume/nrrd.h"

#include "base/mem.h"
#include "base/num.h"
#include "volume/nrrd_labels.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdlib.h>
#include <zlib.h>

enum { PIECE = 1 << 18 }; /* bytes compressed at a time */

static void put_vector(const double v[3], out *to)
{
    char text[NUM_TEXT];
    for (int i = 0; i < 3; i++) {
        num_text(v[i], false, text);
        out_format(to, "%s%s", i ? "," : "(", text);
    }
    out_text(to, ")");
}

static void put_header(const volume *v, bool gzip, out *to)
{
#define NRRD_NAME(name, of, nrrd, meta, low, high) nrrd,
    static const char *const type[] = {VOLUME_TYPES(NRRD_NAME)};
    const uint16_t one = 1;
    const char *endian = *(const unsigned char *)&one ? "little" : "big";
    out_format(to, "NRRD0004\n# made by Sinew\ntype: %s\ndimension: 3\nspace: left-posterior-superior\n",
               type[v->type]);
    out_format(to, "sizes: %" PRId64 " %" PRId64 " %" PRId64 "\nspace directions:", v->size[0], v->size[1], v->size[2]);
    for (int a = 0; a < 3; a++) {
        out_text(to, " ");
        put_vector(v->axis[a], to);
    }
    out_format(to, "\nkinds: domain domain domain\nendian: %s\nencoding: %s\nspace origin: ", endian,
               gzip ? "gzip" : "raw");
    put_vector(v->origin, to);
    out_text(to, "\n");
    labels_write(v, to);
    out_text(to, "\n");
}

/* All of data as one gzip member. */
static int put_gzip(const volume *v, out *to, err *e)
{
    z_stream z = {0};
    unsigned char *piece = mem_array(PIECE, 1, "compressing", e);
    size_t left = (size_t)volume_count(v) * volume_type_size(v->type);
    if (!piece || deflateInit2(&z, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
        free(piece);
        return err_memory(e, "compressing");
    }
    int code = Z_OK;
    z.next_in = v->data;
    while (code == Z_OK) {
        if (!z.avail_in) {
            z.avail_in = left < UINT32_MAX ? (uInt)left : UINT32_MAX;
            left -= z.avail_in;
        }
        z.next_out = piece;
        z.avail_out = PIECE;
        code = deflate(&z, left ? Z_NO_FLUSH : Z_FINISH);
        out_write(to, piece, PIECE - z.avail_out);
    }
    deflateEnd(&z);
    free(piece);
    return code == Z_STREAM_END ? 0 : err_set(e, NULL, 0, "compressing failed; expected zlib's end of stream");
}

int nrrd_write(const volume *v, bool gzip, out *to, err *e)
{
    put_header(v, gzip, to);
    if (gzip)
        return put_gzip(v, to, e);
    out_write(to, v->data, (size_t)volume_count(v) * volume_type_size(v->type));
    return 0;
}
