#include "base/clock.h"

#include <math.h>

double clock_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct timespec clock_timespec(double seconds)
{
    const double whole = floor(seconds);
    return (struct timespec){.tv_sec = (time_t)whole, .tv_nsec = (long)(1e9 * (seconds - whole))};
}

void clock_sleep(double seconds)
{
    const struct timespec time = clock_timespec(fmax(seconds, 0));
    if (seconds > 0)
        nanosleep(&time, NULL);
}
