/* Exponential, logarithm and powers of doubles, and in lanes. */
// needs: tests/unit/powers_lanes.c
#include "powers_cases.h"

#include "powers_lanes.h"

/* As powers_lanes. */
static void one_by_one(double x, double y, double to[POWERS_LANES])
{
    to[0] = real_exp(x);
    to[1] = real_exp_less(x);
    to[2] = real_log(x);
    to[3] = real_log_more(x);
    to[4] = real_power(x, y);
    to[5] = real_power_less(x, y);
}

static void test_lanes(void)
{
    int wrong = 0;
    for (int i = 0; i < 1000; i++) {
        const double x[2] = {4 * next_number(), pick_positive(next_number())}, y = next_number();
        double both[POWERS_LANES][2], one[2][POWERS_LANES];
        powers_lanes(x, y, both);
        for (int lane = 0; lane < 2; lane++)
            one_by_one(x[lane], y, one[lane]);
        for (int f = 0; f < POWERS_LANES; f++)
            for (int lane = 0; lane < 2; lane++)
                wrong += memcmp(&both[f][lane], &one[lane][f], sizeof(double)) != 0;
    }
    ok(wrong == 0, "lanes have the bytes of one number: %d differ", wrong);
}

int main(void)
{
    test_all_powers();
    test_lanes();
    return done_testing();
}
