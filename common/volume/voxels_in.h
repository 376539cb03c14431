/* The voxels of a file, as NRRD and MetaImage both keep them: after the header or in a file beside it; as they are,
 * compressed (zlib or gzip), or as text; in either byte order. Memory grows as they come, whatever the header says.
 */
#ifndef SINEW_VOXELS_IN_H
#define SINEW_VOXELS_IN_H

#include "volume/volume.h"

typedef enum voxels_encoding { VOXELS_RAW, VOXELS_DEFLATED, VOXELS_TEXT } voxels_encoding;

typedef struct voxels_in {
    voxels_encoding encoding;
    bool big;      /* the byte order of plain or compressed numbers: the most significant first */
    int64_t lines; /* to skip before the data, */
    int64_t bytes; /* and bytes after those, before what is compressed; -1: all but the last that are needed */
    char *file;    /* NULL: the data follow the header; else the name of their file; owned by the caller */
} voxels_in;

/* Reads what v's type and sizes need into v->data, from s or from the file, which has to be in the folder that path is
 * in, links followed. Fewer or more than that is an error. */
int voxels_in_read(volume *v, const voxels_in *x, in *s, const char *path, const volume_budget *b, err *e);

#endif
