/* powers.h in lanes. */
#define ELEMENT_LANES 2
#include "physics/powers.h"

#include "powers_lanes.h"

void powers_lanes(const double x[2], double y, double to[POWERS_LANES][2])
{
    real in, out[POWERS_LANES];
    memcpy(&in, x, sizeof in);
    out[0] = real_exp(in);
    out[1] = real_exp_less(in);
    out[2] = real_log(in);
    out[3] = real_log_more(in);
    out[4] = real_power(in, real_of(y));
    out[5] = real_power_less(in, real_of(y));
    memcpy(to, out, sizeof out);
}
