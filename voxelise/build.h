/* Elements from runs of voxels: the arrays of a model. Elements come in the order of the runs; nodes, the corners that
 * elements have, in k, j, i order (i fastest), numbered from one bit a corner of two layers, so that no grid is ever
 * stored whole. The further nodes of points that slits part follow those of their layer, in the same order; so rows of
 * nodes stay rows. The model owns what is added, which is the same for any number of threads.
 */
#ifndef SINEW_BUILD_H
#define SINEW_BUILD_H

#include "mesh/lattice.h"
#include "voxelise/slits.h"
#include "voxelise/volumes.h"
#include "voxelise/voxels.h"

/* Adds axes node and element, node.position, node.lattice, element.node, element.lattice and element.volume; by shares
 * element.fraction too, cut.element and cut.moments where x has any, and element.mix and element.mixture where some
 * element has a second volume, and
 * element.inside where slits are open. */
int build_elements(model *m, const voxels *x, const slits *s, const lattice *l, pool *threads, err *e);

/* Adds axis volume and its arrays; volumes have their numbers of the plan. */
int build_volumes(model *m, const volumes *plan, err *e);

/* Adds metadata for bind: the surface that slits lie between, by its name in the model, and those of its names that
 * bound level 0. */
int build_slits(model *m, const volumes *v, const char *name, err *e);

#endif
