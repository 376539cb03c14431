/* The CUDA executors as they are for forms of law that have no kernels of their own: with kernels of any form alone,
 * but for the march. any_single.cu and any_double.cu.
 */
#ifndef SINEW_ANY_FORM_H
#define SINEW_ANY_FORM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "tled/problem/tled_executor.h"

extern const tled_executor any_form_single, any_form_double;

/* In single precision, with steps that change a history, as a law's would: each step adds a + 1 to number a of each
 * element, in every field on elements. */
extern const tled_executor history_cuda;

#ifdef __cplusplus
}
#endif

#endif
