/* What makes muscles contract: for each, its contraction centre, the mean place of its rigid nodes (W&M section 3), and in
 * each of its elements the direction of its fibres.
 */
#ifndef SINEW_MUSCLE_H
#define SINEW_MUSCLE_H

#include "model/model.h"

typedef enum muscle_fibre {
    MUSCLE_CENTRE, /* from the element's centre toward the contraction centre */
    MUSCLE_AXIS    /* along the muscle's longest axis, the principal one of its elements' centres */
} muscle_fibre;

typedef struct muscle {
    const char *name; /* borrowed from volume.name */
    int32_t volume;
    int64_t elements, rigid_nodes;
    double centre[3]; /* contraction centre, m; nan where it has none */
    double middle[3]; /* the mean of its elements' centres */
    double axis[3];   /* unit; toward the contraction centre where there is one; 0 0 0 where no axis is the longest */
} muscle;

/* Makes the axis muscle with muscle.volume and muscle.centre, and element.fibre, in place of those that are there, from
 * node.rigid and the volumes that are muscles. An element that lies at the contraction centre gets the axis. Notes the
 * muscles that can have no centre or no fibres. *list (muscles of them, *count) is the caller's to free. */
int muscle_make(model *m, muscle_fibre fibre, muscle **list, int64_t *count, notes *warnings, err *e);

#endif
