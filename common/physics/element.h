/* The maths of one element: a box of eight corners, one integration point at its centre, in total Lagrangian form
 * (Miller, Joldes, Lance & Wittek 2007), with hourglass control in the same form (Joldes, Wittek & Miller 2008). Compiled by
 * gcc, clang and nvcc alike; `real` is double, or float where ELEMENT_SINGLE is defined before; or, where ELEMENT_LANES is
 * too, a vector of so many of them: as many elements side by side (GNU C's vectors, which gcc and clang have). No branches on
 * data, no loops, no arrays indexed by a variable, and every operation rounds by itself: the same bits in any lane.
 *
 * Corners are in VTK order. Over a box, a field u with values at the corners is a sum of eight modes: its mean, three
 * slopes (x, y, z) and four hourglass modes (xy, yz, zx, xyz), each a product of signs at the corners. The slopes give the
 * displacement gradient at the centre: the derivatives of the shape functions there are B_ai = +-1/(4 h_i). The
 * hourglass modes are Flanagan & Belytschko's gamma vectors, exact for a box.
 */
#ifndef SINEW_ELEMENT_H
#define SINEW_ELEMENT_H

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
#define REAL_SELECT(mask, yes, no) ((mask) ? (yes) : (no))
#endif

#ifdef __CUDACC__
#define ELEMENT_FUNCTION static __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define ELEMENT_FUNCTION static inline __attribute__((always_inline)) /* without it gcc calls, and makes no vectors */
#else
#define ELEMENT_FUNCTION static inline
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

/* One component of a vector field at the eight corners, and all three. */
typedef struct element_corners {
    real at[8];
} element_corners;

typedef struct element_field {
    element_corners x, y, z;
} element_field;

typedef struct element_modes {
    real x, y, z, xy, yz, zx, xyz;
} element_modes;

typedef struct element_vector {
    real x, y, z;
} element_vector;

/* Row: component of the field; column: axis. */
typedef struct element_tensor {
    real xx, xy, xz, yx, yy, yz, zx, zy, zz;
} element_tensor;

/* The box: 1/(4 h) (1/m) and V/(4 h) (m2) along each axis. */
typedef struct element_shape {
    element_vector slope, area;
} element_shape;

/* mu and K (Pa); k (N/m) of every hourglass mode. */
typedef struct element_law {
    real mu, bulk, hourglass;
} element_law;

/* Unit direction at rest, and the active stress a s (Pa): level times peak. */
typedef struct element_fibre {
    element_vector along;
    real tension;
} element_fibre;

ELEMENT_FUNCTION element_shape element_box(double hx, double hy, double hz)
{
    element_shape s = {{real_of(1 / (4 * hx)), real_of(1 / (4 * hy)), real_of(1 / (4 * hz))},
                       {real_of(hy * hz / 4), real_of(hz * hx / 4), real_of(hx * hy / 4)}};
    return s;
}

/* min(lambda + 2 mu, 11 mu), lambda + 2 mu = K + 4/3 mu (Pa): the modulus that hourglass modes are held by. With lambda
 * + 2 mu alone they grow stiff with K, and an element locks in bending toward nu = .5, as bending is what these modes
 * are. The two are the same at nu = .45, where rounding is not to decide: up to there it is lambda + 2 mu to the last
 * bit. */
ELEMENT_FUNCTION double element_hourglass_modulus(double mu, double bulk)
{
    double wave = bulk + 4. / 3 * mu, most = 11 * mu;
    return wave > most * (1 + 1e-12) ? most : wave;
}

/* k = kappa min(lambda + 2 mu, 11 mu) V sum(B^2) / 8, the sum over all corners and axes: sum(B^2) = sum(1/h^2) / 2. */
ELEMENT_FUNCTION double element_hourglass(double kappa, double mu, double bulk, double hx, double hy, double hz)
{
    double squares = (1 / (hx * hx) + 1 / (hy * hy) + 1 / (hz * hz)) / 2;
    return kappa * element_hourglass_modulus(mu, bulk) * hx * hy * hz * squares / 8;
}

/* The modes of one component: sums and differences along x, then y, then z. */
ELEMENT_FUNCTION element_modes element_modes_of(element_corners u)
{
    real s01 = u.at[0] + u.at[1], d01 = u.at[1] - u.at[0];
    real s32 = u.at[3] + u.at[2], d32 = u.at[2] - u.at[3];
    real s45 = u.at[4] + u.at[5], d45 = u.at[5] - u.at[4];
    real s76 = u.at[7] + u.at[6], d76 = u.at[6] - u.at[7];
    real x0 = d01 + d32, xy0 = d32 - d01, y0 = s32 - s01, sum0 = s01 + s32;
    real x1 = d45 + d76, xy1 = d76 - d45, y1 = s76 - s45, sum1 = s45 + s76;
    element_modes m = {x0 + x1, y0 + y1, sum1 - sum0, xy0 + xy1, y1 - y0, x1 - x0, xy1 - xy0};
    return m;
}

/* The way back: the sum of the modes at each corner (no mean: forces of an element have none). */
ELEMENT_FUNCTION element_corners element_corners_of(element_modes m)
{
    real x0 = m.x - m.zx, x1 = m.x + m.zx, y0 = m.y - m.yz, y1 = m.y + m.yz;
    real xy0 = m.xy - m.xyz, xy1 = m.xy + m.xyz;
    real s01 = -m.z - y0, s32 = y0 - m.z, s45 = m.z - y1, s76 = m.z + y1;
    real d01 = x0 - xy0, d32 = x0 + xy0, d45 = x1 - xy1, d76 = x1 + xy1;
    element_corners f = {{s01 - d01, s01 + d01, s32 + d32, s32 - d32, s45 - d45, s45 + d45, s76 + d76, s76 - d76}};
    return f;
}

/* H = grad u at the centre. */
ELEMENT_FUNCTION element_tensor element_gradient(element_modes x, element_modes y, element_modes z,
                                                 element_vector slope)
{
    element_tensor h = {x.x * slope.x, x.y * slope.y, x.z * slope.z, y.x * slope.x, y.y * slope.y,
                        y.z * slope.z, z.x * slope.x, z.y * slope.y, z.z * slope.z};
    return h;
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

/* P = F S of the neo-Hookean W = mu/2 (J^-2/3 tr C - 3) + K/2 (J - 1)^2. From S = mu J^-2/3 (I - tr C/3 C^-1) +
 * K J (J - 1) C^-1, as I - tr C/3 C^-1 = C^-1 dev C and dev C = dev(C - I):
 *     P = cof F (mu J^-5/3 dev(C - I) + K (J - 1) I),   C - I = H + H^T + H^T H,
 * which takes no difference of nearly equal numbers, so that float keeps small strains. */
ELEMENT_FUNCTION element_tensor element_stress(element_tensor h, real mu, real bulk)
{
    real exx = 2 * h.xx + (h.xx * h.xx + h.yx * h.yx + h.zx * h.zx);
    real eyy = 2 * h.yy + (h.xy * h.xy + h.yy * h.yy + h.zy * h.zy);
    real ezz = 2 * h.zz + (h.xz * h.xz + h.yz * h.yz + h.zz * h.zz);
    real exy = h.xy + h.yx + (h.xx * h.xy + h.yx * h.yy + h.zx * h.zy);
    real eyz = h.yz + h.zy + (h.xy * h.xz + h.yy * h.yz + h.zy * h.zz);
    real ezx = h.zx + h.xz + (h.xz * h.xx + h.yz * h.yx + h.zz * h.zx);
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real square = root * root;
    real scale = mu * (square * square * root);
    real pressure = bulk * dilation - scale * ((exx + eyy + ezz) * R(1. / 3));
    real sxx = scale * exx + pressure, syy = scale * eyy + pressure, szz = scale * ezz + pressure;
    real sxy = scale * exy, syz = scale * eyz, szx = scale * ezx;
    element_tensor g = element_cofactor(h);
    element_tensor p = {g.xx * sxx + g.xy * sxy + g.xz * szx, g.xx * sxy + g.xy * syy + g.xz * syz,
                        g.xx * szx + g.xy * syz + g.xz * szz, g.yx * sxx + g.yy * sxy + g.yz * szx,
                        g.yx * sxy + g.yy * syy + g.yz * syz, g.yx * szx + g.yy * syz + g.yz * szz,
                        g.zx * sxx + g.zy * sxy + g.zz * szx, g.zx * sxy + g.zy * syy + g.zz * syz,
                        g.zx * szx + g.zy * syz + g.zz * szz};
    return p;
}

/* f(l), l the fibre's stretch: 9 (l - .4)^2 on .4 to .6, 1 - 4 (1 - l)^2 to 1.4, 9 (l - 1.6)^2 to 1.6, else 0. */
ELEMENT_FUNCTION real element_force_length(real l)
{
    real low = 9 * (l - R(.4)) * (l - R(.4)), middle = 1 - 4 * (1 - l) * (1 - l);
    real high = 9 * (l - R(1.6)) * (l - R(1.6));
    real f = REAL_SELECT(l < R(.6), low, REAL_SELECT(l <= R(1.4), middle, high));
    return REAL_SELECT(l < R(.4), REAL_ZERO, REAL_SELECT(l > R(1.6), REAL_ZERO, f));
}

/* Its derivative. */
ELEMENT_FUNCTION real element_force_length_slope(real l)
{
    real f = REAL_SELECT(l < R(.6), 18 * (l - R(.4)), REAL_SELECT(l <= R(1.4), 8 * (1 - l), 18 * (l - R(1.6))));
    return REAL_SELECT(l < R(.4), REAL_ZERO, REAL_SELECT(l > R(1.6), REAL_ZERO, f));
}

/* F a0. */
ELEMENT_FUNCTION element_vector element_fibre_now(element_tensor h, element_vector a)
{
    element_vector m = {a.x + (h.xx * a.x + h.xy * a.y + h.xz * a.z), a.y + (h.yx * a.x + h.yy * a.y + h.yz * a.z),
                        a.z + (h.zx * a.x + h.zy * a.y + h.zz * a.z)};
    return m;
}

ELEMENT_FUNCTION real element_length(element_vector a)
{
    return real_sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/* P of the muscle's active stress S = a s f(l)/l a0 (x) a0: a s f(l)/l (F a0) (x) a0. No fibre (a0 = 0): none. */
ELEMENT_FUNCTION element_tensor element_active(element_tensor h, element_fibre fibre)
{
    element_vector a = fibre.along, m = element_fibre_now(h, a);
    real l = element_length(m);
    real t = fibre.tension * element_force_length(l) / REAL_SELECT(l > 0, l, REAL_ZERO + 1);
    element_tensor p = {t * m.x * a.x, t * m.x * a.y, t * m.x * a.z, t * m.y * a.x, t * m.y * a.y,
                        t * m.y * a.z, t * m.z * a.x, t * m.z * a.y, t * m.z * a.z};
    return p;
}

ELEMENT_FUNCTION element_tensor element_sum(element_tensor a, element_tensor b)
{
    element_tensor s = {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
                        a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
    return s;
}

/* One component of f_a = V P B_a + k sum_g gamma_g (gamma_g . u); px, py, pz: its row of P. */
ELEMENT_FUNCTION element_corners element_gather(element_modes u, real px, real py, real pz, element_vector area, real k)
{
    element_modes f = {px * area.x, py * area.y, pz * area.z, k * u.xy, k * u.yz, k * u.zx, k * u.xyz};
    return element_corners_of(f);
}

/* As element_force, with a second fibre. */
ELEMENT_FUNCTION element_field element_force_of_two(element_field u, element_shape shape, element_law law,
                                                    element_fibre fibre, int is_active, element_fibre second,
                                                    int is_second_active)
{
    element_modes x = element_modes_of(u.x), y = element_modes_of(u.y), z = element_modes_of(u.z);
    element_tensor h = element_gradient(x, y, z, shape.slope);
    element_tensor p = element_stress(h, law.mu, law.bulk);
    if (is_active)
        p = element_sum(p, element_active(h, fibre));
    if (is_second_active)
        p = element_sum(p, element_active(h, second));
    element_field f = {element_gather(x, p.xx, p.xy, p.xz, shape.area, law.hourglass),
                       element_gather(y, p.yx, p.yy, p.yz, shape.area, law.hourglass),
                       element_gather(z, p.zx, p.zy, p.zz, shape.area, law.hourglass)};
    return f;
}

/* The internal forces at the corners (N): what the element pulls with, for displacements u (m). is_active false: the
 * fibre is not looked at. */
ELEMENT_FUNCTION element_field element_force(element_field u, element_shape shape, element_law law, element_fibre fibre,
                                             int is_active)
{
    return element_force_of_two(u, shape, law, fibre, is_active, fibre, 0);
}

/* Strain energy per volume at rest (J/m3), without the active stress. */
ELEMENT_FUNCTION real element_energy(element_tensor h, real mu, real bulk)
{
    real dilation = element_dilation(h);
    real root = element_cube_root_inverse(1 + dilation);
    real trace = 2 * (h.xx + h.yy + h.zz) + (h.xx * h.xx + h.yx * h.yx + h.zx * h.zx) +
                 (h.xy * h.xy + h.yy * h.yy + h.zy * h.zy) + (h.xz * h.xz + h.yz * h.yz + h.zz * h.zz);
    return mu / 2 * (root * root * (3 + trace) - 3) + bulk / 2 * dilation * dilation;
}

/* Energy of one component's hourglass modes (J). */
ELEMENT_FUNCTION real element_hourglass_energy(element_modes u, real k)
{
    return k / 2 * (u.xy * u.xy + u.yz * u.yz + u.zx * u.zx + u.xyz * u.xyz);
}

#endif
