/* Skin that touches itself. Samples of it (contact.element, contact.weight of the model) are carried by their elements;
 * a sample that is found in another deformed element has a place there at rest, xi, and how far that place was from the
 * skin, phi(xi), trilinear between the nodes' distances (skin.node, skin.distance), tells how deep it is and the way
 * out:
 *     n = F^-T grad phi / |F^-T grad phi|,   g = phi/|F^-T grad phi|.
 * What is nearer than at rest, where skin may overlap as the model has it, is put back after the predictor. With N the
 * shares of the nodes of the sample's element and of the other, and p the parts of the two sides,
 *     u_i += p lambda N_i n,   v_i += beta p lambda N_i n/dt,   so that (sum_i N_i u_i) . n + g >= g0,
 * with the opposite sign on the other side; p are such that both have equal and opposite momentum (sum_i N_i m_i is the
 * mass of a side). Nodes thus share by their masses: a light one at the border of cut elements moves as its neighbours.
 * beta is the part of the depth that came in this step: what was there before is taken back without speed. Nothing
 * bounces, and the stable step stays. Coulomb friction takes, of the velocity along the skin, at most mu times what is
 * taken across it.
 *
 * All contacts of a step are solved at once by Jacobi's iteration; each goes so short a way, by the sums of the shares
 * at its nodes, that no number of samples at one place overshoots (as masses that are split between contacts: Tonge et
 * al. 2012, ACM Transactions on Graphics 31:105). A sample and an element that have a node in common are one piece and
 * do not touch.
 *
 * Bone that skin may not enter (contact_bone.h) is a side that nothing moves: the sample's takes it all.
 *
 * Skin may move blended, as it is drawn (mesh/motion.h): then N are the shares of all nodes that move a sample, or a
 * place in an element, so; and the place is the one that this takes to the sample (contact_blend.h).
 *
 * A table of where elements are, in cells of space, is made anew when any node has moved by more than its margin; which
 * contacts there are does not depend on when. All in double, in one order: the same bytes for any number of threads.
 * The creator owns a self_contact; it borrows the model.
 */
#ifndef SINEW_SELF_CONTACT_H
#define SINEW_SELF_CONTACT_H

#include "base/pool.h"
#include "tled/contact/deformed_place.h"
#include "tled/contact/sliding.h"
#include "tled/problem/state.h"

#define SELF_CONTACT_DEEP .1 /* of a shortest side: deeper than that at rest is worth a word */

enum { SELF_CONTACT_BESIDE = 64 /* elements that are kept of those beside one */ };

typedef struct self_contact {
    int64_t samples, elements, nodes; /* elements: that samples may be in; nodes: of these, and what moves samples */
    int32_t *node;                    /* nodes: of the model; all is owned */
    int32_t *sample_element;          /* samples: rows of `element` */
    int32_t *sample_start, *sample;   /* elements + 1; samples by the element that each is bound to, ascending */
    double *place;                    /* samples x 3: in its element, 0 to 1 along each axis in it */
    int32_t *lever_start;             /* samples + 1: of what moves each: */
    int32_t *lever_node;              /* rows of `node` */
    double *lever_share;              /* which sum to 1 */
    struct contact_blend *blend;      /* of skin that moves blended; NULL: with its element alone */
    int32_t *element;                 /* elements x 8: rows of `node` */
    deformed_factors *distance;       /* elements, m: phi */
    double *rest;                     /* samples, m: g0, at most 0 */
    int32_t *ring_start, *ring;       /* elements + 1; nodes of the elements about each, ascending */
    double side[3], shortest;         /* m: an element's sides, and the shortest of them */
    struct sliding *bones;            /* whose fields: */
    int32_t *solid;                   /* solids: those that skin may not enter */
    int32_t solids;
    double *bone_rest;    /* solids x samples, m: as rest */
    double friction;      /* mu */
    int64_t deep;         /* samples that are deeper than SELF_CONTACT_DEEP of that at rest */
    double deepest;       /* m: the most */
    int64_t deep_in_bone; /* and in bone */
    double deepest_in_bone;
} self_contact;

/* Makes c, of 0 samples where the model has none; it is the problem's from then on. bones: of the model, with their
 * fields. -1 with e filled, and c to be freed all the same. */
int self_contact_make(self_contact *c, tled_problem *p, const model *m, sliding *bones, double friction, pool *threads,
                      err *e);
void self_contact_free(self_contact *c);

/* What a step takes. The creator owns it. */
typedef struct self_contact_work self_contact_work;

/* NULL with e filled. */
self_contact_work *self_contact_room(const tled_problem *p, err *e);
void self_contact_room_free(self_contact_work *w);
int64_t self_contact_bytes(const self_contact_work *w);

/* Forgets what it knows from steps before: those from here on are as if it had been made now. */
void self_contact_forget(self_contact_work *w);

/* How many elements had more beside them, in any step so far, than a list keeps: of the others nothing was felt. */
int64_t self_contact_crowded(const self_contact_work *w);

/* Displacements of the nodes (nodes x 3), the caller's to fill after the predictor. */
double *self_contact_displacement(self_contact_work *w);

/* Finds what touches there, in a step from the curves' values `was` to `is`. Returns how many nodes are about that; row
 * k of them is node rows[k] of c->node. */
int32_t self_contact_find(self_contact_work *w, pool *threads, const double *was, const double *is,
                          const int32_t **rows);

/* Velocities of the nodes (nodes x 3): of those about contacts the caller's to fill. */
double *self_contact_velocity(self_contact_work *w);

/* Puts what touches back, in a step of dt: displacements and velocities of the nodes about contacts change. */
void self_contact_solve(self_contact_work *w, double dt);

#endif
