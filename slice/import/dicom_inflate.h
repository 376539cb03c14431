/* A DICOM file whose elements are deflated as a whole (PS3.5: A.5), made one whose are not. The caller frees the bytes.
 */
#ifndef SINEW_DICOM_INFLATE_H
#define SINEW_DICOM_INFLATE_H

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>

/* Whether the elements of the file are deflated. */
bool dicom_is_deflated(const unsigned char *bytes, size_t size);

/* 1: it is such a file, and *plain (*plain_size bytes) is it in explicit
 * little-endian; 0: it is not; -1 with e filled. */
int dicom_inflate(const unsigned char *bytes, size_t size, unsigned char **plain, size_t *plain_size, const char *name,
                  err *e);

#endif
