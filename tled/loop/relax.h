/* How a run comes to rest: the frequency of what still moves, guessed from two states by Rayleigh's
 * quotient; from that the mass damping that is soonest at rest (dynamic relaxation, Underwood 1983), and how
 * far the tissue has still to go. Owns nothing.
 */
#ifndef SINEW_RELAX_H
#define SINEW_RELAX_H

#include "tled/loop/monitor.h"

/* The damping of a run that adapts it, in parts of the frequency; 2 is critical. From a distance of 1 to one of 1e-4 a
 * critically damped motion takes 11.8 of its radians, one with this damping at most 11.4. */
#define RELAX_DAMPING 1.75

typedef struct relax {
    double guess;     /* rad/s: the lowest frequency, before anything moves */
    double low, high; /* rad/s: bounds of `frequency` */
    double frequency; /* rad/s: of the last motion; the guess before there is any */
    double lowest;    /* rad/s: of the guess and of any motion in about the last period */
    double time;      /* s: of the state before */
    int states;       /* how many states it was updated with; 2: or more */
} relax;

/* A guess of the lowest frequency: that of a column of the slowest shear waves, w = (pi/2) c / L, c the least of
 * sqrt(mu/rho), L the model's reach (support.h). Critical damping is 2 w. */
double relax_guess(const tled_problem *p, double reach);

/* stable: the stable step at rest (s). */
relax relax_of(double guess, double stable);

/* Takes a reading of the state: w^2 = du . df / (du . M du) over what is free, where du is the displacement, and df the
 * change of the internal forces, since the state that the monitor saved. */
void relax_update(relax *r, const monitor_reading *s);

/* How far the tissue has still to go, as a share of what it has moved, or of 1/100 of the most that it had, for what is
 * let go. The way is |a| / w^2 and |v| / w in one root (m, root mean square over the mass), as of an oscillator out of
 * balance by a and moving at v; w is the lowest frequency, since at a turning point the slowest does not show. Infinite
 * until two states are known, unless nothing moves. */
double relax_share(const relax *r, const monitor_reading *s);

#endif
