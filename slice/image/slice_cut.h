/* The polygons in which a slice cuts the tetrahedra (PST figure 5c), as an OBJ in mm, LPS: a group for each of the
 * model's volumes; corners that polygons share are one vertex. Keeps nothing.
 */
#ifndef SINEW_SLICE_CUT_H
#define SINEW_SLICE_CUT_H

#include "base/out.h"
#include "model/model.h"
#include "slice/image/slice_cutter.h"

/* Of the cutter's last image, whose plane this is. -1 with e filled on no memory.
 * Returns 0; how many polygons: *count. */
int slice_cut_write(const slice_cutter *c, const slice_plane *at, const model *m, out *to, int64_t *count, err *e);

#endif
