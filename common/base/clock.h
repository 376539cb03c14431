/* Seconds of a clock that only goes forward, from a beginning of its own: for how long something takes, not for when it
 * was.
 */
#ifndef SINEW_CLOCK_H
#define SINEW_CLOCK_H

double clock_now(void);

#endif
