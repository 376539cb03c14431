/* Holds a voxel model by films of tissue between the surface of bone and points at most half a voxel away from it, in
 * place of rigid nodes. Each piece of the surface that is half a voxel from the bone, in one element, is a film: it has
 * the tissue between it and the bone, and is pulled as that is strained between the bone and the displacement of its
 * point in the element (tled/problem/films.h). What films have of elements is listed: the rest counts as theirs.
 *
 * The surface is moved along normals of its vertices, so that pieces of a round bone neither overlap nor part. Which
 * side of it has the tissue is seen by the elements near its polygons: by all those of a surface, if these agree.
 */
#ifndef SINEW_FILM_H
#define SINEW_FILM_H

#include "model/model.h"
#include "rigid.h"

/* Makes the axes bone and film in place of those that are there, of the rigid surfaces. node.anchor (and node.body) are
 * those of Algorithm 2: a film belongs to the body that the node nearest to it of its surface does. Then no node is
 * rigid any more. *area gets the films' (m2). -1 with e filled. */
int film_make(model *m, const rigid *r, double *area, notes *warnings, err *e);

/* Takes away the axes bone and film. */
void film_drop(model *m, notes *warnings);

#endif
