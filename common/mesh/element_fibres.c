#include "mesh/element_fibres.h"

#include <math.h>

element_fibres element_fibres_of(const model *m, const materials_map *map)
{
    const model_array *first = model_find(m, "element.fibre"), *second = model_find(m, "element.mixfibre");
    return (element_fibres){.map = map, .first = first ? first->f32 : NULL, .second = second ? second->f32 : NULL};
}

/* share: of the element that this volume is; contractile: elements, or NULL. */
static element_fibre fibre_of(const element_fibres *of, const float *along, int64_t element, int32_t volume,
                              double share, const double *activation, const double *contractile)
{
    double curve[MUSCLE_NUMBERS];
    if (!along || volume < 0)
        return (element_fibre){.tension = 0};
    const material *is = &of->map->of_volume[volume];
    material_muscle(is, curve);
    element_fibre fibre = element_fibre_of(along + 3 * element, share, curve);
    if (activation && isfinite(activation[volume]))
        fibre.tension = share * activation[volume] * is->peak / is->optimum;
    if (contractile)
        fibre.series.contractile = contractile[element];
    else
        fibre.series.stiffness = 0;
    return fibre;
}

static int32_t mix_of(const element_fibres *of, int64_t element)
{
    return of->map->mix ? of->map->mix[element] : -1;
}

/* The share of the element that its second volume has. */
static double second_share(const element_fibres *of, int64_t element)
{
    return mix_of(of, element) < 0 ? 0 : (double)of->map->mixture[element];
}

element_fibre element_fibres_first(const element_fibres *of, int64_t element, const double *activation)
{
    const double share = 1 - second_share(of, element);
    return fibre_of(of, of->first, element, of->map->volume[element], share, activation, of->contractile);
}

element_fibre element_fibres_second(const element_fibres *of, int64_t element, const double *activation)
{
    return fibre_of(of, of->second, element, mix_of(of, element), second_share(of, element), activation,
                    of->mixcontractile);
}
