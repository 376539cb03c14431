/* See any_form.h. */
#include "tests/emulate/any_form.h"

#define CUDA_EXECUTOR any_form_double
#define CUDA_OWN(X)
#define CUDA_OWN_FIBRED(X)
#include "tled/cuda/cuda_loops.cuh"
