/* Levels of muscles in a script: tracks that are smooth between rows, spans of levels, sums of expressions, and
 * activations as the values of curves, also of lines that come live. */
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
#include "tled/problem/script.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* Muscles a, b and c, all of one material. */
static void make_model(model *m, err *e)
{
    static const char *const volume[] = {"muscle_a", "muscle_b", "c"};
    *m = (model){0};
    model_axis_add(m, "volume", 3, e);
    model_axis_add(m, "material", 1, e);
    model_add(m, "volume.name", e);
    model_add(m, "volume.material", e);
    model_add(m, "material.peak", e)->f64[0] = 1;
    uint8_t *muscle = model_add(m, "volume.muscle", e)->u8;
    for (int i = 0; i < 3; i++)
        model_set_text(model_find(m, "volume.name"), i, volume[i], e), muscle[i] = 1;
}

static in *text_of(const char *text, err *e)
{
    return in_memory(text, strlen(text), "t.txt", e);
}

static void read_track(script *s, const model *m, const char *text, bool smooth, err *e)
{
    in *source = text_of(text, e);
    ok(source && !script_read_track(s, source, m, smooth, e), "a track: %s", e->text);
    in_close(source);
}

static void read_expressions(expressions *x, const model *m, const char *text, err *e)
{
    in *source = text_of(text, e);
    ok(source && !expressions_read(x, source, m, e), "expressions: %s", e->text);
    in_close(source);
}

static double now(const script *s, int64_t curve, double time)
{
    double value[30];
    script_values(s, time, value);
    return value[3 * curve];
}

/* Through its rows, without a corner, never past them; and what activations are solved of is the same. */
static void smooth(const model *m)
{
    static const double want[] = {0, 1, .2, .2, .7, 1};
    script s = {0};
    err e = {0};
    read_track(&s, m, "time\ta\n0\t0\n1\t1\n1.5\t.2\n2\t.2\n3\t.7\n5\t1\n", true, &e);
    static const double time[] = {0, 1, 1.5, 2, 3, 5};
    for (int i = 0; i < 6; i++)
        near_(now(&s, 0, time[i]), want[i], 1e-15, "the row at %g s", time[i]);
    double corner = 0, outside = 0, apart = 0;
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 1000; k++) {
            const double h = (time[i + 1] - time[i]) / 1000, t = time[i] + k * h;
            const double value = now(&s, 0, t), low = fmin(want[i], want[i + 1]), high = fmax(want[i], want[i + 1]);
            outside = fmax(outside, fmax(low - value, value - high));
            if (k)
                corner = fmax(corner, fabs(now(&s, 0, t + h) - 2 * value + now(&s, 0, t - h)) / (h * h));
            activation_span span = {.from = t};
            script_add_span(&s, &s.curve[0], 1, &span);
            const double half = h / 2;
            apart = fmax(apart, fabs(span.c[0] - value));
            apart = fmax(apart, fabs(span.c[0] + half * (span.c[1] + half * (span.c[2] + half * span.c[3])) -
                                     now(&s, 0, t + half)));
        }
    near_(outside, 0, 0, "never past its rows");
    near_(now(&s, 0, 1.75), .2, 0, "level where they are");
    ok(corner < 30, "no corner within: its second derivative is %g 1/s2 at most", corner);
    near_(now(&s, 0, 2.999999) - now(&s, 0, 2.999998), now(&s, 0, 3.000002) - now(&s, 0, 3.000001), 1e-11,
          "nor at a row");
    near_(apart, 0, 1e-12, "spans are the same curve");
    near_(now(&s, 0, 9), 1, 0, "the last row holds");
    script_free(&s);
}

/* Rise and fall as the values of curves; sums of expressions, at most 1. */
static void followed(const model *m)
{
    script s = {.times = {.01, .04}};
    expressions x = {0};
    err e = {0};
    notes warnings = {0};
    read_expressions(&x, m, "e: a=.5 b=1\nf: muscle_b=.75 c=.5\n", &e);
    s.expressions = &x;
    read_track(&s, m, "time\t@e\t@f\ta\n0\t1\t1\t.5\n.1\t1\t1\t.5\n.100000001\t0\t0\t0\n", false, &e);
    ok(!script_check_levels(&s, m, &warnings, &e) && s.terms == 4, "its activations: %s", e.text);
    ok(warnings.count == 1 && strstr(warnings.line[0], "of muscle_b add up to 1.75"), "%s", warnings.line[0]);
    int64_t curve[3] = {-1, -1, -1};
    for (int64_t i = 0; i < s.curves; i++)
        if (s.curve[i].verb == SCRIPT_CONTRACT)
            curve[s.curve[i].volume] = i;
    near_(script_level_at(&s, curve[0], .05), 1, 0, "a: .5 of its own and .5 of @e");
    near_(script_level_at(&s, curve[1], .05), 1, 0, "b: 1.75 is 1");
    near_(script_level_at(&s, curve[2], .05), .5, 0, "c: .5 of @f");
    for (int i = 0; i < 2; i++) {
        near_(now(&s, curve[i], .01), .618623, 6e-7, "it rises as it should");
        near_(now(&s, curve[i], .15), .223266, 2e-6, "and falls");
    }
    ok(script_end(&s) > .5, "it is over with the last activation, at %g s", script_end(&s));
    notes_free(&warnings);
    script_free(&s);
    expressions_free(&x);
}

static int take(script *s, const model *m, const char *line, double time, err *e)
{
    char text[80];
    bool anew = false;
    keyfile k = {.name = "live"};
    const script_now at = {time, time + .01, NULL};
    snprintf(text, sizeof text, "%s", line);
    keyfile_take(&k, text, (int64_t)strlen(text), 1, e);
    return script_take_now(s, m, &k, &at, &anew, e) || anew ? -1 : 0;
}

/* Lines that come live go on from where activations are then; what is forgotten is 0. */
static void live(const model *m)
{
    script s = {.times = {.01, .04}};
    expressions x = {0};
    err e = {0};
    read_expressions(&x, m, "e: a=1 b=.5\n", &e);
    s.expressions = &x;
    ok(!script_add_idle(&s, m, &e) && s.curves == 5 && s.terms == 2, "gravity, three muscles, an expression: %s",
       e.text);
    ok(!take(&s, m, "now contract @e 1", 1, &e), "an expression: %s", e.text);
    near_(now(&s, 1, 1), 0, 0, "nothing at once");
    near_(now(&s, 1, 1.05), .960046, 6e-7, "it rises");
    ok(!take(&s, m, "now contract @e 0", 1.1, &e), "and ends");
    near_(now(&s, 1, 1.15), .223266, 2e-6, "it falls from where it was");
    ok(!take(&s, m, "now contract * .5", 1.15, &e), "all muscles: %s", e.text);
    near_(now(&s, 1, 1.15), .223266, 2e-6, "it goes on from there");
    near_(now(&s, 3, 3), .5, 0, "and each comes to its level");
    ok(take(&s, m, "now contract @f 1", 2, &e) == -1 && strstr(e.text, "unknown expression 'f'"), "%s", e.text);
    const script_now at = {3, 3.01, NULL};
    script_forget_all(&s, &at);
    near_(now(&s, 1, 3), 0, 0, "what is forgotten is 0 at once");
    near_(now(&s, 1, 9), 0, 0, "and stays so");
    script_free(&s);
    expressions_free(&x);
}

int main(void)
{
    model m;
    err e = {0};
    make_model(&m, &e);
    if (!ok(!e.status, "a model: %s", e.text))
        return done_testing();
    smooth(&m);
    followed(&m);
    live(&m);
    model_free(&m);
    return done_testing();
}
