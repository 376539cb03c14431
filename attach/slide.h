/* Lets nodes that rigid surfaces hold slide on these, by distance fields of the bone, sampled at corners of voxels
 * around them (tled/contact/sliding.h): a field for the bone of each rigid body, and one for what belongs to none. The
 * distance is that to the nearest triangle, and its sign is by the pseudonormal of what the nearest point lies on, so
 * turned for each surface that the elements at its nodes have more than 0. Keeps nothing.
 */
#ifndef SINEW_SLIDE_H
#define SINEW_SLIDE_H

#include "base/pool.h"
#include "bone_field.h"
#include "cli/opt.h"

typedef struct slide_options {
    const opt_list *keep, *off; /* values of --slide, and of --slide-off: SURFACE,...[:REGION] */
} slide_options;

typedef struct slide_found {
    int64_t nodes, fields;
    double worst; /* in voxels: how far from the bone the furthest of them is */
} slide_found;

/* Makes the axis slide in place of the one that is there, adds its fields to `fields`, and takes these nodes out of
 * node.rigid, node.anchor and node.body, which must be there; without any option only drops the axis. Coordinates of
 * files and of boxes are in the model's source.unit. -1 with e filled where an option is wrong, holds no node, or its
 * surface does not face one way. */
int slide_make(model *m, const rigid *r, const slide_options *o, pool *threads, bone_fields *fields, slide_found *found,
               notes *warnings, err *e);

#endif
