/* The head of a JPEG or JPEG-LS frame, read before a decoder does: one that says another size than the image's could
 * ask for any memory. Nothing is allocated or kept.
 */
#ifndef SINEW_DICOM_JPEG_H
#define SINEW_DICOM_JPEG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether the bytes begin a frame (with SOI). */
bool dicom_jpeg_begins(const unsigned char *bytes, size_t size);

/* Whether the first frame header in them (ISO/IEC 10918-1: B.2.2, SOF; ISO/IEC 14495-1: C.2.2) is
 * there, and of so many rows and columns. */
bool dicom_jpeg_fits(const unsigned char *bytes, size_t size, int64_t rows, int64_t columns);

#endif
