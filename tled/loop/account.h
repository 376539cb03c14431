/* Where a run's energy comes from and goes: what the tissue holds, and the work done since the run began by gravity,
 * forces, prescribed displacements, muscles, a probe and damping. It is computed from the executor's state in double,
 * on this machine's threads, and changes nothing of the run. The work between two readings is the mean of the forces at
 * both, times the displacement between them (the trapezoidal rule): the closer the readings, the better the balance.
 * Sums go by chunks in a fixed order: the same bytes for any number of threads. The creator owns the account.
 */
#ifndef SINEW_ACCOUNT_H
#define SINEW_ACCOUNT_H

#include "tled/loop/strained.h"
#include "tled/problem/bodies.h"
#include "tled/problem/tled_executor.h"

typedef struct account_sums {
    double time;     /* s */
    double kinetic;  /* J: held now */
    strained tissue; /* the energy that elements hold now, and which of them are folded */
    double gravity, forces, held, muscles,
        probe;                  /* J: work done on the tissue since the first reading; held: by what is displaced */
    double damping;             /* J: taken by it since */
    double balance;             /* J: what is held, less what was held at first and came since: 0 but for errors */
    int64_t falling;            /* elements in which the stress along a fibre falls as it is stretched */
    double displacement, speed; /* m, m/s: the largest */
    double acceleration; /* m/s2: of the forces out of balance, root mean square over the mass where nothing holds */
} account_sums;

/* What an account knows of a run but for the state: what was held at first, and the work since, J. */
typedef struct account_past {
    double first, gravity, forces, held, muscles, probe, damping;
} account_past;

typedef struct account account;

/* Whether a problem has muscles: volumes that contract, or have curves of their own. */
bool account_has_muscles(const tled_problem *p);

account *account_create(const tled_problem *p, pool *threads, err *e);
void account_destroy(account *a);

/* Reads the state, which stands at `time`; damping (1/s): of the steps since the reading before. The sums are borrowed
 * until the next reading. *there gets when the state had come, by the clock: steps may be under way before. NULL with e
 * filled where the executor fails. */
const account_sums *account_read(account *a, const tled_executor *b, tled_state *state, double time, double damping,
                                 double *there, err *e);

/* Of the last reading, nodes x 3, m, and the curves' values; borrowed until the next. */
const double *account_displacement(const account *a);
const double *account_curves(const account *a);

/* The same, and of muscles, as bodies are pulled by. */
bodies_state account_bodies(const account *a);

/* Saves the account of now, in memory; and goes back to the one that was saved. */
void account_save(account *a);
void account_restore(account *a);

/* For checkpoints: what the account knows; and an account that knows it, and has read the state of that check. -1 with
 * e filled. */
account_past account_past_of(const account *a);
int account_resume(account *a, const tled_executor *b, tled_state *state, double time, const account_past *past,
                   err *e);

#endif
