/* Says which parts of neighbouring voxels hang together: across a face, where samples on either side of it are inside
 * and no slit cuts them apart; where none lie opposite each other, and at an edge or a corner, where the line between
 * the two nearest samples stays inside (sight.h). What is asked is a function of the two parts alone, so that all
 * lattice points that both have agree. Borrows all but its tables.
 */
#ifndef SINEW_JOINS_H
#define SINEW_JOINS_H

#include "voxelise/sight.h"
#include "voxelise/voxels.h"

/* Whether two parts hang together, the part of the lower element first. */
typedef struct joins_known {
    int64_t one, other; /* elements + 1; 0: an empty place */
    int32_t part, other_part;
    bool joined;
} joins_known;

typedef struct joins {
    const voxels *x;
    voxels_layers layer; /* owned */
    int64_t *first;      /* runs: the first element of each; owned */
    const cuts *cut;
    int samples;        /* N; 1: by centres */
    sight *sight;       /* owned */
    joins_known *table; /* of so many places, a power of 2; owned */
    int64_t size, known;
} joins;

/* t: the triangles of level 0. g: the lattice of samples. */
int joins_create(joins *j, const voxels *x, const cuts *cut, const inside_triangles *t, const grid *g, int samples,
                 err *e);
void joins_free(joins *j);

/* A part of a voxel. */
typedef struct joins_part {
    int32_t at[3]; /* the voxel */
    int64_t element;
    const pieces_cell *cell; /* NULL: all samples are inside, and of one part */
    int32_t part;
} joins_part;

/* The element in a voxel, or -1. */
int64_t joins_element(const joins *j, const int32_t *cell);

/* The squared distance from the nearest sample of a part to a place in its voxel, both in samples from its first. */
double joins_distance2(const joins *j, const joins_part *p, const double *place);

/* The sample of a part that is nearest to the middle of all of them. */
void joins_middle(const joins *j, const joins_part *p, int32_t *to);

/* Whether parts of two voxels that share a face, an edge or a corner, or of one voxel, hang together. */
bool joins_are_joined(joins *j, const joins_part *one, const joins_part *other);

#endif
