/* What a run looks at now and then, from the state that its back end has reached: energies, forces out of balance, the
 * stable step in the configuration of now, elements that broke. In double whatever the back end, which either looks
 * itself or leaves it to this machine's threads. Sums go by chunks in a fixed order: the same bytes for any number of
 * threads. The creator owns the watch.
 */
#ifndef SINEW_WATCH_H
#define SINEW_WATCH_H

#include "tled/problem/tled_executor.h"

typedef struct watch_sight {
    double time;            /* s */
    double kinetic, strain; /* J; strain with hourglass energy, without what muscles do */
    /* Root mean squares over the mass: of the acceleration that the forces out of balance give (m/s2) and of the
     * velocity (m/s), both where nothing holds, and of the displacement (m). */
    double acceleration, speed, moved;
    double moved_most; /* the largest that this watch has seen */
    double stiffness;  /* J: with du, df what displacement and internal force changed by since watch_keep, du . df */
    double inertia;    /* kg m2: and du . M du, both where nothing holds */
    double largest;    /* m: displacement */
    double stable;     /* s: the stable step now, at most that at rest; within 1 %, or exactly */
    int64_t stable_element; /* whose it is, or -1: that at rest */
    int64_t broken;         /* an element that is inverted (J <= 0) or not a number, or -1 */
    bool inverted;          /* that it is: known here, and after watch_tell wherever */
} watch_sight;

typedef struct watch {
    const tled_problem *p;
    pool *threads;
    double rest_step;
    double raise;     /* 1.01: stable within 1 %, in one test for most elements; 1: exactly. The creator's to change */
    bool differences; /* stiffness and inertia are wanted. The creator's to change, before the first watch_keep */
    double *displacement, *velocity,
        *internal;                             /* nodes x 3: the state that was looked at last; NULL till needed here */
    double *kept_displacement, *kept_internal; /* nodes x 3: what watch_keep kept; likewise */
    double *curves;                            /* values at its time */
    struct watch_part *part;                   /* chunks */
    tled_question question;                    /* of the last look */
    watch_sight sight;
} watch;

watch *watch_create(const tled_problem *p, pool *threads, err *e);
void watch_destroy(watch *w);

/* Looks once more at the state that was looked at last, on this machine's threads: the element that is broken or has
 * the least stable step is then told by the model's order, whatever the back end. -1 with e filled. */
int watch_tell(watch *w, const tled_executor *b, tled_state *state, err *e);

/* Keeps the state that was looked at last: the back end to go back to, the watch to
 * tell differences. -1 with e filled. */
int watch_keep(watch *w, const tled_executor *b, tled_state *state, err *e);

/* Looks at the state, which stands at `time`: w->sight. -1 with e filled where the back end fails. */
int watch_look(watch *w, const tled_executor *b, tled_state *state, double time, err *e);

/* What keeps the stable step small, or broke, in words: an element, its volume and where it is at rest. */
void watch_words(const model *m, const watch_sight *s, char *to, size_t size);

#endif
