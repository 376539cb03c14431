#ifndef SINEW_CUDA_EXACT_CUH
#define SINEW_CUDA_EXACT_CUH
#include "msds/cuda_tissue.cuh"
typedef struct tissue_exact { int x; } tissue_exact;
cudaError_t tissue_exact_fit(int *blocks);
#endif
