/* The nodes that a probe presses, as the FEM wants them: each is kept on its side of the plane that touches the probe
 * where the node came out, and slides along it freely. The creator owns it; what it allocates it allocates at once.
 */
#ifndef SINEW_CONTACTS_H
#define SINEW_CONTACTS_H

#include "base/pool.h"
#include "msds/cpu/lanes.h"

typedef struct contact {
    int32_t node;   /* the model's */
    double way[3];  /* unit: out of the probe */
    double depth;   /* m: how far it has to go that way; below 0: how far it may come */
    double from[3]; /* m: its displacement where depth was found */
    double force;   /* N: what it is pushed with, along way */
    bool active;    /* tissue.h: it is held on its plane, */
    bool meets;     /* or comes to it now */
    double pull;    /* N: by what would pull it off; below 0: press it on */
    double grip;    /* N/m: of the spring of friction (grips.h); 0: none; */
    double to[3];   /* m: the displacement that it pulls to, along the plane; */
    double drag[3]; /* N: and what it pulls with after a step */
} contact;

/* How far u, the model's nodes x 3, moves a contact's node along its way. */
static inline double contacts_along(const contact *c, const double *u)
{
    const double *own = u + 3 * (int64_t)c->node;
    double sum = 0;
    for (int a = 0; a < 3; a++)
        sum += c->way[a] * own[a];
    return sum;
}

typedef struct contacts {
    contact *list;
    int64_t count;
    double
        *held; /* the model's nodes: the force of the frame before, -1 where listed without one, 0 where not listed */
    int32_t *found;  /* our nodes: those in the ball, by chunks */
    int64_t *amount; /* chunks: how many */
} contacts;

/* Which nodes: PRESSED, those inside the probe, or pressed by it in the frame before and no farther than a 50th of
 * the probe's size; NEAR, all within a tenth. */
typedef enum contacts_rule { CONTACTS_PRESSED, CONTACTS_NEAR } contacts_rule;

int contacts_make(contacts *c, const sell *s, int64_t nodes, err *e);
void contacts_free(contacts *c);

/* Lists them, in the solver's order, with the forces of the frame before; w has the probe and the displacements,
 * or u (the model's nodes x 3) has these to more digits. */
void contacts_find(contacts *c, const lanes *loops, lanes_springs *w, const msds_problem *p, const double *u,
                   pool *threads, contacts_rule rule);

/* Notes the forces, for the next frame. */
void contacts_hold(contacts *c, const msds_problem *p);

/* Whether a node that is not listed is deeper in the probe than this, m; u as above. Notes the forces too. */
bool contacts_missed(contacts *c, const lanes *loops, lanes_springs *w, const msds_problem *p, const double *u,
                     pool *threads, double depth);

/* How many nodes were pressed in the frame before. */
int64_t contacts_held(const contacts *c, const msds_problem *p);

/* The force on the probe, N, and how many nodes it presses. */
int64_t contacts_sum(const contacts *c, double force[3]);

/* The torque of those forces, N m; w has the probe and the displacements, or u as above. */
void contacts_twist(const contacts *c, const lanes_springs *w, const msds_problem *p, const double *u,
                    double torque[3]);

#endif
