/* The parts of build.c: what each kind of thing adds to a build. Private to build*.c.
 */
#ifndef SINEW_BUILD_PARTS_H
#define SINEW_BUILD_PARTS_H

#include "render/build.h"

/* Adds a mesh, and its values (handed over; NULL: none). -1 with e filled; both are freed in every case. */
int build_add(build *b, scene_mesh *mesh, double *value, err *e);

/* Whether `name` is among the patterns (any case, '*' at the end). */
bool build_named(const char *const *pattern, int patterns, const char *name);

/* Where a node is, as the frame moves it. u: NULL: at rest. */
void build_place(const double *rest, const double *u, int64_t node, float *to);

/* A colour of 0 to 255 sRGB as linear. */
void build_linear(const uint8_t srgb[3], float to[3]);

/* Whether all names asked for are names of something. */
int build_check_names(const model *m, const build_want *want, err *e);

/* All surfaces (or those that names say), the elements, the spheres. at_nodes: the field at the nodes, or NULL. */
int build_surfaces(build *b, const model *m, const build_want *want, const double *at_nodes, err *e);
int build_elements(build *b, const model *m, const build_want *want, err *e);
int build_spheres(build *b, const model *m, const build_want *want, err *e);

#endif
