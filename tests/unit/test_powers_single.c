/* Exponential, logarithm and powers of floats. */
#define ELEMENT_SINGLE
#include "powers_cases.h"

int main(void)
{
    test_all_powers();
    return done_testing();
}
