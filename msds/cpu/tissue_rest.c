#include "msds/cpu/tissue_rest.h"

#include "base/mem.h"
#include "msds/cpu/tissue_work.h"

#include <math.h>
#include <stdlib.h>

/* Conjugate gradients end at this share of the square of the load, or after so many. */
static const double enough = 1e-8;
enum { MOST = 2000 };

/* What may be left then, so that tissue moves little at first. */
static const double bearable = 1e-4;

static void prestress_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const tissue *t = context;
    (void)chunk;
    t->loops->tissue_prestress(&t->m, &t->step, from, to);
}

/* What pressures at rest push nodes with, in t->left, and a unit of each; and the tangents without them. u is at rest,
 * and no point holds anything. */
static void find_load(tissue *t)
{
    tissue_clear(t, &t->step);
    tissue_clear(t, &t->way);
    tissue_clear(t, &t->left);
    for (int c = 0; c < t->pressed.p->cavities; c++) {
        float *held = &t->m.held[t->m.cavity_point + c];
        *held = -1;
        tissue_pull(t, &t->pulled);
        t->pushed[c] = tissue_dot(t, &t->pulled, &t->pulled);
        tissue_advance(t, t->pressed.p->cavity[c].at_rest);
        *held = 0;
    }
    tissue_pull(t, &t->pulled);
}

/* The step under the load. Elements keep what bulk stiffness they have of their own, so that they do not lock: any
 * stress in balance will do. */
static int solve(tissue *t, err *e)
{
    double left = tissue_advance(t, 0), beta = 0;
    const double first = left, least = enough * left;
    for (int i = 0; i < MOST && left > least; i++) {
        tissue_turn(t, beta);
        const double curvature = tissue_stiffness(t, &t->way);
        if (!(curvature > 0))
            break;
        const double before = left;
        left = tissue_advance(t, before / curvature);
        beta = left / before;
    }
    return left <= bearable * first
               ? 0
               : err_set(e, NULL, 0,
                         "no prestress balances the cavities: %.2g of their pressure is left; expected tissue "
                         "that holds them, and fewer elements",
                         sqrt(left / first));
}

int tissue_rest_make(tissue *t, err *e)
{
    const msds_problem *p = t->pressed.p;
    bool any = false;
    for (int c = 0; c < p->cavities; c++)
        any = any || p->cavity[c].at_rest != 0;
    float *made = any ? mem_array(6 * t->m.groups * LANES, sizeof *made, "the solver", e) : NULL;
    t->pushed = mem_array(p->cavities + 1, sizeof *t->pushed, "the solver", e);
    if ((any && !made) || !t->pushed) {
        free(made);
        return -1;
    }
    if (!p->cavities)
        return 0;
    tissue_copy(t, &t->started, t->u);
    tissue_clear(t, t->u);
    find_load(t);
    int failed = 0;
    if (any) {
        failed = solve(t, e);
        t->m.prestress = made;
        tissue_groups(t, prestress_work);
    }
    tissue_copy(t, t->u, &t->started);
    return failed;
}

/* What a cavity loses of its volume presses on its walls by how long that takes: outflow times how fast. */
void tissue_rest_fill(tissue *t, double elapsed)
{
    const msds_problem *p = t->pressed.p;
    bool throttled = false;
    for (int c = 0; c < p->cavities; c++) {
        const int32_t at = t->m.cavity_point + c;
        t->m.held[at] = 0;
        t->m.bulk[at] = elapsed > 0 ? (float)(p->cavity[c].outflow / elapsed) : 0;
        throttled = throttled || t->m.bulk[at] > 0;
    }
    if (throttled)
        tissue_measure(t);
    for (int c = 0; c < p->cavities; c++) {
        const int32_t at = t->m.cavity_point + c;
        t->m.held[at] = (float)-p->cavity[c].pressure - (throttled ? t->m.pressure[at] : 0);
    }
}
