/* The CUDA executors against the CPU's: the same bytes in the same precision where the steps are the same (where it
 * marches 1e-5 of the largest displacement off double in single precision, 1e-12 in double), 1e-4 of the largest
 * displacement between single precision there and double here over 10,000 steps and at rest, the same looks, the same
 * messages. Without a card all is skipped.
 */
// needs: tled/cuda/march.c tled/cuda/march_units.c tled/cuda/march_near.c tled/cuda/march_tips.c
// needs: tled/cuda/march_cells.c tled/tiles/lattice_sheet.c tled/tiles/places.c  tled/*/*.c
#include "tled_card_runs.h"
#include "tled_live_trial.h"

#ifdef SINEW_CUDA
#include "solve/card.h"
#endif

static const block middle = {{40, 40, 24}, {.001, .001, .001}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 1, 0}, 0, false};
static const block large = {{80, 80, 64}, {.001, .001, .001}, 3000, .49, 1000, 30000, 2, 1, 0, {0, 1, 0}, 0, false};

/* Slits of these: a half one, one across it, and in the large one, one through cells. */
static const slit middle_slits = {
    "slits", {{0, 17, {0, 0}, {25, 24}, false, false}, {2, 11, {5, 10}, {30, 30}, false, false}}, false};
static const slit large_slits = {"slits",
                                 {{0, 37, {0, 0}, {45, 64}, false, false},
                                  {2, 31, {5, 10}, {60, 70}, false, false},
                                  {1, 20, {0, 50}, {30, 70}, true, true}},
                                 false};

/* Slits where it marches, with and without special cells. */
static void test_slits_marched(const tled_executor *cuda)
{
    block cut = large;
    cut.fraction = -1;
    cut.mixed = true;
    in_slit = &large_slits;
    test_marched(&large, .2, false, 60, cuda, "slits, a muscle");
    test_marched(&marched, 0, true, 60, cuda, "slits, a script");
    test_marched(&cut, .5, false, 60, cuda, "slits, elements mixed of two muscles");
    in_control = ISOTROPIC(.0075);
    test_marched(&cut, .5, false, 60, cuda, "slits, isotropic control");
    in_control = PHYSICAL;
    test_look(&large, false, 60, cuda, "slits, single, many bricks", 1e-6);
    in_slit = NULL;
}

/* The march of the form and the fibres that are set: without a muscle, with one, of cut elements, and of slits with
 * tips. */
static void test_marched_as(const tled_executor *cuda, const char *name)
{
    block plain = small, few = small, cut = large;
    char what[80];
    few.fraction = cut.fraction = -1;
    plain.fibre[1] = 0;
    snprintf(what, sizeof what, "%s, a few elements without a muscle", name);
    test_marched_small(&plain, 300, cuda, what);
    snprintf(what, sizeof what, "%s, a few elements", name);
    test_marched_small(&few, 300, cuda, what);
    snprintf(what, sizeof what, "%s, a muscle", name);
    test_marched(&large, .2, false, 60, cuda, what);
    snprintf(what, sizeof what, "%s, cut elements", name);
    test_marched(&cut, .5, false, 60, cuda, what);
    in_slit = &large_slits;
    snprintf(what, sizeof what, "%s, cut elements and slits", name);
    test_marched(&cut, .5, false, 60, cuda, what);
    in_slit = NULL;
}

/* Laws beside the neo-Hookean, and fibres. */
static void test_laws_marched(const tled_executor *cuda)
{
    static const block_fibres *const all[] = {&quadratic_fibres, &hgo_fibres, &two_families, NULL};
    block mixed = large;
    mixed.mixed = true;
    in_form = FORM_MOONEY_RIVLIN;
    test_marched_as(cuda, "mooney-rivlin");
    test_marched(&mixed, .5, false, 60, cuda, "mooney-rivlin, elements mixed of two muscles");
    in_form = FORM_FIRST;
    test_marched_as(cuda, "first");
    test_marched(&mixed, .5, false, 60, cuda, "first, elements mixed of two muscles");
    in_form = FORM_NEO_HOOKEAN;
    for (size_t i = 0; all[i]; i++) {
        in_fibres = all[i];
        test_marched_as(cuda, all[i]->name);
    }
    in_fibres = NULL;
}

/* Elements whose strain is its mean over their part. */
static void test_cuts_marched(const tled_executor *cuda)
{
    block few = small, mixed = large, scripted = marched;
    few.mixed = mixed.mixed = scripted.mixed = true;
    in_cuts = true;
    test_marched_small(&few, 300, cuda, "mean strain, a few mixed elements");
    test_marched(&large, .2, false, 60, cuda, "mean strain, a muscle");
    test_marched(&marched, 0, true, 60, cuda, "mean strain, a script");
    test_marched(&scripted, 0, true, 60, cuda, "mean strain, mixed elements, a script");
    in_slit = &large_slits;
    test_marched(&mixed, .5, false, 60, cuda, "mean strain, elements mixed of two muscles, slits");
    in_slit = NULL;
    in_form = FORM_MOONEY_RIVLIN;
    test_marched_as(cuda, "mean strain, mooney-rivlin");
    in_form = FORM_FIRST;
    test_marched_as(cuda, "mean strain, first");
    in_form = FORM_NEO_HOOKEAN;
    in_fibres = &hgo_fibres;
    test_marched_as(cuda, "mean strain, hgo fibres");
    in_fibres = &two_families;
    test_marched_as(cuda, "mean strain, two families");
    in_fibres = NULL;
    test_look(&large, false, 60, cuda, "mean strain, single, many bricks", 1e-6);
    in_cuts = false;
}

static void test_all_marched(const tled_executor *cuda)
{
    bench b;
    make(&b, &large, .2, false, cuda, 0);
    const bool marches = is_march(&b, computed(&b, cuda));
    bench_free(&b);
    if (!marches) {
        skip(1, "this card has no march");
        return;
    }
    block few = small;
    test_marched_small(&few, 300, cuda, "a few elements");
    few.fraction = -1;
    few.mixed = true;
    test_marched_small(&few, 300, cuda, "a few elements, cut and mixed");
    in_control = ISOTROPIC(.0075);
    test_marched_small(&few, 300, cuda, "isotropic control, a few elements, cut and mixed");
    in_control = PHYSICAL;
    test_marched(&large, .2, false, 60, cuda, "a muscle");
    test_marched(&marched, 0, true, 60, cuda, "a script");
    block cut = large;
    cut.fraction = -1;
    test_marched(&cut, .5, false, 60, cuda, "cut elements");
    cut.mixed = true;
    test_marched(&cut, .5, false, 60, cuda, "elements mixed of two muscles");
    cut = marched;
    cut.mixed = true;
    test_marched(&cut, 0, true, 60, cuda, "mixed elements, a script");
    test_slits_marched(cuda);
    test_laws_marched(cuda);
    test_cuts_marched(cuda);
}

/* Other forms, on the card, where none marches. */
static void test_forms_bytes(const tled_executor *cpu, const tled_executor *cuda, const char *name)
{
    char what[80];
    block mixed = muscle;
    mixed.mixed = true;
    for (int f = 0; f < FORM_STEPPED; f++) {
        if (f == FORM_NEO_HOOKEAN)
            continue;
        in_form = (form)f;
        snprintf(what, sizeof what, "%s, form %d, a script", name, f);
        test_bytes(&lump, 0, true, 1000, cpu, cuda, what);
        snprintf(what, sizeof what, "%s, form %d, mixed elements", name, f);
        test_bytes(&mixed, .5, false, 1000, cpu, cuda, what);
    }
    in_form = FORM_NEO_HOOKEAN;
}

/* Fibres that act by themselves: the CPU's bytes in bricks, small and many, also where slits are. */
static void test_fibres_bytes(const tled_executor *cpu, const tled_executor *cuda, const char *name)
{
    static const block_fibres *const all[] = {&quadratic_fibres, &hgo_fibres,    &two_families,
                                              &passive_muscles,  &all_fibres,    &fung_tissue,
                                              &serial_muscles,   &serial_fibres, NULL};
    char what[120];
    block mixed = muscle, cut = lump;
    mixed.mixed = cut.mixed = true;
    mixed.fraction = cut.fraction = -1;
    for (size_t i = 0; all[i]; i++) {
        in_fibres = all[i];
        snprintf(what, sizeof what, "%s, %s, a muscle", name, all[i]->name);
        test_bytes(&muscle, .5, false, 1000, cpu, cuda, what);
        snprintf(what, sizeof what, "%s, %s, mixed muscles", name, all[i]->name);
        test_bytes(&mixed, .5, false, 1000, cpu, cuda, what);
    }
    in_fibres = &two_families;
    snprintf(what, sizeof what, "%s, two families, more bricks", name);
    test_bytes(&middle, .2, false, 60, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, two families, many bricks", name);
    if (cpu == &tled_cpu_double)
        test_bytes(&large, .2, false, 20, cpu, cuda, what);
    in_slit = &slits[5];
    snprintf(what, sizeof what, "%s, two families, slits, a script", name);
    test_bytes(&cut, 0, true, 1000, cpu, cuda, what);
    in_slit = NULL;
    in_form = FORM_MOONEY_RIVLIN;
    snprintf(what, sizeof what, "%s, two families of another form, a script", name);
    test_bytes(&cut, 0, true, 1000, cpu, cuda, what);
    in_form = FORM_NEO_HOOKEAN;
    in_fibres = NULL;
}

static void test_fibres_looks(const tled_executor *twice, const tled_executor *once)
{
    block mixed = muscle;
    mixed.mixed = true;
    in_bent = true;
    in_fibres = &hgo_fibres;
    test_look(&lump, true, 300, once, "single, hgo fibres, a script", 1e-6);
    in_fibres = &fung_tissue;
    test_look(&lump, true, 300, twice, "double, fung, a script", 1e-10);
    test_look(&large, false, 300, once, "single, hgo fibres, many bricks", 1e-6);
    in_fibres = &all_fibres;
    test_look(&mixed, false, 300, twice, "double, passive muscles with two families", 1e-10);
    in_fibres = &serial_fibres;
    test_look(&mixed, false, 300, twice, "double, muscles in series with springs", 1e-10);
    in_fibres = &two_families;
    test_look(&middle, false, 300, twice, "double, two families, more bricks", 1e-10);
    in_fibres = NULL;
    in_bent = false;
}

/* Elements whose strain is its mean over their part: the CPU's bytes in bricks, small and many, of the form that has
 * kernels of its own for them, of others, with fibres, under isotropic control and where slits are. */
static void test_cuts_bytes(const tled_executor *cpu, const tled_executor *cuda, const char *name)
{
    char what[120];
    block mixed = muscle, scripted = lump;
    mixed.mixed = scripted.mixed = true;
    in_cuts = true;
    snprintf(what, sizeof what, "%s, mean strain, a script", name);
    test_bytes(&lump, 0, true, 1000, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, mean strain, mixed muscles", name);
    test_bytes(&mixed, .5, false, 1000, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, mean strain, more bricks", name);
    test_bytes(&middle, .2, false, 60, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, mean strain, many bricks", name);
    if (cpu == &tled_cpu_double)
        test_marched_double(&large, .2, 30, cuda, what);
    in_slit = &slits[5];
    snprintf(what, sizeof what, "%s, mean strain, slits, a script", name);
    test_bytes(&scripted, 0, true, 1000, cpu, cuda, what);
    in_slit = NULL;
    in_form = FORM_FIRST;
    snprintf(what, sizeof what, "%s, mean strain of another form, a script", name);
    test_bytes(&scripted, 0, true, 1000, cpu, cuda, what);
    in_form = FORM_NEO_HOOKEAN;
    in_control = ISOTROPIC(.0075);
    snprintf(what, sizeof what, "%s, mean strain, isotropic, a script", name);
    test_bytes(&scripted, 0, true, 1000, cpu, cuda, what);
    in_control = PHYSICAL;
    in_fibres = &all_fibres;
    snprintf(what, sizeof what, "%s, mean strain, mixed muscles with fibres", name);
    test_bytes(&mixed, .5, false, 1000, cpu, cuda, what);
    in_fibres = &serial_fibres;
    snprintf(what, sizeof what, "%s, mean strain, mixed muscles with springs", name);
    test_bytes(&mixed, .5, false, 1000, cpu, cuda, what);
    in_fibres = NULL;
    in_cuts = false;
}

static void test_cuts_looks(const tled_executor *twice, const tled_executor *once)
{
    block mixed = muscle;
    mixed.mixed = true;
    in_cuts = in_bent = true;
    test_look(&lump, true, 300, twice, "double, mean strain, a script", 1e-10);
    test_look(&middle, false, 300, once, "single, mean strain, more bricks", 1e-6);
    in_fibres = &all_fibres;
    test_look(&mixed, false, 300, twice, "double, mean strain, mixed muscles with fibres", 1e-10);
    in_fibres = NULL;
    ok(bench_look_at_rest(&lump, once) == 1 && bench_look_at_rest(&lump, twice) == 1,
       "a look at rest finds the stable step of cut elements there");
    in_cuts = in_bent = false;
}

/* Slits: the CPU's bytes in bricks, but of so many elements that they march. */
static void test_slits_bytes(const tled_executor *cpu, const tled_executor *cuda, const char *name)
{
    char what[120];
    for (int i = 0; i < SLITS; i++) {
        block cut = lump;
        cut.fraction = i % 2 ? -1 : 0;
        cut.mixed = i % 2;
        if (slits[i].thin) /* what the script names is not there: a muscle moves it */
            cut.cells[1] = 1, cut.fibre[0] = 1;
        in_slit = &slits[i];
        snprintf(what, sizeof what, "%s, %s", name, slits[i].name);
        test_bytes(&cut, slits[i].thin ? .5 : 0, !slits[i].thin, 1000, cpu, cuda, what);
    }
    in_slit = &middle_slits;
    snprintf(what, sizeof what, "%s, slits, more bricks", name);
    test_bytes(&middle, .2, false, 60, cpu, cuda, what);
    in_slit = &large_slits;
    snprintf(what, sizeof what, "%s, slits, many bricks", name);
    if (cpu == &tled_cpu_double)
        test_marched_double(&large, .2, 20, cuda, what);
    in_slit = NULL;
}

/* Nodes that slide: the CPU's bytes in bricks, and nearly where it marches; and looks. */
static void test_sliding(const tled_executor *twice, const tled_executor *once)
{
    in_sliding = true;
    test_bytes(&lump, 0, true, 1000, &tled_cpu_double, twice, "double, sliding, a script");
    test_bytes(&muscle, .5, false, 1000, &tled_cpu_double, twice, "double, sliding, a muscle");
    test_bytes(&lump, 0, true, 1000, &tled_cpu_double, twice, "double, sliding again");
    test_marched(&marched, 0, true, 60, once, "sliding, a script");
    test_marched(&large, .2, false, 60, once, "sliding, a muscle");
    in_cuts = true;
    test_marched(&large, .2, false, 60, once, "sliding, cut elements");
    in_cuts = false;
    in_bent = true;
    test_look(&lump, true, 300, twice, "double, sliding", 1e-10);
    test_look(&large, false, 60, once, "single, sliding", 1e-6);
    in_bent = in_sliding = false;
}

/* Nearly the numbers of the CPU in double precision: less nearly from step to step, as contacts come and go. */
static void test_near(const tled_executor *cuda, double tolerance, const char *name)
{
    bench here, there;
    make(&here, &lump, 0, true, &tled_cpu_double, 60);
    make(&there, &lump, 0, true, cuda, 60);
    const int gone = bench_go(&here) | bench_go(&there);
    ok(!gone && here.end.reading.largest > 1e-6 && apart(&there, &here) < tolerance, "%s: %.2g mm, %.2g off %s", name,
       1e3 * here.end.reading.largest, apart(&there, &here), there.e.text);
    bench_free(&here);
    bench_free(&there);
}

/* Skin that touches itself and a bone that moves: nearly the CPU's numbers, and the same bytes run after run. */
static void test_touching(const tled_executor *twice, const tled_executor *once)
{
    const touching plainly = {0, false, false}, all = {.3, true, true};
    in_slit = &slits[2];
    in_touching = &plainly;
    test_near(once, 1e-5, "single, skin that touches");
    in_touching = &all;
    test_near(once, 1e-5, "single, skin that rubs on skin and bone");
    test_near(twice, 1e-6, "double, skin that rubs on skin and bone");
    test_bytes(&lump, 0, true, 1000, twice, twice, "double, skin that rubs, run after run");
    test_bytes(&lump, 0, true, 1000, once, once, "single, skin that rubs, run after run");
    in_touching = NULL;
    in_slit = NULL;
    trial_touch(true);
    trial_beside(&trial_touching, trial_touching_lines, &tled_cpu_double, twice, 1e-6,
                 "double, skin and sliding nodes");
    trial_touch(false);
}

/* Isotropic control: the CPU's bytes, and a look. */
static void test_isotropic(const tled_executor *twice, const tled_executor *once)
{
    block mixed = muscle;
    mixed.mixed = true;
    in_control = ISOTROPIC(.0075);
    test_bytes(&lump, 0, true, 1000, &tled_cpu_double, twice, "double, isotropic, a script");
    test_bytes(&mixed, .5, false, 1000, &tled_cpu_single, once, "single, isotropic, mixed elements");
    test_look(&lump, true, 300, twice, "double, isotropic", 1e-10);
    in_control = PHYSICAL;
}

static void test_all_bytes(const tled_executor *cpu, const tled_executor *cuda, const char *name)
{
    char what[80];
    snprintf(what, sizeof what, "%s, a script", name);
    test_bytes(&lump, 0, true, 1000, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, a muscle", name);
    test_bytes(&muscle, .5, false, 1000, cpu, cuda, what);
    block cut = muscle;
    cut.fraction = -1;
    snprintf(what, sizeof what, "%s, cut elements", name);
    test_bytes(&cut, .5, false, 1000, cpu, cuda, what);
    cut.mixed = true;
    snprintf(what, sizeof what, "%s, elements mixed of two muscles", name);
    test_bytes(&cut, .5, false, 1000, cpu, cuda, what);
    cut = lump;
    cut.mixed = true;
    snprintf(what, sizeof what, "%s, mixed elements, a script", name);
    test_bytes(&cut, 0, true, 1000, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, more bricks", name);
    test_bytes(&middle, .2, false, 60, cpu, cuda, what);
    snprintf(what, sizeof what, "%s, many bricks", name);
    if (cpu == &tled_cpu_double)
        test_marched_double(&large, .2, 20, cuda, what);
}

/* By default settings: the step may be cut, at times that differ by what single precision does to the stable step. */
static void test_long(const tled_executor *cuda, const char *name)
{
    bench here, there;
    const double gravity[3] = {1, -2, -9.81};
    bench_make(&here, &muscle, gravity, .6, PHYSICAL, 2);
    bench_make(&there, &muscle, gravity, .6, PHYSICAL, 2);
    bench_steps(&here, 10000, here.setup.damping);
    bench_steps(&there, 10000, here.setup.damping);
    there.setup.device = cuda;
    int gone = bench_go(&here) | bench_go(&there);
    ok(!gone && apart(&there, &here) < 1e-4, "%s: after 10,000 steps %.2g of the largest displacement off %s", name,
       apart(&there, &here), there.e.text);
    bench_free(&here);
    bench_free(&there);
}

static void test_rest(const tled_executor *cuda, const char *name, double tolerance)
{
    bench here, there;
    const double gravity[3] = {0, 0, -9.81};
    bench_make(&here, &lump, gravity, 0, PHYSICAL, 2);
    bench_make(&there, &lump, gravity, 0, PHYSICAL, 2);
    there.setup.device = cuda;
    there.setup.single = &cuda->is == tled_executors_single[0];
    here.setup.rest = there.setup.rest = tolerance;
    int gone = bench_go(&here) | bench_go(&there);
    ok(!gone && there.end.rested && apart(&there, &here) < 2 * tolerance,
       "%s: at rest after %" PRId64 " steps (CPU: %" PRId64 "), %.2g off %s", name, there.end.steps, here.end.steps,
       apart(&there, &here), there.e.text);
    bench_free(&here);
    bench_free(&there);
}

static void test_repeats(const tled_executor *cuda, const char *name)
{
    bench first, b;
    int different = 0, gone = 0;
    make(&first, &muscle, .7, false, cuda, 120);
    gone |= bench_go(&first);
    for (int i = 0; i < 100; i++) {
        make(&b, &muscle, .7, false, cuda, 120);
        gone |= bench_go(&b);
        different += !same(&first, &b);
        bench_free(&b);
    }
    ok(!gone && !different, "%s: 100 repeats, the same bytes", name);
    bench_free(&first);
}

/* From one state, again and again. */
static void test_again(const block *what, const tled_executor *cuda, const char *name)
{
    bench b;
    int different = 0;
    tled_plan plan = {0};
    make(&b, what, .7, false, cuda, 0);
    plan.rate = b.setup.rate;
    const size_t size = 3 * (size_t)b.problem.nodes * sizeof(double);
    double *first = malloc(size), *now = malloc(size);
    tled_state *state = cuda->create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || !first || !now || cuda->step(state, &plan, 100, &b.e) || cuda->save(state, &b.e), &b.e);
    plan.first = 100;
    for (int i = 0; i < 100; i++) {
        bench_must(cuda->step(state, &plan, 20, &b.e) || cuda->get(state, TLED_DISPLACEMENT, now, &b.e), &b.e);
        if (!i)
            memcpy(first, now, size);
        different += memcmp(first, now, size) != 0;
        bench_must(cuda->restore(state, &b.e), &b.e);
    }
    ok(!different && first[0] == first[0], "%s: 100 repeats, the same bytes", name);
    cuda->destroy(state);
    free(first);
    free(now);
    bench_free(&b);
}

/* Diverging here and there: the same step, time and element. */
static void test_diverged(const tled_executor *cpu, const tled_executor *cuda)
{
    bench here, there;
    make(&here, &muscle, 1, false, cpu, 100000);
    make(&there, &muscle, 1, false, cuda, 100000);
    here.setup.rate = there.setup.rate = 1.5 / step_at_rest(&here.problem, NULL);
    int gone = bench_go(&here) & bench_go(&there);
    ok(gone && there.e.status == STATUS_DIVERGED && !strcmp(here.e.text, there.e.text), "diverges as there: %s / %s",
       here.e.text, there.e.text);
    bench_free(&here);
    bench_free(&there);
}

/* The card's memory: with frames, or in a run to rest and with frames, at most so many
 * bytes an element in single precision. */
static void test_memory(const block *what, bool rests, const tled_executor *cuda, double most)
{
    bench b;
    tled_sums sums;
    tled_question question = {.rest = INFINITY, .raise = 1.01, .differences = rests};
    bench_make(&b, what, NULL, 0, PHYSICAL, 2);
    tled_state *state = cuda->create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || cuda->monitor(state, &question, &sums, &b.e), &b.e);
    double each = (double)cuda->bytes(state) / (double)b.problem.elements;
    bench_must(cuda->snapshot(state, 0, &b.e), &b.e);
    double frames = (double)cuda->bytes(state) / (double)b.problem.elements;
    ok(each > 40 && frames >= each && frames <= most, "single%s: %lld elements, %.4g bytes each, %.4g with frames",
       rests ? ", to rest" : "", (long long)b.problem.elements, each, frames);
    cuda->destroy(state);
    bench_free(&b);
}

/* What is said when the card has not the memory, and when a call fails. */
static void test_messages(bool have_card)
{
#ifdef SINEW_CUDA
    err e = {0};
    card_check(2, "cudaFoo(bar)", 1234, &e);
    ok(e.status == STATUS_BAD && !strcmp(e.text, "CUDA: cudaFoo(bar) failed at step 1234: out of memory"), "%s",
       e.text);
    e = (err){0};
    void *none = have_card ? card_take(INT64_C(1) << 50, "the solver of 5 elements", &e) : NULL;
    if (!have_card)
        skip(1, "no card");
    else
        ok(!none && strstr(e.text, "the solver of 5 elements takes 1.126e+06 GB of the card's memory, which has "),
           "%s", e.text);
#else
    (void)have_card;
    skip(2, "built without CUDA");
#endif
}

static void test_steps_bytes(const tled_executor *twice, const tled_executor *once)
{
    test_all_bytes(&tled_cpu_double, twice, "double");
    test_all_bytes(&tled_cpu_single, once, "single");
    test_forms_bytes(&tled_cpu_double, twice, "double");
    test_forms_bytes(&tled_cpu_single, once, "single");
    test_slits_bytes(&tled_cpu_double, twice, "double");
    test_slits_bytes(&tled_cpu_single, once, "single");
    test_fibres_bytes(&tled_cpu_double, twice, "double");
    test_fibres_bytes(&tled_cpu_single, once, "single");
    test_fibres_looks(twice, once);
    test_cuts_bytes(&tled_cpu_double, twice, "double");
    test_cuts_bytes(&tled_cpu_single, once, "single");
    test_cuts_looks(twice, once);
    test_all_marched(once);
    test_isotropic(twice, once);
}

static void test_contact(const tled_executor *twice, const tled_executor *once)
{
    test_sliding(twice, once);
    test_touching(twice, once);
}

static void test_runs(const tled_executor *twice, const tled_executor *once)
{
    test_long(twice, "double");
    test_long(once, "single");
    test_rest(twice, "double", 1e-5);
    test_rest(once, "single", 1e-3);
    test_repeats(twice, "double");
    test_repeats(once, "single");
    test_again(&large, once, "single, marched");
    ok(bench_look_at_rest(&lump, once) == 1 && bench_look_at_rest(&lump, twice) == 1,
       "a look at rest, with unlike sides, finds the stable step at rest");
    test_look(&lump, true, 300, twice, "double, a script", 1e-10);
    test_look(&muscle, false, 300, twice, "double, a muscle", 1e-10);
    test_look(&muscle, false, 300, once, "single, a muscle", 1e-6);
    block cut = muscle;
    cut.fraction = -1;
    test_look(&cut, false, 300, twice, "double, cut elements", 1e-10);
    cut.mixed = true;
    test_look(&cut, false, 300, twice, "double, mixed elements", 1e-10);
    test_look(&cut, false, 300, once, "single, mixed elements", 1e-6);
    in_slit = &middle_slits;
    test_look(&middle, false, 300, twice, "slits, double, more bricks", 1e-10);
    in_slit = NULL;
    test_look(&middle, false, 300, twice, "double, more bricks", 1e-10);
    test_look(&middle, false, 300, once, "single, more bricks", 1e-6);
    test_look(&large, false, 300, once, "single, many bricks", 1e-6);
    for (int rests = 0; rests < 2; rests++) {
        test_memory(&middle, rests, once, 167); /* resident: its tiles have messages as well */
        test_memory(&large, rests, once, 140);
    }
    test_diverged(&tled_cpu_double, twice);
}

/* `test_tled_cuda contact`, or bytes, or runs: these alone, as all of them take minutes. */
int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*test)(const tled_executor *twice, const tled_executor *once);
    } parts[] = {{"bytes", test_steps_bytes}, {"contact", test_contact}, {"runs", test_runs}};
    const char *why;
    const tled_executor *twice = bench_cuda(tled_executors_double, &why),
                        *once = bench_cuda(tled_executors_single, &why);
    test_messages(twice != NULL);
    if (!twice || !once) {
        skip(1, why);
        return done_testing();
    }
    for (int i = 0; i < 3; i++)
        if (argc < 2 || !strcmp(argv[1], parts[i].name))
            parts[i].test(twice, once);
    return done_testing();
}
