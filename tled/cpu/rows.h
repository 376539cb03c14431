/* A problem in rows, for an executor that computes several elements side by side: nodes in the order of their places in
 * the lattice, x fastest; elements in groups of one kind, whose forces are kept until they are added to nodes, in the
 * elements' order. So each node's sum is the same whichever elements were computed side by side.
 * The problem is cut into slabs of whole rows of nodes, one for a thread at a time: a slab computes every element at
 * its nodes, those at its border as its neighbour does too, so that no thread waits for another within a step and each
 * node's sum is the same however it is cut. A slab is computed in blocks: so many elements that the cache holds their
 * forces, then the nodes that have their sums by then.
 *
 * A group is at most `lanes` elements of a block that are of one volume, or mixed of the same two, all cut or none, all
 * laminates or none. It consists of stretches, elements that follow each other along a row as their corners do; these
 * need not lie in a lattice, but for where they follow each other: any model of boxes can be cut so. The creator owns
 * the rows; they hold no pointer into the problem.
 */
#ifndef SINEW_ROWS_H
#define SINEW_ROWS_H

#include "tled/problem/state.h"

enum {
    ROWS_PAD = 16, /* nodes between slabs and at both ends, and cells at the end, that mean nothing but may be read */
    ROWS_BLOCK = 4096 /* elements to a block */
};

/* Elements of a group that follow each other along x, in the rows' order of elements as in its lanes. */
typedef struct rows_stretch {
    int32_t node[8]; /* of its first element's corners, VTK order, in the rows' order of nodes */
    uint8_t lane;    /* of its first element */
    uint8_t count;   /* elements */
    bool regular;    /* node[1] is node[0] + 1, and so on */
} rows_stretch;

typedef struct rows_group {
    int32_t cell;    /* its first element, in the order of fibre and fraction */
    int32_t stretch; /* its first */
    int32_t seat;    /* where its forces are kept until its block's nodes have them */
    int32_t volume;
    int32_t mix;    /* the second volume of all of them, or -1 */
    int32_t cut;    /* of groups that are cut, which one this is; -1: none is */
    int32_t border; /* of groups of laminates, which one this is; -1: none of its elements is one */
    uint8_t count, stretches;
} rows_group;

/* What of one corner of a stretch goes to `lanes` nodes that follow each other: of the forces from `at` on, those in
 * the lanes whose bits are set. at: in numbers, of the first component; the others' are 8 lanes and 16 lanes behind. */
typedef struct rows_term {
    int32_t at;
    uint32_t bits;
} rows_term;

/* The sums of `lanes` nodes: their terms are added one after the other, in the order of the elements. */
typedef struct rows_sum {
    int32_t node;
    int32_t term, terms;
} rows_sum;

/* A block of a slab: once its groups have their forces, these are added; then its nodes have their sums. */
typedef struct rows_block {
    int32_t group, groups;
    int32_t sum, sums;
    int32_t node, nodes;
} rows_block;

typedef struct rows_slab {
    int32_t block, blocks;
    int32_t extra, extras; /* of its nodes */
} rows_slab;

typedef struct rows {
    int32_t lanes;
    int32_t slabs, blocks, groups, stretches, sums, terms, cells, extras, seats;
    int32_t cuts, borders; /* groups of elements that are cut; of laminates */
    int64_t nodes;         /* with all padding: the length of arrays over nodes */
    rows_slab *slab;
    rows_block *block;
    rows_group *group;
    rows_stretch *stretch;
    rows_sum *sum;
    rows_term *term;
    int32_t *place;        /* the model's nodes: where each is */
    int32_t *cell_element; /* cells: which of the model's elements */
    int32_t *extra; /* extras: nodes in the rows' order that the script displaces or pushes; ascending in each block */
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
