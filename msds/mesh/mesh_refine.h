/* Which cells are halved: those under the skin, down to depths, or those around a place, within distances. A depth or
 * distance for each halving: within the first, cells are halved once at least, within the second twice, and so on. It
 * borrows what it points to.
 */
#ifndef SINEW_MESH_REFINE_H
#define SINEW_MESH_REFINE_H

#include "msds/mesh/mesh_mask.h"
#include "msds/mesh/mesh_tets.h"

typedef struct mesh_refine {
    const mesh_box *box;
    const mesh_mask *mask; /* NULL: the skin is the top side; else it is the first tissue in each column */
    int top;               /* a side */
    int levels;
    double within[MESH_LEVELS]; /* m, falling */
    const double *around;       /* m, or NULL: a place that distances are from; else they are depths under the skin */
} mesh_refine;

/* r must outlive the wish. */
mesh_wish mesh_refine_wish(const mesh_refine *r);

#endif
