/* Which kernels there are, by form of law, hourglass control and what tiles may have, and the choice among them. A
 * kernel that is compiled for one of each is the fastest; but for each size of bricks, way and precision a form then
 * takes four kernels for each kind of control. So a form has kernels of its own in the ways that a table says. In all
 * others it runs in the kernels of any form, one for each size, way and precision, whose threads branch alike by what
 * they are told. Both give the same bytes. Models with fibres that resist being stretched, or with muscles that have
 * curves of their own, run in kernels with fibres, of which there are as many again: of any form, and, under physical
 * control, of those forms that a second table names. Models with elements that are cut (element_cut.h) have kernels
 * that look for these: under physical control without fibres, those of forms that a third table names; for all else, of
 * any form, with fibres. Included by cuda_view.cuh alone.
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

/* Likewise, of kernels for cut elements without fibres. */
#ifndef CUDA_OWN_CUT
#define CUDA_OWN_CUT(X) X(NEO_HOOKEAN, CUDA_TILES | CUDA_RESIDENT)
#endif

/* The ways in which a form has kernels of its own, without fibres, with them, and for cut elements. */
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

static constexpr int cuda_own_cut_ways(form which)
{
    CUDA_OWN_CUT(OWN_ROW)
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
    static constexpr bool ASKS = false, FIBRED = false, CUT = false;
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
    static constexpr bool ASKS = true, FIBRED = false, CUT = false;
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

/* One of these, for cut elements. */
template <class L> struct cuda_cut : L {
    static constexpr bool CUT = true;
    cuda_cut(form f, hourglass_kind k) : L(f, k)
    {
    }
};

/* What of a model's elements kernels are compiled for, beside laws: none has more than a law and an active muscle; some
 * have fibres that resist being stretched or muscles with curves of their own; some are cut; both. */
typedef enum cuda_elements { CUDA_USUAL, CUDA_FIBRED, CUDA_CUT, CUDA_CUT_FIBRED } cuda_elements;

/* The one that a form takes in a way. */
template <bool OWN, cuda_elements E, form F, int N, int M, hourglass_kind K> struct cuda_form_taken {
    typedef cuda_form<F, N, M, K> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, CUDA_USUAL, F, N, M, K> {
    typedef cuda_any_form type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<true, CUDA_FIBRED, F, N, M, K> {
    typedef cuda_fibred<cuda_form<F, N, M, K>> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, CUDA_FIBRED, F, N, M, K> {
    typedef cuda_fibred<cuda_any_form> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<true, CUDA_CUT, F, N, M, K> {
    typedef cuda_cut<cuda_form<F, N, M, K>> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, CUDA_CUT, F, N, M, K> {
    typedef cuda_cut<cuda_fibred<cuda_any_form>> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, CUDA_CUT_FIBRED, F, N, M, K> {
    typedef cuda_cut<cuda_fibred<cuda_any_form>> type;
};

/* Whether it has kernels of its own there. */
static constexpr bool cuda_is_own(form which, hourglass_kind kind, cuda_elements elements, cuda_way way)
{
    if (elements == CUDA_USUAL)
        return (cuda_own_ways(which) & way) != 0;
    if (kind != HOURGLASS_PHYSICAL || elements == CUDA_CUT_FIBRED)
        return false;
    return ((elements == CUDA_FIBRED ? cuda_own_fibred_ways(which) : cuda_own_cut_ways(which)) & way) != 0;
}

/* What a model's steps depend on, of which kernels are compiled for some. */
typedef struct cuda_wants {
    form which; /* of energy */
    hourglass_kind control;
    cuda_elements elements;
} cuda_wants;

/* Calls f with what a form that steppers know, and the kind, take in a way: tled_problem_make chooses no other. */
template <cuda_way WAY, hourglass_kind K, cuda_elements E, class F> static auto with_form(form which, F f)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        return f(typename cuda_form_taken<cuda_is_own(FORM_##NAME, K, E, WAY), E, FORM_##NAME, coefficients,           \
                                          (coefficients) - (exponents), K>::type(which, K));
    switch (which) {
        FORMS(FORM_ROW)
    default:
        __builtin_unreachable(); /* the choice of executors refuses others */
    }
#undef FORM_ROW
}

template <cuda_way WAY, hourglass_kind K, class F> static auto with_elements(cuda_wants w, F f)
{
    switch (w.elements) {
    case CUDA_USUAL:
        return with_form<WAY, K, CUDA_USUAL>(w.which, f);
    case CUDA_FIBRED:
        return with_form<WAY, K, CUDA_FIBRED>(w.which, f);
    case CUDA_CUT:
        return with_form<WAY, K, CUDA_CUT>(w.which, f);
    default:
        return with_form<WAY, K, CUDA_CUT_FIBRED>(w.which, f);
    }
}

template <cuda_way WAY, class F> static auto with_stepper(cuda_wants w, F f)
{
    return w.control == HOURGLASS_ISOTROPIC ? with_elements<WAY, HOURGLASS_ISOTROPIC>(w, f)
                                            : with_elements<WAY, HOURGLASS_PHYSICAL>(w, f);
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
    if constexpr (L::ASKS || L::FIBRED || L::CUT)
        return f(cuda_any_tiles());
    else if (listed)
        return mixed ? f(cuda_tiles<true, true>()) : f(cuda_tiles<false, true>());
    else
        return mixed ? f(cuda_tiles<true, false>()) : f(cuda_tiles<false, false>());
}

#endif
