#include "tled/problem/muscle_fibre.h"

#include "base/mem.h"
#include "physics/stability.h"
#include "tled/problem/deformed.h"

#include <stdlib.h>

element_fibre muscle_fibre_of(const tled_problem *p, const float *along, int64_t element, int32_t volume, double share,
                              const double *value)
{
    if (!along || volume < 0)
        return (element_fibre){.tension = 0};
    element_fibre fibre = element_fibre_of(along + 3 * element, share, p->volume[volume].muscle);
    fibre.tension = value ? share * tled_tension(p, volume, value) : 0;
    return fibre;
}

double muscle_fibre_energy(const tled_problem *p, int64_t element, element_tensor h)
{
    const double mixture = tled_mixture(p, element);
    if (!p->curved)
        return 0;
    return element_fibre_energy(h,
                                muscle_fibre_of(p, p->fibre, element, p->element_volume[element], 1 - mixture, NULL)) +
           element_fibre_energy(h, muscle_fibre_of(p, p->mixfibre, element, tled_mix(p, element), mixture, NULL));
}

bool muscle_fibre_falls(const tled_problem *p, int64_t element, const double *value, element_tensor h, double mu)
{
    const double mixture = tled_mixture(p, element);
    const element_fibre own = muscle_fibre_of(p, p->fibre, element, p->element_volume[element], 1 - mixture, value);
    const element_fibre other = muscle_fibre_of(p, p->mixfibre, element, tled_mix(p, element), mixture, value);
    return (element_fibre_which(own) && stability_falls(h, own, mu)) ||
           (element_fibre_which(other) && stability_falls(h, other, mu));
}

/* c - 1 of a fibre whose spring has the stress of a muscle that does not move. */
static double at_rest(element_tensor h, element_fibre fibre)
{
    const double lambda = element_length(element_fibre_now(h, fibre.along));
    const double tension = fibre.tension * muscle_force_length(lambda + lambda * fibre.curves.less);
    const double spring = fibre.series.stiffness;
    return spring > 0 ? element_fibre_strain(h, fibre.along, lambda) - tension / spring : 0;
}

int muscle_fibre_rest(tled_problem *p, int i, double time, err *e)
{
    const bool second = i == TLED_MIXCONTRACTILE;
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    double *value = mem_array(p->script->curves, 3 * sizeof *value, "the muscles", e);
    if (!value)
        return -1;
    tled_curves(p, time, value);
    for (int64_t k = 0; k < p->elements; k++) {
        const double mixture = tled_mixture(p, k), share = second ? mixture : 1 - mixture;
        const int32_t volume = second ? tled_mix(p, k) : p->element_volume[k];
        const element_fibre fibre = muscle_fibre_of(p, second ? p->mixfibre : p->fibre, k, volume, share, value);
        const deformed d = deformed_of(p, k, box, p->at_start.of[TLED_DISPLACEMENT]);
        p->at_start.of[i][k] = at_rest(d.h, fibre);
    }
    free(value);
    return 0;
}
