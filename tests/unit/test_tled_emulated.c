/* The CUDA executors' kernels on a card that the processor plays (tests/emulate): the march, its bricks, those that
 * stay, and looks, a third of them by several lots; and that the card finds what is wrong, in kernels that are, and in
 * ours where it leaves out what they say. With SINEW_LONG for twenty times as many steps, all by several lots, and more
 * shapes, slits and ways. */
// needs: tled/*/*.c
#include "tled_live_trial.h"

#ifdef SINEW_EMULATED
#include "tests/emulate/any_form.h"
#include "tests/emulate/wrong.h"
#include "tled/cuda/cuda.h"
#include "tled/cuda/march_near.h"
#include "tled_history.h"
#include "tled_trial_contact.h"
#include "tled_trial_cuts.h"

/* Steps, of a lump on so many processors, in a test of what is left out. */
enum { OMITTED_STEPS = 8, OMITTED_ON = 6, OMITTED_NODES = 18 * 10 * 7 };

/* Of all pairs of units that wait for each other in a march that is made, the number
 * of the one that is left out, if not -1. */
static int64_t near_left_out = -1;

/* march_near_find to the march.c that is tried here: emulate.mk. */
int near_find_tried(march *m, int64_t nodes, err *e);
int near_find_tried(march *m, int64_t nodes, err *e)
{
    int64_t left = near_left_out;
    if (march_near_find(m, nodes, e))
        return -1;
    for (int64_t i = 0; i < m->units && left >= 0; i++) {
        int32_t *row = m->near + i * m->nears;
        for (int64_t k = 0; k < m->nears && row[k] >= 0 && left >= 0; k++)
            if (row[k] != i && left-- == 0)
                memmove(row + k, row + k + 1, (size_t)(m->nears - k - 1) * sizeof *row);
    }
    return 0;
}

static void test_wrong(void)
{
    for (const wrong_kernel *k = wrong_kernels; k->name; k++) {
        const char *said = NULL;
        int as_told = 0;
        for (uint64_t seed = 1; seed <= 3; seed++) {
            put_in(&staying, seed, 2);
            const int e = k->start();
            said = e ? wrong_text(e) : "nothing";
            as_told += k->says ? e && strstr(said, k->says) : !e;
        }
        ok(as_told == 3, "%s: %s", k->name, said);
    }
}

static void test_marches(int64_t steps)
{
    block cut = small;
    cut.fraction = -1;
    const trial all[] = {{"a muscle", small, .5, false, {0}, false},
                         {"cut elements", cut, .5, false, {0}, false},
                         {"mixed elements", mixed_of(small), .5, false, {0}, false},
                         {"a script", lump, 0, true, {0}, false},
                         {"mixed elements, a script", mixed_of(lump), 0, true, {0}, false},
                         {"a run to rest", small, .5, false, {0}, true}};
    /* The first two have nothing that others have not. */
    for (size_t i = all_of_it ? 0 : 2; i < sizeof all / sizeof *all; i++)
        try(&all[i], &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    for (size_t i = all_of_it ? 0 : 3; i < sizeof all / sizeof *all; i++)
        try_marched(&all[i], steps);
}

/* Plates and rods of 1 to 3 elements along every axis, or of one of these numbers. */
static void test_thin(int64_t steps)
{
    for (int axis = 0; axis < 3; axis++)
        for (int n = 1; n <= 3; n++) {
            char name[40];
            if (!all_of_it && n != axis + 1)
                continue;
            trial plate = {name, mixed_of(small), .5, false, {17, 17, 17}, false},
                  rod = {name, small, .5, false, {n, n, n}, false};
            plate.cells[axis] = n;
            rod.cells[axis] = 33;
            plate.what.fixed_axis = (axis + 1) % 3;
            rod.what.fixed_axis = axis;
            snprintf(name, sizeof name, "a plate of %d along %c", n, 'x' + axis);
            try(&plate, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
            snprintf(name, sizeof name, "a rod of %d along %c", n, 'x' + axis);
            try(&rod, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
            if (all_of_it || axis == 2)
                try_marched(&plate, steps);
        }
}

static void test_bricks(int64_t steps)
{
    const trial all[] = {{"a script in bricks", lump, 0, true, {0}, false},
                         {"a muscle in bricks", muscle, .5, false, {0}, false},
                         {"mixed elements in bricks", mixed_of(muscle), .5, false, {0}, false}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        try(&all[i], &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
        try(&all[i], &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
    }
    try(&all[0], &plain, &tled_cuda_double, &tled_cpu_double, steps, 0);
    try(&all[0], &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    const trial rests = {"a script in bricks, to rest", lump, 0, true, {0}, true};
    try(&rests, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
}

/* Slits, wherever they are, or those that have what others have, too: where it marches, in bricks and in bricks that
 * stay; and looks. */
static void test_slits(int64_t steps)
{
    for (int i = 0; i < SLITS; i++) {
        char name[3][80];
        if (!all_of_it && i != 3 && i != 5 && !slits[i].thin)
            continue;
        static const char *const way[3] = {"marched", "in bricks", "in bricks that stay"};
        block what = i % 2 ? mixed_of(lump) : lump;
        what.cells[1] = slits[i].thin ? 1 : what.cells[1];
        for (int k = 0; k < 3; k++)
            snprintf(name[k], sizeof name[k], "%s, %s", slits[i].name, way[k]);
        const trial walk = {name[0], what, 0, !slits[i].thin, {0}, false};
        trial bricks = walk, stay = walk;
        bricks.name = name[1], stay.name = name[2];
        in_slit = &slits[i];
        try(&walk, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        try(&bricks, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
        try(&stay, &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
        if (i == 5) {
            try(&bricks, &plain, &tled_cuda_double, &tled_cpu_double, steps, 0);
            try(&stay, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
            try_marched(&walk, steps);
            put_in(&plain, 4, 4);
            test_look(&lump, true, steps, &tled_cuda_single, "a look at slits in bricks", 1e-6);
            put_in(&marching, 3, 2);
            test_look(&lump, true, steps, &tled_cuda_single, "a look at slits where it marches", 1e-6);
        }
    }
    in_slit = &slits[3];
    if (all_of_it) {
        const trial walk = {"crossing slits, isotropic control", mixed_of(small), .5, false, {0}, false};
        in_control = ISOTROPIC(.0075);
        try(&walk, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        in_control = PHYSICAL;
    }
    const trial muscles = {"crossing slits in muscles", mixed_of(small), .5, false, {0}, false};
    try(&muscles, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try_marched(&muscles, steps);
    in_slit = NULL;
}

/* Laws beside the neo-Hookean, and fibres, where it marches: elements of them alone, special ones, and tips. */
static void test_laws_marched(int64_t steps)
{
    static const struct {
        form of;
        const block_fibres *fibres;
    } all[] = {{FORM_MOONEY_RIVLIN, NULL},
               {FORM_FIRST, NULL},
               {FORM_NEO_HOOKEAN, &quadratic_fibres},
               {FORM_NEO_HOOKEAN, &hgo_fibres},
               {FORM_NEO_HOOKEAN, &two_families}};
    block cut = small, cubes = lump;
    cut.fraction = -1;
    for (int a = 0; a < 3; a++)
        cubes.cells[a] = (const int[]){17, 7, 8}[a], cubes.side[a] = .01;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const trial alone = {"a law, marched", cubes, 0, true, {0}, false};
        const trial special = {"a law, cut elements and a muscle, marched", cut, .5, false, {0}, false};
        const trial mixed = {"a law, mixed elements, marched", mixed_of(small), .5, false, {0}, false};
        const trial parted = {"a law, crossing slits, marched", cut, .5, false, {0}, false};
        in_form = all[i].of;
        in_fibres = all[i].fibres;
        printf("# form %d, %s\n", (int)in_form, in_fibres ? in_fibres->name : "no fibres");
        try(&alone, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        try(&special, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        if (!in_fibres)
            try_marched(all_of_it || i ? &special : &alone, steps);
        if (!in_fibres)
            try(&mixed, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        in_slit = &slits[3];
        if (all_of_it || i % 2)
            try(&parted, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
        in_slit = NULL;
    }
    in_form = FORM_NEO_HOOKEAN;
    in_fibres = NULL;
}

/* Another form in bricks, to the CPU's bytes, on a card that marches too, if that has no march for it. */
static void test_form(form f, int64_t steps)
{
    const trial all[] = {{"another form, a script", lump, 0, true, {0}, false},
                         {"another form, a muscle", muscle, .5, false, {0}, false},
                         {"another form, mixed elements", mixed_of(muscle), .5, false, {0}, false}};
    printf("# form %d\n", (int)f);
    in_form = f;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        try(&all[i], &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
        try(&all[i], &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
        if (f == FORM_GENERAL || all[i].what.side[0] != all[i].what.side[1])
            try(&all[i], &marching, &tled_cuda_single, &tled_cpu_single, steps, 0);
    }
    try(&all[2], &plain, &tled_cuda_double, &tled_cpu_double, steps, 0);
    try(&all[2], &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    put_in(&plain, 4, 4);
    test_look(&lump, true, steps, &tled_cuda_single, "a look at another form", 1e-6);
    in_form = FORM_NEO_HOOKEAN;
}

/* Kernels of any form give the CPU's bytes too, as those do that are compiled for one. */
static void test_any_form(int64_t steps)
{
    const trial moved = {"kernels of any form, a script", lump, 0, true, {0}, false};
    const trial mixed = {"kernels of any form, mixed elements", mixed_of(muscle), .5, false, {0}, false};
    const trial parted = {"kernels of any form, slits", mixed_of(lump), 0, true, {0}, false};
    for (int f = 0; f < FORM_STEPPED; f++) {
        in_form = (form)f;
        printf("# form %d\n", f);
        try(&mixed, &plain, &any_form_single, &tled_cpu_single, steps, 0);
        try(&moved, &staying, &any_form_single, &tled_cpu_single, steps, 0);
        try(&mixed, &staying, &any_form_double, &tled_cpu_double, steps, 0);
    }
    in_slit = &slits[5];
    try(&parted, &plain, &any_form_double, &tled_cpu_double, steps, 0);
    try(&parted, &staying, &any_form_single, &tled_cpu_single, steps, 0);
    in_slit = NULL;
    in_form = FORM_NEO_HOOKEAN;
    in_control = ISOTROPIC(.0075);
    try(&mixed, &plain, &any_form_single, &tled_cpu_single, steps, 0);
    in_control = PHYSICAL;
}

/* Fibres that act by themselves change how a block moves. */
static void fibres_act(const block_fibres *f, trial t, int64_t steps)
{
    answer with, without;
    in_fibres = f;
    find(&with, &t, &tled_cpu_double, steps);
    in_fibres = NULL;
    find(&without, &t, &tled_cpu_double, steps);
    ok(off(&with, &without) > 1e-4 && off(&with, &without) < INFINITY, "%s matter: %.2g %s", f->name,
       off(&with, &without), with.b.e.text);
    answer_free(&with);
    answer_free(&without);
}

/* Fibres that resist being stretched, and muscles with curves of their own: the CPU's bytes in bricks and in bricks
 * that stay, on a card that marches too. */
static void test_fibres(int64_t steps)
{
    const block cut = mixed_of(muscle);
    const struct {
        const block_fibres *fibres;
        trial what;
    } all[] = {{&quadratic_fibres, {"quadratic fibres, a script", lump, 0, true, {0}, false}},
               {&fung_tissue, {"fung, mixed elements, a script", mixed_of(lump), 0, true, {0}, false}},
               {&hgo_fibres, {"hgo fibres, mixed elements, a script", mixed_of(lump), 0, true, {0}, false}},
               {&two_families, {"two families, mixed muscles", cut, .5, false, {0}, false}},
               {&passive_muscles, {"passive muscles, mixed", cut, .5, false, {0}, false}},
               {&passive_muscles, {"a passive muscle", muscle, .5, false, {0}, false}},
               {&all_fibres, {"passive muscles with two families, mixed", cut, .5, false, {0}, false}},
               {&serial_muscles, {"muscles with springs, mixed", cut, .5, false, {0}, false}},
               {&serial_muscles, {"a muscle with springs", muscle, .5, false, {0}, false}},
               {&serial_fibres, {"muscles with springs and fibres, mixed", cut, .5, false, {0}, false}}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        fibres_act(all[i].fibres, all[i].what, steps);
        in_fibres = all[i].fibres;
        try(&all[i].what, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
        try(&all[i].what, &staying, &tled_cuda_single, &tled_cpu_single, steps, 0);
        if (all_of_it || i % 2)
            try(&all[i].what, &plain, &tled_cuda_double, &tled_cpu_double, steps, 0);
        if (all_of_it || i % 2 == 0)
            try(&all[i].what, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    }
    in_fibres = &two_families;
    try(&all[3].what, &marching, &tled_cuda_single, &tled_cpu_single, steps, 0);
    in_control = ISOTROPIC(.0075);
    try(&all[3].what, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
    in_control = PHYSICAL;
    in_slit = &slits[5];
    const trial parted = {"two families, slits", mixed_of(lump), 0, true, {0}, false};
    try(&parted, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
    try(&parted, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    in_slit = NULL;
    in_fibres = NULL;
}

/* In kernels of any form. */
static void test_fibres_of_forms(int64_t steps)
{
    const trial mixed = {"hgo fibres of any form, mixed elements", mixed_of(muscle), .5, false, {0}, false};
    in_fibres = &hgo_fibres;
    for (int f = 0; f < FORM_STEPPED; f++) {
        in_form = (form)f;
        printf("# form %d\n", f);
        try(&mixed, &plain, &any_form_single, &tled_cpu_single, steps, 0);
        if (all_of_it || f == FORM_NEO_HOOKEAN)
            try(&mixed, &staying, &any_form_double, &tled_cpu_double, steps, 0);
    }
    in_form = FORM_NEO_HOOKEAN;
}

static void test_fibres_looks(int64_t steps)
{
    const block cut = mixed_of(muscle);
    put_in(&plain, 4, 4);
    in_bent = true;
    in_fibres = &hgo_fibres;
    test_look(&lump, true, steps, &tled_cuda_single, "a look at hgo fibres", 1e-6);
    in_fibres = &fung_tissue;
    test_look(&lump, true, steps, &tled_cuda_single, "a look at fung", 1e-6);
    in_fibres = &all_fibres;
    test_look(&cut, false, steps, &tled_cuda_double, "a look at passive muscles with two families", 1e-10);
    in_fibres = &serial_fibres;
    test_look(&cut, false, steps, &tled_cuda_double, "a look at muscles with springs", 1e-10);
    in_fibres = &two_families;
    test_look(&cut, false, steps, &tled_cuda_double, "a look at two families", 1e-10);
    in_fibres = NULL;
    in_bent = false;
}

/* The emulated card is one thread's: frames, which have others, are left out. */
static int no_snapshot(tled_state *state, int slot, err *e)
{
    (void)state, (void)slot, (void)e;
    return 0;
}

static int no_fetch(tled_state *state, int slot, const field_values *to, err *e)
{
    (void)state, (void)slot, (void)to, (void)e;
    return 0;
}

/* Lines that come live, beside a processor: new targets taken over in place, or by a state that is made again. */
static void test_live(const emulated_card *card, bool again, const char *name)
{
    tled_executor alone = tled_cuda_single;
    alone.snapshot = no_snapshot;
    alone.fetch = no_fetch;
    if (again)
        alone.reload = NULL;
    put_in(card, 5, 4);
    trial_beside(&trial_block, trial_lines, &tled_cpu_single, &alone, 1e-4, name);
}

/* And where skin touches and nodes slide. */
static void test_live_touching(const emulated_card *card, const char *name)
{
    tled_executor alone = tled_cuda_double;
    alone.snapshot = no_snapshot;
    alone.fetch = no_fetch;
    put_in(card, 5, 4);
    trial_touch(true);
    trial_beside(&trial_touching, trial_touching_lines, &tled_cpu_double, &alone, 1e-6, name);
    trial_touch(false);
}

static void test_isotropic(int64_t steps)
{
    const trial marches = {"isotropic control, a script", lump, 0, true, {0}, false};
    const trial mixed = {"isotropic control, mixed elements", mixed_of(small), .5, false, {0}, false};
    const trial bricks = {"isotropic control in bricks", mixed_of(muscle), .5, false, {0}, false};
    in_control = ISOTROPIC(.0075);
    try(&marches, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try_marched(&marches, steps);
    if (all_of_it)
        try(&mixed, &marching, &tled_cuda_single, &tled_cpu_double, steps, 1e-5);
    try(&bricks, &plain, &tled_cuda_single, &tled_cpu_single, steps, 0);
    try(&bricks, &staying, &tled_cuda_double, &tled_cpu_double, steps, 0);
    put_in(&plain, 4, 4);
    test_look(&lump, true, steps, &tled_cuda_single, "a look under isotropic control", 1e-6);
    in_control = PHYSICAL;
}

/* A look at a bent block, in bricks, by one lot. */
static tled_sums look_by(uint64_t seed)
{
    bench b;
    tled_sums sums = {0};
    const tled_question question = {.time = .03, .raise = 1.01, .differences = true};
    put_in(&plain, seed, 4);
    make(&b, &lump, 0, true, &tled_cuda_single, 1);
    bend(&b);
    tled_state *state = tled_cuda_single.create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || tled_cuda_single.save(state, &b.e) || tled_cuda_single.monitor(state, &question, &sums, &b.e),
               &b.e);
    tled_cuda_single.destroy(state);
    bench_free(&b);
    return sums;
}

static void test_looks(int64_t steps)
{
    const tled_sums once = look_by(7), again = look_by(8);
    ok(once.frequency_element >= 0 && !memcmp(&once, &again, sizeof once), "a look in bricks: the same by other lots");
    put_in(&marching, 3, 2);
    test_look(&small, false, steps, &tled_cuda_single, "a look where it marches", 1e-6);
    test_look(&small, false, steps, &tled_cuda_double, "a look where it marches in double precision", 1e-10);
    ok(bench_look_at_rest(&lump, &tled_cuda_single) == 1,
       "a look at rest, with unlike sides, finds the stable step at rest");
    const block mixed = mixed_of(small);
    if (all_of_it)
        test_look(&mixed, false, steps, &tled_cuda_single, "a look at mixed elements", 1e-6);
    put_in(&plain, 4, 4);
    test_look(&lump, true, steps, &tled_cuda_single, "a look at a script", 1e-6);
    test_look(&muscle, false, steps, &tled_cuda_double, "a look in double precision", 1e-10);
}

/* A march of some steps at once, on a card that omits something: displacements to `to`. */
static int march_at_once(emulated_omission what, uint64_t seed, double *to, err *e)
{
    const block mixed = mixed_of(lump);
    const tled_executor *device = &tled_cuda_single;
    emulated_card omits = marching;
    bench b;
    omits.omission = what;
    put_in(&omits, seed, OMITTED_ON);
    make(&b, &mixed, 0, true, device, 1);
    bend(&b);
    const tled_plan plan = {.origin = b.problem.start, .rate = b.setup.rate, .damping = b.setup.damping};
    tled_state *state = device->create(&b.problem, b.setup.threads, e);
    const int gone =
        !state || device->step(state, &plan, OMITTED_STEPS, e) || device->get(state, TLED_DISPLACEMENT, to, e);
    device->destroy(state);
    bench_free(&b);
    return gone;
}

/* Whether what is omitted is found out by some lot: a fault, or another answer than the right one. (Where blocks run
 * one after another, they need not wait.) */
static void try_omission(emulated_omission what, const double *right, const char *name)
{
    const size_t size = 3 * OMITTED_NODES * sizeof(double);
    double *to = malloc(size);
    const bool none = what == OMIT_NOTHING && near_left_out < 0;
    const uint64_t few = all_of_it ? 3 : 1;
    uint64_t lots = 0;
    bool found = false;
    err e = {0};
    while (!found && lots < (none ? few : 12))
        found = march_at_once(what, ++lots, to, &e) || memcmp(to, right, size) != 0;
    const char *said = *e.text ? e.text : "another answer";
    ok(found != none, "without %s: after %d lots, %s", name, (int)lots, found ? said : "nothing");
    free(to);
}

static void test_omissions(void)
{
    static const char *const name[] = {"nothing",   "__syncthreads()", "__syncwarp()",    "barrier_wait()",
                                       "arrived()", "hear_done()",     "each ticket once"};
    double *right = calloc(OMITTED_NODES, 3 * sizeof *right);
    err e = {0};
    bench_must(march_at_once(OMIT_NOTHING, 99, right, &e), &e);
    for (int i = OMIT_NOTHING; i <= OMIT_TICKET; i++)
        try_omission((emulated_omission)i, right, name[i]);
    for (near_left_out = 0; near_left_out < 20; near_left_out += all_of_it ? 5 : 10)
        try_omission(OMIT_NOTHING, right, "waiting for one of its neighbours");
    near_left_out = -1;
    free(right);
}

/* Displacements after `steps` steps in one call, and two, from a bent state. */
static void call_once(const block *what, const tled_executor *device, int64_t steps, double *to)
{
    bench b;
    make(&b, what, 0, false, device, 1);
    bend(&b);
    tled_plan plan = {.origin = b.problem.start, .rate = b.setup.rate, .damping = b.setup.damping};
    tled_state *state = device->create(&b.problem, b.setup.threads, &b.e);
    bench_must(!state || device->step(state, &plan, steps, &b.e), &b.e);
    plan.first += steps;
    bench_must(device->step(state, &plan, 2, &b.e) || device->get(state, TLED_DISPLACEMENT, to, &b.e), &b.e);
    device->destroy(state);
    bench_free(&b);
}

/* A call of as many passes as curves' values go to the card at once, and one: of steps, and of their end. */
static void test_long_calls(void)
{
    enum { X = 2, Y = 2, Z = 1, COUNT = 3 * (X + 1) * (Y + 1) * (Z + 1) };
    block what = lump;
    double want[COUNT], got[COUNT];
    memcpy(what.cells, (int32_t[]){X, Y, Z}, sizeof what.cells);
    for (int64_t steps = all_of_it ? 255 : 256; steps < 258; steps++) {
        double off = 0, most = 0;
        put_in(&marching, 9, 2);
        call_once(&what, &tled_cpu_double, steps, want);
        call_once(&what, &tled_cuda_single, steps, got);
        for (int i = 0; i < COUNT; i++) {
            off = fmax(off, fabs(got[i] - want[i]));
            most = fmax(most, fabs(want[i]));
        }
        ok(off < 1e-3 * most, "%lld steps in one call: %.2g of the largest displacement off", (long long)steps,
           off / most);
    }
}

/* A history of elements that several tiles compute, where it marches, in bricks and in bricks that stay: by frames that
 * have their own memory on the card, and, once the monitor has asked for differences, by frames as the state stands. */
static void test_histories(void)
{
    static const struct {
        const char *name, *direct;
        const emulated_card *card;
        const block *what;
    } all[] = {{"a history where it marches", "a history where it marches, to rest", &marching, &small},
               {"a history in bricks", "a history in bricks, to rest", &plain, &muscle},
               {"a history in bricks that stay", "a history in bricks that stay, to rest", &staying, &muscle}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        put_in(all[i].card, 5, all[i].card->processors);
        if (all_of_it || i == 1)
            test_history(&history_cuda, all[i].what, false, all[i].name);
        test_history(&history_cuda, all[i].what, true, all[i].direct);
    }
}

/* The executors on cards have no steps that change a history, and say so. */
static void test_refusal(void)
{
    const executor *table[] = {&tled_cuda_single.is, NULL}, *other[] = {&history_cuda.is, NULL};
    char says[200];
    bench b;
    bench_make(&b, &muscle, NULL, 0, PHYSICAL, 1);
    executor_need need = tled_need(&b.problem);
    ok(!(need.features & EXECUTOR_HISTORY), "tissue without a history needs none");
    need.features |= EXECUTOR_HISTORY;
    ok(!executor_choose(table, "cuda", &need, says, sizeof says, &b.e) && strstr(b.e.text, "no history of elements"),
       "a history is refused: %s", b.e.text);
    ok(executor_choose(other, "cuda", &need, says, sizeof says, &b.e) == &history_cuda.is, "or chosen for: %s", says);
    bench_free(&b);
}

int main(void)
{
    all_of_it = getenv("SINEW_LONG") != NULL;
    const int64_t more = all_of_it ? 20 : 1;
    if (!emulate(&plain)) {
        skip(1, "this processor has no fused operations");
        return done_testing();
    }
    test_wrong();
    test_omissions();
    test_marches(4 * more);
    test_laws_marched(4 * more);
    test_thin(3 * more);
    test_long_calls();
    test_bricks(3 * more);
    test_slits(more);
    for (int f = 0; f < FORM_STEPPED; f++)
        if (f != FORM_NEO_HOOKEAN)
            test_form((form)f, 2 * more);
    test_any_form(more);
    test_fibres(more);
    test_fibres_of_forms(more);
    test_fibres_looks(2 * more);
    test_cuts(more);
    test_sliding(2 * more);
    test_pressing(2 * more);
    test_touching(2 * more);
    test_live(&marching, false, "a march");
    test_live_touching(&plain, "skin and sliding nodes in bricks");
    if (all_of_it) {
        test_live(&marching, true, "a march, made again");
        test_live(&plain, false, "bricks");
        test_live(&staying, false, "resident bricks");
        test_live(&staying, true, "resident bricks, made again");
        test_live_touching(&marching, "skin and sliding nodes where it marches");
    }
    test_isotropic(3 * more);
    test_looks(2 * more);
    test_histories();
    test_refusal();
    return done_testing();
}
#else
int main(void)
{
    skip(1, "no g++ for x86-64");
    return done_testing();
}
#endif
