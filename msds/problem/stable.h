/* The maths of one element of the stable neo-Hookean law (Smith, de Goes & Kim 2018, ACM Transactions on Graphics
 * 37:12):
 *
 *     W = mu/2 (I - 3) - mu/2 log(I + 1) + kappa/2 (J - alpha)^2 + 110 mu h^2 max(0, 1 - J/h)^3,
 *     I = |F|^2,   J = det F,   alpha = 1 + 3 mu/(4 kappa),   h = .2.
 *
 * The last term is ours: it keeps elements from being pressed flat, up to a pressure of 66 mu. W is finite for every F,
 * and pulls elements that are inside out back. With mu = 4/3 mu_L and kappa = lambda_L + 5/6 mu_L it has the moduli
 * lambda_L, mu_L of linear elasticity at rest. Of kappa, a part may act on the mean of J about nodes (Bonet & Burton
 * 1998, Communications in Numerical Methods in Engineering 14:437): elements then share pressures p of that, and kappa
 * is what is left.
 *
 * Where this is included, stable_number is float, double or a vector of them, and stable_larger(a, b) gives the larger
 * of two; nvcc compiles it for a card. F = 1 + g; matrices are row by row. All is written in g and J - 1, so that small
 * strains keep their digits. Owns nothing.
 */
#ifndef SINEW_STABLE_H
#define SINEW_STABLE_H

/* 1 over the J below which an element counts less in a mean. */
#define STABLE_COUNTED 5

/* J below which an element gets stiff, and how stiff, in mu. */
#define STABLE_THIN  .2f
#define STABLE_STIFF 330

/* The x of stable_meeting below which its pressure does not grow. */
#define STABLE_LEAST .02f

#ifdef __CUDACC__
#define STABLE_FUNCTION static __device__ __forceinline__
#else
#define STABLE_FUNCTION static inline __attribute__((always_inline))
#endif

/* mu and kappa of the moduli of linear elasticity. */
#define STABLE_MU(mu)            (4 * (mu) / 3)
#define STABLE_KAPPA(lambda, mu) ((lambda) + 5 * (mu) / 6)

/* The cofactors of a matrix. */
STABLE_FUNCTION void stable_cofactors(const stable_number m[9], stable_number to[9])
{
    to[0] = m[4] * m[8] - m[5] * m[7];
    to[1] = m[5] * m[6] - m[3] * m[8];
    to[2] = m[3] * m[7] - m[4] * m[6];
    to[3] = m[2] * m[7] - m[1] * m[8];
    to[4] = m[0] * m[8] - m[2] * m[6];
    to[5] = m[1] * m[6] - m[0] * m[7];
    to[6] = m[1] * m[5] - m[2] * m[4];
    to[7] = m[2] * m[3] - m[0] * m[5];
    to[8] = m[0] * m[4] - m[1] * m[3];
}

/* What cofactors change by with m, along d. */
STABLE_FUNCTION void stable_cofactors_along(const stable_number m[9], const stable_number d[9], stable_number to[9])
{
    to[0] = (d[4] * m[8] + m[4] * d[8]) - (d[5] * m[7] + m[5] * d[7]);
    to[1] = (d[5] * m[6] + m[5] * d[6]) - (d[3] * m[8] + m[3] * d[8]);
    to[2] = (d[3] * m[7] + m[3] * d[7]) - (d[4] * m[6] + m[4] * d[6]);
    to[3] = (d[2] * m[7] + m[2] * d[7]) - (d[1] * m[8] + m[1] * d[8]);
    to[4] = (d[0] * m[8] + m[0] * d[8]) - (d[2] * m[6] + m[2] * d[6]);
    to[5] = (d[1] * m[6] + m[1] * d[6]) - (d[0] * m[7] + m[0] * d[7]);
    to[6] = (d[1] * m[5] + m[1] * d[5]) - (d[2] * m[4] + m[2] * d[4]);
    to[7] = (d[2] * m[3] + m[2] * d[3]) - (d[0] * m[5] + m[0] * d[5]);
    to[8] = (d[0] * m[4] + m[0] * d[4]) - (d[1] * m[3] + m[1] * d[3]);
}

STABLE_FUNCTION stable_number stable_dot(const stable_number a[9], const stable_number b[9])
{
    return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]) +
           (a[6] * b[6] + a[7] * b[7] + a[8] * b[8]);
}

/* J - 1; cofactors: of g. */
STABLE_FUNCTION stable_number stable_swelling(const stable_number g[9], const stable_number cofactors[9])
{
    return (g[0] + g[4] + g[8]) + (cofactors[0] + cofactors[4] + cofactors[8]) +
           (g[0] * cofactors[0] + g[1] * cofactors[1] + g[2] * cofactors[2]);
}

/* How much of an element counts in the mean about nodes: all, but less where J comes near 0, and nothing where it is
 * inside out. A mean of elements inside out and others too large would else be at rest. swelling: J - 1. */
STABLE_FUNCTION stable_number stable_counted(stable_number swelling)
{
    const stable_number none = swelling * 0;
    return -stable_larger(-stable_larger((swelling + 1) * STABLE_COUNTED, none), none - 1);
}

/* The mean is taken of this in place of J - 1. Its derivative by J is `counted`. */
STABLE_FUNCTION stable_number stable_swelling_counted(stable_number swelling, stable_number counted)
{
    return counted * (swelling + 1) + (1 - counted * counted) / (2 * STABLE_COUNTED) - 1;
}

/* What keeps an element from being pressed flat: a pressure that is missing from its own, and what that changes by with
 * J. */
typedef struct stable_barrier {
    stable_number pressure, stiffness; /* Pa */
} stable_barrier;

/* Of tissue, below STABLE_THIN. */
STABLE_FUNCTION stable_barrier stable_thin(stable_number swelling, stable_number mu)
{
    const stable_number lacking = stable_larger(STABLE_THIN - 1 - swelling, swelling * 0);
    const stable_number stiff = mu * STABLE_STIFF / STABLE_THIN * lacking;
    return (stable_barrier){stiff * lacking, 2 * stiff};
}

/* Of cavities, whose walls meet: hard (1 - x)^2 / x, x = J/thin, so that half of the volume bears twice the pressure;
 * constant below x = STABLE_LEAST. */
STABLE_FUNCTION stable_barrier stable_meeting(stable_number swelling, stable_number thin, stable_number hard)
{
    const stable_number none = swelling * 0, x = (swelling + 1) / thin;
    const stable_number at = -stable_larger(-stable_larger(x, none + STABLE_LEAST), none - 1), left = 1 - at;
    const stable_number within = -stable_larger(-stable_larger((x - STABLE_LEAST) * 1e6f, none), none - 1);
    return (stable_barrier){hard * left * left / at, hard * within * left * (1 + at) / (at * at * thin)};
}

/* What a stress has worked out, that the tangent takes: a, b/2 = mu/(I + 1)^2, q, and r, the bulk stiffness. */
typedef struct stable_state {
    stable_number a, b, q, r;
} stable_state;

enum { STABLE_NUMBERS = 4 };

/* The first Piola-Kirchhoff stress a F + q cof F, with a = mu - mu/(I + 1), q = kappa (J - alpha) + p, less
 * what keeps it from being flat. */
STABLE_FUNCTION stable_state stable_stress_of(const stable_number g[9], stable_number mu, stable_number kappa,
                                              stable_number p, const stable_barrier *b, stable_number to[9])
{
    stable_number c[9];
    stable_cofactors(g, c);
    const stable_number trace = g[0] + g[4] + g[8], more = 2 * trace + stable_dot(g, g); /* I - 3 */
    const stable_number share = mu / (more + 4), a = mu - share, swelling = stable_swelling(g, c);
    const stable_number pressure = kappa * swelling + p - b->pressure;
    const stable_number q = pressure - mu * 3 / 4, both = share * more / 4 + pressure; /* a + q */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to[3 * i + j] = a * g[3 * i + j] + q * (c[3 * i + j] - g[3 * j + i]);
    for (int i = 0; i < 3; i++)
        to[4 * i] += both + q * trace;
    return (stable_state){a, share / (more + 4), q, kappa + b->stiffness};
}

/* Of tissue. */
STABLE_FUNCTION stable_state stable_stress(const stable_number g[9], stable_number mu, stable_number kappa,
                                           stable_number p, stable_number to[9])
{
    stable_number c[9];
    stable_cofactors(g, c);
    const stable_barrier b = stable_thin(stable_swelling(g, c), mu);
    return stable_stress_of(g, mu, kappa, p, &b, to);
}

/* What the stress changes by along d (the derivatives of a displacement), where p changes by more. */
STABLE_FUNCTION void stable_tangent(const stable_number g[9], const stable_number d[9], const stable_state *at,
                                    stable_number more, stable_number to[9])
{
    stable_number f[9], c[9], along[9];
    for (int i = 0; i < 9; i++)
        f[i] = g[i];
    for (int i = 0; i < 9; i += 4)
        f[i] += 1;
    stable_cofactors(f, c);
    stable_cofactors_along(f, d, along);
    const stable_number b = 2 * at->b * stable_dot(f, d), r = at->r * stable_dot(c, d) + more;
    for (int i = 0; i < 9; i++)
        to[i] = (at->a * d[i] + b * f[i]) + (at->q * along[i] + r * c[i]);
}

#endif
