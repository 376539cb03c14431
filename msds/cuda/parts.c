#include "msds/cuda/parts.h"

#include "base/mem.h"

#include <stdlib.h>

enum { HOLD = 3 };

/* The first node of n's part so far; halves the way there. */
static int32_t first_of(int32_t *toward, int32_t n)
{
    while (toward[n] != n) {
        toward[n] = toward[toward[n]];
        n = toward[n];
    }
    return n;
}

int parts_held(const msds_problem *p, err *e)
{
    int32_t *toward = mem_array(p->nodes, sizeof *toward, "the parts of the mesh", e);
    uint8_t *held = mem_array(p->nodes, sizeof *held, "the parts of the mesh", e);
    int result = toward && held ? 0 : -1;
    for (int64_t n = 0; n < p->nodes && !result; n++)
        toward[n] = (int32_t)n;
    for (int64_t i = 0; i < p->springs && !result; i++) {
        int32_t a = first_of(toward, p->spring[i].node[0]), b = first_of(toward, p->spring[i].node[1]);
        if (a > b)
            toward[a] = b;
        else
            toward[b] = a;
    }
    for (int64_t n = 0; n < p->nodes && !result; n++) {
        int32_t first = first_of(toward, (int32_t)n);
        held[first] = (uint8_t)(held[first] + (p->fixed[n] && held[first] < HOLD));
    }
    for (int64_t n = 0; n < p->nodes && !result; n++)
        if (!p->fixed[n] && held[first_of(toward, (int32_t)n)] < HOLD)
            result = err_set(e, NULL, 0,
                             "nothing holds node %lld's part of the model, so that the FEM has no unique solution; "
                             "expected rigid nodes",
                             (long long)n);
    free(toward);
    free(held);
    return result;
}
