/* Adds to a model what its muscles contract by: the contraction centre of each muscle, which is the mean position of
 * its rigid nodes (W&M section 3), and the direction of the fibres in each of its elements.
 */
#ifndef SINEW_MUSCLE_H
#define SINEW_MUSCLE_H

#include "attachment.h"
#include "cli/opt.h"
#include "model/model.h"
#include "muscle_body.h"

/* The rules that give fibres (fibre_rule.h), in the order in which they are tried. */
typedef enum muscle_fibre {
    MUSCLE_ROUND,  /* along the line of a ring, or along an arc of a sphincter */
    MUSCLE_SHAPE,  /* along the gradient of a potential between the ends of its closed surface (muscle_shape.h) */
    MUSCLE_FIELD,  /* the same between the ends of its voxels (fibre_field.h) */
    MUSCLE_AXIS,   /* along the muscle's longest axis, the principal one of its elements' centres */
    MUSCLE_CENTRE, /* from the element's centre toward the contraction centre */
    MUSCLE_RULES
} muscle_fibre;

#define MUSCLE_RULE_NAMES "centre|axis|field|shape|round|auto"

typedef struct muscle {
    const char *name; /* borrowed from volume.name */
    int32_t volume;
    int asked; /* the rule that --fibre gives it, -1 = by default */
    muscle_fibre rule;
    bool is_ring;
    int64_t elements, rigid_nodes; /* elements: with those that it is the second volume of */
    int64_t by_axis;               /* elements whose fibre is along the axis because the rule asked for gives none */
    int64_t without;               /* elements without a fibre */
    int64_t still;                 /* elements whose nodes are all rigid */
    double weight;                 /* the sum of its shares of its elements */
    double centre[3];              /* contraction centre, m; nan where it has none */
    double middle[3];              /* the mean of its elements' centres, by enclosed share */
    double axis[3]; /* unit; toward the contraction centre where there is one; 0 0 0 where no axis is the longest */
} muscle;

typedef struct muscles {
    muscle *of;
    int64_t count;
    attachments attached;
    body *body; /* what they are computed from */
} muscles;

/* Makes the axis muscle with muscle.volume and muscle.centre, the axis attachment with attachment.muscle and its other
 * arrays, and element.fibre (and element.mixfibre where there is element.mix), of zeros yet (muscle_fibres.h), in place
 * of those that are there, from node.rigid (and node.anchor, element.fraction and element.mix, where there are any),
 * and the volumes that are muscles. asked: the values of --fibre. Spreads are weighted by its shares. The caller frees
 * the list, on failure too. */
int muscle_find(model *m, const opt_list *asked, muscles *list, notes *warnings, err *e);

/* Whether it has an element that has a fibre, and one that has a free node. */
static inline bool muscle_contracts(const muscle *m)
{
    return m->without < m->elements && m->still < m->elements;
}

void muscles_free(muscles *list);

#endif
