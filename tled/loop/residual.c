#include "tled/loop/residual.h"

#include "base/mem.h"

#include <stdlib.h>

int residual_read(const tled_problem *p, const tled_executor *device, tled_state *state, double time,
                  double *displacement, double *residual, err *e)
{
    double *value = mem_array(p->script->curves, 3 * sizeof *value, "the forces", e);
    if (!value || device->get(state, TLED_DISPLACEMENT, displacement, e) ||
        device->get(state, TLED_INTERNAL, residual, e)) {
        free(value);
        return -1;
    }
    tled_curves(p, time, value);
    for (int64_t n = 0; n < p->nodes; n++) {
        double force[3];
        tled_external(p, value, displacement + 3 * n, n, force);
        for (int a = 0; a < 3; a++)
            residual[3 * n + a] = p->hold[3 * n + a] == HOLD_FREE ? force[a] - residual[3 * n + a] : 0;
    }
    free(value);
    return 0;
}
