/* The arithmetic of a march's cells: of faces' modes, in no fixed order, with operations fused. A cell has
 * the face of its layer of nodes, `low`, and that of the next, `high`. Included by cuda_march.cu alone;
 * nothing here is told of blocks and threads.
 */
#ifndef SINEW_CUDA_CELLS_CUH
#define SINEW_CUDA_CELLS_CUH

/* element.h before it */
#include "tled/cuda/cuda_march_laws.cuh"

/* Forces of the cell below on a face; isotropic: on its xy, those are twice `hourglass` times the face's. */
template <march_control K> struct push {
    real mean[3], x[3], y[3], xy[3];
};
template <> struct push<MARCH_ISOTROPIC> {
    real mean[3], x[3], y[3], hourglass;
};

/* x^(-5/3), in single precision to 4e-7 of it. */
static __device__ __forceinline__ real power(real x)
{
    if constexpr (SINGLE)
        return near_exp2(near_log2((float)x) * (-5.f / 3));
    const real root = near_root_of_inverse((double)x), square = root * root;
    return square * root * square;
}

/* The neo-Hookean form, in fewer operations. With s = mu J^-5/3, d = J - 1, e = tr(C - I), G
 * = cof F - I, all of it first order in H:
 *     P = (s (d - e/3) + K d) I + s J H + (K d - s (1 + e/3)) G.
 * No cell: mu and bulk are 0, and J is not looked at. */
static __device__ __forceinline__ element_tensor stress(element_tensor h, real mu, real bulk, bool is)
{
    const element_tensor m = {h.yy * h.zz - h.yz * h.zy, h.yz * h.zx - h.yx * h.zz, h.yx * h.zy - h.yy * h.zx,
                              h.xz * h.zy - h.xy * h.zz, h.xx * h.zz - h.xz * h.zx, h.xy * h.zx - h.xx * h.zy,
                              h.xy * h.yz - h.xz * h.yy, h.xz * h.yx - h.xx * h.yz, h.xx * h.yy - h.xy * h.yx};
    const real trace = h.xx + h.yy + h.zz;
    const real dilation = trace + ((m.xx + m.yy + m.zz) + (h.xx * m.xx + h.xy * m.xy + h.xz * m.xz));
    const real third = (2 * trace + (h.xx * h.xx + h.xy * h.xy + h.xz * h.xz + h.yx * h.yx + h.yy * h.yy + h.yz * h.yz +
                                     h.zx * h.zx + h.zy * h.zy + h.zz * h.zz)) *
                       ((real)1 / 3);
    const real j = is ? 1 + dilation : 1, scale = mu * power(j), pressure = bulk * dilation;
    const real all = pressure + scale * (dilation - third), own = scale * j, g = pressure - (scale + scale * third);
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

static __device__ __forceinline__ element_tensor gradient_of(const cuda_march<real> &m, const face &low,
                                                             const face &high)
{
    const element_tensor h = {(low.x[0] + high.x[0]) * m.slope[0],       (low.y[0] + high.y[0]) * m.slope[1],
                              (high.mean[0] - low.mean[0]) * m.slope[2], (low.x[1] + high.x[1]) * m.slope[0],
                              (low.y[1] + high.y[1]) * m.slope[1],       (high.mean[1] - low.mean[1]) * m.slope[2],
                              (low.x[2] + high.x[2]) * m.slope[0],       (low.y[2] + high.y[2]) * m.slope[1],
                              (high.mean[2] - low.mean[2]) * m.slope[2]};
    return h;
}

/* Of a cell that may be cut; cut: NULL: it is not. */
static __device__ __forceinline__ element_tensor gradient_by(const cuda_march<real> &m, const march_cut *cut,
                                                             const face &low, const face &high)
{
    element_tensor h = gradient_of(m, low, high);
    real more[3][3] = {};
    if (!cut)
        return h;
    add_cut(*cut, low, high, more);
    h.xx += more[0][0] * m.slope[0], h.xy += more[0][1] * m.slope[1], h.xz += more[0][2] * m.slope[2];
    h.yx += more[1][0] * m.slope[0], h.yy += more[1][1] * m.slope[1], h.yz += more[1][2] * m.slope[2];
    h.zx += more[2][0] * m.slope[0], h.zy += more[2][1] * m.slope[1], h.zz += more[2][2] * m.slope[2];
    return h;
}

/* The forces of a cell: `sum` gets those on its lower face, with `below`, which becomes those on its upper face. */
static __device__ __forceinline__ void cell_forces(const cuda_march<real> &m, real mu, real bulk, real hourglass,
                                                   bool is, const face &low, const face &high, face *sum,
                                                   push<MARCH_ISOTROPIC> *below)
{
    const element_tensor s = stress(gradient_of(m, low, high), mu, bulk, is);
    const real px[3] = {s.xx, s.yx, s.zx}, py[3] = {s.xy, s.yy, s.zy}, pz[3] = {s.xz, s.yz, s.zz};
    const real both = 2 * (below->hourglass + hourglass);
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const real zx = hourglass * (high.x[a] - low.x[a]), yz = hourglass * (high.y[a] - low.y[a]);
        const real z = pz[a] * m.area[2];
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

/* Strains of a mode. */
static __device__ __forceinline__ void strains_of(const real inverse[3][3], const real mode[3], real to[3])
{
#pragma unroll
    for (int i = 0; i < 3; i++)
        to[i] = inverse[0][i] * mode[0] + inverse[1][i] * mode[1] + inverse[2][i] * mode[2];
}

/* Forces on a mode from its stresses; p gets what it has of them. */
static __device__ __forceinline__ void mode_forces(const real inverse[3][3], const real stress[3], const real strain[3],
                                                   real to[3], real p[3][3])
{
#pragma unroll
    for (int a = 0; a < 3; a++) {
        to[a] = inverse[a][0] * stress[0] + inverse[a][1] * stress[1] + inverse[a][2] * stress[2];
#pragma unroll
        for (int i = 0; i < 3; i++)
            p[a][i] -= to[a] * strain[i];
    }
}

/* Of the modes of a cell, of its faces' xy, whose sum and difference are its modes xy and xyz, of yz and zx: forces, or
 * strains, or stresses. */
typedef struct modes {
    real low[3], high[3], yz[3], zx[3];
} modes;

/* k.own; of a cube it is 1 times the torsion. */
template <march_control K> static __device__ __forceinline__ real own_of(const march_hold<real> &k, int i)
{
    return march_kind<K>::CUBES ? k.torsion : k.own[i];
}

/* k.bending; of a plain cell it is 1. */
template <bool PLAIN> static __device__ __forceinline__ real bending_of(const march_hold<real> &k)
{
    return PLAIN ? 1 : k.bending;
}

/* Strains e and stresses s of the modes. */
template <march_control K, bool PLAIN>
static __device__ __forceinline__ void stress_modes(const march_hold<real> &k, const real inverse[3][3],
                                                    const face &low, const face &high, modes *e, modes *s)
{
    real yz[3], zx[3], xy[3];
#pragma unroll
    for (int a = 0; a < 3; a++) {
        yz[a] = high.y[a] - low.y[a];
        zx[a] = high.x[a] - low.x[a];
    }
    strains_of(inverse, low.xy, e->low);
    strains_of(inverse, high.xy, e->high);
    strains_of(inverse, yz, e->yz);
    strains_of(inverse, zx, e->zx);
#pragma unroll
    for (int i = 0; i < 3; i++)
        xy[i] = e->low[i] + e->high[i];
    const real bending = bending_of<PLAIN>(k), twist = k.torsion * (e->yz[0] + e->zx[1] + xy[2]);
    const real s_xy[3] = {bending * xy[0] + k.coupling * e->yz[2], bending * xy[1] + k.coupling * e->zx[2],
                          own_of<K>(k, 2) * xy[2] + twist};
    s->yz[0] = own_of<K>(k, 0) * e->yz[0] + twist;
    s->yz[1] = bending * e->yz[1] + k.coupling * e->zx[0];
    s->yz[2] = bending * e->yz[2] + k.coupling * xy[0];
    s->zx[0] = bending * e->zx[0] + k.coupling * e->yz[1];
    s->zx[1] = own_of<K>(k, 1) * e->zx[1] + twist;
    s->zx[2] = bending * e->zx[2] + k.coupling * xy[1];
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const real gap = e->high[i] - e->low[i];
        s->low[i] = s_xy[i] - k.corner * gap;
        s->high[i] = s_xy[i] + k.corner * gap;
    }
}

/* Twice their energy. In this order a step takes .5 % less than by i alone. */
static __device__ __forceinline__ real work_of(const modes &e, const modes &s)
{
    real work = 0;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        work += s.yz[i] * e.yz[i];
        work += s.zx[i] * e.zx[i];
    }
#pragma unroll
    for (int i = 0; i < 3; i++) {
        work += s.low[i] * e.low[i];
        work += s.high[i] * e.high[i];
    }
    return work;
}

/* Forces on them; p gets what it has of them. */
static __device__ __forceinline__ void force_modes(const real inverse[3][3], const modes &e, const modes &s, modes *f,
                                                   real p[3][3])
{
    mode_forces(inverse, s.low, e.low, f->low, p);
    mode_forces(inverse, s.high, e.high, f->high, p);
    mode_forces(inverse, s.yz, e.yz, f->yz, p);
    mode_forces(inverse, s.zx, e.zx, f->zx, p);
}

/* V P L, and the forces on the modes, of a law that these follow: their energy is W = t w0 with t = T/T(0), so P has
 * w0 t' dx/dF besides, which is the law's own stress with w0 t'/V more in place of f'. Leaves t F'^-T, by which
 * the modes' forces are t times what they are, in `inverse`. */
template <march_control K>
static __device__ __forceinline__ void follow(const cuda_march<real> &m, const tissue<K> &of, const stretch &s, bool is,
                                              real work, real inverse[3][3], real p[3][3])
{
    const bent b = bent_of(of.more, s);
    push_of<K>(m, of, (b.slope + work * b.slope_of_shear) * b.scale, s, is, p);
#pragma unroll
    for (int i = 0; i < 9; i++)
        inverse[i / 3][i % 3] *= b.shear;
}

/* Adds what V P L, p[component][axis], pulls the modes of a cut cell with, the transpose of add_cut; a cell's mode xy
 * is the sum of its faces', xyz their difference. */
static __device__ __forceinline__ void add_cut_forces(const march_cut &c, const real p[3][3], modes *f)
{
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const real xy = p[a][0] * c.y + p[a][1] * c.x;
        const real xyz = p[a][0] * c.yz + p[a][1] * c.zx + p[a][2] * c.xy;
        f->low[a] += xy - xyz;
        f->high[a] += xy + xyz;
        f->yz[a] += p[a][1] * c.z + p[a][2] * c.y;
        f->zx[a] += p[a][0] * c.z + p[a][2] * c.x;
    }
}

/* As cell_forces of isotropic control; PLAIN: the cell is; cut: of a cut cell; else NULL. */
template <march_control K, bool PLAIN>
static __device__ __forceinline__ void cell_forces(const cuda_march<real> &m, const tissue<K> &of, bool is,
                                                   const face &low, const face &high, const march_cut *cut, face *sum,
                                                   push<K> *below)
{
    real inverse[3][3], p[3][3];
    modes strains, stresses, f;
    const stretch s = stretch_of<K>(m, is, low, high, cut);
    inverse_of<K>(m, s, inverse);
    stress_modes<K, PLAIN>(of.hold, inverse, low, high, &strains, &stresses);
    if constexpr (march_kind<K>::FORM == FORM_FIRST)
        follow<K>(m, of, s, is, work_of(strains, stresses), inverse, p);
    else
        push_of<K>(m, of, scale_of(of.hold, s), s, is, p);
    force_modes(inverse, strains, stresses, &f, p);
    if (cut)
        add_cut_forces(*cut, p, &f);
#pragma unroll
    for (int a = 0; a < 3; a++) {
        sum->mean[a] = below->mean[a] - p[a][2];
        sum->x[a] = below->x[a] + (p[a][0] - f.zx[a]);
        sum->y[a] = below->y[a] + (p[a][1] - f.yz[a]);
        sum->xy[a] = below->xy[a] + f.low[a];
        below->mean[a] = p[a][2];
        below->x[a] = p[a][0] + f.zx[a];
        below->y[a] = p[a][1] + f.yz[a];
        below->xy[a] = f.high[a];
    }
}

/* Adds to the forces of a cut cell what a stress pulls its modes with; px, py, pz: its columns. */
template <march_control K>
static __device__ __forceinline__ void add_cut_tension(const cuda_march<real> &m, const march_cut &c, const real px[3],
                                                       const real py[3], const real pz[3], face *sum, push<K> *below)
{
    real p[3][3];
    modes f = {};
#pragma unroll
    for (int a = 0; a < 3; a++)
        p[a][0] = px[a] * m.area[0], p[a][1] = py[a] * m.area[1], p[a][2] = pz[a] * m.area[2];
    add_cut_forces(c, p, &f);
#pragma unroll
    for (int a = 0; a < 3; a++) {
        sum->x[a] -= f.zx[a];
        sum->y[a] -= f.yz[a];
        sum->xy[a] += f.low[a];
        below->x[a] += f.zx[a];
        below->y[a] += f.yz[a];
        below->xy[a] += f.high[a];
    }
}

/* Adds those of a muscle; h: the cell's gradient, tension: Pa; cut: of a cut cell; else NULL. */
template <march_control K>
static __device__ __forceinline__ void add_tension(const cuda_march<real> &m, element_tensor h, element_fibre fibre,
                                                   const march_cut *cut, face *sum, push<K> *below)
{
    const element_tensor s = element_active(h, fibre);
    const real px[3] = {s.xx, s.yx, s.zx}, py[3] = {s.xy, s.yy, s.zy}, pz[3] = {s.xz, s.yz, s.zz};
#pragma unroll
    for (int a = 0; a < 3; a++) {
        sum->mean[a] -= pz[a] * m.area[2];
        sum->x[a] += px[a] * m.area[0];
        sum->y[a] += py[a] * m.area[1];
        below->mean[a] += pz[a] * m.area[2];
        below->x[a] += px[a] * m.area[0];
        below->y[a] += py[a] * m.area[1];
    }
    if constexpr (K != MARCH_ISOTROPIC)
        if (cut)
            add_cut_tension<K>(m, *cut, px, py, pz, sum, below);
}

/* What a cell below leaves on a face, where there is none above it. */
template <march_control K> static __device__ __forceinline__ face face_of(const push<K> &below, const face &low)
{
    face f;
#pragma unroll
    for (int a = 0; a < 3; a++) {
        f.mean[a] = below.mean[a];
        f.x[a] = below.x[a];
        f.y[a] = below.y[a];
        if constexpr (K == MARCH_ISOTROPIC)
            f.xy[a] = 2 * below.hourglass * low.xy[a];
        else
            f.xy[a] = below.xy[a];
    }
    return f;
}

#endif
