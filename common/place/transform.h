/* A rigid motion from a file that another program, or a person, wrote: how a probe's face stands on its marker, or
 * where a model lies in the frame that poses are in. What kind of file it is, its content says:
 *
 *     a line `time tx ty tz qx qy qz qw`                   metres; the time is passed over
 *     four lines of four numbers, or one of 16             4 x 4, row by row, mm, as PLUS and 3D Slicer print it
 *     XML with <CoordinateDefinitions><Transform .../>     a configuration of PLUS, mm; FILE:FROMToTO names what of it
 *     #Insight Transform File V1.0                         ITK's, as Slicer saves a transform as .tfm; LPS, mm
 *
 * The motion takes places of the probe's own frame to the marker's, or of the model (in LPS) to the frame of the poses.
 * It owns nothing but what a function says.
 */
#ifndef SINEW_TRANSFORM_H
#define SINEW_TRANSFORM_H

#include "base/err.h"
#include "base/pose.h"

/* What a motion is for. */
typedef enum transform_use { TRANSFORM_MARKER, TRANSFORM_BODY } transform_use;

typedef struct transform_file {
    const char *name;  /* for messages */
    const char *bytes; /* NUL-terminated; none of it is kept */
    int64_t size;
    const char *frames; /* "ProbeToProbeMarker", or NULL: as the file has it */
    transform_use use;
} transform_file;

/* Splits FILE:FROMToTO into the file's path, which is the caller's to free, and the names, which are of `path` (NULL:
 * there are none). NULL with e filled: memory is out. */
char *transform_path(const char *path, const char **frames, err *e);

/* Whether bytes begin as one of the files above, or one that is refused by its name; else they may be words. */
bool transform_is(const char *bytes, int64_t size);

/* Reads the file. -1 with e filled: what is no such file, or is none of a rigid motion. */
int transform_read(const transform_file *f, pose *to, err *e);

/* Reads --marker's file. -1 with e filled. */
int transform_marker(const char *path, pose *to, err *e);

#endif
