/* The parts of a voxel by its samples: samples that are inside and next to each other along an axis are of one part,
 * unless a slit cuts them apart (cuts.h). Voxels that are all inside and uncut are not kept: they are one part. The
 * caller owns a pieces, one a thread, and a list.
 */
#ifndef SINEW_PIECES_H
#define SINEW_PIECES_H

#include "voxelise/climb.h"
#include "voxelise/cuts.h"

/* So many samples of a part are in a volume. */
typedef struct pieces_share {
    int32_t cell, part, volume, samples; /* cell: in its list */
} pieces_share;

typedef struct pieces_cell {
    int32_t cell[3];
    int32_t parts;   /* from their lowest samples on */
    int64_t element; /* of one voxel each */
    int64_t bits;    /* the first word of the first part */
} pieces_cell;

/* In the order of the elements. */
typedef struct pieces_list {
    pieces_cell *cell;
    uint64_t *bits;      /* parts x pieces_words: a bit for each sample, (z N + y) N + x */
    pieces_share *share; /* of voxels of several parts: by cell, part and volume */
    int64_t cells, words, shares, cell_capacity, bits_capacity, share_capacity;
} pieces_list;

/* Words of the bits of a part. */
static inline int64_t pieces_words(int samples)
{
    return ((int64_t)samples * samples * samples + 63) / 64;
}

/* Bytes for a voxel, in a list and once more in what it is joined to. */
double pieces_bytes(int samples);

void pieces_list_free(pieces_list *l);

/* Makes an empty list with room for so much. */
int pieces_list_reserve(pieces_list *l, int64_t cells, int64_t words, int64_t shares, err *e);

/* Adds a list, whose elements are numbered from `element` on. */
int pieces_list_join(pieces_list *to, const pieces_list *from, int64_t element, err *e);

/* The voxel of an element, or NULL: all of it is inside, and one part. */
const pieces_cell *pieces_of(const pieces_list *l, int64_t element);

/* The shares of a voxel of several parts: the first, and how many (0: it has one part). */
const pieces_share *pieces_shares(const pieces_list *l, const pieces_cell *of, int64_t *count);

typedef struct pieces {
    int samples;     /* N */
    const cuts *cut; /* borrowed */
    int64_t low;     /* voxel along x */
    int64_t words;   /* of a row of samples */
    uint64_t *row;   /* N x N rows of samples */
    climb_runs runs; /* of samples */
    uint16_t *in, *part;
    uint16_t *closed[3]; /* N x N each: samples that are cut from the next along an axis */
} pieces;

/* g: the lattice of samples. */
int pieces_create(pieces *p, const grid *g, int samples, const cuts *cut, err *e);
void pieces_free(pieces *p);

/* Takes a run of samples of the row of voxels at hand. */
int pieces_add(pieces *p, const climb_run *run, err *e);

/* The voxels of a row, whose runs are given, from the samples taken since the last row. element: the first one's. */
int pieces_row(pieces *p, const climb_run *run, int64_t runs, int64_t element, pieces_list *to, err *e);

#endif
