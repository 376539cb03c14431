/* A DICOM file as a volume needs it: pixels and where they lie, and nothing that
 * names anybody. The caller owns the struct.
 */
#ifndef SINEW_DICOM_IMAGE_H
#define SINEW_DICOM_IMAGE_H

#include "slice/import/dicom_elements.h"

#include <stddef.h>

enum { DICOM_UID = 65, DICOM_KIND = 20 };

typedef enum dicom_burned { DICOM_NOT_SAID, DICOM_CLEAN, DICOM_BURNED } dicom_burned;

/* A value is slope times what is stored, and intercept. */
typedef struct dicom_scale {
    double slope, intercept;
} dicom_scale;

typedef struct dicom_image {
    char series[DICOM_UID]; /* to tell series apart; for no output */
    int64_t columns, rows, frames;
    int bytes;                            /* of a sample: 1 or 2 */
    bool negative;                        /* samples are signed */
    double slope, intercept;              /* of frames that have none of their own */
    double spacing[3];                    /* mm between columns, rows and frames; nan: not said */
    double along_row[3], along_column[3]; /* unit vectors, LPS: the way in which columns and rows are counted */
    bool placed;    /* frames have positions; where not, along_* are the axes, and frames lie one behind the other */
    bool own_frame; /* positions are in a frame of the volume's own, not the patient's */
    bool private_geometry;    /* some of it came from a maker's private elements */
    double *position;         /* frames x 3: mm, LPS, the centre of the first pixel; nan: not said */
    double *time;             /* frames: when, or which time; 0 where there is one only */
    char (*kind)[DICOM_KIND]; /* frames: what their data are, as TISSUE_INTENSITY; "": not said */
    dicom_scale *scale;       /* frames; NULL: slope and intercept of all */
    dicom_burned burned;
    unsigned char *pixels; /* frames x rows x columns x bytes, little-endian, brighter = more */
} dicom_image;

/* Whether these bytes begin as a DICOM file does: 132 of them are enough to know. */
bool dicom_is(const void *bytes, size_t size);

/* Reads a file that is in memory; name is for messages. seen (may be NULL) gets its elements, those
 * of nested items too. 1: it is a directory of other files (DICOMDIR), or holds no image, and d is
 * empty; 0; -1 with e filled. d: zeroed. */
int dicom_read(dicom_image *d, const void *bytes, size_t size, const char *name, dicom_elements *seen, err *e);

void dicom_free(dicom_image *d);

/* What DCMTK allocated once. */
void dicom_end(void);

#endif
