/* Seconds of a clock that only goes forward, from a beginning of its own: for how long something takes, not for when it
 * was.
 */
#ifndef SINEW_CLOCK_H
#define SINEW_CLOCK_H

#include <time.h>

double clock_now(void);

/* Seconds, not below 0, as the system's calls take them. Those of clock_now are a time of CLOCK_MONOTONIC. */
struct timespec clock_timespec(double seconds);

/* Sleeps for so many seconds; not at all for 0 or less. A signal that this thread handles ends the sleep early. */
void clock_sleep(double seconds);

#endif
