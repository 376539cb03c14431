/* A problem cut for a march through its lattice, as the CUDA executor takes it in both precisions. The lattice is cut
 * into columns of 15 by 15 nodes, of which blocks of 16 by 16 threads go layer by layer along one axis: thread (i, j)
 * computes the cell whose low corner has place (i, j) in the column, and moves the node of that place. Places 1 to 15
 * are owned, 0 and 16 are of columns beside this one.
 *
 * What stands at the places of a layer is told by words: which node, whether it is owned, whether a cell has its low
 * corner there. A layer's words stand in the order of threads, each warp having 8 by 4 of them, so that warps without
 * any cell in a layer, as in a shell, have little to do: warps 0 to 3 those of places 0 to 7 along rows, one after
 * another across, 6, 7, 4 and 5 the others. Then come those of places (16, 0) to (16, 16) and (0, 16) to (15, 16).
 *
 * Nodes stand in an order of the march's own: by part and column, each in the one that owns it, then by layer, then row
 * by row. So what a column owns of a layer stands in one piece, whatever axes are taken.
 *
 * The axes are those by which the fewest warps have cells, summed over layers; a unit is what a block takes at once:
 * layers in a row. Columns are cut into units of nearly equal cost, some for each block that the card runs at once: a
 * layer takes a block 2, 4 more where it has special cells, and 1 for each warp with cells. Blocks take units in turn,
 * in the order of columns and layers, pass after pass; a unit waits for those near it alone, in the pass before, which
 * this order has long since left behind. The creator owns the march; it holds no pointer into the problem.
 *
 * A problem with slits is cut into sheets (lattice_sheet.h), each with columns of its own: a column has the cells that
 * touch nodes which it owns, and their corners, whoever owns these. Nodes that no sheet takes, tips, stand after all
 * others in the order; up to MARCH_TIPS of them are a unit, beside one that owns nodes next to them, in which eight
 * threads each compute the elements of one: a row of eight march_tip.
 */
#ifndef SINEW_MARCH_H
#define SINEW_MARCH_H

#include "tled/problem/state.h"

enum {
    MARCH_SIDE = 16,     /* cells along a column's side: one more than owned nodes */
    MARCH_THREADS = 256, /* cells of a layer */
    MARCH_WORDS = 296,   /* of a layer: 256 and 33, and 7 of no use */
    MARCH_PATCH_X = 8,   /* of a warp */
    MARCH_PATCH_Y = 4,
    MARCH_TIPS = 32,            /* the most of a unit */
    MARCH_AHEAD = 7,            /* layers that displacements are ahead, and words: so many of nothing follow the last */
    MARCH_NODE = (1 << 28) - 1, /* of a word: where its node stands */
    MARCH_SPECIAL = 1 << 28,    /* its cell is not of the plain law: see `which` */
    MARCH_THERE = 1 << 29,      /* there is a node */
    MARCH_OWN = 1 << 30         /* and this column moves it */
};
#define MARCH_CELL (UINT32_C(1) << 31) /* there is a cell */

/* Layers of nodes base to base + cells, and of cells base to base + cells - 1, whose nodes
 * all but the first and last are moved; or tips from base on. */
typedef struct march_unit {
    int32_t base, cells, special, tips; /* cells: 2 or more, or 0 where there are tips; special: it has special cells */
} march_unit;

/* A muscle of a cell, or none: curve is -1. */
typedef struct march_muscle {
    float fibre[3]; /* a direction along the march's axes */
    int32_t curve;  /* the script's; MARCH_SECOND: there is another */
} march_muscle;
enum { MARCH_SECOND = 1 << 30 };

/* A cell that is not plain: of another law, contracting, mixed, or not all tissue. What it has is multiplied by its
 * share of tissue, and a muscle's peak by the muscle's share of the cell. What most of them need comes first. `second`
 * is what holds modes under isotropic control; else, of the Mooney-Rivlin form 2 c01, of `first` 4 c2, and `more` 6 c3,
 * 8 c4, 10 c5. */
typedef struct march_cell {
    double mu, bulk, second, peak; /* Pa; second: below; peak: of the first of: */
    march_muscle muscle[2];        /* of its volumes, those that may contract */
    double second_peak, more[3];
    double family[4]; /* of fibres that resist being stretched: k1, k2, kappa, angle (rad) */
} march_cell;

/* What a cut cell has besides (element_cut.h): means over its part of the coordinates along the march's axes, -1 to 1,
 * and of the products of the first and second, second and third, third and first. */
typedef struct march_cut {
    float x, y, z, xy, yz, zx;
} march_cut;

/* An element of a tip. */
typedef struct march_tip {
    int32_t node[8]; /* where its corners stand: of the lower face, then of the upper; along rows first */
    int32_t corner;  /* which of them is the tip; -1: the tip has no such element, nor one after it */
    int32_t special; /* in cell, from 1 on; 0: it is plain */
} march_tip;

typedef struct march {
    int axis[3];   /* the model's axes along the rows of columns, across them, and along the march */
    int32_t plain; /* the volume of plain cells */
    int64_t layers, units, details, cells;
    int64_t nears;    /* a row of `near`, a multiple of 32 */
    double computed;  /* threads of warps with cells, over elements */
    double cost;      /* of all layers, by march_units.c's measure */
    int32_t *order;   /* nodes: where each stands */
    uint32_t *word;   /* (layers + MARCH_AHEAD) x MARCH_WORDS */
    march_unit *unit; /* units: none where the problem is not suited */
    int32_t *near;    /* units x nears: the units that have nodes which this one moves, or
               * move what it has, itself too; then -1 */
    int32_t *detail;  /* layers + MARCH_AHEAD: where its special cells stand in `which`, in layers; or -1 */
    int32_t *which;   /* details x MARCH_THREADS: in cell, from 1 on; 0: none */
    march_cell *cell;
    march_cut *cut; /* cuts: of the first of these cells, which are the cut ones */
    int64_t cuts;
    int families;    /* of fibres that resist being stretched, the most of a cell */
    uint32_t *along; /* ((layers + MARCH_AHEAD) x MARCH_THREADS + tips x 8) x 2: the directions of cells' and of
                      * tips' elements' (march_cells.h); NULL: there are none */
    int64_t tips;
    int32_t tip_first; /* where the first of them stands */
    march_tip *tip;    /* tips x 8; NULL: there are none */
} march;

/* The warp of a place in its layer. A multiprocessor has four schedulers, and every fourth warp is one's: neighbours
 * are of different ones, along rows and across. */
static inline int march_warp_of(int32_t i, int32_t j)
{
    const int half = i / MARCH_PATCH_X;
    return 4 * half + (j / MARCH_PATCH_Y + 2 * half) % 4;
}

/* The word of a place in its layer. */
static inline int march_word_of(int32_t i, int32_t j)
{
    if (i == MARCH_SIDE)
        return MARCH_THREADS + j;
    if (j == MARCH_SIDE)
        return MARCH_THREADS + MARCH_SIDE + 1 + i;
    return 32 * march_warp_of(i, j) + MARCH_PATCH_X * (j % MARCH_PATCH_Y) + i % MARCH_PATCH_X;
}

/* slots: blocks that the card runs at once. A problem whose cells fill too few threads has no units, and no order. -1
 * with e filled, and m to be freed all the same. */
int march_make(march *m, const tled_problem *p, int64_t slots, err *e);
void march_free(march *m);

/* Whether a step in double precision is predicted to take less time so than in bricks that compute `cells` elements.
 * slots: as above. */
bool march_pays(const march *m, int64_t cells, int64_t slots);

#endif
