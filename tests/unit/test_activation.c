/* Activations against the closed forms of their equation, against printed figures, and against Runge-Kutta steps. */
// needs: tled/muscle/activation.c
#include "tled/muscle/activation.h"

#include "tap.h"

static const activation_times usual = {.01, .04};

/* t of a rise from `from` to a with level u: both sides of (.5 + 1.5 a) / (u - a) da = dt / rise. */
static double rise_time(double u, double from, double a)
{
    return usual.rise * (-1.5 * (a - from) - (.5 + 1.5 * u) * log((u - a) / (u - from)));
}

/* The same of a fall: da / ((u - a) (.5 + 1.5 a)) = dt / fall, by partial fractions. */
static double fall_time(double u, double from, double a)
{
    return usual.fall / (.5 + 1.5 * u) * log((.5 + 1.5 * a) / (.5 + 1.5 * from) * (from - u) / (a - u));
}

static void make(activation *a, const activation_span *spans, int count, double last, err *e)
{
    int failed = activation_begin(a, spans[0].from, 0, e);
    for (int i = 0; i < count && !failed; i++)
        failed = activation_follow(a, &usual, &spans[i], e);
    failed = failed || activation_settle(a, &usual, last, e);
    ok(!failed, "an activation of %d spans: %lld nodes %s", count, (long long)a->nodes, e->text);
}

/* Level 1 for .1 s, then 0: the closed forms to 1e-7, whose values are these; and figures that somebody printed from
 * steps of 10 us by Euler's method, which are .00027 too large at first. */
static void printed(void)
{
    static const double at[][3] = {{.01, .618623, .61889}, {.02, .797765, .79793}, {.05, .960046, .96009},
                                   {.1, .996810, .99682},  {.12, .467244, .4673},  {.15, .223266, .2233},
                                   {.2, .091137, .0911}};
    activation a = {0};
    err e = {0};
    make(&a, &(activation_span){0, .1, {1, 0, 0, 0}}, 1, 0, &e);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++)
        near_(activation_at(&a, at[i][0]), at[i][1], 6e-7, "level 1 to .1 s, then 0, at %g s", at[i][0]),
            near_(activation_at(&a, at[i][0]), at[i][2], 3e-4, "near the figure of Euler's steps");
    near_(activation_at(&a, -1), 0, 0, "nothing before");
    near_(activation_at(&a, 10), 0, 0, "and nothing in the end, exactly");
    ok(activation_end(&a) > .5 && activation_end(&a) < 2, "it is over at %g s", activation_end(&a));
    ok(a.nodes < 600, "%lld nodes", (long long)a.nodes);
    activation_free(&a);
}

static void closed_forms(void)
{
    activation a = {0};
    err e = {0};
    double worst = 0;
    make(&a, &(activation_span){2, 2.3, {.7, 0, 0, 0}}, 1, .2, &e);
    for (int i = 1; i < 1000; i++) {
        const double value = .7 * i / 1000 * .999;
        worst = fmax(worst, fabs(activation_at(&a, 2 + rise_time(.7, 0, value)) - value));
    }
    near_(worst, 0, 3e-7, "a rise is its closed form");
    const double top = activation_at(&a, 2.3);
    worst = 0;
    for (int i = 1; i < 1000; i++) {
        const double value = top - (top - .2) * i / 1000 * .999;
        worst = fmax(worst, fabs(activation_at(&a, 2.3 + fall_time(.2, top, value)) - value));
    }
    near_(worst, 0, 3e-7, "a fall is its closed form");
    near_(activation_at(&a, 9), .2, 0, "a level that stays is reached");
    activation_free(&a);
}

static double slope(double level, double value)
{
    const double gap = level - value, factor = .5 + 1.5 * value;
    return gap > 0 ? gap / (usual.rise * factor) : gap * factor / usual.fall;
}

/* A level that goes up, stays and goes down by curves, by steps of Runge-Kutta's method of 10 us. */
static void by_runge_kutta(void)
{
    const activation_span spans[] = {
        {0, .03, {0, 20, 0, 0}}, {.03, .05, {.6, 0, 0, 0}}, {.05, .15, {.6, 0, -180, 1200}}, {.15, .2, {0, 0, 400, 0}}};
    const double h = 1e-5;
    double value = 0, worst = 0;
    activation a = {0};
    err e = {0};
    make(&a, spans, 4, 1, &e);
    for (int i = 0; i < 20000; i++) {
        int k = 0;
        while (spans[k].until < (i + .5) * h)
            k++;
        const double s = i * h - spans[k].from, *c = spans[k].c;
        double level[3];
        for (int j = 0; j < 3; j++) {
            const double t = s + j * h / 2;
            level[j] = fmin(fmax(c[0] + t * (c[1] + t * (c[2] + t * c[3])), 0), 1);
        }
        const double k1 = slope(level[0], value), k2 = slope(level[1], value + h / 2 * k1);
        const double k3 = slope(level[1], value + h / 2 * k2), k4 = slope(level[2], value + h * k3);
        value += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        worst = fmax(worst, fabs(activation_at(&a, (i + 1) * h) - value));
    }
    near_(worst, 0, 1e-6, "levels that change all the time");
    activation_free(&a);
}

/* Nodes are few also where times are short for the level, or long. */
static void extremes(void)
{
    const activation_times times[] = {{1e-4, 1e-4}, {1e-4, 100}, {100, 1e-4}, {100, 100}};
    for (int i = 0; i < 4; i++) {
        activation a = {0};
        err e = {0};
        bool sound = true;
        const activation_span up = {0, 1e5, {0, 1e-5, 0, 0}}, down = {1e5, 1e5 + 1, {1, -1, 0, 0}};
        ok(!activation_begin(&a, 0, 0, &e) && !activation_follow(&a, &times[i], &up, &e) &&
               !activation_follow(&a, &times[i], &down, &e) && !activation_settle(&a, &times[i], 0, &e),
           "rise %g s, fall %g s: %s", times[i].rise, times[i].fall, e.text);
        ok(a.nodes < 1000, "%lld nodes", (long long)a.nodes);
        for (int64_t n = 1; n < a.nodes; n++)
            sound &= a.node[n].time > a.node[n - 1].time && a.node[n].value >= 0 && a.node[n].value <= 1;
        ok(sound, "times rise, values from 0 to 1");
        if (times[i].rise < 1 && times[i].fall < 1)
            near_(activation_at(&a, 5e4), .5, 1e-6, "it follows a slow level");
        activation_free(&a);
    }
}

/* At times whose digits have no room for a step. */
static void late(void)
{
    activation a = {0};
    err e = {0};
    const activation_span spans[] = {{1e17, 2e17, {0, 1e-17, 0, 0}}, {2e17, 1e300, {.3, 0, 0, 0}}};
    make(&a, spans, 2, .5, &e);
    near_(activation_at(&a, 1e18), .3, 1e-12, "an activation is its level there");
    near_(activation_at(&a, 1e301), .5, 0, "and at the end");
    activation_free(&a);
}

int main(void)
{
    late();
    printed();
    closed_forms();
    by_runge_kutta();
    extremes();
    return done_testing();
}
