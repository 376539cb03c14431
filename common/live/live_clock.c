#include "live/live_clock.h"

#include "base/clock.h"
#include "base/num.h"

#include <math.h>
#include <stdio.h>

/* Bin i holds lags from least 1.05^i on: 1 us to 300 s. */
static const double least = 1e-6, factor = 1.05;

void live_clock_begin(live_clock *c, double rate)
{
    const double now = clock_now();
    *c = (live_clock){.each = 1 / rate, .began = now, .due = now};
}

double live_clock_now(const live_clock *c)
{
    return clock_now() - c->began;
}

void live_clock_pass(live_clock *c)
{
    const double now = clock_now();
    c->due = num_clamp(c->due + c->each, now, now + c->each);
}

void live_clock_tick(live_clock *c, double step)
{
    c->frames++;
    c->modelled += step;
    live_clock_pass(c);
}

static int bin_of(double lag)
{
    const double bin = floor(log(lag / least) / log(factor));
    return (int)fmin(LIVE_CLOCK_BINS - 1, fmax(0, bin));
}

void live_clock_showed(live_clock *c, double came)
{
    const double lag = fmax(clock_now() - came, least);
    c->shown++;
    c->lag[bin_of(lag)]++;
    c->worst = fmax(c->worst, lag);
}

double live_clock_lag(const live_clock *c, double share)
{
    int64_t sum = 0;
    for (int i = 0; i < LIVE_CLOCK_BINS; i++) {
        sum += c->lag[i];
        if (sum && (double)sum >= share * (double)c->shown)
            return fmin(c->worst, least * pow(factor, i + 1));
    }
    return 0;
}

double live_clock_ratio(const live_clock *c)
{
    const double now = live_clock_now(c);
    return now > 0 ? c->modelled / now : 1;
}

void live_clock_text(const live_clock *c, char text[LIVE_CLOCK_TEXT])
{
    char ratio[40] = "", lag[120] = "";
    if (c->modelled > 0)
        snprintf(ratio, sizeof ratio, ", %.3g of real time", live_clock_ratio(c));
    if (c->shown)
        snprintf(lag, sizeof lag, "; lag of %lld poses: median %.3g ms, 95 %% %.3g ms, largest %.3g ms",
                 (long long)c->shown, 1e3 * live_clock_lag(c, .5), 1e3 * live_clock_lag(c, .95), 1e3 * c->worst);
    snprintf(text, LIVE_CLOCK_TEXT, "%lld frames in %.1f s%s%s", (long long)c->frames, live_clock_now(c), ratio, lag);
}
