/* What the tissue of a march's cells does under physical control: the stress of each law that has kernels (MARCHES), in
 * no fixed order, with operations fused. Included by cuda_cells.cuh alone, whose faces are here as well.
 *
 * With c = 4 h and L = diag(1/c), F' = F L^-1 = diag(c) + H' has as H' the sums and differences over corners, which so
 * need no slopes, and the forces on these, V P L, no areas. With G' = cof F' and V' = 64 V = c_x c_y c_z,
 *     V P L = all V L + own V H' L^2 + g (G' - V' L)/64,   J - 1 = (det F' - V')/V',
 * all, own and g being those of `stress` (cuda_cells.cuh). The strains of a mode, 1/(4 h_i) times q_i, are
 * e = F'^-1 m. With s = dW/de the forces on the mode are f = F'^-T s, and V P L has -f (x) e. The three shears share
 * one sum: with a, b, c the strains yz.x, zx.y, xy.z and l = 1/c,
 *     s_a = mu V/3 ((l_y^2 + l_z^2 - l_x^2)/l_x^2 a + (a + b + c)). */
#ifndef SINEW_CUDA_MARCH_LAWS_CUH
#define SINEW_CUDA_MARCH_LAWS_CUH

#include "tled/cuda/cuda_march.cuh"
#include "tled/cuda/cuda_ptx.cuh"

/* Modes of a face's four nodes, or forces on them. */
typedef struct face {
    real mean[3], x[3], y[3], xy[3];
} face;

/* Of displacements at corners (0, 0), (1, 0), (0, 1), (1, 1). */
static __device__ __forceinline__ face face_between(real4 a, real4 b, real4 c, real4 d)
{
    const real low[2][3] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}}, high[2][3] = {{c.x, c.y, c.z}, {d.x, d.y, d.z}};
    face f;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const real s = low[0][i] + low[1][i], t = low[1][i] - low[0][i];
        const real sum = high[0][i] + high[1][i], gap = high[1][i] - high[0][i];
        f.mean[i] = s + sum;
        f.y[i] = sum - s;
        f.x[i] = t + gap;
        f.xy[i] = gap - t;
    }
    return f;
}

/* F' and, first order in H', what of it is measured from rest. */
typedef struct stretch {
    real h[3][3];  /* H': row a, column: of the modes x, y, z */
    real g[3][3];  /* cof F'; on the diagonal, less that at rest */
    real dilation; /* det F' - V' */
    real j;        /* J; no cell: in single precision NO_CELL */
    real root;     /* in double precision J^(-1/3); no cell: 0 */
    real third;    /* (tr C - 3)/3 */
} stretch;

/* What a cell is made of, under physical control: what holds it; what laws have beside it, and the directions of
 * families. */
template <march_control K> struct tissue {
    march_hold<real> hold;
    march_more<real> more;
    march_family<real> family;
    uint2 along;
};

/* As J, of which all that depends on it is 0: a power of it, and what it divides. */
#define NO_CELL 3e38f

/* x^(-1/3), in double precision, to some 1e-16 of it. With h = 1 - x y^3, which is some 1e-6, it is
 * y (1 - h)^(-1/3) = y (1 + h/3 + 2/9 h^2 + ...). */
static __device__ __forceinline__ double near_root_of_inverse(double x)
{
    const double y = near_exp2(near_log2((float)x) * (-1.f / 3)), h = fma(-x * y, y * y, 1.);
    return fma(y * h, fma(h, 2. / 9, 1. / 3), y);
}

/* J^(-N/3); no cell: 0. */
template <int N> static __device__ __forceinline__ real power_of(const stretch &s)
{
    if constexpr (N == 3 && SINGLE)
        return near_inverse((float)s.j);
    if constexpr (SINGLE)
        return near_exp2(near_log2((float)s.j) * (-(float)N / 3));
    const real square = s.root * s.root;
    if constexpr (N == 2)
        return square;
    if constexpr (N == 3)
        return square * s.root;
    return N == 4 ? square * square : square * s.root * square;
}

/* What march_hold has for a modulus. */
static __device__ __forceinline__ real held_mu(real mu)
{
    return SINGLE ? (real)near_log2((float)mu) : mu;
}

/* Of a box, by axis. */
template <march_control K>
static __device__ __forceinline__ const march_side<real> &side_of(const cuda_march<real> &m, int i)
{
    return m.side[march_kind<K>::CUBES ? 0 : i];
}

/* V'/c^2; of a cube, c. */
template <march_control K> static __device__ __forceinline__ real squares_of(const cuda_march<real> &m, int i)
{
    return march_kind<K>::CUBES ? m.side[0].width : m.side[i].squares;
}

/* Adds c^2 (C - 1) on the diagonal, along one axis, to c H' there; f: F' there. */
static __device__ __forceinline__ real add_square(const real h[3][3], real f, int i, real sum)
{
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum += h[i][i] * f;
    sum += h[j][i] * h[j][i];
    return sum + h[k][i] * h[k][i];
}

/* (tr C - 3)/3, of a cube in one sum; wide: of a cube, c H' on the diagonal, which cof F' has too. */
template <march_control K>
static __device__ __forceinline__ real third_of(const cuda_march<real> &m, const real h[3][3], const real wide[3],
                                                const real f[3])
{
    real all = 0;
#pragma unroll
    for (int i = 0; i < 3; i++)
        if constexpr (march_kind<K>::CUBES)
            all = add_square(h, f[i], i, i ? all + wide[i] : wide[i]);
        else
            all += m.side[i].thirds * add_square(h, f[i], i, m.side[i].width * h[i][i]);
    return march_kind<K>::CUBES ? m.side[0].thirds * all : all;
}

/* Adds what the modes of a part have (element_cut.h), to H'. */
static __device__ __forceinline__ void add_cut(const march_cut &c, const face &low, const face &high, real h[3][3])
{
#pragma unroll
    for (int a = 0; a < 3; a++) {
        const real xy = low.xy[a] + high.xy[a], xyz = high.xy[a] - low.xy[a];
        const real yz = high.y[a] - low.y[a], zx = high.x[a] - low.x[a];
        h[a][0] += c.y * xy + c.z * zx + c.yz * xyz;
        h[a][1] += c.x * xy + c.z * yz + c.zx * xyz;
        h[a][2] += c.y * yz + c.x * zx + c.xy * xyz;
    }
}

/* cut: of a cut cell; else NULL. */
template <march_control K>
static __device__ __forceinline__ stretch stretch_of(const cuda_march<real> &m, bool is, const face &low,
                                                     const face &high, const march_cut *cut)
{
    stretch s;
    real f[3], wide[3];
#pragma unroll
    for (int a = 0; a < 3; a++) {
        s.h[a][0] = low.x[a] + high.x[a];
        s.h[a][1] = low.y[a] + high.y[a];
        s.h[a][2] = high.mean[a] - low.mean[a];
    }
    if (cut)
        add_cut(*cut, low, high, s.h);
#pragma unroll
    for (int i = 0; i < 3; i++) {
        f[i] = side_of<K>(m, i).width + s.h[i][i];
        wide[i] = side_of<K>(m, (i + 2) % 3).width * s.h[i][i];
    }
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        s.g[i][i] = fma(s.h[j][j], f[k], fma(-s.h[j][k], s.h[k][j], wide[k]));
        s.g[i][j] = s.h[j][k] * s.h[k][i] - s.h[j][i] * f[k];
        s.g[i][k] = s.h[j][i] * s.h[k][j] - s.h[k][i] * f[j];
    }
    s.dilation = f[0] * s.g[0][0] + m.side[0].face * s.h[0][0] + s.h[0][1] * s.g[0][1] + s.h[0][2] * s.g[0][2];
    s.j = is ? 1 + s.dilation * m.side[0].density : NO_CELL;
    s.root = 0;
    if constexpr (!SINGLE)
        s.root = is ? near_root_of_inverse(s.j) : 0;
    s.third = third_of<K>(m, s.h, wide, f);
    return s;
}

/* What a law of the form `first` has at a cell's x = I1bar - 3, of which hourglass control has to know (element.h). */
typedef struct bent {
    real scale;                        /* J^-5/3; no cell: 0 */
    real slope, shear, slope_of_shear; /* 2 f'(x); T/T(0); its slope, over V' */
} bent;

/* c[0] + c[1] x + ... */
template <int COUNT> static __device__ __forceinline__ real series(const real *c, real x)
{
    real sum = c[COUNT - 1];
#pragma unroll
    for (int k = COUNT - 2; k >= 0; k--)
        sum = fma(sum, x, c[k]);
    return sum;
}

/* By y = x/3. No cell: y is -1, so that all is finite. All powers take less time than to ask how many there are. */
static __device__ __forceinline__ bent bent_of(const march_more<real> &c, const stretch &s)
{
    bent b;
    const real root = power_of<2>(s), y = root * s.third + (root - 1);
    b.scale = SINGLE ? root * near_inverse(s.j) : power_of<5>(s);
    b.slope = series<MARCH_POWERS>(c.slope, y);
    b.shear = 1 + y * series<MARCH_POWERS - 1>(c.shear, y);
    b.slope_of_shear = series<MARCH_POWERS - 1>(c.rise, y);
    return b;
}

/* mu J^-5/3; in single precision 2^(log2 mu - 5/3 log2 J). */
static __device__ __forceinline__ real scale_of(const march_hold<real> &k, const stretch &s)
{
    if constexpr (SINGLE)
        return near_exp2((float)k.mu + near_log2((float)s.j) * (-5.f / 3));
    return k.mu * power_of<5>(s);
}

/* A direction from the two numbers that march_cells.h has of it. */
static __device__ __forceinline__ void unfold(float folded_x, float folded_y, float to[3])
{
    const float z = 1 - fabsf(folded_x) - fabsf(folded_y), more = fmaxf(-z, 0);
    const float x = folded_x - copysignf(more, folded_x), y = folded_y - copysignf(more, folded_y);
    const float by = near_root_inverse(x * x + y * y + z * z);
    to[0] = x * by, to[1] = y * by, to[2] = z * by;
}

/* A number of 21 bits, the lowest of these, as least to least + range; other bits are nobody's. */
static __device__ __forceinline__ float number_of(uint32_t bits, float least, float range)
{
    const float step = range * (2097152.f / 2097151.f);
    return (least - step) + step * __uint_as_float(0x3f800000 | (bits << 2 & 0x7ffffc));
}

/* Of two families. Returns whether there are any. */
static __device__ __forceinline__ bool directions_of(const march_family<float> &f, uint2 of, float first[3],
                                                     float second[3])
{
    float a[3], sine, cosine;
    const bool is = of.y >> 31;
    unfold(number_of(of.x, -1, 2), number_of(__funnelshift_r(of.x, of.y, 21), -1, 2), a);
    near_turn(number_of(of.y >> 10, 0, 6.28318530717958648f), &sine, &cosine);
    const float sign = copysignf(1, a[2]), c = -near_inverse(sign + a[2]), b = a[0] * a[1] * c; /* march_beside */
    const float beside[3] = {1 + sign * a[0] * a[0] * c, sign * b, -sign * a[0]};
    const float across[3] = {b, sign + a[1] * a[1] * c, -a[1]};
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const float apart = f.sin * (cosine * beside[i] + sine * across[i]);
        first[i] = f.cos * a[i] + apart;
        second[i] = f.cos * a[i] - apart;
    }
    return is;
}

/* Adds what a family has, F'a0 being c a0 and h' a0: 2 W' of F to *both, that of F a0 (x) a0 to p. is:
 * there are fibres. */
static __device__ __forceinline__ void add_family(const cuda_march<real> &m, const march_family<real> &f, bool is,
                                                  const float a[3], const stretch &s, real *both, real p[3][3])
{
    real moved[3], dot = 0, square = 0;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        moved[i] = s.h[i][0] * a[0] + s.h[i][1] * a[1] + s.h[i][2] * a[2];
        dot += a[i] * moved[i];
        square += moved[i] * moved[i];
    }
    const real strain = fmax(f.around * s.third + f.along * (2 * m.side[0].width * dot + square), (real)0);
    const real twice = (is ? f.stiff : 0) * strain * near_exp2((float)fmin(f.grow * strain * strain, f.most));
    const real own = twice * f.own;
    *both += twice * f.all;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const real to = own * (m.side[0].width * a[i] + moved[i]);
#pragma unroll
        for (int j = 0; j < 3; j++)
            p[i][j] += to * a[j];
    }
}

/* Adds what c01 has. With b = 2 c01 J^-4/3, F x G = I1 F - F C (by components (F x G)_iI = e_ijk e_IJK F_jJ G_kK), and
 * I2 = G:G,
 *     P = b (F x G - 2 I2/(3 J) G) = b (F x (G - I) + tr H I - H^T) + b (2 - 2 I2/(3 J)) I - b (2 I2/(3 J)) (G - I),
 * where 2 - 2 I2/(3 J) = 2/J (J - 1 - 2/3 tr(G - I) - |G - I|^2/3). *g, *all: as of push_of. */
static __device__ __forceinline__ void add_second(const cuda_march<real> &m, real second, const stretch &s, real *g,
                                                  real *all, real p[3][3])
{
    const march_side<real> &side = m.side[0];
    const real b = second * power_of<4>(s), inverse = power_of<3>(s);
    const real by = b * 3 * side.thirds * side.width; /* b/c */
    const real trace = s.h[0][0] + s.h[1][1] + s.h[2][2], turn = s.g[0][0] + s.g[1][1] + s.g[2][2];
    real square = 0, f[3][3];
#pragma unroll
    for (int i = 0; i < 9; i++) {
        square += s.g[i / 3][i % 3] * s.g[i / 3][i % 3];
        f[i / 3][i % 3] = s.h[i / 3][i % 3] + (i % 4 ? 0 : side.width);
    }
    const real squared = 3 * side.thirds; /* 1/c^2 */
    const real less = s.dilation * side.density - ((real)2 / 3 * turn + (real)1 / 3 * squared * square) * squared;
    const real rest = 2 * b * less * inverse;
    *all += rest;
    *g += rest - 2 * b;
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
#pragma unroll
        for (int q = 0; q < 3; q++) {
            const int r = (q + 1) % 3, t = (q + 2) % 3;
            real n = side.face * ((i == q ? trace : 0) - s.h[q][i]);
            n += f[j][r] * s.g[k][t];
            n += f[k][t] * s.g[j][r];
            n -= f[j][t] * s.g[k][r];
            n -= f[k][r] * s.g[j][t];
            p[i][q] += by * n;
        }
    }
}

/* What p and its coefficients have of what is more than the neo-Hookean form. */
template <march_control K>
static __device__ __forceinline__ void push_begun(const cuda_march<real> &m, const tissue<K> &of, const stretch &s,
                                                  real *all, real *own, real *g, real p[3][3])
{
    real both = 0;
#pragma unroll
    for (int i = 0; i < 9; i++)
        p[i / 3][i % 3] = 0;
    if constexpr (march_kind<K>::FORM == FORM_MOONEY_RIVLIN)
        add_second(m, of.more.slope[0], s, g, all, p);
    if constexpr (march_kind<K>::FAMILIES == 1) {
        const float x = __uint_as_float(of.along.x);
        float a[3];
        unfold(x, __uint_as_float(of.along.y), a);
        add_family(m, of.family, x <= 1, a, s, &both, p);
    }
    if constexpr (march_kind<K>::FAMILIES == 2) {
        float a[2][3];
        const bool is = directions_of(of.family, of.along, a[0], a[1]);
        add_family(m, of.family, is, a[0], s, &both, p);
        add_family(m, of.family, is, a[1], s, &both, p);
    }
    *own += both;
    *all += both;
}

/* V P L, by `stress`' formula, scale being its mu J^-5/3; no cell: 0. */
template <march_control K>
static __device__ __forceinline__ void push_of(const cuda_march<real> &m, const tissue<K> &of, real scale,
                                               const stretch &s, bool is, real p[3][3])
{
    const real pressure = is ? of.hold.press * s.dilation : 0;
    real all = pressure + scale * (s.dilation * m.side[0].density - s.third), own = scale * s.j;
    real g = pressure - scale * (1 + s.third);
    constexpr bool begun = march_kind<K>::FORM == FORM_MOONEY_RIVLIN || march_kind<K>::FAMILIES > 0;
    if constexpr (begun)
        push_begun<K>(m, of, s, &all, &own, &g, p);
#pragma unroll
    for (int i = 0; i < 3; i++) {
        const real column = own * squares_of<K>(m, i);
#pragma unroll
        for (int a = 0; a < 3; a++)
            p[a][i] = (begun ? p[a][i] + column * s.h[a][i] : column * s.h[a][i]) + g * s.g[a][i];
        p[i][i] += all * side_of<K>(m, i).face;
    }
}

/* F'^-T; no cell: nothing. */
template <march_control K>
static __device__ __forceinline__ void inverse_of(const cuda_march<real> &m, const stretch &s, real to[3][3])
{
    const real inverse = m.side[0].density * power_of<3>(s);
#pragma unroll
    for (int i = 0; i < 3; i++)
#pragma unroll
        for (int a = 0; a < 3; a++)
            to[a][i] = a == i ? s.g[i][i] * inverse + side_of<K>(m, i).face * inverse : s.g[a][i] * inverse;
}

/* Of a law, by hourglass_numbers' formulas. */
static __device__ __forceinline__ march_hold<real> hold_of(const cuda_march<real> &m, real mu, real bulk)
{
    const real least = (real)1e-30, torsion = m.volume * m.weight * ((real)1 / 3) * mu, twice = 2 * torsion;
    march_hold<real> k;
    k.mu = held_mu(m.weight * mu);
    k.press = m.weight * m.side[0].density * bulk;
    k.coupling = twice * (bulk - (real)2 / 3 * mu) * near_inverse(fmax(bulk + (real)4 / 3 * mu, least));
    k.bending = k.coupling + twice;
    k.torsion = torsion;
    k.corner = 3 * torsion * bulk * near_inverse(fmax(3 * bulk + mu, least));
#pragma unroll
    for (int a = 0; a < 3; a++)
        k.own[a] = m.side[a].own * torsion;
    return k;
}

/* Of a family: k1, k2, kappa, angle. */
static __device__ __forceinline__ march_family<real> family_of(const cuda_march<real> &m, const real k[4])
{
    const real log2_e = (real)1.4426950408889634, around = 3 * k[2], along = 1 - around;
    float sine, cosine;
    near_turn((float)k[3], &sine, &cosine);
    return {2 * m.weight * k[0],
            k[1] * log2_e,
            FIBRE_CAP * log2_e,
            around,
            along * 3 * m.side[0].thirds,
            k[2],
            along * m.side[0].width,
            cosine,
            sine};
}

/* Of a special cell, by hold_of; c: what march_cell has of its law beside mu. */
static __device__ __forceinline__ march_more<real> more_of(const cuda_march<real> &m, real mu, const real c[4])
{
    const real inverse = near_inverse(fmax(mu, (real)1e-30)), slope[MARCH_POWERS] = {mu, c[0], c[1], c[2], c[3]};
    march_more<real> to;
    real three = 1;
#pragma unroll
    for (int k = 0; k < MARCH_POWERS; three *= 3, k++) {
        to.slope[k] = m.weight * three * slope[k];
        if (k == 0)
            continue;
        to.shear[k - 1] = (2 * k + 1) * three * slope[k] * inverse;
        to.rise[k - 1] = k * ((real)1 / 3) * m.side[0].density * to.shear[k - 1];
    }
    return to;
}

/* Of a plain cell, but for directions. */
template <march_control K> static __device__ __forceinline__ tissue<K> plain_tissue(const cuda_march<real> &m)
{
    tissue<K> of;
    of.hold = m.held;
    of.more = m.more;
    of.family = m.family;
    return of;
}

/* law: the first numbers of `cell`, a special one. */
template <march_control K>
static __device__ __forceinline__ void special_tissue(const cuda_march<real> &m, const cuda_march_cell<real> &cell,
                                                      real4 law, tissue<K> *to)
{
    to->hold = hold_of(m, law.x, law.y);
    if constexpr (march_kind<K>::FORM == FORM_MOONEY_RIVLIN) {
        to->hold.mu = held_mu(m.weight * (law.x - law.z));
        to->more.slope[0] = m.weight * law.z;
    }
    if constexpr (march_kind<K>::FORM == FORM_FIRST) {
        const real c[4] = {law.z, cell.more[0], cell.more[1], cell.more[2]};
        to->more = more_of(m, law.x, c);
    }
    if constexpr (march_kind<K>::FAMILIES > 0)
        to->family = family_of(m, cell.family);
}

#endif
