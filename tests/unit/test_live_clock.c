/* The clock of live runs: when ticks are due, whatever was early or late; how lags are counted; what is told. */
#include "base/clock.h"
#include "live/live_clock.h"

#include "tap.h"

#include <math.h>
#include <string.h>

static void ticks(void)
{
    live_clock c;
    live_clock_begin(&c, 50);
    ok(c.each == .02 && c.due <= clock_now(), "the first tick is due at the beginning");
    const double first = c.due;
    live_clock_tick(&c, 0);
    ok(c.due >= first + .02 - 1e-12, "the next, one interval after it");
    for (int i = 0; i < 100; i++)
        live_clock_tick(&c, 0);
    ok(c.due <= clock_now() + .02, "frames that come before their ticks do not put the next one off");
    c.due = clock_now() - 7;
    live_clock_tick(&c, 0);
    ok(fabs(c.due - clock_now()) < 1, "what was missed is not made up for");
    ok(c.frames == 102, "frames are counted");
    live_clock_pass(&c);
    ok(c.frames == 102 && c.due > clock_now() - 1, "a tick without one is not");
}

static void lags(void)
{
    char text[LIVE_CLOCK_TEXT];
    live_clock c;
    live_clock_begin(&c, 60);
    live_clock_tick(&c, 0);
    live_clock_text(&c, text);
    ok(strstr(text, "1 frames in ") && !strstr(text, "real time") && !strstr(text, "lag"), "%s", text);
    ok(live_clock_lag(&c, .5) == 0, "no lag without poses");
    for (int i = 0; i < 100; i++)
        live_clock_showed(&c, clock_now() - (i < 90 ? 1 : 20));
    const double median = live_clock_lag(&c, .5), most = live_clock_lag(&c, .95);
    ok(median > .9 && median < 1.2, "the median of lags: %g", median);
    ok(most > 19 && most < 22, "and their 95 %%: %g", most);
    live_clock_tick(&c, 1e6);
    live_clock_text(&c, text);
    ok(strstr(text, "of real time; lag of 100 poses: median 1.0"), "%s", text);
}

static void sleeps(void)
{
    const struct timespec t = clock_timespec(3.25), most = clock_timespec(nextafter(5, 0));
    ok(t.tv_sec == 3 && t.tv_nsec == 250000000, "seconds and a fraction");
    ok(most.tv_sec == 4 && most.tv_nsec == 999999999, "the fraction stays below a second");
    const double before = clock_now();
    clock_sleep(-1e300);
    clock_sleep(0);
    clock_sleep(.01);
    ok(clock_now() - before >= .0099, "a sleep is not shorter than asked, and none below 0 fails");
}

int main(void)
{
    sleeps();
    ticks();
    lags();
    return done_testing();
}
