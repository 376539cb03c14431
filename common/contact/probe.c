#include "contact/probe.h"

#include "base/num.h"

#include <string.h>

int probe_of(probe *p, const char *text, err *e)
{
    num_length radius;
    if (strncmp(text, "sphere:", 7) != 0)
        return err_usage(e, "--probe %.100s; expected sphere:RADIUS, such as sphere:2cm", text);
    if (num_length_of(text + 7, &radius))
        return err_usage(e, "--probe %.100s: '%.80s' is no length; expected sphere:RADIUS, such as sphere:2cm", text,
                         text + 7);
    p->kind = PROBE_SPHERE;
    p->radius = num_length_in(radius, num_unit_of("m"), num_unit_of("m"));
    if (!(p->radius > 0) || p->radius > 1e6)
        return err_usage(e, "--probe %.100s: a radius of %g m; expected one above 0", text, p->radius);
    return 0;
}
