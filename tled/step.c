#include "tled/step.h"

#include <math.h>

void step_matrix_of(const tled_problem *p, const tled_law *law, element_tensor h, element_fibre fibre,
                    element_fibre second, step_matrix *a)
{
    stability_matrix(law->mu, law->bulk, law->density, p->side, h, fibre, second, a);
}

bool step_below(const step_matrix *a, double limit)
{
    return stability_below(a, limit);
}

double step_largest(const step_matrix *a)
{
    return stability_largest(a);
}

/* The square of the highest frequency of an element at rest, or what that is at most where two volumes are mixed. */
static double square_at_rest(const tled_problem *p, int64_t element)
{
    const tled_volume *v = &p->volume[p->element_volume[element]];
    if (tled_mix(p, element) < 0)
        return v->square;
    const tled_volume *w = &p->volume[p->mix[element]];
    const double s = tled_mixture(p, element), own = (1 - s) * v->density, other = s * w->density;
    return (own * v->square + other * w->square) / (own + other);
}

double step_at_rest(const tled_problem *p, int32_t *volume)
{
    double highest = 0;
    for (int64_t i = 0; i < p->elements; i++) {
        double square = square_at_rest(p, i);
        if (square > highest && volume)
            *volume = p->element_volume[i];
        highest = fmax(highest, square);
    }
    return 2 / sqrt(highest);
}

double step_rate(double stable, int64_t *check)
{
    double parts, steps = fmax(1, ceil(.01 / (.5 * stable)));
    parts = ceil(steps / 50);
    *check = (int64_t)ceil(steps / parts);
    return 100 * parts * (double)*check;
}
