/* The CPU executor's pass over a slab, compiled for each instruction set, precision and form of one source,
 * cpu_lanes.c: block by block, groups of elements side by side, whose forces are kept; then each corner's force is
 * added to its node, in the lattice's order; then the block's nodes, whose sums are whole. What the pass works on is
 * cpu_work's, which the executor owns (cpu_loops.h).
 *
 *     f_n = sum over elements at n of element_force(u),   a = g + (f_ext - f_n) / m,   then node.h.
 */
#ifndef SINEW_CPU_PASS_H
#define SINEW_CPU_PASS_H

#include "solve/vectors.h"
#include "tled/cpu/rows.h"

/* What an element without a lattice has, in a group's lanes: slopes, twists and volume (element_any.h); what holds its
 * modes, basis and moduli or k, by the control; the form's coefficients. */
enum { CPU_SHAPE = 34 };

static inline int cpu_hold_numbers(hourglass_kind control)
{
    return control == HOURGLASS_PHYSICAL ? 9 + HOURGLASS_NUMBERS : 1;
}

static inline int cpu_mesh_numbers(form f, hourglass_kind control)
{
    return CPU_SHAPE + cpu_hold_numbers(control) + form_numbers(f);
}

/* A law's numbers, in this order: the form's coefficients, then what holds the hourglass modes. */
static inline int cpu_law_numbers(form f)
{
    return form_numbers(f) + HOURGLASS_NUMBERS;
}

/* A volume's numbers: those of its law, and its tension. As many as the form has: steppers read them for each group. */
static inline int cpu_kind_numbers(form f)
{
    return cpu_law_numbers(f) + 1;
}

enum { NODE_FREE = 1, NODE_EXTRA = 8 }; /* flags of a node: NODE_FREE << a: nothing holds component a; an extra */

/* Arrays over nodes are in the rows' order, one for each component, of float or double as the function called. */
typedef struct cpu_work {
    const rows *r;
    const tled_problem *p;
    const double *kind;  /* volumes x cpu_kind_numbers: the law's numbers, then the tension of now */
    const void *from[3]; /* displacements */
    void *to[3];         /* the next ones, or internal forces */
    void *velocity[3];
    void *sum[3]; /* zeros, before and after */
    const void *mass_inverse;
    const uint8_t *flags;
    const void *fibre[3]; /* cells, or NULL */
    const void *fraction; /* cells, or NULL */
    const void *cut;      /* groups that are cut x 6 moments x lanes; or NULL: none is */
    const void *border;   /* groups of laminates x LAMINATE_NUMBERS x lanes; or NULL: none is */
    const void *weight;   /* nodes: by which gravity goes, in parts of the mass; or NULL: all of it */
    const void *mixture;  /* cells, or NULL: none is mixed */
    const void *law[FORM_NUMBERS + HOURGLASS_NUMBERS];                    /* cells: those that are mixed; or NULL */
    const void *mixfibre[3];                                              /* cells, or NULL */
    const void *family[FIBRE_FAMILIES][3], *mixfamily[FIBRE_FAMILIES][3]; /* cells, or NULL: of families */
    void *contractile, *mixcontractile; /* cells: contractile elements, which the pass moves on; or NULL */
    const void *shape;                  /* without a lattice: groups x cpu_mesh_numbers x lanes; or NULL */
    const int32_t *group_node;          /* likewise: groups x 8 x lanes; or NULL */
    void *force;                        /* groups, or seats of such, x 3 x 8 x lanes: what each corner is pulled with;
                                         * of seats, lanes before and behind may be read */
    const double *now, *next;           /* the curves' values */
    double dt, damping;
    int what;
} cpu_work;

/* A pass in one instruction set and precision. lanes: elements side by side. */
typedef struct cpu_pass {
    const char *name;
    int lanes;
    void (*slab)(const cpu_work *w, int32_t slab);
    /* Without a lattice: all groups of elements, then all nodes, from a multiple of lanes on. */
    void (*elements)(const cpu_work *w, int64_t from, int64_t to);
    void (*nodes)(const cpu_work *w, int64_t from, int64_t to);
} cpu_pass;

/* The passes of a precision, one for each set of solve/vectors.h and each form. */
extern const cpu_pass *const cpu_passes_double[VECTORS_COUNT][FORM_STEPPED];
extern const cpu_pass *const cpu_passes_single[VECTORS_COUNT][FORM_STEPPED];

/* That of the form in the first set that this processor can do, or in the one that the environment's SINEW_VECTORS
 * names: plain, AVX2 or AVX-512. All give the same bytes. NULL with e filled where that is not to be had. */
const cpu_pass *cpu_pass_choose(const cpu_pass *const passes[][FORM_STEPPED], form f, err *e);

#endif
