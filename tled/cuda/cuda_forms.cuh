/* Which kernels there are, by form of law, hourglass control and what tiles may have, and the choice among them. A
 * kernel that is compiled for one of each is the fastest; but for each size of bricks, way and precision a form then
 * takes four kernels for each kind of control. So a form has kernels of its own in the ways that a table says. In all
 * others it runs in the kernels of any form, one for each size, way and precision, whose threads branch alike by what
 * they are told. Both give the same bytes. Included by cuda_view.cuh alone.
 */
#ifndef SINEW_CUDA_FORMS_CUH
#define SINEW_CUDA_FORMS_CUH

#include <stdint.h>

extern "C" {
#include "physics/forms.h"
#include "physics/hourglass_numbers.h"
}

/* The ways in which a card takes steps, as bits. */
enum cuda_way { CUDA_TILES = 1, CUDA_RESIDENT = 2, CUDA_MARCH = 4 };

/* X(NAME, ways): the forms that have kernels of their own, and in which ways. The march has no others. A form that is
 * not here costs no kernel. */
#ifndef CUDA_OWN
#define CUDA_OWN(X)                                                                                                    \
    X(NEO_HOOKEAN, CUDA_TILES | CUDA_RESIDENT | CUDA_MARCH)                                                            \
    X(MOONEY_RIVLIN, CUDA_TILES | CUDA_RESIDENT)                                                                       \
    X(FIRST, CUDA_TILES | CUDA_RESIDENT)
#endif

/* The ways in which a form has kernels of its own. */
static constexpr int cuda_own_ways(form which)
{
#define OWN_ROW(NAME, ways)                                                                                            \
    if (which == FORM_##NAME)                                                                                          \
        return ways;
    CUDA_OWN(OWN_ROW)
#undef OWN_ROW
    return 0;
}

/* The forms that have kernels of their own in a way: bit i for form i. */
static constexpr uint32_t cuda_own_forms(cuda_way way)
{
    uint32_t forms = 0;
    for (int f = 0; f < FORM_STEPPED; f++)
        forms |= cuda_own_ways((form)f) & way ? 1u << f : 0;
    return forms;
}

enum { LAWS_NEAR = 16 /* volumes whose laws stand in shared memory */ };

/* What of a law holds hourglass modes. */
static constexpr int cuda_held(hourglass_kind kind)
{
    return kind == HOURGLASS_ISOTROPIC ? 1 : (int)HOURGLASS_NUMBERS;
}

/* What a kernel is compiled for: a form and a kind of hourglass control. A law's numbers are its coefficients, then
 * those that hold hourglass modes; NEAR: numbers that all threads of a block ask for, gravity and laws. */
template <form F, int N, int M, hourglass_kind K> struct cuda_form {
    static constexpr bool ASKS = false;
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
    static constexpr bool ASKS = true;
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

/* The one of both that a form takes in a way. */
template <bool OWN, form F, int N, int M, hourglass_kind K> struct cuda_form_taken {
    typedef cuda_form<F, N, M, K> type;
};
template <form F, int N, int M, hourglass_kind K> struct cuda_form_taken<false, F, N, M, K> {
    typedef cuda_any_form type;
};

/* Calls f with what a form that steppers know, and the kind, take in a way: tled_problem_make chooses no other. */
template <cuda_way WAY, hourglass_kind K, class F> static auto with_form(form which, F f)
{
#define FORM_ROW(NAME, name, coefficients, exponents, history)                                                         \
    case FORM_##NAME:                                                                                                  \
        return f(typename cuda_form_taken<(cuda_own_ways(FORM_##NAME) & WAY) != 0, FORM_##NAME, coefficients,          \
                                          (coefficients) - (exponents), K>::type(which, K));
    switch (which) {
        FORMS(FORM_ROW)
    default:
        __builtin_unreachable(); /* the choice of executors refuses others */
    }
#undef FORM_ROW
}

template <cuda_way WAY, class F> static auto with_stepper(form which, hourglass_kind kind, F f)
{
    return kind == HOURGLASS_ISOTROPIC ? with_form<WAY, HOURGLASS_ISOTROPIC>(which, f)
                                       : with_form<WAY, HOURGLASS_PHYSICAL>(which, f);
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
    if constexpr (L::ASKS)
        return f(cuda_any_tiles());
    else if (listed)
        return mixed ? f(cuda_tiles<true, true>()) : f(cuda_tiles<false, true>());
    else
        return mixed ? f(cuda_tiles<true, false>()) : f(cuda_tiles<false, false>());
}

#endif
