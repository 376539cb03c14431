/* The parts of showing.c: what each kind of thing adds to a showing. Private to showing*.c.
 */
#ifndef SINEW_SHOWING_PARTS_H
#define SINEW_SHOWING_PARTS_H

#include "render/showing.h"

/* Adds a mesh, and its values (handed over; NULL: none). -1 with e filled; both are freed in every case. */
int showing_add(showing *b, scene_mesh *mesh, double *value, err *e);

/* Whether `name` is among the patterns (any case, '*' at the end). */
bool showing_named(const char *const *pattern, int patterns, const char *name);

/* By which of the want's clear one sees through what has this name: bit k for clear[k]. */
uint64_t showing_cleared(const showing_want *want, const char *name);

/* How the frame that is shown moves the nodes, which `what` moves with: *u is NULL at rest. -1 with e filled where the
 * frame does not say. */
int showing_moves(const showing_want *want, const char *what, const double **u, err *e);

/* Where a node is, as the frame moves it. u: NULL: at rest. */
void showing_place(const double *rest, const double *u, int64_t node, float *to);

/* A colour of 0 to 255 sRGB as linear. */
void showing_linear(const uint8_t srgb[3], float to[3]);

/* Whether all names asked for are names of something. */
int showing_check_names(const model *m, const showing_want *want, err *e);

/* All surfaces (or those that names say), the elements, the spheres, the probe.
 * at_nodes: the field at the nodes, or NULL. */
int showing_surfaces(showing *b, const model *m, const showing_want *want, const double *at_nodes, err *e);
int showing_elements(showing *b, const model *m, const showing_want *want, err *e);
int showing_spheres(showing *b, const model *m, const showing_want *want, err *e);
int showing_probe(showing *b, const model *m, const showing_want *want, err *e);

/* The image of the want, where it lies. */
int showing_slice(showing *b, const showing_want *want, err *e);

/* The surfaces of the want's body, as they lie to the volume; those of a rigid body of the model where that is. */
int showing_body(showing *b, const model *m, const showing_want *want, err *e);

#endif
