/* DICOM files of one series, put in order by where they lie, to a volume. The list owns what is in it.
 */
#ifndef SINEW_SERIES_H
#define SINEW_SERIES_H

#include "slice/import/dicom_image.h"
#include "volume/volume.h"

typedef struct series_file {
    char *name; /* for messages; owned */
    dicom_image image;
} series_file;

typedef struct series {
    series_file *file;
    int64_t count, capacity;
} series;

/* Adds a file; d's contents are the series' from then on, also where this fails. */
int series_add(series *s, const char *name, dicom_image *d, err *e);
void series_free(series *s);

typedef struct series_wish {
    double spacing[3]; /* mm; instead of what the files say; nan: as they say */
    int64_t number;    /* which series, of those that there are in the order of their files, from 1; -1: the only one */
    int64_t time;      /* which time, from 1; -1: the only one */
    const char *kind;  /* which kind of data, as TISSUE_INTENSITY; NULL: the only one */
    const volume_budget *budget; /* may be NULL */
} series_wish;

/* The volume, from the first slice along rows x columns to the last. Slices that are missing, lie at one place,
 * unevenly or askew, are an error that names them. v: zeroed. */
int series_volume(volume *v, const series *s, const series_wish *wish, err *e);

#endif
