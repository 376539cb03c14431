/* A contour as a group of an OBJ file, in mm, LPS. Nothing is kept.
 */
#ifndef SINEW_CONTOUR_OBJ_H
#define SINEW_CONTOUR_OBJ_H

#include "slice/contour/contour.h"
#include "volume/samples.h"

/* `before`: vertices that the file has already. Positions are those of a box of v. Triangles face outward
 * whichever way the volume's axes turn. */
void contour_write(const contour *c, const volume *v, const samples_box *box, const char *group, int64_t before,
                   out *to);

#endif
