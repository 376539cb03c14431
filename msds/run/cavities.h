/* The cavities of a run: what --cavity, --outflow and --wall say of volumes of the model, as lists NAME=VALUE,... . The
 * session owns it; it allocates nothing.
 */
#ifndef SINEW_CAVITIES_H
#define SINEW_CAVITIES_H

#include "model/model.h"
#include "msds/problem/problem.h"

enum { CAVITIES_MOST = 64 };

typedef struct cavities {
    msds_cavity list[CAVITIES_MOST];
    int count;
} cavities;

/* What is said on the command line; each text may be NULL. */
typedef struct cavities_said {
    const char *pressure, *outflow, *wall;
} cavities_said;

/* Reads them for the volumes of m, each of which must have elements. -1 with e filled. */
int cavities_read(cavities *c, const cavities_said *said, const model *m, err *e);

/* Gives cavities that are there other pressures, from now on: NAME=PRESSURE,... . -1 with e filled, and all is as it
 * was. */
int cavities_change(cavities *c, const char *pressures, const model *m, err *e);

/* The problem's are these from here on, which must outlive it. */
void cavities_put(const cavities *c, msds_problem *p);

/* A fingerprint of their names, pressures at rest, resistances and walls, for a record; to: of `size` bytes. */
void cavities_text(const cavities *c, const model *m, char *to, size_t size);

#endif
