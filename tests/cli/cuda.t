#!/bin/sh
# The shared element header as CUDA C++: a kernel that calls an element's whole force and energy, in double and in single
# precision, compiled by nvcc. A machine with nvcc needs no device for it.
. "$(dirname "$0")/lib.sh"

nvcc=${NVCC:-$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null)}
[ -n "$nvcc" ] || skip_all "no nvcc: tled/element.h is not compiled as CUDA"

cat >"$T/element.cu" <<'END'
#include "tled/element.h"

__global__ void force(element_field *u, element_shape shape, element_law law, element_fibre fibre, real *energy)
{
    element_modes x = element_modes_of(u->x), y = element_modes_of(u->y), z = element_modes_of(u->z);
    *energy = element_energy(element_gradient(x, y, z, shape.slope), law.mu, law.bulk) +
              element_hourglass_energy(x, law.hourglass);
    *u = element_force(*u, shape, law, fibre, 1);
}
END
for precision in DOUBLE SINGLE; do
    check "tled/element.h compiles with nvcc, $precision" "$nvcc" -Werror all-warnings -fmad=false -D"ELEMENT_$precision" \
        -I common -I . -c -o "$T/element.o" "$T/element.cu"
    check "and has the kernel in it" grep -q _Z5force "$T/element.o"
done
done_testing
