/* What a run has to say of its elements once it is over, from the frames that it wrote: the smallest J, how many
 * elements are folded and where, and how much of the energy hourglass control holds. The creator owns it; problem and
 * model are borrowed.
 */
#ifndef SINEW_FOLDS_H
#define SINEW_FOLDS_H

#include "model/model.h"
#include "tled/loop/strained.h"

typedef struct folds {
    const tled_problem *p;
    const model *m;
    pool *threads; /* its own: it reads frames while the run goes on */
    strained *part;
    strained last;          /* of the frame seen last; */
    bool has_energies;      /* not its quality alone */
    int64_t frames, folded; /* seen; with a folded element */
    double time;            /* s: of the last */
    strained worst;         /* of the frame whose J at a corner is the smallest; its energies if elements are folded */
    double worst_time;      /* s */
} folds;

enum { FOLDS_TEXT = 500 };

/* -1 with e filled, and to be freed all the same. */
int folds_make(folds *f, const tled_problem *p, const model *m, int threads, err *e);
void folds_free(folds *f);

/* Adds a frame: displacement, nodes x 3, m; its energies are left for the last. Not in two threads at once. */
void folds_add(folds *f, double time, const double *displacement);

/* Adds the energies of the frame seen last, so that they can be told. */
void folds_end(folds *f, const double *displacement);

/* The last frame in a line; where the run did not come to its end, also when that is. */
void folds_text(const folds *f, bool ended, char text[FOLDS_TEXT]);

/* What is folded, in the last frame and on the way; and where hourglass energy is past QUALITY_HOURGLASS of strain
 * energy, or of 1/100 of the most that there was (J), for what is let go. */
void folds_warn(const folds *f, bool ended, double most_strain, notes *warnings);

#endif
