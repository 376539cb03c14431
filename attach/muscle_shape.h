/* The shape of a muscle: its closed surface, filled with small cells of its own in its principal axes. Fibres are
 * laid in these cells by the potential of fibre_field.h, from one free end of the muscle to the other; so they do not
 * depend on how few voxels a muscle has, on their steps, or on where tissue cuts them off. The creator owns the
 * shape.
 */
#ifndef SINEW_MUSCLE_SHAPE_H
#define SINEW_MUSCLE_SHAPE_H

#include "base/err.h"
#include "muscle_body.h"
#include "surface/trimesh.h"

typedef struct muscle_shape muscle_shape;

/* Of a closed surface (m), which is copied. A muscle has about 2000 cells, however large it is. NULL with e filled. */
muscle_shape *muscle_shape_create(const trimesh *of, err *e);
void muscle_shape_free(muscle_shape *s);

/* How many cells it has: 0 where the surface encloses nothing. The middle of one goes into place, m. */
int64_t muscle_shape_cells(const muscle_shape *s);
void muscle_shape_place(const muscle_shape *s, int64_t cell, double place[3]);

/* Fills the fibres of a volume at its elements: means over the cells about an element's centre. Where bone is plays no
 * part, as voxels touch it beside a muscle too. -1 with e filled. */
int muscle_shape_fibres(muscle_shape *s, const body *b, int32_t volume, err *e);

#endif
