/* Finds the element whose centre is nearest to a point. Blocks of 2 x 2 x 2 cells of the lattice, blocks of such
 * blocks, and so on up to one that holds all, know whether any element is in them: a search goes down only into those
 * that may hold a nearer centre than the one found. Owns its tables; searches may run in several threads.
 */
#ifndef SINEW_NEAREST_H
#define SINEW_NEAREST_H

#include "mesh/lattice.h"

enum { NEAREST_LEVELS = 32 };

typedef struct nearest_level {
    int32_t size[3];   /* blocks */
    uint8_t *occupied; /* NULL at level 0, whose blocks are the cells of the map */
} nearest_level;

typedef struct nearest {
    lattice grid;
    lattice_map map;
    nearest_level level[NEAREST_LEVELS];
    int levels;
    double tie;    /* centres whose distances differ by no more are equally near, m */
    double margin; /* further than this from its cell's sides (in cells), a point can have no tie */
} nearest;

/* m needs at least one hexahedron, each the box of its cell. threads: NULL for the caller alone. -1 with e filled. */
int nearest_build(nearest *n, const model *m, pool *threads, err *e);
void nearest_free(nearest *n);

/* point: finite, m. Of equally near elements (to 1e-9 of a cell's shortest side) the one of the lowest index. */
int32_t nearest_element(const nearest *n, const double *point);

#endif
