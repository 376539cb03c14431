/* The element header in float. */
#define ELEMENT_SINGLE
#include "element_cases.h"

int main(void)
{
    test_homogeneous(1e-4);
    test_rotation(1e-3);
    test_hourglass(1e-5);
    test_force_length();
    test_cube_root(2e-6);
    return done_testing();
}
