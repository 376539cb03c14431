/* Trials of nodes that slide on bone (tled/contact/sliding.h), of skin that touches itself
 * (tled/contact/self_contact.h), and of a probe (tled/problem/collider.h), on a card that the processor plays. Included
 * by test_tled_emulated.c.
 */
#ifndef SINEW_TLED_TRIAL_CONTACT_H
#define SINEW_TLED_TRIAL_CONTACT_H

#include "tled/cuda/cuda.h"
#include "tled_trial.h"

/* Checks that the two answers differ by more than `least`, and frees both. */
static inline void test_matters(answer *without, answer *with, double least, const char *what)
{
    const double apart = off(with, without);
    ok(apart > least && apart < INFINITY, "%s: %.2g %s", what, apart, with->b.e.text);
    answer_free(with);
    answer_free(without);
}

/* The CPU's bytes in bricks, which are not those that stay, as these take no step between passes; nearly, where it
 * marches, with slits and cut elements too; and looks. */
static inline void test_sliding(int64_t steps)
{
    const trial moved = {"sliding on a bone that moves", lump, 0, true, {0}, false};
    const trial muscles = {"a muscle that slides", mixed_of(small), .5, false, {0}, false};
    const trial rests = {"sliding, to rest", lump, 0, true, {0}, true};
    answer with, without;
    find(&without, &moved, &tled_cpu_double, steps);
    in_sliding = true;
    find(&with, &moved, &tled_cpu_double, steps);
    test_matters(&without, &with, 1e-4, "sliding matters");
    try(&moved, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
    try(&moved, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    try(&rests, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
    try(&muscles, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try_marched(&muscles, steps);
    in_slit = &slits[3];
    try(&moved, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    in_slit = NULL;
    in_cuts = true;
    try(&moved, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    in_cuts = false;
    put_in(&plain, 4, 4);
    in_bent = true;
    test_look(&lump, true, steps, &tled_cuda_single, "a look at nodes that slide", 1e-6);
    put_in(&marching, 3, 2);
    test_look(&lump, true, steps, &tled_cuda_single, "a look at them where it marches", 1e-6);
    in_bent = false;
    in_sliding = false;
}

/* A probe: in bricks and where it marches, nearly the CPU's numbers, as sums are others; beside nodes that slide too.
 */
static inline void test_pressing(int64_t steps)
{
    const probe ball = probe_sphere(.02), array = probe_linear(.03, .012, .003);
    const trial pressed = {"a probe, a script", lump, 0, true, {0}, false};
    const trial muscles = {"a probe on a muscle", mixed_of(small), .5, false, {0}, false};
    const trial rests = {"a probe, to rest", lump, 0, true, {0}, true};
    answer with, without;
    find(&without, &pressed, &tled_cpu_double, steps);
    in_pressing = &ball;
    find(&with, &pressed, &tled_cpu_double, steps);
    test_matters(&without, &with, 1e-4, "a probe matters");
    try(&pressed, &plain, &tled_cuda_double, &tled_cpu_double, steps, 1e-13);
    try(&rests, &staying, &tled_cuda_single, &tled_cpu_single, steps, 1e-5);
    try(&pressed, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try_marched(&pressed, steps);
    in_pressing = &array;
    try(&muscles, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    in_sliding = true;
    try(&pressed, &plain, &tled_cuda_double, &tled_cpu_double, steps, 1e-13);
    in_sliding = false;
    put_in(&plain, 4, 4);
    in_bent = true;
    test_look(&lump, true, steps, &tled_cuda_single, "a look at what a probe presses", 1e-6);
    in_bent = false;
    in_pressing = NULL;
}

/* Skin on skin, and on a bone that moves: nearly the CPU's numbers, as sums are others; the same by other lots, and by
 * more or fewer blocks. */
static inline void test_touching(int64_t steps)
{
    const touching plainly = {.2, false, false}, blended = {0, true, true}, all = {.3, true, true};
    const trial closed = {"a slit that is closed", lump, 0, false, {7, 5, 6}, false};
    const trial moved = {"a slit, and a bone that moves", lump, 0, true, {0}, false};
    const trial rests = {"skin on skin and bone, that rubs", lump, 0, false, {7, 5, 6}, true};
    answer with, without;
    in_slit = &slits[2];
    find(&without, &closed, &tled_cpu_double, steps);
    in_touching = &plainly;
    find(&with, &closed, &tled_cpu_double, steps);
    test_matters(&without, &with, 1e-3, "skin matters");
    try(&closed, &plain, &tled_cuda_double, &tled_cpu_double, steps, 1e-9);
    try(&closed, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try(&closed, &marching, &tled_cuda_double, &tled_cpu_double, steps, 1e-9);
    in_touching = &blended;
    try(&moved, &staying, &tled_cuda_double, &tled_cpu_double, 1, 1e-9);
    in_touching = &all;
    try(&rests, &staying, &tled_cuda_single, &tled_cpu_single, steps, 1e-5);
    in_sliding = true;
    try(&moved, &plain, &tled_cuda_double, &tled_cpu_double, 1, 1e-9);
    in_sliding = false;
    in_touching = NULL;
    in_slit = NULL;
}

#endif
