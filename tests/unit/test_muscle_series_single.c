/* Muscles in series with a spring, in single precision. */
#define ELEMENT_SINGLE
#include "series_cases.h"

int main(void)
{
    test_all_series(2e-5, 4);
    return done_testing();
}
