/* Trials of elements that are cut (tled/problem/cut.h) on a card that the processor plays. Included by
 * test_tled_emulated.c.
 */
#ifndef SINEW_TLED_TRIAL_CUTS_H
#define SINEW_TLED_TRIAL_CUTS_H

#include "tled/cuda/cuda.h"
#include "tled_trial.h"

/* Elements that are cut: the CPU's bytes in bricks and in bricks that stay, of the form that has kernels of its own, of
 * others, with fibres, mixed, and under isotropic control, which no march has for them. */
static inline void test_cuts_in_bricks(int64_t steps)
{
    const block mixed = mixed_of(muscle);
    const struct {
        form of;
        const block_fibres *fibres;
        trial what;
    } all[] = {{FORM_NEO_HOOKEAN, NULL, {"cut, a script, in bricks", lump, 0, true, {0}, false}},
               {FORM_NEO_HOOKEAN, NULL, {"cut and mixed muscles, in bricks", mixed, .5, false, {0}, false}},
               {FORM_FIRST, NULL, {"cut, of another form, in bricks", mixed_of(lump), 0, true, {0}, false}},
               {FORM_NEO_HOOKEAN, &all_fibres, {"cut and fibred, in bricks", mixed, .5, false, {0}, false}},
               {FORM_NEO_HOOKEAN, &serial_fibres, {"cut, with springs, in bricks", mixed, .5, false, {0}, false}}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        in_form = all[i].of;
        in_fibres = all[i].fibres;
        try(&all[i].what, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
        try(&all[i].what, &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
        if (all_of_it || i % 2)
            try(&all[i].what, &plain, &tled_cuda_double, &tled_cpu_double, steps, 0);
        if (all_of_it || i % 2 == 0)
            try(&all[i].what, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    }
    in_form = FORM_NEO_HOOKEAN;
    in_fibres = NULL;
    in_control = ISOTROPIC(.0075);
    try(&all[1].what, &marching, &tled_cuda_single, &tled_cpu_single, steps, 0);
    in_control = PHYSICAL;
    in_slit = &slits[5];
    const trial parted = {"cut and parted, in bricks", mixed_of(lump), 0, true, {0}, false};
    try(&parted, &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
    in_slit = NULL;
}

/* Likewise where it marches. */
static inline void test_cuts_marched(int64_t steps)
{
    static const struct {
        form of;
        const block_fibres *fibres;
    } all[] = {{FORM_NEO_HOOKEAN, NULL},
               {FORM_MOONEY_RIVLIN, NULL},
               {FORM_FIRST, NULL},
               {FORM_NEO_HOOKEAN, &hgo_fibres},
               {FORM_NEO_HOOKEAN, &two_families}};
    const trial scripted = {"cut, a script, marched", lump, 0, true, {0}, false};
    const trial muscles = {"cut and mixed muscles, marched", mixed_of(small), .5, false, {0}, false};
    const trial alone = {"cut, a law, marched", small, .5, false, {0}, false};
    try(&scripted, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try(&muscles, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try_marched(&scripted, steps);
    try_marched(&muscles, steps);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        in_form = all[i].of;
        in_fibres = all[i].fibres;
        printf("# form %d, %s\n", (int)in_form, in_fibres ? in_fibres->name : "no fibres");
        in_slit = i % 2 ? &slits[3] : NULL;
        try(&alone, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        if (!in_fibres && (all_of_it || i))
            try_marched(&alone, steps);
    }
    in_slit = &slits[3];
    in_form = FORM_NEO_HOOKEAN;
    in_fibres = NULL;
    try(&scripted, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    in_slit = NULL;
}

/* And looks, and that the cuts matter to what is tried. */
static inline void test_cuts(int64_t steps)
{
    const trial moved = {"cut", lump, 0, true, {0}, false};
    answer with, without;
    in_cuts = true;
    find(&with, &moved, &tled_cpu_double, steps);
    in_cuts = false;
    find(&without, &moved, &tled_cpu_double, steps);
    ok(off(&with, &without) > 1e-4 && off(&with, &without) < INFINITY, "cuts matter: %.2g %s", off(&with, &without),
       with.b.e.text);
    answer_free(&with);
    answer_free(&without);
    in_cuts = true;
    test_cuts_in_bricks(steps);
    test_cuts_marched(2 * steps);
    put_in(&plain, 4, 4);
    in_bent = true;
    test_look(&lump, true, steps, &tled_cuda_single, "a look at cut elements", 1e-6);
    ok(bench_look_at_rest(&lump, &tled_cuda_single) == 1, "a look at rest finds the stable step of cut elements there");
    const block mixed = mixed_of(muscle);
    test_look(&mixed, false, steps, &tled_cuda_double, "a look at cut and mixed muscles", 1e-10);
    in_fibres = &all_fibres;
    test_look(&mixed, false, steps, &tled_cuda_double, "a look at cut elements with fibres", 1e-10);
    in_fibres = NULL;
    put_in(&marching, 3, 2);
    test_look(&small, false, steps, &tled_cuda_single, "a look at cut elements where it marches", 1e-6);
    in_bent = false;
    in_cuts = false;
}

#endif
