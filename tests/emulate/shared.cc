/* What kernels read and write of shared memory by its addresses (cuda_ptx.cuh), each checked as other accesses are. */
#include "machine.h"
#include "tled/cuda/cuda_ptx.cuh"

float4 shared_load(uint32_t at)
{
    HERE();
    return *(const float4 *)touch_shared(at, sizeof(float4), false);
}

float shared_number(uint32_t at)
{
    HERE();
    return *(const float *)touch_shared(at, sizeof(float), false);
}

void shared_number_store(uint32_t at, float x)
{
    HERE();
    *(float *)touch_shared(at, sizeof(float), true) = x;
}

void shared_store(uint32_t at, float x, float y, float z)
{
    HERE();
    *(float4 *)touch_shared(at, sizeof(float4), true) = {x, y, z, __uint_as_float(lot(~0u))};
}

double2 shared_pair(uint32_t at)
{
    HERE();
    return *(const double2 *)touch_shared(at, sizeof(double2), false);
}

void shared_pair_store(uint32_t at, double x, double y)
{
    HERE();
    *(double2 *)touch_shared(at, sizeof(double2), true) = {x, y};
}

double shared_double(uint32_t at)
{
    HERE();
    return *(const double *)touch_shared(at, sizeof(double), false);
}

void shared_double_store(uint32_t at, double x)
{
    HERE();
    *(double *)touch_shared(at, sizeof(double), true) = x;
}
