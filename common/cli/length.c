#include "cli/length.h"

int length_mm(const opt_lengths *l, const char *option, double *mm, err *e)
{
    num_unit last = l->count ? l->value[l->count - 1].unit : 0;
    for (int i = 0; i < l->count; i++) {
        if (!l->value[i].unit && !last)
            return err_usage(e, "%s %g: a length without its unit; expected one of " NUM_UNITS ", as in %gmm", option,
                             l->value[i].value, l->value[i].value);
        mm[i] = num_length_in(l->value[i], last, num_unit_of("mm"));
    }
    return 0;
}
