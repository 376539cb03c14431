/* Where a run's energy comes from and goes: what the tissue holds, and the work done since the run began by gravity,
 * forces, prescribed displacements, muscles, a probe and damping. An account looks at a state from outside, in double
 * on this machine's threads, whatever the back end, and changes nothing of the run. Work between two looks goes by the
 * mean of the forces at both, times the way between them: so the nearer looks are to each other, the better the sums
 * balance. Sums go by chunks in a fixed order: the same bytes for any number of threads. The creator owns the account.
 */
#ifndef SINEW_ACCOUNT_H
#define SINEW_ACCOUNT_H

#include "tled/problem/tled_executor.h"
#include "tled/run/strained.h"

typedef struct account_sums {
    double time;     /* s */
    double kinetic;  /* J: held now */
    strained tissue; /* the energy that elements hold now, and which of them are folded */
    double gravity, forces, held, muscles,
        probe;                  /* J: work done on the tissue since the first look; held: by what is displaced */
    double damping;             /* J: taken by it since */
    double balance;             /* J: what is held, less what was held at first and came since: 0 but for errors */
    double displacement, speed; /* m, m/s: the largest */
    double acceleration; /* m/s2: of the forces out of balance, root mean square over the mass where nothing holds */
} account_sums;

/* What an account knows of a run but for the state: what was held at first, and the work since, J. */
typedef struct account_past {
    double first, gravity, forces, held, muscles, probe, damping;
} account_past;

typedef struct account account;

account *account_create(const tled_problem *p, pool *threads, err *e);
void account_destroy(account *a);

/* Looks at the state, which stands at `time`; damping (1/s): on the way to it. What it finds is borrowed until the next
 * look. NULL with e filled where the back end fails. */
const account_sums *account_look(account *a, const tled_executor *b, tled_state *state, double time, double damping,
                                 err *e);

/* Of the last look, nodes x 3, m; borrowed until the next. */
const double *account_displacement(const account *a);

/* Keeps what is known now, for a run that goes back; and goes back to it. */
void account_keep(account *a);
void account_back(account *a);

/* For a run that is to be gone on with: what is known; and goes on from it, at the state
 * that it was known at. -1 with e filled. */
account_past account_past_of(const account *a);
int account_go_on(account *a, const tled_executor *b, tled_state *state, double time, const account_past *past, err *e);

#endif
