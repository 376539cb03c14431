/* A row more in the table of a state, a history of 6 numbers an element that a step changes. With no other edit the
 * executor on processors saves, restores and snapshots it, frames have it, and a run that is broken off goes on from
 * its checkpoint to the same bytes.
 */
// needs: tled/*/*.c
#include "tled/cpu/cpu.h"

#define CPU_EXECUTOR           history_cpu
#define CPU_EXECUTOR_OF_MESHES history_cpu_meshes
#define CPU_PASSES             cpu_passes_double
#include "tled/cpu/cpu_loops.h"

#include "tled_history.h"

#include "base/checksum.h"
#include "tled/loop/checkpoint.h"

#include <unistd.h>

enum { STEPS = 700 };

static const block muscle = {{6, 3, 3}, {.0025, .0025, .0025}, 3000, .45, 1000, 30000, 2, 1, 0, {1, 0, 0}, 0, false};

/* As a law's would, each element's numbers change by themselves: here by the steps taken. */
static int history_step(tled_state *s, const tled_plan *plan, int64_t count, err *e)
{
    const int64_t stride = layout_of(s, HISTORY).stride;
    for (int a = 0; a < COLUMNS; a++)
        for (int64_t k = 0; k < s->rows.cells; k++)
            s->field[HISTORY][a * stride + k] += (double)(count * (a + 1));
    return cpu_step(s, plan, count, e);
}

/* ---- a run that is broken off */

typedef struct record {
    bench b;
    field row[HISTORY + 1];
    checkpoint *c;
    int saves, fatal; /* the save after which the run ends, 0: none */
    uint32_t crc;     /* of all fields of the last frame */
    int arrays;       /* of it */
    bool is_right;    /* its history is that of its step */
} record;

static int put(void *context, double time, const field_values *state, err *e)
{
    record *r = context;
    const tled_problem *p = &r->b.problem;
    frame f = {.index = r->b.frames++, .time = time};
    const int bad =
        fields_lend(&p->fields, FIELD_IN_FRAMES, state, &f, &r->b.m, e) || (r->c && checkpoint_add(r->c, &f, e));
    r->crc = fields_crc(&p->fields, state, 0);
    r->arrays = f.arrays.count;
    r->is_right = is_after(state->of[HISTORY], p->elements, (int64_t)nearbyint(time * r->b.setup.rate));
    frame_free(&f);
    return bad ? -1 : 0;
}

static int again(void *context, const frame *f, err *e)
{
    record *r = context;
    (void)f, (void)e;
    r->b.frames++;
    return 0;
}

static int save(void *context, const run_point *at, double time, const field_values *state, err *e)
{
    record *r = context;
    if (checkpoint_save(r->c, at, time, state, e))
        return -1;
    return ++r->saves == r->fatal ? err_set(e, NULL, 0, "broken off") : 0;
}

static void make(record *r, const tled_executor *device)
{
    memset(r, 0, sizeof *r);
    bench_make(&r->b, &muscle, NULL, .2, PHYSICAL, 2);
    add_history(&r->b.problem, r->row, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS);
    bench_steps(&r->b, STEPS, r->b.setup.damping);
    r->b.setup.device = device;
    r->b.setup.rate_fixed = true;
    r->b.setup.every = .01;
    r->b.setup.save_every = .01;
    r->b.setup.context = r;
    r->b.setup.frame = put;
}

static void test_run(const tled_executor *device)
{
    record whole, r;
    char folder[] = "/tmp/history.XXXXXX", path[40];
    make(&whole, device);
    ok(!bench_go(&whole.b) && whole.arrays == 3 && whole.is_right, "frames have it: %s", whole.b.e.text);
    bench_must(!mkdtemp(folder), &whole.b.e);
    snprintf(path, sizeof path, "%s/state", folder);
    make(&r, device);
    const fingerprint_run run = {"options", &r.b.m, &r.b.setup, &r.b.problem, 0};
    r.b.setup.save = save;
    r.fatal = 3;
    r.c = checkpoint_begin(path, &run, &r.b.e);
    ok(r.c && bench_go(&r.b) && strstr(r.b.e.text, "broken off"), "a run ends after a checkpoint: %s", r.b.e.text);
    checkpoint_close(r.c);
    r.b.e = (err){0};
    r.fatal = 0;
    r.b.problem.at_start.of[HISTORY][5] += 1e-9;
    r.c = checkpoint_resume(path, &run, NULL, &r.b.e);
    ok(!r.c && strstr(r.b.e.text, "start differs"), "its fingerprint has it: %s", r.b.e.text);
    r.b.e = (err){0};
    r.b.problem.at_start.of[HISTORY][5] = 5;
    r.b.frames = 0;
    r.c = checkpoint_resume(path, &run, NULL, &r.b.e);
    bench_must(!r.c, &r.b.e);
    r.b.setup.point = checkpoint_take(r.c, &r.b.problem);
    ok(!checkpoint_replay(r.c, again, &r, &r.b.e) && !bench_go(&r.b) && r.is_right, "it goes on %s", r.b.e.text);
    ok(r.b.frames == whole.b.frames && r.crc == whole.crc, "to the same bytes");
    ok(!checkpoint_remove(r.c, &r.b.e) && !rmdir(folder), "and its files are removed");
    checkpoint_close(r.c);
    bench_free(&r.b);
    bench_free(&whole.b);
}

int main(void)
{
    tled_executor device = history_cpu;
    device.step = history_step;
    test_history(&device, &muscle, false, "a history");
    test_run(&device);
    return done_testing();
}
