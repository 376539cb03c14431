/* Runs of layers of a march's columns, and how they are cut into units for a card: march.h says by what model. The
 * creator owns the runs; what march_runs_cut makes is its caller's.
 */
#ifndef SINEW_MARCH_UNITS_H
#define SINEW_MARCH_UNITS_H

#include "tled/cuda/march.h"

typedef struct march_run {
    int32_t base, owned; /* its empty first layer; layers with owned nodes after it */
    int64_t first;       /* of their costs */
} march_run;

typedef struct march_runs {
    march_run *run;
    int64_t count, capacity;
    double *cost; /* of the owned layers of all runs */
    int64_t costs, costs_capacity;
} march_runs;

/* Warps that a layer's mask says. */
int march_warps(uint8_t mask);

/* warps, special: of each layer with owned nodes: those with cells, and whether any of these is special. */
int march_runs_add(march_runs *r, int32_t base, const uint8_t *warps, const bool *special, int64_t owned, err *e);
int march_runs_cut(const march_runs *r, int64_t slots, march_unit **unit, int64_t *units, err *e);
void march_runs_free(march_runs *r);

#endif
