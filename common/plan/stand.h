/* Where a probe stands, in words: on a voxel of a volume, on a surface or at a place, and along which axes. The caller
 * owns it, zeroed to begin with.
 */
#ifndef SINEW_STAND_H
#define SINEW_STAND_H

#include "base/keyfile.h"
#include "base/num.h"
#include "base/pose.h"
#include "surface/pseudonormal.h"
#include "surface/trimesh.h"
#include "volume/volume.h"

/* The volume and the surface that a plan names places and axes of. */
typedef struct stand {
    num_unit unit; /* of lengths without a suffix; 0: m */
    bool has_volume, has_surface;
    volume image;
    obj file;
    trimesh mesh; /* m */
    triangle_tree *tree;
    pseudonormal normal;
} stand;

/* -1 with e filled, and to be freed all the same. */
int stand_volume(stand *s, const char *path, err *e);
int stand_surface(stand *s, const char *path, num_unit unit, notes *warnings, err *e);
void stand_free(stand *s);

/* Takes the words from `at` on as PLACE [into AXIS] [columns AXIS]; *next: the first word that is left. -1 with e
 * filled: what is no place or axis, with the line. */
int stand_take(const stand *s, const keyfile *k, int at, int *next, pose *to, err *e);

/* "4mm", in m. -1 with e filled. */
int stand_length(const stand *s, const keyfile *k, const char *text, double *to, err *e);

/* Three lengths between commas, in m. -1 with e filled. */
int stand_lengths(const stand *s, const keyfile *k, const char *text, double to[3], err *e);

#endif
