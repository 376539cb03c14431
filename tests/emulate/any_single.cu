/* See any_form.h. Of histories, every cell is changed, copies in other tiles' cells alike. */
#include "tests/emulate/any_form.h"

#define CUDA_EXECUTOR any_form_single
#define CUDA_OWN(X)
#define CUDA_OWN_FIBRED(X)
#define ELEMENT_SINGLE
#include "tled/cuda/cuda_loops.cuh"

enum { AGE_THREADS = 64 };

static __global__ void age_kernel(real *to, int64_t stride, int64_t cells, int columns, real steps)
{
    const int64_t i = (int64_t)blockIdx.x * AGE_THREADS + threadIdx.x;
    for (int a = 0; a < columns && i < cells; a++)
        to[a * stride + i] += steps * (real)(a + 1);
}

static int history_step(cuda_state *s, const tled_plan *plan, int64_t count, err *e)
{
    for (int i = CUDA_STEPPED; i < s->p->fields.count; i++) {
        const field_layout l = layout_of(s, i);
        const card_blocks blocks = {(l.places + AGE_THREADS - 1) / AGE_THREADS, AGE_THREADS, 0, s->stream};
        if (CUDA_TRY(card_start(age_kernel, blocks, s->field[i], l.stride, l.places, l.columns, (real)count)))
            return -1;
    }
    return cuda_step(s, plan, count, e);
}

static tled_executor with_history(void)
{
    tled_executor device = any_form_single;
    device.is.features |= EXECUTOR_HISTORY;
    device.step = history_step;
    return device;
}

const tled_executor history_cuda = with_history();
