#include "model/material_families.h"

#include "base/near.h"

#include <string.h>

static const char *kind_name(const material *of)
{
    return of->fibre ? of->fibre->name : fibre_kind_none;
}

int material_families_store(model *m, int64_t at, const material *of, err *e)
{
    model_array *kind = model_find(m, "material.fibre");
    if (!kind && !of->fibre)
        return 0;
    if (!kind && !(kind = model_add(m, "material.fibre", e)))
        return -1;
    for (int64_t i = 0; i < kind->rows; i++)
        if ((i == at || !*kind->str[i]) && model_set_text(kind, i, i == at ? kind_name(of) : fibre_kind_none, e))
            return -1;
    return 0;
}

int material_families_kind(const model *m, int64_t i, const fibre_kind **to, err *e)
{
    const char *names[FIBRE_KIND_MOST];
    const model_array *kind = model_find(m, "material.fibre");
    *to = kind ? fibre_kind_find(kind->str[i]) : NULL;
    if (!kind || *to || !strcmp(kind->str[i], fibre_kind_none))
        return 0;
    return near_unknown(e, m->stream, m->stream ? model_line(kind, i) : 0, "fibre", kind->str[i], names,
                        fibre_kind_names(names));
}

void material_families_drop(model *m)
{
    const model_array *kind = model_find(m, "material.fibre");
    bool any = false;
    for (int64_t i = 0; kind && i < kind->rows; i++)
        any |= strcmp(kind->str[i], fibre_kind_none) != 0;
    if (kind && !any)
        model_remove(m, "material.fibre");
}

fibre_numbers material_fibres(const material *a)
{
    fibre_numbers n = {0};
    if (a->law->fibres)
        a->law->fibres(a->value, &n);
    if (a->fibre)
        a->fibre->fill(a->families, &n);
    return n;
}

bool material_muscle(const material *a, double curve[MUSCLE_NUMBERS])
{
    memset(curve, 0, MUSCLE_NUMBERS * sizeof *curve);
    if (a->passive == 0 && a->optimum == 1 && a->vmax == 0)
        return false;
    curve[MUSCLE_LESS] = 1 / a->optimum - 1;
    curve[MUSCLE_PASSIVE] = a->passive * a->peak / a->optimum;
    curve[MUSCLE_STIFFENING] = a->stiffening;
    curve[MUSCLE_STRAIGHT] = a->straight - 1;
    if (a->vmax > 0) {
        curve[MUSCLE_SPRING] = a->peak / (a->optimum * a->optimum * a->series);
        curve[MUSCLE_FASTEST] = a->optimum * a->vmax;
    }
    return true;
}
