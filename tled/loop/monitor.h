/* The monitor of a run: at each check it reads from the state of the executor the energies, the forces out of balance,
 * the stable step in the configuration of now, and which element broke. It computes in double, whatever the executor's
 * precision: on the device where the executor has a monitor of its own, else on this machine's threads. Sums go by
 * chunks in a fixed order: the same bytes for any number of threads. The creator owns the monitor.
 */
#ifndef SINEW_MONITOR_H
#define SINEW_MONITOR_H

#include "tled/problem/films.h"
#include "tled/problem/followers.h"
#include "tled/problem/tled_executor.h"

typedef struct monitor_reading {
    double time;            /* s */
    double kinetic, strain; /* J; strain with hourglass energy, without what muscles do */
    /* Root mean squares over the mass: of the acceleration that the forces out of balance give (m/s2) and of the
     * velocity (m/s), both where nothing holds, and of the displacement (m). */
    double acceleration, speed, moved;
    double moved_most; /* the largest that this monitor has seen */
    double stiffness;  /* J: with du, df what displacement and internal force changed by since monitor_save, du . df */
    double inertia;    /* kg m2: and du . M du, both where nothing holds */
    double largest;    /* m: displacement */
    double stable;     /* s: the stable step now, at most that at rest; within 1 %, or exactly */
    int64_t stable_element; /* whose it is, or -1: that at rest */
    int64_t broken;         /* an element that is inverted (J <= 0) or not a number, or -1 */
    bool inverted;          /* that it is: known here, and after monitor_locate wherever */
} monitor_reading;

typedef struct monitor {
    const tled_problem *p;
    pool *threads;
    double rest_step;
    double raise;     /* 1.01: stable within 1 %, in one test for most elements; 1: exactly. The creator's to change */
    bool differences; /* stiffness and inertia are wanted. The creator's to change, before the first monitor_save */
    double *displacement, *velocity, *internal;  /* nodes x 3: the state that was read last; NULL till needed here */
    double *saved_displacement, *saved_internal; /* nodes x 3: what monitor_save saved; likewise */
    double *curves;                              /* values at its time */
    struct monitor_part *part;                   /* chunks */
    followers_work followers;
    films_work films;
    double film_square;     /* 1/s2: of elements and films, of the state read last */
    double load_square;     /* 1/s2: what pressures raise the square of the frequency by */
    double spring_square;   /* 1/s2: and springs */
    tled_question question; /* of the last reading */
    monitor_reading reading;
} monitor;

monitor *monitor_create(const tled_problem *p, pool *threads, err *e);
void monitor_destroy(monitor *w);

/* Takes over what tled_problem_reload changed. -1 with e filled. */
int monitor_reload(monitor *w, err *e);

/* Reads the same state once more, on this machine's threads: the element that is broken or has the least stable step is
 * then the first in the model's order, whatever the executor. -1 with e filled. */
int monitor_locate(monitor *w, const tled_executor *b, tled_state *state, err *e);

/* Saves the state that was read last: in the executor, for a restore; here, to tell differences from. -1 with e
 * filled. */
int monitor_save(monitor *w, const tled_executor *b, tled_state *state, err *e);

/* Reads the state, which stands at `time`, into w->reading. -1 with e filled where the executor fails. */
int monitor_read(monitor *w, const tled_executor *b, tled_state *state, double time, err *e);

/* What keeps the stable step small, or broke, in words: an element, its volume and where it is at rest. */
void monitor_words(const model *m, const monitor_reading *s, char *to, size_t size);

#endif
