/* The CUDA executor in single precision with steps that change a history, as a law's would: history.cu.
 */
#ifndef SINEW_HISTORY_H
#define SINEW_HISTORY_H

#ifdef __cplusplus
extern "C" {
#endif

#include "tled/problem/tled_executor.h"

/* Each step adds a + 1 to number a of each element, in every field on elements. */
extern const tled_executor history_cuda;

#ifdef __cplusplus
}
#endif

#endif
