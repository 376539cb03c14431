#include "tled/problem/muscle_fibre.h"

#include "physics/stability.h"

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
