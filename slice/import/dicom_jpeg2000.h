/* A frame of JPEG 2000, which DCMTK of Debian does not decode: the one user of OpenJPEG. The caller owns both arrays.
 */
#ifndef SINEW_DICOM_JPEG2000_H
#define SINEW_DICOM_JPEG2000_H

#include "base/err.h"

#include <stddef.h>

typedef struct dicom_frame {
    int64_t columns, rows;
    int samples, bytes; /* a pixel; a sample */
} dicom_frame;

/* Decodes a codestream (PS3.5: A.4.4) to samples by pixel, little-endian; one of another
 * shape is an error. name: for messages. */
int dicom_jpeg2000(const dicom_frame *f, const unsigned char *from, size_t size, unsigned char *to, const char *name,
                   err *e);

#endif
