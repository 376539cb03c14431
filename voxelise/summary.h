/* Makes what every run of voxelise says of its volumes: a table of what each has and has lost, and warnings about
 * volumes that have nothing and muscles that have lost half of their voxels. Keeps nothing.
 */
#ifndef SINEW_SUMMARY_H
#define SINEW_SUMMARY_H

#include "cli/text_table.h"
#include "voxelise/layers.h"
#include "voxelise/surfaces/grid.h"
#include "voxelise/volumes.h"
#include "voxelise/voxels.h"

/* What a run has found; borrowed. */
typedef struct summary {
    const volumes *plan;
    const layers *layer;
    const voxels *x;
    const grid *g;
    num_unit unit;
    const char *const *material; /* names */
    int64_t samples;             /* of a voxel, along each axis; 1: by centres */
    bool boxed;                  /* --box */
    bool laminates;              /* --mixed laminate */
    bool verbose;                /* priorities and surfaces too */
} summary;

/* A row a volume, in the model's order. The caller frees it. NULL with e filled. */
text_table *summary_table(const summary *s, err *e);

/* By shares: how many voxels the surfaces enclose. */
double summary_enclosed(const voxels *x);

/* Warns of volumes without voxels, of layers that voxels do not show, and of muscles that
 * keep at most half of their voxels. */
int summary_warn(const summary *s, notes *warnings, err *e);

#endif
