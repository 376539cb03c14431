/* MetaImage (.mha, and .mhd with its data in one file beside it): two or three axes of one number each, as they are,
 * compressed by zlib, or as text. Keys that are not of the image (those of tracked sequences) are passed over. Source:
 * MetaIO's documentation, itk.org/Wiki/ITK/MetaIO.
 */
#ifndef SINEW_METAIMAGE_H
#define SINEW_METAIMAGE_H

#include "volume/volume.h"

/* Whether this is the first line of one. */
bool metaimage_is(const char *line);

/* See volume_read; line: the stream's first, which it has still to take in. The rows of TransformMatrix are the
 * directions of the axes; AnatomicalOrientation repeats them, and CenterOfRotation moves nothing, as ITK has it. */
int metaimage_read(volume *v, in *s, char *line, const char *path, const volume_budget *b, err *e);

#endif
