/* The arithmetic of a march's cells: of faces' modes, in no fixed order, with operations fused. A cell has
 * the face of its layer of nodes, `low`, and that of the next, `high`. Included by cuda_march.cu alone;
 * nothing here is told of blocks and threads.
 */
#ifndef SINEW_CUDA_CELLS_CUH
#define SINEW_CUDA_CELLS_CUH

/* element.h before it, in single precision */
#include "tled/cuda/cuda_march.cuh"
#include "tled/cuda/cuda_ptx.cuh"

/* Modes of a face's four nodes, or forces on them. */
typedef struct face {
    float mean[3], x[3], y[3], xy[3];
} face;

/* Forces of the cell below on a face; on its xy: those are twice `hourglass` times the face's. */
typedef struct push {
    float mean[3], x[3], y[3], hourglass;
} push;

/* Of displacements at corners (0, 0), (1, 0), (0, 1), (1, 1). */
static __device__ __forceinline__ face face_between(float4 a, float4 b, float4 c, float4 d)
{
    const float low[2][3] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}}, high[2][3] = {{c.x, c.y, c.z}, {d.x, d.y, d.z}};
    face f;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const float s = low[0][i] + low[1][i], t = low[1][i] - low[0][i];
        const float sum = high[0][i] + high[1][i], gap = high[1][i] - high[0][i];
        f.mean[i] = s + sum;
        f.y[i] = sum - s;
        f.x[i] = t + gap;
        f.xy[i] = gap - t;
    }
    return f;
}

/* x^(-5/3), to 4e-7 of it. */
static __device__ __forceinline__ float power(float x)
{
    return near_exp2(near_log2(x) * (-5.f / 3));
}

/* The neo-Hookean form, in fewer operations. With s = mu J^-5/3, d = J - 1, e = tr(C - I), G
 * = cof F - I, all of it first order in H:
 *     P = (s (d - e/3) + K d) I + s J H + (K d - s (1 + e/3)) G.
 * No cell: mu and bulk are 0, and J is not looked at. */
static __device__ __forceinline__ element_tensor stress(element_tensor h, float mu, float bulk, bool is)
{
    const element_tensor m = {h.yy * h.zz - h.yz * h.zy, h.yz * h.zx - h.yx * h.zz, h.yx * h.zy - h.yy * h.zx,
                              h.xz * h.zy - h.xy * h.zz, h.xx * h.zz - h.xz * h.zx, h.xy * h.zx - h.xx * h.zy,
                              h.xy * h.yz - h.xz * h.yy, h.xz * h.yx - h.xx * h.yz, h.xx * h.yy - h.xy * h.yx};
    const float trace = h.xx + h.yy + h.zz;
    const float dilation = trace + ((m.xx + m.yy + m.zz) + (h.xx * m.xx + h.xy * m.xy + h.xz * m.xz));
    const float third = (2 * trace + (h.xx * h.xx + h.xy * h.xy + h.xz * h.xz + h.yx * h.yx + h.yy * h.yy +
                                      h.yz * h.yz + h.zx * h.zx + h.zy * h.zy + h.zz * h.zz)) *
                        (1.f / 3);
    const float j = is ? 1 + dilation : 1, scale = mu * power(j), pressure = bulk * dilation;
    const float all = pressure + scale * (dilation - third), own = scale * j, g = pressure - (scale + scale * third);
    const element_tensor p = {all + own * h.xx + g * (trace - h.xx + m.xx),
                              own * h.xy + g * (m.xy - h.yx),
                              own * h.xz + g * (m.xz - h.zx),
                              own * h.yx + g * (m.yx - h.xy),
                              all + own * h.yy + g * (trace - h.yy + m.yy),
                              own * h.yz + g * (m.yz - h.zy),
                              own * h.zx + g * (m.zx - h.xz),
                              own * h.zy + g * (m.zy - h.yz),
                              all + own * h.zz + g * (trace - h.zz + m.zz)};
    return p;
}

static __device__ __forceinline__ element_tensor gradient_of(const cuda_march &m, const face &low, const face &high)
{
    const element_tensor h = {(low.x[0] + high.x[0]) * m.slope[0],       (low.y[0] + high.y[0]) * m.slope[1],
                              (high.mean[0] - low.mean[0]) * m.slope[2], (low.x[1] + high.x[1]) * m.slope[0],
                              (low.y[1] + high.y[1]) * m.slope[1],       (high.mean[1] - low.mean[1]) * m.slope[2],
                              (low.x[2] + high.x[2]) * m.slope[0],       (low.y[2] + high.y[2]) * m.slope[1],
                              (high.mean[2] - low.mean[2]) * m.slope[2]};
    return h;
}

/* The forces of a cell: `sum` gets those on its lower face, with `below`, which becomes those on its upper face. */
static __device__ __forceinline__ void cell_forces(const cuda_march &m, float mu, float bulk, float hourglass, bool is,
                                                   const face &low, const face &high, face *sum, push *below)
{
    const element_tensor s = stress(gradient_of(m, low, high), mu, bulk, is);
    const float px[3] = {s.xx, s.yx, s.zx}, py[3] = {s.xy, s.yy, s.zy}, pz[3] = {s.xz, s.yz, s.zz};
    const float both = 2 * (below->hourglass + hourglass);
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const float zx = hourglass * (high.x[a] - low.x[a]), yz = hourglass * (high.y[a] - low.y[a]);
        const float z = pz[a] * m.area[2];
        sum->mean[a] = below->mean[a] - z;
        sum->x[a] = (below->x[a] - zx) + px[a] * m.area[0];
        sum->y[a] = (below->y[a] - yz) + py[a] * m.area[1];
        sum->xy[a] = both * low.xy[a];
        below->mean[a] = z;
        below->x[a] = zx + px[a] * m.area[0];
        below->y[a] = yz + py[a] * m.area[1];
    }
    below->hourglass = hourglass;
}

/* Adds those of a muscle; h: the cell's gradient, tension: Pa. */
static __device__ __forceinline__ void add_tension(const cuda_march &m, element_tensor h, element_fibre fibre,
                                                   face *sum, push *below)
{
    const element_tensor s = element_active(h, fibre);
    const float px[3] = {s.xx, s.yx, s.zx}, py[3] = {s.xy, s.yy, s.zy}, pz[3] = {s.xz, s.yz, s.zz};
#pragma unroll
    for (int a = 0; a < 3; a++) {
        sum->mean[a] -= pz[a] * m.area[2];
        sum->x[a] += px[a] * m.area[0];
        sum->y[a] += py[a] * m.area[1];
        below->mean[a] += pz[a] * m.area[2];
        below->x[a] += px[a] * m.area[0];
        below->y[a] += py[a] * m.area[1];
    }
}

/* What a cell below leaves on a face, where there is none above it. */
static __device__ __forceinline__ face face_of(const push &below, const face &low)
{
    face f;
#pragma unroll
    for (int a = 0; a < 3; a++) {
        f.mean[a] = below.mean[a];
        f.x[a] = below.x[a];
        f.y[a] = below.y[a];
        f.xy[a] = 2 * below.hourglass * low.xy[a];
    }
    return f;
}

#endif
