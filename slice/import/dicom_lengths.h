/* A look through a DICOM file, before DCMTK gets it, for elements that claim to be longer than what is left of it:
 * DCMTK asks for as much memory as is claimed, up to 4 GiB, before it sees that it is not there. Nothing is kept.
 */
#ifndef SINEW_DICOM_LENGTHS_H
#define SINEW_DICOM_LENGTHS_H

#include "base/err.h"

#include <stddef.h>

/* 0, or -1 with e filled: such an element. Where it cannot tell how to go on, it stops, and
 * leaves the rest to DCMTK. */
int dicom_lengths_check(const unsigned char *bytes, size_t size, const char *name, err *e);

/* Tags of items, in either byte order: a file cannot have more levels of items in items than these. */
int64_t dicom_lengths_items(const unsigned char *bytes, size_t size);

#endif
