/* What of a volume image is tissue, and what is air: a byte for each voxel, by words of the command line,
 *
 *     above:LEVEL   of the voxels in a finest cell's size around it, at least half are above the level; of these
 *                   voxels the largest connected component; and all that lies below it, seen from the top, where
 *                   the probe is: so vessels and shadows are tissue, as sound does not come through air
 *     tissue:LABEL  of one of these labels
 *     air:LABEL     of none of these labels
 *     sector        what the image covers: not 0, or enclosed by what is not; the largest connected component
 *
 * and of several words what all say (tissue:, what one of them says). The creator owns it.
 */
#ifndef SINEW_MESH_MASK_H
#define SINEW_MESH_MASK_H

#include "msds/mesh/mesh_cells.h"
#include "msds/mesh/mesh_chosen.h"

/* A side of the box: axis * 2, + 1 at its high end. */
enum { MESH_SIDES = 6 };

typedef struct mesh_mask {
    volume place;          /* the image's geometry; no voxels, no names */
    uint8_t *tissue;       /* voxels: 1, or 0 */
    int top;               /* a side */
    mesh_chosen only, air; /* by words: labels that alone are tissue (none: all), and that are not */
    int32_t *skin; /* columns along its axis, the others in their order: voxels above the first of tissue; all of them
                        where there is none */
} mesh_mask;

/* labels: becomes whether the words, of which there are none where list is NULL, ask for any. -1 with e filled: a
 * usage error. */
int mesh_mask_words(const char *list, bool *labels, err *e);

/* Makes m (zeroed) of the words about the image. cell: the size of a finest cell, voxels. At most MESH_MASK_BYTES a
 * voxel are taken. -1 with e filled, and to be freed all the same, as below: no memory, nothing that is tissue. */
enum { MESH_MASK_BYTES = 20 };

int mesh_mask_grey(mesh_mask *m, const char *list, const volume *like, int top, const double cell[3], err *e);

/* Takes those about labels. labels: NULL, if there are no such words. where: the image's name. Then m is complete. */
int mesh_mask_labels(mesh_mask *m, const char *list, const volume *labels, const char *where, err *e);

/* Whether words leave out all that has a label. m: a mesh_mask. */
bool mesh_mask_leaves(const void *m, int64_t label);
void mesh_mask_free(mesh_mask *m);

/* The part of a cell's voxels that is tissue. */
double mesh_mask_share(const mesh_mask *m, const mesh_cells *c, const mesh_cell *of);

/* Of the columns along the top's axis that go through a cell: the voxels above the skin, at least and at most. low is
 * above high where none has tissue. */
typedef struct mesh_span {
    int64_t low, high;
} mesh_span;

mesh_span mesh_mask_skin(const mesh_mask *m, const mesh_cells *c, const mesh_cell *of);

/* How much tissue there is at a place in voxels (the centre of 0 0 0 is 0 0 0), trilinear: 1/2 at the border. */
double mesh_mask_at(const mesh_mask *m, const double voxel[3]);

#endif
