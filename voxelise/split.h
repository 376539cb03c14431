/* Parts of voxels become elements: which parts of a voxel are one, the numbers that elements then have, and the voxels
 * with those of several elements repeated. Borrows the parts; owns its tables.
 */
#ifndef SINEW_SPLIT_H
#define SINEW_SPLIT_H

#include "voxelise/voxels.h"

typedef struct split {
    const pieces_list *of;
    int64_t *first;  /* cells of the list + 1: the number of the first part, counted in voxels of several parts only */
    int64_t parts;   /* of those */
    int64_t *lowest; /* parts: the lowest that is one with each */
    int64_t *past;   /* parts: the number that follows its voxel's last */
    int32_t *order;  /* parts: its element's place among those of its voxel */
    int64_t *before; /* cells + 1: elements that the voxels before it have got more */
} split;

int split_create(split *s, const pieces_list *of, err *e);
void split_free(split *s);

/* The number of the first part of a voxel that has several. */
int64_t split_number(const split *s, const pieces_cell *of);

/* Whether two parts of one voxel are one by now, and makes them one. */
bool split_are_one(const split *s, int64_t one, int64_t other);
void split_unite(split *s, int64_t one, int64_t other);

/* The part of a voxel that has the most samples together with those that are one with it; the first of several. */
int64_t split_largest(const split *s, const pieces_cell *of);

/* Numbers the elements, when all that is one has been made one. */
void split_number_elements(split *s);

/* The number of an element, by that of its voxel and of its part (-1: the voxel has one). */
int64_t split_element(const split *s, int64_t element, int64_t part);

/* Repeats voxels that have become several elements, with the share and the volumes of each; counts are made anew. */
int split_voxels(const split *s, voxels *x, int samples, int32_t volumes, err *e);

#endif
