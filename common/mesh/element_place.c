#include "mesh/element_place.h"

#include "base/num.h"

#include <stdio.h>

void element_place(const model *m, int64_t element, double middle[3])
{
    const model_array *node = model_find(m, "element.node"), *rest = model_find(m, "node.position");
    const int32_t *own = node->i32 + element * node->columns;
    for (int a = 0; a < 3; a++) {
        middle[a] = 0;
        for (int c = 0; c < node->columns; c++)
            middle[a] += rest->f64[3 * (int64_t)own[c] + a];
        middle[a] /= node->columns;
    }
}

void element_place_text(const model *m, int64_t element, char to[ELEMENT_PLACE])
{
    const char *source = model_meta_of(m, "source.unit");
    const num_unit metre = num_unit_of("m"), own = source ? num_unit_of(source) : 0;
    const num_unit unit = own ? own : metre;
    const model_array *volume = model_find(m, "element.volume"), *name = model_find(m, "volume.name");
    char of[140] = "";
    double at[3];
    element_place(m, element, at);
    for (int a = 0; a < 3; a++)
        at[a] = num_length_in((num_length){at[a], metre}, metre, unit);
    if (volume && name)
        snprintf(of, sizeof of, " (volume '%.100s')", name->str[volume->i32[element]]);
    snprintf(to, ELEMENT_PLACE, "element %lld%s at %.4g%s,%.4g%s,%.4g%s", (long long)element, of, at[0],
             num_unit_name(unit), at[1], num_unit_name(unit), at[2], num_unit_name(unit));
}
