/* A problem in rows, for an executor that computes several elements side by side: nodes in the order of their places in
 * the lattice, x fastest; elements that follow each other along x in runs, whose corners then follow each other too.
 * The problem is cut into slabs of whole rows of nodes, one for a thread at a time: a slab computes every element at
 * its nodes, those at its border as its neighbour does too, so that no thread waits for another within a step and each
 * node's sum is the same however it is cut.
 *
 * A run is at most `lanes` elements of one volume, or mixed of the same two; its corners need not lie in a
 * lattice, but for where they follow each other: any model of boxes can be cut so. The creator owns the
 * rows; they hold no pointer into the problem.
 */
#ifndef SINEW_ROWS_H
#define SINEW_ROWS_H

#include "tled/problem/state.h"

enum {
    ROWS_PAD = 16
}; /* nodes between slabs and at both ends, and cells at the end, that mean nothing but may be read */

typedef struct rows_run {
    int32_t node[8]; /* of its first element's corners, VTK order, in the rows' order of nodes */
    int32_t cell;    /* its first element, in the order of fibre and fraction */
    int32_t volume;
    int32_t mix;    /* the second volume of all of them, or -1 */
    int32_t cut;    /* of runs with an element that is cut, which one this is; -1: none is */
    int32_t border; /* of runs of laminates, which one this is; -1: none of its elements is one */
    uint8_t count;  /* elements */
    uint8_t mask;   /* bit r: the row of nodes at corners 2r and 2r + 1 (r = 0 to 3: y, z
               * low; y high; ...) is the slab's own */
    bool regular;   /* node[1] is node[0] + 1, and so on */
} rows_run;

/* A layer of a slab: after its runs, its nodes have their sums. */
typedef struct rows_layer {
    int32_t run, runs;
    int32_t node, nodes;
} rows_layer;

typedef struct rows_slab {
    int32_t layer, layers;
    int32_t extra, extras; /* of its nodes */
} rows_slab;

typedef struct rows {
    int32_t lanes;
    int32_t slabs, layers, runs, cells, extras, cuts, borders; /* cuts: runs with an element that is cut; borders:
                                                                * of laminates */
    int64_t nodes;                                             /* with all padding: the length of arrays over nodes */
    rows_slab *slab;
    rows_layer *layer;
    rows_run *run;
    int32_t *place;        /* the model's nodes: where each is */
    int32_t *cell_element; /* cells: which of the model's elements */
    int32_t *extra; /* extras: nodes in the rows' order that the script displaces or pushes; ascending in each layer */
    int32_t *extra_node; /* extras: which of the model's nodes */
} rows;

/* Whether the script displaces or pushes a node that does not slide. */
bool rows_is_extra(const tled_problem *p, int64_t node);

/* Lists the extras again, once places and slabs are known. -1 with e filled. */
int rows_list_extras(rows *r, const tled_problem *p, err *e);

/* slabs: as many as that, or fewer. -1 with e filled and r to be freed all the same. */
int rows_make(rows *r, const tled_problem *p, int lanes, int slabs, err *e);
void rows_free(rows *r);

#endif
