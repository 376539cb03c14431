/* Finds the voxels that become elements, and the volume of each: slab after slab of the inside test, row after row of
 * Algorithm 1 (climb.h), by their centres or by the share that is enclosed (shares.h). The result is runs of voxels
 * along x, in the order of the elements (k, j, i; i fastest), the same for any number of threads; the caller owns it.
 */
#ifndef SINEW_VOXELS_H
#define SINEW_VOXELS_H

#include "base/pool.h"
#include "cli/progress.h"
#include "voxelise/pieces.h"
#include "voxelise/shares.h"

struct depths;

/* Layers from the skin inward, by shares: samples in volumes of level 0 are in layers by their depths (depths.h). The
 * layers are volumes that follow those of level 0; all others follow them. Borrowed. */
typedef struct voxels_strata {
    const struct depths *depth; /* of samples */
    int32_t lowest, layers;     /* volumes of level 0; layers */
} voxels_strata;

typedef struct voxels {
    climb_run *run;
    int64_t runs, elements;
    climb_count *count;  /* volumes; by shares, inside and reached are samples */
    float *fraction;     /* elements, by shares; otherwise NULL */
    int32_t *mix;        /* elements: the second volume, -1 = none; NULL where no element has one */
    float *mixture;      /* elements: its share of what is enclosed; likewise */
    bool moments;        /* by shares: they are looked for */
    moments_list cut;    /* where they are: of elements that are enclosed in part */
    moments_list border; /* of what two volumes fill, parted by a plane: of the second's part */
    pieces_list part;    /* by shares, where slits are looked for */
} voxels;

/* test: with rays along CLIMB_RAY; by shares, of the lattice of samples. level: of each volume; volumes are in order of
 * level, then of priority. rule: NULL for centres. cut (NULL: none are looked for): the slits between samples; then the
 * parts of voxels are found too. strata (NULL: there are none): then x's volumes are with the layers. Refuses, before
 * any of it is allocated, what would not fit in memory. progress (may be NULL) counts slabs and has been started. */
int voxels_find(voxels *x, const inside *test, const int32_t *level, int32_t volumes, const shares_rule *rule,
                const cuts *cut, const voxels_strata *strata, pool *threads, progress *shown, err *e);

void voxels_free(voxels *x);

/* Where each layer of cells begins, from the lowest that has a voxel to the highest. The caller owns it. */
typedef struct voxels_layers {
    int64_t low, count;   /* layers */
    int64_t *run, *voxel; /* layers + 1: the first run and the first voxel of each */
} voxels_layers;

int voxels_find_layers(const voxels *x, voxels_layers *l, err *e);
void voxels_layers_free(voxels_layers *l);

/* Refuses what would take more memory than there is: `elements` of them, on the lattice g, and so many bytes `more`, of
 * slabs and of the parts of voxels. available: bytes. */
int voxels_check_memory(const grid *g, double elements, double more, double available, err *e);

#endif
