/* The layers of a march in a row: the order of nodes that they own; and runs of layers of its columns, and how they are
 * cut into units for a card: march.h says by what model. Those of first sheets are cut as without further ones, whose
 * units come on top: so all have their turns as long after those near them as without. The creator owns the runs; what
 * march_runs_cut makes is its caller's.
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
    double all; /* of runs that are not of further sheets */
} march_runs;

/* Orders the nodes as words own them, behind them the tips, and says in all words where theirs stands. sheet: of each
 * node: SHEET_TIP, or not; NULL: there are no tips. -1 with e filled. */
int march_order_nodes(march *m, int64_t nodes, const int32_t *sheet, pool *threads, err *e);

/* Warps that a layer's mask says. */
int march_warps(uint8_t mask);

/* warps, special: of each layer with owned nodes: those with cells, and whether any of these is special. further: of a
 * sheet after the first, whose layers, where few warps have cells, last nearly as long as full ones. They count as
 * full: no step takes less time than its longest unit. */
int march_runs_add(march_runs *r, int32_t base, const uint8_t *warps, const bool *special, int64_t owned, bool further,
                   err *e);
int march_runs_cut(const march_runs *r, int64_t slots, march_unit **unit, int64_t *units, err *e);

/* Notes which units have special cells, once these are listed. */
void march_units_mark(march *m);
void march_runs_free(march_runs *r);

#endif
