/* W&M Algorithm 1 on one row of cells along x: a voxel climbs to a level only if it was taken at the
 * one below; within a level the first volume keeps it. 64 cells at a time. The caller owns a climb
 * and a list of runs, one of each a thread.
 */
#ifndef SINEW_CLIMB_H
#define SINEW_CLIMB_H

#include "voxelise/inside.h"

/* Rays run along y (any axis but that of the runs; slabs are then whole layers of z). */
enum { CLIMB_RAY = 1 };

/* Cells from <= i < to of row (j, k). */
typedef struct climb_run {
    int32_t from, to, j, k, volume;
} climb_run;

typedef struct climb_runs {
    climb_run *run; /* owned */
    int64_t runs, capacity;
} climb_runs;

int climb_add_run(climb_runs *to, climb_run run, err *e);

/* Of one volume. */
typedef struct climb_count {
    int64_t inside;  /* centres in it */
    int64_t reached; /* of them, those taken at the level below (on level 0 all) */
    int64_t kept;    /* of them, those that it has in the end */
    int64_t mixed;   /* by shares (shares.h): voxels that it is the second volume in */
    int64_t divided; /* likewise: voxels in which its samples count as those of two others */
} climb_count;

typedef struct climb {
    const inside *test;   /* with rays along CLIMB_RAY; borrowed */
    const int32_t *level; /* volumes, which are in order of level, then of priority; borrowed */
    climb_count *count;   /* volumes */
    inside_part *active;  /* the volumes in a row, in order */
    int64_t actives, capacity;
    uint64_t *below, *now; /* words of a row: what is taken on the level below, and on this one */
} climb;

int climb_create(climb *c, const inside *test, const int32_t *level, int32_t volumes, err *e);
void climb_free(climb *c);

/* Adds a row's runs to a list (NULL: they are counted only), by where they begin. It writes over the slab's row. */
int climb_row(climb *c, const inside_slab *slab, int64_t j, int64_t k, climb_runs *to, err *e);

#endif
