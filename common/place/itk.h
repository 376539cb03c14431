/* ITK's text files of transforms, as 3D Slicer saves one as .tfm. Such a file is in LPS and mm, and made for
 * resampling: it takes a place of the parent to one of the child, so it holds the inverse of what Slicer shows. This
 * gives what Slicer shows: for a marker the numbers themselves, as its frames are neither LPS nor RAS; for a body,
 * whose model is in LPS, the motion in LPS. It keeps nothing.
 */
#ifndef SINEW_ITK_H
#define SINEW_ITK_H

#include "base/out.h"
#include "place/transform.h"

#define ITK_FIRST "#Insight Transform File"

/* -1 with e filled: another kind of transform than an affine one, several, scale, shear. */
int itk_read(const transform_file *f, pose *to, err *e);

/* Writes a file that itk_read reads as p. */
void itk_write(const pose *p, transform_use use, out *to);

#endif
