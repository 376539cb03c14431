/* The pixels of a DICOM file, decompressed and made greys, into an image.
 */
#ifndef SINEW_DICOM_PIXELS_H
#define SINEW_DICOM_PIXELS_H

#include "slice/import/dicom_file.h"
#include "slice/import/dicom_image.h"

/* Of an image whose rows, columns and frames are known: fills bytes, negative and pixels. */
int dicom_pixels_read(dicom_image *d, dicom_file *f, err *e);

#endif
