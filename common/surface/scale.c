#include "surface/scale.h"

num_unit scale_unit(const char *unit, const model *m, err *e)
{
    const char *source = model_meta_of(m, "source.unit");
    const char *name = unit ? unit : source;
    num_unit known = name ? num_unit_of(name) : 0;
    if (known)
        return known;
    if (!unit && source)
        err_set(e, NULL, 0, "the model's source.unit is '%s'; expected " NUM_UNITS ": give --unit", source);
    else if (!unit)
        err_set(e, NULL, 0, "the model has no source.unit; expected --unit " NUM_UNITS);
    else
        err_usage(e, "--unit '%s': expected " NUM_UNITS, unit);
    return 0;
}

double scale_of(num_unit unit)
{
    return (double)unit / 1e6;
}
