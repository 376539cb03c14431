/* Numbers, and tensors of one material point, from which element.h and the forms are made: `real` is double, or float
 * where ELEMENT_SINGLE is defined before; or, where ELEMENT_LANES is too, a vector of so many of them: as many elements
 * side by side (GNU C's vectors, which gcc and clang have). Compiled by gcc, clang and nvcc alike. No branches on data,
 * no loops, no arrays indexed by a variable, and every operation rounds by itself: the same bits in any lane. Owns
 * nothing.
 */
#ifndef SINEW_STRAIN_H
#define SINEW_STRAIN_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef ELEMENT_SINGLE
typedef float real_one;
#define REAL_SQRT_ONE sqrtf
#else
typedef double real_one;
#define REAL_SQRT_ONE sqrt
#endif
#define R(constant) ((real_one)(constant))

#ifdef ELEMENT_LANES
typedef real_one real __attribute__((vector_size(ELEMENT_LANES * sizeof(real_one))));
typedef float real_guess __attribute__((vector_size(ELEMENT_LANES * sizeof(float))));
typedef int32_t real_bits __attribute__((vector_size(ELEMENT_LANES * sizeof(int32_t))));
#ifdef ELEMENT_SINGLE
typedef int32_t real_mask __attribute__((vector_size(ELEMENT_LANES * sizeof(int32_t))));
#else
typedef int64_t real_mask __attribute__((vector_size(ELEMENT_LANES * sizeof(int64_t))));
#endif
#define REAL_ZERO                  ((real){0})
#define REAL_CONVERT(x, type)      __builtin_convertvector(x, type)
#define REAL_SELECT(mask, yes, no) ((real)(((mask) & (real_mask)(yes)) | (~(mask) & (real_mask)(no))))
#else
typedef real_one real;
typedef float real_guess;
typedef int32_t real_bits;
#define REAL_ZERO                  ((real)0)
#define REAL_CONVERT(x, type)      ((type)(x))
typedef int real_mask;
#define REAL_SELECT(mask, yes, no) ((mask) ? (yes) : (no))
#endif

/* Tangents are in double; ELEMENT_FORCES_ALONE: nor are they there for numbers that only look like it. */
#if !defined ELEMENT_SINGLE && !defined ELEMENT_LANES && !defined ELEMENT_FORCES_ALONE
#define REAL_IS_DOUBLE
#endif

#ifdef __CUDACC__
#define ELEMENT_FUNCTION static __host__ __device__ __forceinline__
#define ELEMENT_APART    ELEMENT_FUNCTION
#elif defined(__GNUC__)
#define ELEMENT_FUNCTION static inline __attribute__((always_inline)) /* without it gcc calls, and makes no vectors */
/* What is long: compiled once, not wherever it is called; but in lanes a call takes up to a seventh of a step. */
#if defined __cplusplus || (defined ELEMENT_LANES && !defined __SANITIZE_ADDRESS__)
#define ELEMENT_APART ELEMENT_FUNCTION
#else
#define ELEMENT_APART static __attribute__((noinline, unused))
#endif
#else
#define ELEMENT_FUNCTION static inline
#define ELEMENT_APART    static inline
#endif

/* In all lanes. */
ELEMENT_FUNCTION real real_of(double x)
{
#ifdef ELEMENT_LANES
    return REAL_ZERO + (real_one)x;
#else
    return (real)x;
#endif
}

/* Whether it is so in any lane: what no lane needs may be left out, if lanes that do not need it have the same bytes
 * beside one that does. */
ELEMENT_FUNCTION int real_any(real_mask mask)
{
#ifdef ELEMENT_LANES
    int any = 0;
    for (int i = 0; i < ELEMENT_LANES; i++)
        any |= mask[i] != 0;
    return any;
#else
    return mask != 0;
#endif
}

ELEMENT_FUNCTION real real_sqrt(real x)
{
#ifdef ELEMENT_LANES
    for (int i = 0; i < ELEMENT_LANES; i++)
        x[i] = REAL_SQRT_ONE(x[i]);
    return x;
#else
    return REAL_SQRT_ONE(x);
#endif
}

typedef struct element_vector {
    real x, y, z;
} element_vector;

/* Row: component of the field; column: axis. */
typedef struct element_tensor {
    real xx, xy, xz, yx, yy, yz, zx, zy, zz;
} element_tensor;

#ifdef REAL_IS_DOUBLE
/* Of nine numbers, row by row. */
ELEMENT_FUNCTION element_tensor element_tensor_of(const double of[9])
{
    const element_tensor t = {of[0], of[1], of[2], of[3], of[4], of[5], of[6], of[7], of[8]};
    return t;
}
#endif

ELEMENT_FUNCTION element_tensor element_sum(element_tensor a, element_tensor b)
{
    element_tensor s = {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
                        a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
    return s;
}

/* yes where the mask is set, else no. */
ELEMENT_FUNCTION element_tensor element_selected(real_mask mask, element_tensor yes, element_tensor no)
{
    const element_tensor s = {
        REAL_SELECT(mask, yes.xx, no.xx), REAL_SELECT(mask, yes.xy, no.xy), REAL_SELECT(mask, yes.xz, no.xz),
        REAL_SELECT(mask, yes.yx, no.yx), REAL_SELECT(mask, yes.yy, no.yy), REAL_SELECT(mask, yes.yz, no.yz),
        REAL_SELECT(mask, yes.zx, no.zx), REAL_SELECT(mask, yes.zy, no.zy), REAL_SELECT(mask, yes.zz, no.zz)};
    return s;
}

/* J - 1 for F = I + H, as a polynomial in H: exact where strains are small. */
ELEMENT_FUNCTION real element_dilation(element_tensor h)
{
    real first = h.xx + h.yy + h.zz;
    real second = (h.xx * h.yy - h.xy * h.yx) + (h.yy * h.zz - h.yz * h.zy) + (h.zz * h.xx - h.zx * h.xz);
    real third =
        h.xx * (h.yy * h.zz - h.yz * h.zy) - h.xy * (h.yx * h.zz - h.yz * h.zx) + h.xz * (h.yx * h.zy - h.yy * h.zx);
    return first + second + third;
}

/* cof F = J F^-T for F = I + H. */
ELEMENT_FUNCTION element_tensor element_cofactor(element_tensor h)
{
    real xx = 1 + h.xx, yy = 1 + h.yy, zz = 1 + h.zz;
    element_tensor g = {yy * zz - h.yz * h.zy,   h.yz * h.zx - h.yx * zz, h.yx * h.zy - yy * h.zx,
                        h.xz * h.zy - h.xy * zz, xx * zz - h.xz * h.zx,   h.xy * h.zx - xx * h.zy,
                        h.xy * h.yz - h.xz * yy, h.xz * h.yx - xx * h.yz, xx * yy - h.xy * h.yx};
    return g;
}

/* x^(-1/3) for x > 0, to a few last bits: a guess from the bits of a float, then two steps of fourth order on
 * y^-3 - x. Arithmetic only, so the same bytes with any C library. For x <= 0 some number. */
ELEMENT_FUNCTION real element_cube_root_inverse(real x)
{
    real_guess guess = REAL_CONVERT(x, real_guess);
    real_bits bits;
    memcpy(&bits, &guess, sizeof bits);
    bits = REAL_CONVERT(1419967116.f - REAL_CONVERT(bits, real_guess) * (1.f / 3), real_bits);
    memcpy(&guess, &bits, sizeof guess);
    real y = REAL_CONVERT(guess, real);
    real r = 1 - x * y * y * y;
    y += y * r * (R(1. / 3) + r * (R(2. / 9) + r * R(14. / 81)));
    r = 1 - x * y * y * y;
    return y + y * r * (R(1. / 3) + r * (R(2. / 9) + r * R(14. / 81)));
}

/* A symmetric tensor. */
typedef struct element_symmetric {
    real xx, yy, zz, xy, yz, zx;
} element_symmetric;

/* C - I = F^T F - I for F = I + H, twice Green's strain: no difference of nearly equal numbers, so float keeps small
 * strains. */
ELEMENT_FUNCTION element_symmetric element_green(element_tensor h)
{
    element_symmetric e = {2 * h.xx + (h.xx * h.xx + h.yx * h.yx + h.zx * h.zx),
                           2 * h.yy + (h.xy * h.xy + h.yy * h.yy + h.zy * h.zy),
                           2 * h.zz + (h.xz * h.xz + h.yz * h.yz + h.zz * h.zz),
                           h.xy + h.yx + (h.xx * h.xy + h.yx * h.yy + h.zx * h.zy),
                           h.yz + h.zy + (h.xy * h.xz + h.yy * h.yz + h.zy * h.zz),
                           h.zx + h.xz + (h.xz * h.xx + h.yz * h.yx + h.zz * h.zx)};
    return e;
}

/* tr(C - I), summed in the order of the energies. */
ELEMENT_FUNCTION real element_green_trace(element_tensor h)
{
    return 2 * (h.xx + h.yy + h.zz) + (h.xx * h.xx + h.yx * h.yx + h.zx * h.zx) +
           (h.xy * h.xy + h.yy * h.yy + h.zy * h.zy) + (h.xz * h.xz + h.yz * h.yz + h.zz * h.zz);
}

/* r^2 - 1 for r = J^-1/3 (root) and d = J - 1: as r^3 = 1/J, r - 1 = -d r^3 / (1 + r + r^2), no difference of nearly
 * equal numbers. */
ELEMENT_FUNCTION real element_square_less(real dilation, real root)
{
    real square = root * root;
    return (root + 1) * (-dilation * (square * root) / (1 + root + square));
}

/* I1bar - 3 = 3 (r^2 - 1) + r^2 tr E, trace: tr E, E = C - I; float keeps small strains. */
ELEMENT_FUNCTION real element_first_bar(real dilation, real root, real trace)
{
    return 3 * element_square_less(dilation, root) + root * root * trace;
}

/* g s, s symmetric. */
ELEMENT_FUNCTION element_tensor element_times(element_tensor g, element_symmetric s)
{
    element_tensor p = {g.xx * s.xx + g.xy * s.xy + g.xz * s.zx, g.xx * s.xy + g.xy * s.yy + g.xz * s.yz,
                        g.xx * s.zx + g.xy * s.yz + g.xz * s.zz, g.yx * s.xx + g.yy * s.xy + g.yz * s.zx,
                        g.yx * s.xy + g.yy * s.yy + g.yz * s.yz, g.yx * s.zx + g.yy * s.yz + g.yz * s.zz,
                        g.zx * s.xx + g.zy * s.xy + g.zz * s.zx, g.zx * s.xy + g.zy * s.yy + g.zz * s.yz,
                        g.zx * s.zx + g.zy * s.yz + g.zz * s.zz};
    return p;
}

ELEMENT_FUNCTION element_tensor element_product(element_tensor a, element_tensor b)
{
    const element_tensor c = {a.xx * b.xx + a.xy * b.yx + a.xz * b.zx, a.xx * b.xy + a.xy * b.yy + a.xz * b.zy,
                              a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.yx * b.xx + a.yy * b.yx + a.yz * b.zx,
                              a.yx * b.xy + a.yy * b.yy + a.yz * b.zy, a.yx * b.xz + a.yy * b.yz + a.yz * b.zz,
                              a.zx * b.xx + a.zy * b.yx + a.zz * b.zx, a.zx * b.xy + a.zy * b.yy + a.zz * b.zy,
                              a.zx * b.xz + a.zy * b.yz + a.zz * b.zz};
    return c;
}

#endif
