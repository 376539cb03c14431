#include "tled/step.h"

#include <math.h>

void step_matrix_of(const tled_problem *p, const tled_volume *v, element_tensor h, element_fibre fibre, step_matrix *a)
{
    stability_matrix(v->mu, v->bulk, v->density, p->side, h, fibre, a);
}

bool step_below(const step_matrix *a, double limit)
{
    return stability_below(a, limit);
}

double step_largest(const step_matrix *a)
{
    return stability_largest(a);
}

double step_at_rest(const tled_problem *p, int32_t *volume)
{
    const element_tensor rest = {0};
    const element_fibre none = {0};
    double least = INFINITY, share = p->side[0] * p->side[1] * p->side[2] / 8;
    for (int32_t i = 0; i < p->volumes; i++) {
        const tled_volume *v = &p->volume[i];
        step_matrix a;
        if (!v->elements)
            continue;
        step_matrix_of(p, v, rest, none, &a);
        double dt = 2 / sqrt(fmax(step_largest(&a), 8 * v->hourglass / (v->density * share)));
        if (dt < least && volume)
            *volume = i;
        least = fmin(least, dt);
    }
    return least;
}

double step_rate(double stable, int64_t *check)
{
    double parts, steps = fmax(1, ceil(.01 / (.5 * stable)));
    parts = ceil(steps / 50);
    *check = (int64_t)ceil(steps / parts);
    return 100 * parts * (double)*check;
}
