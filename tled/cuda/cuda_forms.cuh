/* Which kernels there are, by form of law, hourglass control and what tiles may have, and the choice among them. A
 * kernel that is compiled for one of each is the fastest; but for each size of bricks, way and precision a form then
 * takes four kernels for each kind of control. So a form has kernels of its own in the ways that a table says. In all
 * others it runs in the kernels of any form, one for each size, way and precision, whose threads branch alike by what
 * they are told. Both give the same bytes. Models with fibres that resist being stretched, or with muscles that have
 * curves of their own, run in kernels with fibres, of which there are as many again: of any form, and, under physical
 * control, of those forms that a second table names. Included by cuda_view.cuh alone.
 */
#ifndef SINEW_CUDA_FORMS_CUH
#define SINEW_CUDA_FORMS_CUH

#include <stdint.h>

extern "C" {
#include "physics/forms.h"
#include "physics/hourglass_numbers.h"
}

/* The ways in which a card takes steps by tiles, as bits. cuda_march.cuh's MARCHES says what the march has kernels
 * for. */
enum cuda_way { CUDA_TILES = 1, CUDA_RESIDENT = 2 };

/* X(NAME, ways): the forms that have kernels of their own, and in which ways. A form that is not here costs no
 * kernel. */
#ifndef CUDA_OWN
#define CUDA_OWN(X)                                                                                                    \
    X(NEO_HOOKEAN, CUDA_TILES | CUDA_RESIDENT)                                                                         \
    X(MOONEY_RIVLIN, CUDA_TILES | CUDA_RESIDENT)                                                                       \
    X(FIRST, CUDA_TILES | CUDA_RESIDENT)
#endif

/* Likewise, of kernels with fibres under physical control, for all kinds of tiles. */
#ifndef CUDA_OWN_FIBRED
#define CUDA_OWN_FIBRED(X) X(NEO_HOOKEAN, CUDA_TILES)
#endif

/* The ways in which a form has kernels of its own, without fibres and with them. */
#define OWN_ROW(NAME, ways)                                                                                            \
    if (which == FORM_##NAME)                                                                                          \
        return ways;
static constexpr int cuda_own_ways(form which)
{
    CUDA_OWN(OWN_ROW)
    return 0;
}

static constexpr int cuda_own_fibred_ways(form which)
{
    CUDA_OWN_FIBRED(OWN_ROW)
    return 0;
}
#undef OWN_ROW

enum { LAWS_NEAR = 16 /* volumes whose laws stand in shared memory */ };

/* What of a law holds hourglass modes. */
static constexpr int cuda_held(hourglass_kind kind)
{
    return kind == HOURGLASS_ISOTROPIC ? 1 : (int)HOURGLASS_NUMBERS;
}

/* What a kernel is compiled for: a form and a kind of hourglass control. A law's numbers are its coefficients, then
 * those that hold hourglass modes; NEAR: numbers that all threads of a block ask for, gravity and laws. */
template <form F, int N, int M, hourglass_kind K> struct cuda_form {
    static constexpr bool ASKS = false, FIBRED = false;
    enum { COEFFICIENTS = N, HELD = cuda_held(K), LAW = N + HELD, NEAR = 4 + LAW * LAWS_NEAR };
    static constexpr form which = F;
    static constexpr hourglass_kind control = K;
    static constexpr int coefficients = N, moduli = M, held = HELD;
    cuda_form(form, hourglass_kind)
    {
    }
};

/* Or all of them: it is told which, and has room for the most numbers. */
struct cuda_any_form {
    static constexpr bool ASKS = true, FIBRED = false;
    enum {
        COEFFICIENTS = FORM_NUMBERS,
        HELD = HOURGLASS_NUMBERS,
        LAW = COEFFICIENTS + HELD,
        NEAR = 4 + LAW * LAWS_NEAR
    };
    form which;
    hourglass_kind control;
    int coefficients, moduli, held;
    cuda_any_form(form f, hourglass_kind k)
        : which(f), control(k), coefficients(form_numbers(f)), moduli(form_moduli(f)), held(cuda_held(k))
    {
    }
};

/* One of these, with fibres. */
template <class L> struct cuda_fibred : L {
    static constexpr bool FIBRED = true;
    cuda_fibred(form f, hourglass_kind k) : L(f, k)
    {
    }
};

/* The one that a form takes in a way. */
template <bool OWN, bool FIBRED, form F, int N, int M, hourglass_kind K> struct cuda_form_taken {
    typedef cuda_form<F, N, M, K> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, false, F, N, M, K> {
    typedef cuda_any_form type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<true, true, F, N, M, K> {
    typedef cuda_fibred<cuda_form<F, N, M, K>> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, true, F, N, M, K> {
    typedef cuda_fibred<cuda_any_form> type;
};

/* Whether it has kernels of its own there. */
static constexpr bool cuda_is_own(form which, hourglass_kind kind, bool fibred, cuda_way way)
{
    return fibred ? kind == HOURGLASS_PHYSICAL && (cuda_own_fibred_ways(which) & way) != 0
                  : (cuda_own_ways(which) & way) != 0;
}

/* What a model's steps depend on, of which kernels are compiled for some. */
typedef struct cuda_wants {
    form which; /* of energy */
    hourglass_kind control;
    bool fibred; /* the kernels with fibres */
} cuda_wants;

/* Calls f with what a form that steppers know, and the kind, take in a way: tled_problem_make chooses no other. */
template <cuda_way WAY, hourglass_kind K, bool FIBRED, class F> static auto with_form(form which, F f)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        return f(typename cuda_form_taken<cuda_is_own(FORM_##NAME, K, FIBRED, WAY), FIBRED, FORM_##NAME, coefficients, \
                                          (coefficients) - (exponents), K>::type(which, K));
    switch (which) {
        FORMS(FORM_ROW)
    default:
        __builtin_unreachable(); /* the choice of executors refuses others */
    }
#undef FORM_ROW
}

template <cuda_way WAY, class F> static auto with_stepper(cuda_wants w, F f)
{
    if (w.control == HOURGLASS_ISOTROPIC)
        return w.fibred ? with_form<WAY, HOURGLASS_ISOTROPIC, true>(w.which, f)
                        : with_form<WAY, HOURGLASS_ISOTROPIC, false>(w.which, f);
    return w.fibred ? with_form<WAY, HOURGLASS_PHYSICAL, true>(w.which, f)
                    : with_form<WAY, HOURGLASS_PHYSICAL, false>(w.which, f);
}

/* What a tile's kernel is compiled for: cells mixed of two volumes, and listed tiles. Models without them have kernels
 * that do without. */
template <bool M, bool N> struct cuda_tiles {
    static constexpr bool MIXED = M, LISTED = N, ASKS = false;
};

/* Or both of them, where there are any. */
struct cuda_any_tiles {
    static constexpr bool MIXED = true, LISTED = true, ASKS = true;
};

/* Calls f with what a model needs, as a type, of kernels that are compiled for the form L. */
template <class L, class F> static auto with_tiles(bool mixed, bool listed, F f)
{
    if constexpr (L::ASKS || L::FIBRED)
        return f(cuda_any_tiles());
    else if (listed)
        return mixed ? f(cuda_tiles<true, true>()) : f(cuda_tiles<false, true>());
    else
        return mixed ? f(cuda_tiles<true, false>()) : f(cuda_tiles<false, false>());
}

#endif
