/* What tests/emulate has for tled/cuda/cuda_ptx.cuh, where each of these is told. */
#ifndef SINEW_EMULATED_CUDA_PTX_CUH
#define SINEW_EMULATED_CUDA_PTX_CUH

#include <cuda_runtime.h>

void *emulated_dynamic();
#define DYNAMIC_SHARED(type, name) type *const name = (type *)emulated_dynamic()

uint32_t shared_at(const void *p);
float4 shared_load(uint32_t at);
float shared_number(uint32_t at);
void shared_number_store(uint32_t at, float x);
void shared_store(uint32_t at, float x, float y, float z);
double2 shared_pair(uint32_t at);
void shared_pair_store(uint32_t at, double x, double y);
double shared_double(uint32_t at);
void shared_double_store(uint32_t at, double x);

void send(uint32_t to, const float4 *from, bool is);
static inline void send_both(uint32_t to, const float4 *from, bool is, uint32_t other_to, const float4 *other,
                             bool is_other)
{
    send(to, from, is);
    send(other_to, other, is_other);
}
static inline uint2 load_once(const uint2 *from)
{
    return *from;
}
void sent();
void emulated_arrived(int but_for);
template <int N> static inline void arrived()
{
    emulated_arrived(N);
}

void barrier_make(uint32_t barrier, uint32_t count);
void barrier_arrive(uint32_t barrier);
void barrier_wait(uint32_t barrier, int odd);
static inline void barrier_arrive_warp(uint32_t barrier)
{
    if (threadIdx.x % 32 == 0)
        barrier_arrive(barrier);
}

void relaxed_store(uint64_t *to, uint64_t word);
uint64_t relaxed_load(const uint64_t *from);

uint32_t take_ticket(uint32_t *from);
void tell_done(uint32_t *to, uint32_t word);
uint32_t hear_done(const uint32_t *from);

static inline const float4 *nth(const float4 *p, uint32_t n)
{
    return p + n;
}
static inline int32_t unknown(int32_t n)
{
    return n;
}
static inline float near_log2(float x)
{
    return log2f(x);
}
static inline float near_inverse(float x)
{
    return 1 / x;
}
static inline float near_root_inverse(float x)
{
    return 1 / sqrtf(x);
}
static inline void near_turn(float x, float *sine, float *cosine)
{
    *sine = sinf(x);
    *cosine = cosf(x);
}
static inline float near_exp2(float x)
{
    return exp2f(x);
}
static inline double near_inverse(double x)
{
    return 1 / x;
}

#endif
