/* Live runs without a clock: lines that come on the way, taken over in place and by a state that is made again, to the
 * same bytes, in a lattice's boxes and as a mesh, by any number of threads; what a script is left with by lines that
 * are wrong or over; tissue that breaks, and breaks at once again.
 */
// needs: tled/*/*.c
#include "tled_live_trial.h"

/* In place, and by a state that is made again. */
static void anew(const block *what, const trial_event *events, const tled_executor *device, bool mesh, const char *name)
{
    tled_executor other = *device;
    live_trial a, b;
    other.reload = NULL;
    trial_begin(&a, what, mesh, events, 1);
    trial_begin(&b, what, mesh, events, 3);
    a.b.setup.device = device;
    b.b.setup.device = &other;
    const int failed = trial_go(&a) || trial_go(&b);
    ok(!failed, "%s: goes on to its end %s%s", name, a.b.e.text, b.b.e.text);
    ok(a.b.frames == TRIAL_TICKS + 1 && !a.broke && a.taken >= TRIAL_TICKS * a.live.parts, "%s: a frame a tick", name);
    ok(!memcmp(a.b.displacement, b.b.displacement, 6 * (size_t)a.b.problem.nodes * sizeof(double)),
       "%s: a state that is made again has the same bytes", name);
    ok(a.b.displacement[2] > 1.9e-3 || a.b.displacement[0] > 1.9e-3, "%s: and what was displaced is so", name);
    trial_free(&a);
    trial_free(&b);
}

/* Lines that are wrong leave the script as it is; targets that are over go when a new one comes. */
static void kept(void)
{
    static const char *const wrong[] = {"now force 1,1,1 1mm 0,0,1",
                                        "pull p 0,0,0 99mm 0,0,0 -1",
                                        "now displace 0,0,0,1,1,1 -,-,-",
                                        "now displace nothing 0,0,0",
                                        "release p",
                                        "now traction skin 0,0,1",
                                        "now contract m 2",
                                        "now",
                                        "now pull"};
    live_trial t;
    trial_begin(&t, &trial_block, false, trial_lines, 1);
    script *s = &t.b.script;
    const script_now now = {1, 2, NULL};
    const int64_t curves = s->curves, keys = s->keys;
    bool changed = false;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[200];
        err e = {0};
        keyfile k = {.name = "live"};
        snprintf(text, sizeof text, "%s", wrong[i]);
        keyfile_take(&k, text, (int64_t)strlen(text), 7, &e);
        ok(script_is_now(&k) && script_take_now(s, &t.b.m, &k, &now, &changed, &e) && e.status == STATUS_BAD, "%s",
           e.text);
    }
    ok(s->curves == curves && s->keys == keys && !s->nodes && !changed, "and nothing has changed");
    for (int i = 0; i < 3000; i++) {
        char text[200];
        err e = {0};
        keyfile k = {.name = "live"};
        snprintf(text, sizeof text,
                 i % 3 == 2   ? "release p%d"
                 : i % 3 == 1 ? "now pull p%d 0,0,0 30mm 0,0,%dmm 5"
                              : "pull p%d 0,0,0 30mm 0,0,%dmm 5",
                 i / 3, i % 7);
        keyfile_take(&k, text, (int64_t)strlen(text), i, &e);
        bench_must(script_take_now(s, &t.b.m, &k, &now, &changed, &e), &e);
    }
    ok(s->curves == curves + 2 && s->keys == keys + 4, "of a thousand springs the last is left: %lld curves",
       (long long)s->curves);
    bench_must(tled_problem_reload(&t.b.problem, &t.b.m, &t.b.e), &t.b.e);
    double value[3];
    script_value(s, &s->curve[curves + 1], 3, value);
    ok(t.b.problem.force_start[t.b.problem.nodes] > 0 && value[0] == 0, "which is released");
    trial_free(&t);
}

/* What is pressed flat breaks: back, at rest, and on; where it stays so, to the beginning. */
static void breaks(void)
{
    static const trial_event flat[] = {{2, "pull p 20mm,12mm,45mm 30mm 20mm,12mm,-3m 900"}, {0, NULL}};
    static const trial_event held[] = {{2, "now displace 0,0,45mm,1,1,45mm 0,0,-20cm"}, {0, NULL}};
    static const trial_event fallen[] = {{2, "now gravity 0,0,-1e9"}, {0, NULL}};
    live_trial t;
    trial_begin(&t, &trial_block, false, flat, 1);
    ok(!trial_go(&t), "a spring that breaks the tissue is released: %s", t.b.e.text);
    ok(t.broke > 0 && t.restored == t.broke && t.b.frames == TRIAL_TICKS + 1, "it broke %d times, and all frames came",
       t.broke);
    bool finite = true;
    for (int64_t i = 0; i < 6 * t.b.problem.nodes; i++)
        finite = finite && isfinite(t.b.displacement[i]);
    ok(finite, "what they have is finite");
    trial_free(&t);
    trial_begin(&t, &trial_block, false, held, 1);
    ok(!trial_go(&t) && t.broke > 0 && t.b.frames == TRIAL_TICKS + 1, "a displacement that breaks it stops: %s",
       t.b.e.text);
    trial_free(&t);
    trial_begin(&t, &trial_block, false, fallen, 1);
    ok(!trial_go(&t) && t.broke == 2 && t.b.frames == TRIAL_TICKS + 1,
       "what goes on breaking it is forgotten, and it goes on from the beginning: %s", t.b.e.text);
    trial_free(&t);
}

int main(void)
{
    anew(&trial_block, trial_lines, &tled_cpu_double, false, "boxes, double");
    anew(&trial_block, trial_lines, &tled_cpu_single, false, "boxes, single");
    anew(&trial_block, trial_lines, &tled_cpu_meshes_double, true, "a mesh, double");
    trial_touch(true);
    anew(&trial_touching, trial_touching_lines, &tled_cpu_double, false, "skin and sliding nodes, double");
    trial_touch(false);
    kept();
    breaks();
    return done_testing();
}
