/* The blocks of a slab, for rows.c: which elements are computed side by side, and in which order their forces are
 * added. The builder owns its scratch, and lends the rows that it fills.
 */
#ifndef SINEW_ROWS_GROUPS_H
#define SINEW_ROWS_GROUPS_H

#include "tled/cpu/rows.h"

/* What elements of a group have alike, and where those of a block are in the order of kinds. */
typedef struct rows_kind {
    int32_t volume, mix;
    bool is_cut, is_laminate;
    int32_t from, count;
} rows_kind;

/* A term, and which sum of its slab it belongs to. */
typedef struct rows_placed_term {
    int32_t sum;
    rows_term term;
} rows_placed_term;

typedef struct rows_groups {
    rows *r;
    const tled_problem *p;
    int32_t node, nodes; /* the slab's, in the rows' order */
    int32_t seat;        /* the slab's first */
    rows_kind *kind;     /* ROWS_BLOCK each: the block's kinds, in the order of their first elements; */
    int32_t kinds;
    int32_t *kind_of; /* which of these each element is of; */
    int32_t *by_kind; /* elements by kinds; */
    int32_t *begins;  /* the stretch that begins with an element, or -1; and its group */
    int32_t *begins_in;
    rows_placed_term *listed; /* the block's, in the order of elements */
    int64_t count, *terms;    /* of these; of each sum of the slab, counted, then where they begin */
    int64_t block_capacity, group_capacity, stretch_capacity, sum_capacity, term_capacity, cell_capacity,
        listed_capacity, terms_capacity;
    err *e;
} rows_groups;

/* b: with rows whose nodes have places, the problem and e. -1 with e filled and b to be freed all the same. */
int rows_groups_make(rows_groups *b);
void rows_groups_free(rows_groups *b);

/* Adds a block of the slab whose nodes and first seat b holds: `count` elements, at most ROWS_BLOCK, ascending in the
 * rows' order. -1 with e filled. */
int rows_add_block(rows_groups *b, const int32_t *element, int32_t count);

#endif
