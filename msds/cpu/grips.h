/* Coulomb friction between the probe and the nodes that it presses, for iterative solvers of finite elements: where a
 * node is first pressed, it takes hold of the probe. A spring along the probe's surface pulls it to where that place of
 * the probe is now, with the contact stiffness of the node (msds_problem.repulsion): it sticks, but for the spring's
 * stretch. It pulls with no more than mu times what the probe pressed the node with in the round before; and after a
 * step the place that is held comes after the node as far as the spring is stretched beyond that: it slipped. Without
 * friction all of this does nothing. The creator owns it; what it allocates it allocates at once.
 */
#ifndef SINEW_GRIPS_H
#define SINEW_GRIPS_H

#include "msds/cpu/contacts.h"

typedef struct grips {
    double *hold;  /* the model's nodes x 3: the place, in the probe's frame, m */
    uint8_t *is;   /* the model's nodes: it holds one */
    int32_t *node; /* those that do */
    int64_t count;
} grips;

int grips_make(grips *g, int64_t nodes, err *e);
void grips_free(grips *g);

/* Lets all nodes go. */
void grips_clear(grips *g);

/* Gives the contacts that were just found, at displacements `from`, their springs: to and grip. */
void grips_take(grips *g, contacts *c, const msds_problem *p, const probe_placed *at);

/* After a step, whose displacements are u, of our nodes: who is pressed takes hold, who is not lets go. */
void grips_keep(grips *g, const contacts *c, const msds_problem *p, const lanes_springs *w);

#endif
