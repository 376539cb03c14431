/* How many operations a step of the solver takes, counted, not estimated: element.h and node.h are compiled once more
 * with a type of number that counts what is done to it. Additions (and subtractions), multiplications, divisions and
 * square roots of numbers that are not known when it is compiled, those that are written twice once; not: changes of
 * sign, comparisons, selections, conversions. Owns nothing.
 */
#ifndef SINEW_FLOPS_H
#define SINEW_FLOPS_H

#include "physics/hourglass_numbers.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct flops {
    int64_t add, multiply, divide, root;
} flops;

/* Of one element whose fibres are all at rest, or one of which contracts: its forces at the corners, and these
 * added to what its nodes have. result, or NULL: gets the forces (x, y, z: 8 each) for displacements u likewise,
 * computed with the numbers that count. */
flops flops_of_element(hourglass_kind kind, int is_active, const double u[24], double result[24]);

/* Of one node that nothing holds: a pass that ends a step and begins the next. */
flops flops_of_node(void);

static inline int64_t flops_sum(flops f)
{
    return f.add + f.multiply + f.divide + f.root;
}

#ifdef __cplusplus
}
#endif

#endif
