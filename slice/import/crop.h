/* A part of a volume, cut out in place: for annotation that is burned into images.
 */
#ifndef SINEW_CROP_H
#define SINEW_CROP_H

#include "volume/samples.h"

/* Keeps the voxels of the box, which has to lie within the volume and hold one. */
void crop_to(volume *v, const samples_box *box);

#endif
