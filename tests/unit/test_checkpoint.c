/* A run that breaks off and goes on: an executor that fails at its n-th call of any kind, as a card may, leaves the
 * last checkpoint whole, and what goes on from there writes the same frames as a run that never stopped. Checkpoints
 * that are damaged, and those of other runs.
 */
// needs: tled/*/*.c
#include "tled_bench.h"

#include "base/checksum.h"
#include "tled/loop/checkpoint.h"

#include <sys/stat.h>
#include <unistd.h>

static const block muscle = {{6, 3, 3}, {.0025, .0025, .0025}, 3000, .45, 1000, 30000, 2, 1, 0, {1, 0, 0}, 0, false};

/* ---- an executor that fails */

static struct {
    const tled_executor *whole;
    int64_t calls, fatal; /* the call that fails, from 1, as do all after it; 0: none */
} fault;

static int failing(err *e)
{
    fault.calls++;
    return fault.fatal && fault.calls >= fault.fatal
               ? err_set(e, NULL, 0, "the device failed at call %lld", (long long)fault.fatal)
               : 0;
}

static int bad_step(tled_state *state, const tled_plan *plan, int64_t count, err *e)
{
    return failing(e) ? -1 : fault.whole->step(state, plan, count, e);
}

static int bad_get(tled_state *state, int what, double *to, err *e)
{
    return failing(e) ? -1 : fault.whole->get(state, what, to, e);
}

static int bad_save(tled_state *state, err *e)
{
    return failing(e) ? -1 : fault.whole->save(state, e);
}

static int bad_restore(tled_state *state, err *e)
{
    return failing(e) ? -1 : fault.whole->restore(state, e);
}

static int bad_snapshot(tled_state *state, int slot, err *e)
{
    return failing(e) ? -1 : fault.whole->snapshot(state, slot, e);
}

static int bad_monitor(tled_state *state, const tled_question *question, tled_sums *answer, err *e)
{
    return failing(e) ? -1 : fault.whole->monitor(state, question, answer, e);
}

static tled_executor breaking(const tled_executor *device, int64_t fatal)
{
    tled_executor b = *device;
    fault.whole = device;
    fault.calls = 0;
    fault.fatal = fatal;
    b.step = bad_step;
    b.get = bad_get;
    b.save = bad_save;
    b.restore = bad_restore;
    b.snapshot = bad_snapshot;
    b.monitor = device->monitor ? bad_monitor : NULL;
    return b;
}

/* ---- a run that is written down */

enum { FRAMES = 200 };

typedef struct record {
    bench b;
    checkpoint *c;
    int64_t frames, saves;
    double time[FRAMES];
    uint32_t crc[FRAMES];
} record;

static char folder[40], path[80], before[80], frames_path[80];

static int put(record *r, const frame *f, err *e)
{
    const size_t size = 3 * (size_t)r->b.problem.nodes * sizeof(double);
    if (r->frames == FRAMES)
        return err_set(e, NULL, 0, "more than %d frames", FRAMES);
    uint32_t crc = checksum_add(0, frame_find(f, "node.displacement")->f64, size);
    r->time[r->frames] = f->time;
    r->crc[r->frames++] = checksum_add(crc, frame_find(f, "node.velocity")->f64, size);
    return 0;
}

static int again(void *context, const frame *f, err *e)
{
    return put(context, f, e);
}

static int put_out(void *context, double time, const field_values *state, err *e)
{
    record *r = context;
    frame f = {.index = r->frames, .time = time};
    int bad = fields_lend(&r->b.problem.fields, FIELD_IN_FRAMES, state, &f, &r->b.m, e) || put(r, &f, e) ||
              (r->c && checkpoint_add(r->c, &f, e));
    frame_free(&f);
    return bad ? -1 : 0;
}

static int save(void *context, const run_point *at, double time, const field_values *state, err *e)
{
    record *r = context;
    r->saves++;
    return checkpoint_save(r->c, at, time, state, e);
}

static void checked(void *context, int64_t step, const monitor_reading *reading, double remaining, int64_t cut,
                    double damping)
{
    (void)context, (void)step, (void)reading, (void)remaining, (void)cut, (void)damping;
}

/* rest: to rest, with the damping adapted; else so many steps. */
static void make(record *r, const tled_executor *device, bool rest)
{
    static const double gravity[3] = {1, -2, -9.81};
    memset(r, 0, sizeof *r);
    bench_make(&r->b, &muscle, gravity, .7, PHYSICAL, 2);
    r->b.setup.device = device;
    r->b.setup.every = rest ? .05 : .0123;
    r->b.setup.first = true;
    r->b.setup.rest = 1e-3;
    r->b.setup.context = r;
    r->b.setup.frame = put_out;
    r->b.setup.checked = checked;
    r->b.setup.save_every = .02;
    if (!rest)
        bench_steps(&r->b, 700, r->b.setup.damping);
}

static fingerprint_run run_of(const record *r)
{
    return (fingerprint_run){"--some options [cpu]", &r->b.m, &r->b.setup, &r->b.problem, 0};
}

static int begin(record *r)
{
    const fingerprint_run run = run_of(r);
    r->b.setup.save = save;
    r->c = checkpoint_begin(path, &run, &r->b.e);
    return r->c ? bench_go(&r->b) : -1;
}

static int resume(record *r, notes *warnings)
{
    const fingerprint_run run = run_of(r);
    r->b.setup.save = save;
    r->c = checkpoint_resume(path, &run, warnings, &r->b.e);
    if (!r->c)
        return -1;
    r->b.setup.point = checkpoint_take(r->c, &r->b.problem);
    r->b.setup.first = false;
    return checkpoint_replay(r->c, again, r, &r->b.e) ? -1 : bench_go(&r->b);
}

static void end(record *r, bool done)
{
    if (done)
        ok(!checkpoint_remove(r->c, &(err){0}), "its files are removed");
    checkpoint_close(r->c);
    bench_free(&r->b);
}

static void remove_all(void)
{
    unlink(path);
    unlink(before);
    unlink(frames_path);
}

static bool same(const record *a, const record *b)
{
    return a->frames == b->frames && !memcmp(a->time, b->time, sizeof a->time) &&
           !memcmp(a->crc, b->crc, sizeof a->crc);
}

static bool there(const char *name)
{
    return access(name, F_OK) == 0;
}

/* ---- */

/* The device fails at call 1, 2, 3, ...; then once more on the way on; then it does not. */
static void test_fails(const tled_executor *device, const char *name, bool rest)
{
    record whole, r;
    int64_t n = 0, said = 0, broken = 0, went_on = 0, twice = 0;
    make(&whole, device, rest);
    int gone = bench_go(&whole.b);
    ok(!gone && whole.frames > 3, "%s: a run of %lld frames, %lld steps %s", name, (long long)whole.frames,
       (long long)whole.b.end.steps, whole.b.e.text);
    tled_executor b = breaking(device, 0);
    make(&r, &b, rest);
    gone = begin(&r);
    const int64_t calls = fault.calls, saves = r.saves;
    ok(!gone && same(&whole, &r), "%s: the same with %lld saves %s", name, (long long)saves, r.b.e.text);
    end(&r, true);
    ok(!there(path) && !there(before) && !there(frames_path), "%s: and nothing is left of them", name);
    for (n = 1; n <= calls; n += n < 40 ? 1 : 1 + calls / 60) {
        b = breaking(device, n);
        make(&r, &b, rest);
        gone = begin(&r);
        said += gone && r.b.e.status == STATUS_BAD && strstr(r.b.e.text, "the device failed");
        broken++;
        end(&r, false);
        if (!there(path)) { /* before anything was saved */
            remove_all();
            went_on++;
            twice++;
            continue;
        }
        b = breaking(device, 10 + n % 30);
        make(&r, &b, rest);
        gone = resume(&r, NULL);
        twice += gone ? strstr(r.b.e.text, "the device failed") != NULL : same(&whole, &r);
        end(&r, !gone);
        if (gone) {
            make(&r, device, rest);
            gone = resume(&r, NULL);
            went_on += !gone && same(&whole, &r);
            if (gone)
                printf("# call %lld: %s\n", (long long)n, r.b.e.text);
            end(&r, true);
        } else {
            went_on++;
        }
    }
    ok(said == broken, "%s: %lld of %lld runs whose device failed ended with its message", name, (long long)said,
       (long long)broken);
    ok(twice == broken && went_on == broken,
       "%s: %lld of them went on to the same bytes, after a second failure (%lld)", name, (long long)went_on,
       (long long)twice);
    bench_free(&whole.b);
}

/* ---- damage */

static unsigned char *slurp(const char *name, size_t *size)
{
    FILE *f = fopen(name, "rb");
    unsigned char *bytes = f ? malloc(1 << 20) : NULL;
    *size = bytes ? fread(bytes, 1, 1 << 20, f) : 0;
    if (f)
        fclose(f);
    return bytes;
}

static void spill(const char *name, const unsigned char *bytes, size_t size)
{
    FILE *f = fopen(name, "wb");
    if (!f || fwrite(bytes, 1, size, f) != size || fclose(f)) {
        printf("Bail out! %s\n", name);
        exit(1);
    }
}

/* Whether the checkpoint at path is refused, with a word, for the one before it. */
static bool falls_back(record *r, double want)
{
    const fingerprint_run run = run_of(r);
    notes warnings = {0};
    err e = {0};
    checkpoint *c = checkpoint_resume(path, &run, &warnings, &e);
    bool good = c && checkpoint_saved(c) == want && warnings.count == 1 && strstr(warnings.line[0], path) &&
                strstr(warnings.line[0], "the run goes on from the checkpoint before it");
    if (!good)
        printf("# %s%s\n", e.text, warnings.count ? warnings.line[0] : "");
    checkpoint_close(c);
    notes_free(&warnings);
    return good;
}

static void test_damage(void)
{
    record r;
    size_t size = 0, size_1 = 0, size_f = 0;
    int64_t flips = 0, cuts = 0, refused = 0, cut_refused = 0;
    const size_t each = getenv("SINEW_LONG") ? 1 : 11;
    tled_executor b = breaking(&tled_cpu_double, 60);
    make(&r, &b, false);
    begin(&r);
    const double last = checkpoint_saved(r.c);
    end(&r, false);
    unsigned char *bytes = slurp(path, &size), *bytes_1 = slurp(before, &size_1), *frames = slurp(frames_path, &size_f);
    make(&r, &tled_cpu_double, false);
    const fingerprint_run run = run_of(&r);
    ok(bytes && size && bytes_1 && size_1 == size && size_f, "a checkpoint of %zu bytes at %g s", size, last);
    unlink(path);
    checkpoint *c = checkpoint_resume(path, &run, NULL, &r.b.e);
    const double earlier = c ? checkpoint_saved(c) : NAN;
    checkpoint_close(c);
    ok(earlier < last && earlier > 0, "and the one before it, at %g s %s", earlier, r.b.e.text);
    for (size_t bit = 0; bit < 8 * size; bit += each, flips++) {
        bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
        spill(path, bytes, size);
        refused += falls_back(&r, earlier);
        bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
    }
    ok(flips && refused == flips, "of %lld checkpoints with a bit flipped %lld were refused for the one before",
       (long long)flips, (long long)refused);
    for (size_t n = 0; n < size; n += each, cuts++) {
        spill(path, bytes, n);
        cut_refused += falls_back(&r, earlier);
    }
    ok(cut_refused == cuts, "of %lld that were cut, %lld", (long long)cuts, (long long)cut_refused);
    spill(path, bytes, size);
    spill(frames_path, frames, size_f - 40);
    ok(falls_back(&r, earlier), "and one whose frames are cut");
    spill(frames_path, frames, 30);
    spill(before, bytes_1, size - 1);
    c = checkpoint_resume(path, &run, NULL, &r.b.e);
    ok(!c && strstr(r.b.e.text, frames_path) && strstr(r.b.e.text, before), "both damaged: %s", r.b.e.text);
    checkpoint_close(c);
    /* Those were the frames: whole again, and gone on from the one before, it ends as ever. */
    record whole;
    make(&whole, &tled_cpu_double, false);
    bench_go(&whole.b);
    spill(frames_path, frames, size_f);
    spill(before, bytes_1, size);
    spill(path, bytes, size - 7);
    r.b.e = (err){0};
    notes warnings = {0};
    int gone = resume(&r, &warnings);
    ok(!gone && same(&whole, &r) && warnings.count == 1, "from the one before to the same bytes %s", r.b.e.text);
    notes_free(&warnings);
    end(&r, true);
    ok(!there(path) && !there(before) && !there(frames_path), "and nothing is left");
    bench_free(&whole.b);
    free(bytes);
    free(bytes_1);
    free(frames);
}

/* ---- other runs */

static void refused(const record *r, const char *options, const char *want, const char *name)
{
    fingerprint_run run = run_of(r);
    err e = {0};
    run.options = options ? options : run.options;
    checkpoint *c = checkpoint_resume(path, &run, NULL, &e);
    ok(!c && e.status == STATUS_BAD && strstr(e.text, want), "%s: %s", name, e.text);
    checkpoint_close(c);
}

static void test_others(void)
{
    record r;
    tled_executor b = breaking(&tled_cpu_double, 60);
    make(&r, &b, false);
    begin(&r);
    end(&r, false);
    make(&r, &tled_cpu_double, false);
    refused(&r, "--some options [cuda]", "other options, '[cpu]'; expected '[cuda]'", "another executor");
    refused(&r, "--other options [cpu]", "'--some'; expected '--other'", "another option");
    refused(&r, "--some values [cpu]", "'--some options'; expected '--some values'", "another value");
    refused(&r, "--some options [cpu] -x", "other options, ''; expected '-x'", "one more");
    r.b.setup.every *= 1 + 1e-15;
    refused(&r, NULL, "--every differs", "other frames");
    r.b.setup.every = .0123;
    r.b.problem.start = 1;
    refused(&r, NULL, "start differs", "another start");
    r.b.problem.start = 0;
    r.b.script.value[3] += 1e-9;
    refused(&r, NULL, "script differs", "another script");
    r.b.script.value[3] -= 1e-9;
    model_find(&r.b.m, "element.fibre")->f32[7] += 1e-6F;
    refused(&r, NULL, "array element.fibre differs", "another array");
    model_find(&r.b.m, "element.fibre")->f32[7] -= 1e-6F;
    model_meta_set(&r.b.m, "extra", "1", &r.b.e);
    refused(&r, NULL, "meta extra is new", "one more meta");
    const fingerprint_run run = run_of(&r);
    checkpoint *c = checkpoint_begin(path, &run, &r.b.e);
    ok(!c && strstr(r.b.e.text, "file: exists already; expected --restart"), "a run that begins: %s", r.b.e.text);
    spill(path, (const unsigned char *)"%sinew 1 text\nend\n", 18);
    refused(&r, NULL, "is not a checkpoint", "another model");
    end(&r, false);
    remove_all();
    make(&r, &tled_cpu_double, false);
    refused(&r, NULL, "No such file", "none");
    r.c = checkpoint_begin(path, &run, &r.b.e);
    c = checkpoint_begin(path, &run, &r.b.e);
    ok(r.c && !c && strstr(r.b.e.text, "another run is using it"), "two runs: %s", r.b.e.text);
    end(&r, true);
    ok(!there(frames_path), "a run that saved nothing leaves nothing");
}

/* FILE.frames, where there is no FILE. */
static void test_left_over(void)
{
    static const unsigned char kept[] = "what someone keeps";
    record r;
    size_t size = 0;
    tled_executor b = breaking(&tled_cpu_double, 60);
    make(&r, &b, false);
    begin(&r);
    end(&r, false);
    unlink(path);
    unlink(before);
    free(slurp(frames_path, &size));
    make(&r, &tled_cpu_double, false);
    const fingerprint_run run = run_of(&r);
    r.c = checkpoint_begin(path, &run, &r.b.e);
    ok(size > 1000 && r.c, "%zu bytes of frames that a run left are begun anew %s", size, r.b.e.text);
    checkpoint_close(r.c);
    spill(frames_path, kept, sizeof kept);
    r.c = checkpoint_begin(path, &run, &r.b.e);
    ok(!r.c && strstr(r.b.e.text, "exists, and is not a checkpoint"), "another's file of that name: %s", r.b.e.text);
    unsigned char *now = slurp(frames_path, &size);
    ok(size == sizeof kept && !memcmp(now, kept, size), "stays as it was");
    free(now);
    end(&r, false);
    remove_all();
}

int main(void)
{
    const char *why;
    /* In memory where that can be: there it takes no time until what is written is stored. */
    snprintf(folder, sizeof folder, "%s/sinew-XXXXXX", access("/dev/shm", W_OK) ? "/tmp" : "/dev/shm");
    if (!mkdtemp(folder)) {
        printf("Bail out! %s\n", folder);
        return 1;
    }
    snprintf(path, sizeof path, "%s/file", folder);
    snprintf(before, sizeof before, "%s/file.1", folder);
    snprintf(frames_path, sizeof frames_path, "%s/file.frames", folder);
    test_fails(&tled_cpu_double, "double", false);
    test_fails(&tled_cpu_double, "double, to rest", true);
    test_fails(&tled_cpu_single, "single", false);
    test_fails(&tled_cpu_single, "single, to rest", true);
    const tled_executor *cuda[] = {bench_cuda(tled_executors_double, &why), bench_cuda(tled_executors_single, &why)};
    for (int i = 0; i < 2; i++)
        if (cuda[i]) {
            test_fails(cuda[i], i ? "CUDA, single" : "CUDA, double", false);
            test_fails(cuda[i], i ? "CUDA, single, to rest" : "CUDA, double, to rest", true);
        } else {
            skip(1, why);
        }
    test_damage();
    test_others();
    test_left_over();
    rmdir(folder);
    return done_testing();
}
