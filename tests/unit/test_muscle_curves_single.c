/* A muscle's curves in float: their figures, and small strains. */
#define ELEMENT_SINGLE
#include "muscle_cases.h"

/* Stretches by so little that 1 + e has few digits of e. */
static void test_small(void)
{
    for (int k = -6; k < 0; k++) {
        const double e = pow(10, k);
        const double want = .05 * peak * expm1(6.6 * (double)(float)e);
        const element_tensor h = {.xx = R(e)};
        near_((double)element_curved(h, muscle_of(0, 1)).xx, want, 2e-6 * want, "strain %g: 2e-6 of the stress", e);
    }
}

int main(void)
{
    test_all_muscles(1e-4);
    test_small();
    return done_testing();
}
