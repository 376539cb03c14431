/* Labels that words of the command line name. The creator owns them; nothing to free.
 */
#ifndef SINEW_MESH_CHOSEN_H
#define SINEW_MESH_CHOSEN_H

#include "volume/volume.h"

#include <stdbool.h>

enum { MESH_CHOSEN = 128 };

typedef struct mesh_chosen {
    int64_t value[MESH_CHOSEN];
    int count;
} mesh_chosen;

bool mesh_chosen_has(const mesh_chosen *c, int64_t value);

/* Adds a label by its number, or all labels of a name. option: who asks. -1 with e filled: a usage error. */
int mesh_chosen_add(mesh_chosen *c, const volume *labels, const char *option, const char *name, err *e);

/* The label of a voxel; voxel -1: outside, 0. -1 with e filled: not a whole number. where: the image's name. */
int mesh_chosen_read(const volume *labels, int64_t voxel, const char *where, int64_t *to, err *e);

#endif
