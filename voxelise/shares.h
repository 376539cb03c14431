/* The volume fraction of each voxel: a voxel is divided into N^3 parts, and the centre of each is a sample, which is in
 * or out, and in one volume, as a voxel's centre is (climb.h). Samples come in runs along x, and are counted at two
 * additions a run. The caller owns a `shares`, one a thread.
 *
 * A voxel is mixed of the two volumes that have most of its samples; those of a third are divided between the two in
 * proportion. As a laminate, of tissue in three layers and more, it is mixed of the stiffest and the softest; samples
 * of others are divided between these so that side by side all have the stiffness that they had, and, as they stay
 * where they are, the same in bending: of modulus m by (m - m_1)/(m_2 - m_1). Beside what is no layer,
 * as a muscle, all layers are one volume, that of the largest, unless a second muscle has more than all of them.
 *
 * The error of a share: where a plane cuts a voxel, each column of parts along the axis that it faces most is off by no
 * more than half a part, so the voxel by no more than 1 / (2 N). Over planes at random the root mean square is 0.066,
 * 0.015, 0.0039 and 0.0008 for N = 2, 4, 8 and 16.
 */
#ifndef SINEW_SHARES_H
#define SINEW_SHARES_H

#include "mesh/cut_moments.h"
#include "voxelise/climb.h"

/* ---- moments
 *
 * Of voxels that are enclosed in part: the means of xi, eta, zeta, xi eta, eta zeta, zeta xi and xi eta zeta, each from
 * -1 to 1 across the voxel, over the samples that are inside. In units of half a sample's width all places are odd
 * whole numbers, so sums are exact, in any order. And of a voxel that two volumes share: the moments of the second's
 * part, and the normal of the border, n dA over which is by Gauss what a part has of the voxel's faces, if no other
 * surface bounds it in the voxel.
 */

typedef struct moments_voxel {
    int64_t element;
    float of[CUT_MOMENTS];
    float faces[3]; /* of that part: on the high side of the voxel less the low, x, y and z, in parts of a side; of a
                     * border n dA, towards the second */
} moments_voxel;

/* In the order of the elements. */
typedef struct moments_list {
    moments_voxel *voxel; /* owned */
    int64_t count, capacity;
} moments_list;

/* Sums over samples: how many, and of each product of places. */
typedef struct moments_sums {
    int64_t count, of[CUT_MOMENTS];
    int64_t faces[3]; /* of rows: samples at the high side less those at the low */
} moments_sums;

/* Adds a sample of a voxel of `samples` along a side: i, j, k from 0. */
void moments_add_sample(moments_sums *s, int samples, int i, int j, int k);

/* Adds a voxel to a list, unless all its samples are inside. */
int moments_list_add(moments_list *to, int64_t element, const moments_sums *s, int samples, err *e);

/* Adds a list, whose elements are numbered from `element` on. */
int moments_list_join(moments_list *to, const moments_list *from, int64_t element, err *e);

/* A row of voxels. */
typedef struct moments {
    int samples;
    int64_t low, cells; /* of the lattice of voxels along x */
    int32_t *sum;       /* MOMENTS_ROWS x (cells + 1) */
} moments;

/* low, cells: of the voxels along x. */
int moments_create(moments *m, int samples, int64_t low, int64_t cells, err *e);
void moments_free(moments *m);

/* Counts a run of samples. */
void moments_add(moments *m, const climb_run *run);

/* Makes sums of what was counted, in voxels from <= i < past of the row, from low. */
void moments_close(moments *m, int64_t from, int64_t past);

/* Those of a voxel that has so many samples. */
moments_sums moments_at(const moments *m, int64_t i, int64_t count);

/* Forgets the row, of which voxels from <= i < past were counted. */
void moments_forget(moments *m, int64_t from, int64_t past);

/* ---- shares */

/* What makes an element. */
typedef struct shares_rule {
    int samples;  /* N, from 1 to SHARES_MOST */
    double least; /* the share of a voxel from which on it is one; some sample has to be inside in any case */
    bool moments; /* of voxels that are enclosed in part are found too */
    bool borders; /* and in those of two volumes, where a plane parts these */
    /* Where there are layers from the skin inward: */
    const double *modulus; /* volumes: in shear, at rest; nan of what does not lie beside layers, as muscles */
    int32_t lowest,
        layers; /* volumes of level 0, which the layers follow: from the skin inward, all above the former */
} shares_rule;

enum { SHARES_MOST = 16 };

typedef struct shares {
    shares_rule rule;
    int64_t low, cells; /* of the lattice of voxels along x */
    int32_t *slot;      /* volumes: a slot + 1; 0 = none */
    int32_t *volume;    /* slots */
    int64_t slots, volume_capacity;
    int32_t *sum; /* slots x 2 x (cells + 1): what begins or ends to fill each voxel, and what is left over in it */
    int64_t sum_capacity;
    int64_t from, past;           /* voxels that samples lie in, from low */
    moments moment;               /* of the row, where they are wanted */
    moments *part;                /* slots, likewise for borders: of each volume's samples */
    int64_t parts, part_capacity; /* made */
} shares;

/* g: the lattice of samples. */
int shares_create(shares *s, const grid *g, const shares_rule *rule, int32_t volumes, err *e);
void shares_free(shares *s);

/* Counts a run of samples. */
int shares_add(shares *s, const climb_run *run, err *e);

/* A voxel. */
typedef struct shares_voxel {
    float fraction; /* the share that is enclosed */
    float mixture;  /* of the samples of its own volume and of the second together, the share that is the second's */
    int32_t mix;    /* the second: the volume that has the most samples after its own, the first of two; -1: none */
} shares_voxel;

typedef struct shares_list {
    shares_voxel *voxel; /* owned */
    int64_t count, capacity;
    moments_list cut, border; /* owned */
} shares_list;

void shares_list_free(shares_list *l);

/* The voxels of row (j, k), from the samples counted since the last row: each belongs to the volume that has the most
 * of them, the first of two. list: grows by one for each voxel of the runs. kept: volumes, grow by their voxels: `kept`
 * of those that are theirs, `mixed` of those that they are the second in. */
int shares_row(shares *s, int64_t j, int64_t k, climb_runs *to, shares_list *list, climb_count *kept, err *e);

#endif
