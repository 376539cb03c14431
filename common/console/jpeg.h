/* Pixels as JPEG, for pages: speckle does not deflate. jpeg.c is the only user of libturbojpeg. The caller owns the
 * compressor, and begins with a zeroed one.
 */
#ifndef SINEW_JPEG_H
#define SINEW_JPEG_H

#include "base/err.h"

#include <stddef.h>

enum { JPEG_QUALITY = 88 };

typedef struct jpeg {
    void *compressor;
    unsigned char *bytes; /* of the picture made last */
    unsigned long capacity;
    size_t size;
} jpeg;

/* Compresses rows x columns x channels (1 or 3) bytes into j->bytes, valid until the next call. -1 with e filled. */
int jpeg_make(jpeg *j, const unsigned char *pixel, int columns, int rows, int channels, err *e);
void jpeg_free(jpeg *j);

#endif
