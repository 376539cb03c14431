/* The wall's clock of a live run: when its next tick is due, how the model's time keeps up, how far frames are behind
 * the poses that they show. Owns nothing.
 */
#ifndef SINEW_LIVE_CLOCK_H
#define SINEW_LIVE_CLOCK_H

#include <stdint.h>

enum { LIVE_CLOCK_BINS = 400, LIVE_CLOCK_TEXT = 200 };

typedef struct live_clock {
    double each;     /* s: between ticks */
    double began;    /* s, by clock_now, as are all that follow */
    double due;      /* the next tick */
    double modelled; /* s of the model's time since then */
    int64_t frames;
    int64_t shown;                /* frames that showed a new pose */
    int64_t lag[LIVE_CLOCK_BINS]; /* how many of these were late by so much, in steps of a twentieth */
    double worst;                 /* s */
} live_clock;

/* Begins now. rate: ticks a second. */
void live_clock_begin(live_clock *c, double rate);

/* s since the beginning. */
double live_clock_now(const live_clock *c);

/* A tick is done, whose frame took the model on by `step` s: the next is due one interval after this one was, or, where
 * that is past already, at once; what was missed is not made up for. After a frame that came before its tick it is due
 * one interval after that. */
void live_clock_tick(live_clock *c, double step);

/* A tick passes without a frame. */
void live_clock_pass(live_clock *c);

/* A frame that shows a pose which came at `came` has been written. */
void live_clock_showed(live_clock *c, double came);

/* s: the lag that a share (0 to 1) of the frames with a new pose did not exceed, to 5 %; 0: there were none. */
double live_clock_lag(const live_clock *c, double share);

/* Seconds of the model's time to one of the wall's. */
double live_clock_ratio(const live_clock *c);

/* Where the model's time went on, its ratio is told too:
 * "600 frames in 10.0 s, real time x 1.00; lag of 580 poses: median 3.1 ms, 95 % 5.2 ms, largest 9 ms". */
void live_clock_text(const live_clock *c, char text[LIVE_CLOCK_TEXT]);

#endif
