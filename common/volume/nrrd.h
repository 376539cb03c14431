/* NRRD, as Slicer, ITK and Teem write it: three space axes of one number each, raw, gzip or text,
 * attached or in one file beside the header. What is written is LPS millimetres. Source: "Definition of
 * NRRD File Format", teem.sourceforge.net/nrrd.
 */
#ifndef SINEW_NRRD_H
#define SINEW_NRRD_H

#include "volume/volume.h"

/* Whether this is the first line of one. */
bool nrrd_is(const char *line);

/* See volume_read; the first line was taken and was one. Spaces LPS, RAS and LAS become LPS; space units become mm.
 * Where a header names no space or one without directions of the body, it is taken as LPS, and as mm. Names of labels
 * are Slicer's keys SegmentN_Name and SegmentN_LabelValue. */
int nrrd_read(volume *v, in *s, const char *path, const volume_budget *b, err *e);

/* Writes the volume, gzip at level 1 (fast; level 6 saves some per cent) or raw; errors stick in
 * the out. -1 with e filled on no memory. */
int nrrd_write(const volume *v, bool gzip, out *to, err *e);

#endif
