/* What a card does that CUDA C++ has no words for, or none that leave no choice to the compiler: all of tled-run's
 * assembly is here, and how its kernels come by shared memory whose size the launch says. Copies take compute
 * capability 8.0; barriers, 9.0. No card is needed where another header of this name is found first: tests/emulate.
 *
 * Shared memory is told by address: 32 bits, from shared_at().
 */
#ifndef SINEW_CUDA_PTX_CUH
#define SINEW_CUDA_PTX_CUH

#include <cuda_runtime.h>
#include <stdint.h>

/* Declares `name`, in a kernel: an array as long as the launch says. One type a file. */
#define DYNAMIC_SHARED(type, name) extern __shared__ type name[]

/* ---- shared memory, where it stands */

static __device__ __forceinline__ uint32_t shared_at(const void *p)
{
    return (uint32_t)__cvta_generic_to_shared(p);
}

static __device__ __forceinline__ float4 shared_load(uint32_t at)
{
    float4 x;
    asm volatile("ld.shared.v4.f32 {%0, %1, %2, %3}, [%4];"
                 : "=f"(x.x), "=f"(x.y), "=f"(x.z), "=f"(x.w)
                 : "r"(at)
                 : "memory");
    return x;
}

static __device__ __forceinline__ float shared_number(uint32_t at)
{
    float x;
    asm volatile("ld.shared.f32 %0, [%1];" : "=f"(x) : "r"(at) : "memory");
    return x;
}

static __device__ __forceinline__ void shared_number_store(uint32_t at, float x)
{
    asm volatile("st.shared.f32 [%0], %1;" ::"r"(at), "f"(x) : "memory");
}

/* The fourth number is whatever stands in some register. */
static __device__ __forceinline__ void shared_store(uint32_t at, float x, float y, float z)
{
    float any;
    asm("" : "=f"(any));
    asm volatile("st.shared.v4.f32 [%0], {%1, %2, %3, %4};" ::"r"(at), "f"(x), "f"(y), "f"(z), "f"(any) : "memory");
}

static __device__ __forceinline__ double2 shared_pair(uint32_t at)
{
    double2 x;
    asm volatile("ld.shared.v2.f64 {%0, %1}, [%2];" : "=d"(x.x), "=d"(x.y) : "r"(at) : "memory");
    return x;
}

static __device__ __forceinline__ void shared_pair_store(uint32_t at, double x, double y)
{
    asm volatile("st.shared.v2.f64 [%0], {%1, %2};" ::"r"(at), "d"(x), "d"(y) : "memory");
}

static __device__ __forceinline__ double shared_double(uint32_t at)
{
    double x;
    asm volatile("ld.shared.f64 %0, [%1];" : "=d"(x) : "r"(at) : "memory");
    return x;
}

static __device__ __forceinline__ void shared_double_store(uint32_t at, double x)
{
    asm volatile("st.shared.f64 [%0], %1;" ::"r"(at), "d"(x) : "memory");
}

/* ---- what is read once a pass: the cache keeps other things */

static __device__ __forceinline__ uint2 load_once(const uint2 *from)
{
    return __ldcs(from);
}

/* ---- copies that the thread does not wait for */

/* On its way to shared memory; if is: 0, zeros. */
static __device__ __forceinline__ void send(uint32_t to, const float4 *from, uint32_t is)
{
    asm volatile("{ .reg .pred none; setp.eq.u32 none, %2, 0;"
                 " cp.async.cg.shared.global [%0], [%1], 16, none; }" ::"r"(to),
                 "l"(from), "r"(is)
                 : "memory");
}

/* Two of them. They follow each other, as ptxas places three instructions of no effect before each copy that follows
 * anything else. */
static __device__ __forceinline__ void send_both(uint32_t to, const float4 *from, uint32_t is, uint32_t other_to,
                                                 const float4 *other, uint32_t is_other)
{
    asm volatile("{ .reg .pred none, no_other; setp.eq.u32 none, %2, 0; setp.eq.u32 no_other, %5, 0;"
                 " cp.async.cg.shared.global [%0], [%1], 16, none;"
                 " cp.async.cg.shared.global [%3], [%4], 16, no_other; }" ::"r"(to),
                 "l"(from), "r"(is), "r"(other_to), "l"(other), "r"(is_other)
                 : "memory");
}

/* What was sent since the last call is a group. */
static __device__ __forceinline__ void sent(void)
{
    asm volatile("cp.async.commit_group;" ::: "memory");
}

/* Waits for all that was sent but for the last N groups. */
template <int N> static __device__ __forceinline__ void arrived(void)
{
    asm volatile("cp.async.wait_group %0;" ::"n"(N) : "memory");
}

/* ---- barriers in shared memory, of 8 bytes each. They end phase after phase, 0, 1, ... */

/* A phase ends when `count` have arrived. Threads other than the caller may know of it after a __syncthreads(). */
static __device__ __forceinline__ void barrier_make(uint32_t barrier, uint32_t count)
{
    asm volatile("mbarrier.init.shared::cta.b64 [%0], %1;" ::"r"(barrier), "r"(count) : "memory");
}

/* One thread of each warp that calls it, all of it at once. */
static __device__ __forceinline__ void barrier_arrive_warp(uint32_t barrier)
{
    asm volatile("{ .reg .pred one; .reg .b64 state; elect.sync _|one, 0xffffffff;"
                 " @one mbarrier.arrive.shared::cta.b64 state, [%0]; }" ::"r"(barrier)
                 : "memory");
}

/* Waits for the end of the phase that goes on or of the one before it: whichever is `odd`. */
static __device__ __forceinline__ void barrier_wait(uint32_t barrier, int odd)
{
    asm volatile(
        "{ .reg .pred is; again%=: mbarrier.try_wait.parity.shared::cta.b64 is, [%0], %1; @!is bra again%=; }" ::"r"(
            barrier),
        "r"(odd)
        : "memory");
}

/* ---- words that blocks tell each other: 64 bits as one, without any order among them */

static __device__ __forceinline__ void relaxed_store(uint64_t *to, uint64_t word)
{
    asm volatile("st.relaxed.gpu.global.u64 [%0], %1;" ::"l"(to), "l"(word) : "memory");
}

static __device__ __forceinline__ uint64_t relaxed_load(const uint64_t *from)
{
    uint64_t word;
    asm volatile("ld.relaxed.gpu.global.u64 %0, [%1];" : "=l"(word) : "l"(from) : "memory");
    return word;
}

/* A number from 0 on, each once. */
static __device__ __forceinline__ uint32_t take_ticket(uint32_t *from)
{
    uint32_t number;
    asm volatile("atom.relaxed.gpu.global.add.u32 %0, [%1], 1;" : "=r"(number) : "l"(from) : "memory");
    return number;
}

/* ---- a word by which a block says what it has done, to who reads it: that may be relied on from then on */

/* What the caller's block did before its last __syncthreads() is known to who reads this word. */
static __device__ __forceinline__ void tell_done(uint32_t *to, uint32_t word)
{
    asm volatile("st.release.gpu.global.u32 [%0], %1;" ::"l"(to), "r"(word) : "memory");
}

static __device__ __forceinline__ uint32_t hear_done(const uint32_t *from)
{
    uint32_t word;
    asm volatile("ld.acquire.gpu.global.u32 %0, [%1];" : "=r"(word) : "l"(from) : "memory");
    return word;
}

/* ---- arithmetic */

/* p + n, of less than 2^32 bytes from p: so the address takes fewer instructions. */
static __device__ __forceinline__ const float4 *nth(const float4 *p, uint32_t n)
{
    return (const float4 *)((const char *)p + n * 16u);
}

/* n, of which the compiler knows nothing: a loop from there on is not unrolled. */
static __device__ __forceinline__ int32_t unknown(int32_t n)
{
    asm volatile("" : "+r"(n));
    return n;
}

/* To some 1e-7 of 1, and of the answer. */
static __device__ __forceinline__ float near_log2(float x)
{
    float y;
    asm("lg2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
}

static __device__ __forceinline__ float near_inverse(float x)
{
    float y;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
}

static __device__ __forceinline__ float near_root_inverse(float x)
{
    float y;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
}

/* Of an angle from 0 to 2 pi. */
static __device__ __forceinline__ void near_turn(float x, float *sine, float *cosine)
{
    asm("sin.approx.ftz.f32 %0, %1;" : "=f"(*sine) : "f"(x));
    asm("cos.approx.ftz.f32 %0, %1;" : "=f"(*cosine) : "f"(x));
}

static __device__ __forceinline__ float near_exp2(float x)
{
    float y;
    asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
}

/* In double precision, to some 1e-16 of the answer, of x that single precision has room for: two steps of Newton's from
 * the card's 20 bits. */
static __device__ __forceinline__ double near_inverse(double x)
{
    double y;
    asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
    y = fma(y, fma(-x, y, 1.), y);
    return fma(y, fma(-x, y, 1.), y);
}

#endif
