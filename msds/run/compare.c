#include "msds/run/compare.h"

#include "base/mem.h"

#include <stdlib.h>

compare *compare_make(const msds_problem *p, const msds_executor *device, pool *threads, err *e)
{
    compare *c = mem_array(1, sizeof *c, "the comparison", e);
    if (!c)
        return NULL;
    c->p = p;
    c->ours = mem_array(p->nodes, 3 * sizeof *c->ours, "the comparison", e);
    c->other = c->ours ? mem_array(p->nodes, 3 * sizeof *c->other, "the comparison", e) : NULL;
    c->state = c->other ? device->create(p, threads, e) : NULL;
    if (c->state)
        return c;
    compare_free(c, device);
    return NULL;
}

void compare_free(compare *c, const msds_executor *device)
{
    if (!c)
        return;
    if (c->state)
        device->destroy(c->state);
    free(c->ours);
    free(c->other);
    free(c);
}

static double square_of(const double *a)
{
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

int compare_frame(compare *c, const msds_executor *device, msds_state *state, const msds_plan *plan, int64_t count,
                  err *e)
{
    double off = 0, size = 0, worst = 0, largest = 0;
    if (device->step(c->state, plan, count, e) || device->monitor(c->state, &c->reading, e) ||
        device->get(state, MSDS_DISPLACEMENT, c->ours, e) || device->get(c->state, MSDS_DISPLACEMENT, c->other, e))
        return -1;
    const double *fem = plan->method == MSDS_SPRINGS ? c->ours : c->other;
    for (int64_t n = 0; n < c->p->nodes; n++) {
        double d[3];
        for (int a = 0; a < 3; a++)
            d[a] = c->ours[3 * n + a] - c->other[3 * n + a];
        off += square_of(d);
        size += square_of(fem + 3 * n);
        worst = fmax(worst, square_of(d));
        largest = fmax(largest, square_of(fem + 3 * n));
    }
    c->mean = off > 0 ? sqrt(off / size) : 0;
    c->worst = worst > 0 ? sqrt(worst / largest) : 0;
    return 0;
}
