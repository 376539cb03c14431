#!/bin/sh
# The element header is CUDA C too: nvcc compiles it for the device, without a warning, in each form and precision. (Most of it each build
# with nvcc compiles in kernels.)
. "$(dirname "$0")/lib.sh"

[ -n "$SINEW_LONG" ] || skip_all "it takes a minute: SINEW_LONG is not set"
NVCC=${NVCC:-$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null)}
[ -n "$NVCC" ] || skip_all "no nvcc here"

cat >"$T/kernel.cu" <<'END'
#include "physics/element.h"

__global__ void forces(const element_field *u, element_field *f, element_shape shape, element_law law, element_fibre fibre)
{
    f[threadIdx.x] = element_force(FORM, CONTROL, u[threadIdx.x], shape, law, fibre, fibre.tension != 0);
}
END
for form in FORM_NEO_HOOKEAN FORM_MOONEY_RIVLIN FORM_FIRST FORM_GENERAL; do
    for precision in "" -DELEMENT_SINGLE; do
        control=HOURGLASS_PHYSICAL
        [ -z "$precision" ] || [ $form = FORM_NEO_HOOKEAN ] || control=HOURGLASS_ISOTROPIC
        # shellcheck disable=SC2086 # empty: no argument
        check "nvcc compiles element.h ${precision:-in double}, $form, $control" \
            "$NVCC" $precision -DFORM=$form -DCONTROL=$control -I"$ROOT" -I"$ROOT/common" -Werror all-warnings -c "$T/kernel.cu" -o "$T/kernel.o"
    done
done
done_testing
