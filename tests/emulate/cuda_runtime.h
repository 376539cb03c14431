/* What tests/emulate has for CUDA's header of this name: as much of CUDA C++ and of
 * its runtime as the kernels here use.
 */
#ifndef SINEW_EMULATED_CUDA_RUNTIME_H
#define SINEW_EMULATED_CUDA_RUNTIME_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <tuple>

#define CUDART_VERSION 12000
#define __device__
#define __global__
#define __host__
#define __forceinline__ inline
#define __grid_constant__
#define __launch_bounds__(...)
/* One for all blocks, of which one has it at a time. (Of the host's thread, so that
 * it is known where all of it stands.) */
#define __shared__ static thread_local

struct alignas(8) uint2 {
    unsigned x, y;
};

struct alignas(16) uint4 {
    uint32_t x, y, z, w;
};

struct alignas(16) float4 {
    float x, y, z, w;
};
struct alignas(16) double2 {
    double x, y;
};
struct float3 {
    float x, y, z;
};
struct dim3 {
    unsigned x, y, z;
    constexpr dim3(unsigned n = 1) : x(n), y(1), z(1)
    {
    }
};

static inline double2 make_double2(double x, double y)
{
    return {x, y};
}

static inline float4 make_float4(float x, float y, float z, float w)
{
    return {x, y, z, w};
}

/* The bits of one as another. */
template <class To, class From> static inline To emulated_bits(From from)
{
    To to;
    static_assert(sizeof to == sizeof from, "as many");
    memcpy(&to, &from, sizeof to);
    return to;
}
static inline unsigned __float_as_uint(float x)
{
    return emulated_bits<unsigned>(x);
}
static inline float __uint_as_float(unsigned x)
{
    return emulated_bits<float>(x);
}
static inline unsigned __funnelshift_r(unsigned low, unsigned high, unsigned by)
{
    return (unsigned)(((uint64_t)high << 32 | low) >> (by & 31));
}
static inline int __double2loint(double x)
{
    return (int)emulated_bits<uint64_t>(x);
}
static inline int __double2hiint(double x)
{
    return (int)(emulated_bits<uint64_t>(x) >> 32);
}
static inline double __hiloint2double(int high, int low)
{
    return emulated_bits<double>((uint64_t)(unsigned)high << 32 | (unsigned)low);
}

/* ---- of a thread */

extern dim3 threadIdx, blockIdx, gridDim;
void __syncthreads();
int __syncthreads_or(int value);
void __syncwarp();
int __any_sync(unsigned mask, int value);
unsigned __ballot_sync(unsigned mask, int value);
uint64_t emulated_exchange(unsigned mask, uint64_t bits, int with);
static inline double __shfl_xor_sync(unsigned mask, double x, int with)
{
    return emulated_bits<double>(emulated_exchange(mask, emulated_bits<uint64_t>(x), with));
}
static inline float __shfl_xor_sync(unsigned mask, float x, int with)
{
    return emulated_bits<float>((uint32_t)emulated_exchange(mask, emulated_bits<uint32_t>(x), with));
}
static inline int __shfl_xor_sync(unsigned mask, int x, int with)
{
    return (int)emulated_exchange(mask, (unsigned)x, with);
}
static inline int __popc(unsigned x)
{
    return __builtin_popcount(x);
}
int atomicMin(int *at, int value);
int atomicAdd(int *at, int value);
int atomicExch(int *at, int value);
unsigned long long atomicAdd(unsigned long long *at, unsigned long long value);
unsigned long long atomicMax(unsigned long long *at, unsigned long long value);

/* ---- of the host */

enum cudaError_t {
    cudaSuccess = 0,
    cudaErrorInvalidValue = 1,
    cudaErrorMemoryAllocation = 2,
    cudaErrorInsufficientDriver = 35,
    cudaErrorLaunchFailure = 719
};
typedef struct emulated_stream *cudaStream_t;
typedef struct emulated_event *cudaEvent_t;
enum cudaDeviceAttr {
    cudaDevAttrComputeCapabilityMajor,
    cudaDevAttrComputeCapabilityMinor,
    cudaDevAttrMultiProcessorCount,
    cudaDevAttrCooperativeLaunch,
    cudaDevAttrMaxSharedMemoryPerBlockOptin,
    cudaDevAttrMaxPersistingL2CacheSize /* none */
};
enum cudaLimit { cudaLimitPersistingL2CacheSize };
enum cudaAccessProperty { cudaAccessPropertyStreaming, cudaAccessPropertyPersisting };
enum cudaStreamAttrID { cudaStreamAttributeAccessPolicyWindow };
struct cudaStreamAttrValue {
    struct {
        void *base_ptr;
        size_t num_bytes;
        float hitRatio;
        cudaAccessProperty hitProp, missProp;
    } accessPolicyWindow;
};
enum cudaFuncAttribute { cudaFuncAttributeMaxDynamicSharedMemorySize };
enum cudaMemcpyKind { cudaMemcpyHostToDevice, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice };
enum { cudaStreamNonBlocking, cudaEventDisableTiming };
enum cudaLaunchAttributeID { cudaLaunchAttributeCooperative };
struct cudaLaunchAttribute {
    cudaLaunchAttributeID id;
    struct {
        int cooperative;
    } val;
};
struct cudaLaunchConfig_t {
    dim3 gridDim, blockDim;
    size_t dynamicSmemBytes;
    cudaStream_t stream;
    cudaLaunchAttribute *attrs;
    unsigned numAttrs;
};

cudaError_t cudaGetDeviceCount(int *count);
cudaError_t cudaDeviceGetAttribute(int *value, cudaDeviceAttr which, int device);
const char *cudaGetErrorString(cudaError_t error);
cudaError_t cudaMalloc(void **at, size_t size);
cudaError_t cudaFree(void *at);
cudaError_t cudaMemcpy(void *to, const void *from, size_t size, cudaMemcpyKind kind);
cudaError_t cudaMemset(void *at, int value, size_t size);

static inline cudaError_t cudaGetDevice(int *device)
{
    *device = 0;
    return cudaSuccess;
}
static inline cudaError_t cudaDeviceSetLimit(cudaLimit, size_t)
{
    return cudaErrorInvalidValue;
}
static inline cudaError_t cudaCtxResetPersistingL2Cache()
{
    return cudaSuccess;
}
static inline cudaError_t cudaStreamSetAttribute(cudaStream_t, cudaStreamAttrID, const cudaStreamAttrValue *)
{
    return cudaErrorInvalidValue;
}
static inline cudaError_t cudaMemGetInfo(size_t *left, size_t *all)
{
    *left = *all = (size_t)1 << 32;
    return cudaSuccess;
}
static inline cudaError_t cudaMallocHost(void **at, size_t size)
{
    *at = malloc(size ? size : 1);
    return *at ? cudaSuccess : cudaErrorMemoryAllocation;
}
static inline cudaError_t cudaFreeHost(void *at)
{
    free(at);
    return cudaSuccess;
}

cudaError_t cudaGetLastError();
cudaError_t cudaDeviceSynchronize();
cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t size, cudaMemcpyKind kind, cudaStream_t stream);
cudaError_t cudaMemsetAsync(void *at, int value, size_t size, cudaStream_t stream);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned flags);
static inline cudaError_t cudaStreamCreateWithPriority(cudaStream_t *stream, unsigned flags, int)
{
    return cudaStreamCreateWithFlags(stream, flags);
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags = 0);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventDestroy(cudaEvent_t event);

/* ---- kernels, which host code knows by their addresses */

cudaError_t emulated_allow(const void *kernel, int shared);
cudaError_t emulated_fit(int *blocks, int threads, size_t shared);
cudaError_t emulated_launch(const void *kernel, const cudaLaunchConfig_t *how, void (*run)(const void *),
                            const void *call, size_t size);

template <class... P>
static inline cudaError_t cudaFuncSetAttribute(void (*kernel)(P...), cudaFuncAttribute, int shared)
{
    return emulated_allow((const void *)kernel, shared);
}

template <class... P>
static inline cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int *blocks, void (*)(P...), int threads,
                                                                        size_t shared)
{
    return emulated_fit(blocks, threads, shared);
}

template <class... P, class... A>
static inline cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t *how, void (*kernel)(P...), const A &...argument)
{
    struct call {
        void (*kernel)(P...);
        std::tuple<P...> with;
    };
    const call c = {kernel, std::tuple<P...>(argument...)};
    const auto run = [](const void *at) { std::apply(((const call *)at)->kernel, ((const call *)at)->with); };
    return emulated_launch((const void *)kernel, how, run, &c, sizeof c);
}

#endif
