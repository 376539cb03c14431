/* The skin that may touch itself: the triangles of the surfaces that `--self-contact` names, and samples on those of
 * them that are in its regions: vertices, and points on edges and in triangles no further apart than is asked. Owns
 * all; begin with a zeroed one.
 */
#ifndef SINEW_TOUCH_SKIN_H
#define SINEW_TOUCH_SKIN_H

#include "base/pool.h"
#include "bind/side.h"
#include "cli/opt.h"

typedef struct touch_skin {
    double *position; /* vertices x 3, m */
    double *inward;   /* vertices x 3: side_normals, or 0 */
    int32_t *corner;  /* triangles x 3 */
    bool *is_sampled; /* triangles */
    int64_t vertices, triangles;
    int64_t position_room, inward_room, corner_room, sampled_room;
    double *sample; /* samples x 3, m */
    double *behind; /* samples x 3: which way the tissue is, of any length, or 0 */
    int64_t samples;
    int64_t sample_room, behind_room;
} touch_skin;

typedef struct touch_skin_options {
    const opt_list *regions; /* SURFACE,...[:REGION], or auto */
    double apart;            /* m */
    bool blended;            /* samples move as blended vertices do (mesh/motion.h) */
} touch_skin_options;

/* Surfaces are the model's, by their names or their groups'; coordinates of regions are in its source.unit. -1 with e
 * filled, and to be freed all the same, where a name is unknown or a region has no triangle. */
int touch_skin_make(touch_skin *to, const model *m, const side *sides, const touch_skin_options *o, pool *threads,
                    err *e);
void touch_skin_free(touch_skin *k);

#endif
