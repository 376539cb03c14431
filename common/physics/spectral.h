/* Eigenvalues and eigenvectors of symmetric tensors, by a fixed number of Jacobi's rotations: what is put together of
 * them again is as exact where eigenvalues are equal as where they are not. In the numbers of strain.h, whose rules
 * hold here. (Golub & Van Loan, Matrix Computations, 8.5.) Owns nothing.
 */
#ifndef SINEW_SPECTRAL_H
#define SINEW_SPECTRAL_H

#include "physics/strain.h"

/* a = V diag(at) V^T, V's columns the eigenvectors. */
typedef struct spectral {
    element_vector at;
    element_tensor v;
} spectral;

/* A rotation's sine and cosine, and the sine over the cosine. */
typedef struct spectral_turn {
    real s, c, t;
} spectral_turn;

/* That makes 0 of pq, the smaller one of two. Scaled, so that no square is lost below the smallest number. */
ELEMENT_FUNCTION spectral_turn spectral_turn_of(real pp, real qq, real pq)
{
    const real d = qq - pp, two = 2 * pq, least = real_of(sizeof(real_one) == sizeof(float) ? 0x1p-126 : 0x1p-1022);
    const real far = REAL_SELECT(d < 0, -d, d), off = REAL_SELECT(two < 0, -two, two);
    const real most = REAL_SELECT(far > off, far, off), inverse = 1 / REAL_SELECT(most > least, most, least);
    const real x = two * inverse, y = REAL_SELECT(most > least, far * inverse, real_of(1));
    const real t = x / (y + real_sqrt(x * x + y * y));
    spectral_turn turn;
    turn.t = REAL_SELECT(d < 0, -t, t);
    turn.c = 1 / real_sqrt(1 + t * t);
    turn.s = turn.t * turn.c;
    return turn;
}

/* Two columns, or two rows, of anything. */
ELEMENT_FUNCTION void spectral_rotate(spectral_turn by, real *p, real *q)
{
    const real was = *p;
    *p = by.c * was - by.s * *q;
    *q = by.s * was + by.c * *q;
}

/* Makes 0 of pq. pr, qr: what is left beside the diagonal; the rest: columns p and q of V. */
ELEMENT_FUNCTION void spectral_clear(real *pp, real *qq, real *pq, real *pr, real *qr, real *xp, real *yp, real *zp,
                                     real *xq, real *yq, real *zq)
{
    const spectral_turn by = spectral_turn_of(*pp, *qq, *pq);
    *pp -= by.t * *pq;
    *qq += by.t * *pq;
    *pq = REAL_ZERO;
    spectral_rotate(by, pr, qr);
    spectral_rotate(by, xp, xq);
    spectral_rotate(by, yp, yq);
    spectral_rotate(by, zp, zq);
}

ELEMENT_FUNCTION void spectral_sweep(element_symmetric *a, element_tensor *v)
{
    spectral_clear(&a->xx, &a->yy, &a->xy, &a->zx, &a->yz, &v->xx, &v->yx, &v->zx, &v->xy, &v->yy, &v->zy);
    spectral_clear(&a->xx, &a->zz, &a->zx, &a->xy, &a->yz, &v->xx, &v->yx, &v->zx, &v->xz, &v->yz, &v->zz);
    spectral_clear(&a->yy, &a->zz, &a->yz, &a->xy, &a->zx, &v->xy, &v->yy, &v->zy, &v->xz, &v->yz, &v->zz);
}

/* Four sweeps leave nothing beside the diagonal that a float has digits for, five nothing that a double has. */
ELEMENT_APART spectral spectral_of(element_symmetric a)
{
    const real one = real_of(1), none = REAL_ZERO;
    element_tensor v = {one, none, none, none, one, none, none, none, one};
    spectral_sweep(&a, &v);
    spectral_sweep(&a, &v);
    spectral_sweep(&a, &v);
    spectral_sweep(&a, &v);
#ifndef ELEMENT_SINGLE
    spectral_sweep(&a, &v);
#endif
    const spectral s = {{a.xx, a.yy, a.zz}, v};
    return s;
}

/* V diag(at) V^T. */
ELEMENT_FUNCTION element_symmetric spectral_with(element_tensor v, element_vector at)
{
    const element_symmetric a = {at.x * v.xx * v.xx + at.y * v.xy * v.xy + at.z * v.xz * v.xz,
                                 at.x * v.yx * v.yx + at.y * v.yy * v.yy + at.z * v.yz * v.yz,
                                 at.x * v.zx * v.zx + at.y * v.zy * v.zy + at.z * v.zz * v.zz,
                                 at.x * v.xx * v.yx + at.y * v.xy * v.yy + at.z * v.xz * v.yz,
                                 at.x * v.yx * v.zx + at.y * v.yy * v.zy + at.z * v.yz * v.zz,
                                 at.x * v.zx * v.xx + at.y * v.zy * v.xy + at.z * v.zz * v.xz};
    return a;
}

#endif
