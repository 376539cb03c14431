/* Nodes that slide on bone: a distance field of the bone, which moves with its body, keeps them as far from it as they
 * are at rest, or no nearer. With phi the distance, B the bone's motion and phi0 = phi(X), a node at x = X + u is off
 * by
 *     g = phi(B^-1 x) - phi0;
 * after the predictor it is put back along n = B grad phi, which leaves the stable step as it is:
 *     u -= g n,   v -= g n/dt.
 * The forces that push it into the bone, or pull it off where it may not lift, are borne by that: with a the
 * acceleration by all forces, its part along n is left out, and so is no part of v at the end of a step. What then
 * bears on the bone in a step is m (g/dt - a.n dt), and Coulomb friction takes at most mu times that of the velocity
 * relative to the bone, along it.
 *
 * phi is trilinear between samples at corners of voxels (slide.node, field.first, distance.value of the model); beyond
 * the field it goes on as in the nearest cell. Nodes that the script displaces do not slide in what it displaces.
 * All is computed in double, node by node (sliding_node.h): the same bytes for any number of threads. The creator owns
 * a sliding; it borrows the model.
 */
#ifndef SINEW_SLIDING_H
#define SINEW_SLIDING_H

#include "tled/contact/sliding_node.h"
#include "tled/problem/state.h"

typedef struct sliding {
    int64_t count; /* nodes */
    const int32_t *node, *of;
    const uint8_t *lifts; /* nodes: whether it may come off; NULL: none may */
    double *rest;         /* nodes, m: phi0 */
    int32_t *row;         /* of the model's nodes: which slides, or -1 */
    sliding_field *field;
    int64_t fields;
    const uint8_t *touches; /* fields: whether samples of skin may not enter it (self_contact.h); NULL: of none */
    const int32_t *body;    /* fields: the body that each moves with, or -1; NULL: none moves */
    char *const *name;      /* bodies */
    sliding_ground ground;
} sliding;

/* Makes s, of no nodes or no fields where the model has none; it is the problem's from then on where nodes slide. -1
 * with e filled, and s to be freed all the same. */
int sliding_make(sliding *s, tled_problem *p, const model *m, double friction, err *e);
void sliding_free(sliding *s);

/* Bodies that the script does not move stay where a frame, which the run begins from, has them (body.pose). */
void sliding_start(sliding *s, const frame *f);

/* Takes over which curves of the script move the bones. */
void sliding_follow(sliding *s, const script *of);

/* Samples of all fields. */
int64_t sliding_samples(const sliding *s);

/* Node row i, as the script has it now; and a field's bone, at the curves' values. */
sliding_node sliding_node_of(const tled_problem *p, int64_t i);
sliding_bone sliding_bone_at(const sliding *s, int32_t which, const double *value);

/* Of node row i; value: the curves'; displacement: of all nodes. */
sliding_load sliding_load_at(const tled_problem *p, int64_t i, const double *value, const double *displacement,
                             const double net[3]);

/* A node between two moments, and at them. */
typedef struct sliding_moment {
    const double *value, *displacement; /* as above */
    const sliding_load *load;           /* of node row i */
} sliding_moment;

/* The bone's work on it, J: of a node that slips, friction is mu times the mean of what presses it. */
double sliding_work(const tled_problem *p, int64_t i, const sliding_moment *was, const sliding_moment *is);

/* Of the nodes at these displacements (nodes x 3, m), the most that one is off (m, either way, or into the bone where
 * it may lift), and how many are beyond their field. */
double sliding_worst(const tled_problem *p, const double *value, const double *displacement, int64_t *beyond);

#endif
