/* Moves the normals of an OBJ (its vn lines) with a deformation: at each corner that uses a normal, by F^-T.
 */
#ifndef SINEW_NORMALS_H
#define SINEW_NORMALS_H

#include "mesh/bone.h"

/* Fills normal (o->normals x 3): the mean over the corners that use it of n' = F^-T n / |F^-T n|, made a unit vector;
 * as it was read where it turned by less than 1e-9, or no corner uses it. held (may be NULL): vertices at which nothing
 * turns. */
void normals_deform(const obj *o, const motion *m, const bone *carried, const bool *held, double *normal);

/* The same where only the vertices are known, position (o->vertices x 3, in the OBJ's unit): F at a corner is that of
 * its face, which the two edges there and the unit normal between them tell. A corner without area there turns
 * nothing. */
void normals_turn(const obj *o, const double *position, double *normal);

#endif
