/* The rigid bodies of a model: parts of its bone, each with the rigid nodes that move with it. A part is named by rigid
 * surfaces, or by the closed surface of an OBJ file around it. Keeps nothing.
 */
#ifndef SINEW_PART_H
#define SINEW_PART_H

#include "cli/opt.h"
#include "model/model.h"
#include "rigid.h"

/* Makes the axis body with body.name and body.centre, and node.body, in place of those that are there, from node.rigid,
 * node.anchor and `parts`, each NAME=SURFACE,... or NAME=FILE.obj; no parts: no such arrays. Coordinates of files are
 * in the model's source.unit.
 *
 * A rigid node belongs to a part of surfaces if the first surface that holds it is one of them; and to a part of a file
 * if it lies inside of it, or, where it lies inside of none, at most half a voxel's diagonal away from it: rigid nodes
 * are the layer nearest to the bone's surface. Of several files so near the nearest counts, of equals the first.
 * loose: surfaces that hold no node, which parts may have too. -1 with e filled where a part is wrong, has neither a
 * node nor a loose surface, or shares a node with another. */
int part_make(model *m, const opt_list *parts, const rigid *loose, notes *warnings, err *e);

/* The first part that names a surface, or -1. */
int32_t part_of_surface(const opt_list *parts, const char *name);

#endif
