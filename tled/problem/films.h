/* Films of tissue on bone, which hold a model of attach --surface. A film has the gradient F of mesh/bone_films.h and
 * the energy A d W(F) of its element's law, its muscles and its fibres. F is linear in the displacements of the
 * element's corners, sum_a u_a (x) g_a and what the bone does; so a film's pull on these is the derivative of an
 * energy, A d P(F) g_a. Elements have what films leave them: their share, the moments of the rest and the weight go by
 * film.share, their mass is the whole.
 *
 * Against this, a spring (lambda + 2 mu) A/h at the bone's surface would yield as a further layer of tissue h thick
 * does: its error is of order 1.
 *
 * Forces join the elements' in the sums that a node's step takes, as a pressure's do (followers.h). All is computed in
 * double, film by film and node by node in one order: the same bytes for any number of threads and any precision.
 *
 * The stable step: node n bears of elements e at most sum_e l_e m_ne, l_e the squares of their frequencies and m_ne the
 * mass that they bring, and of films at most sum_i A d q_n sum_b q_b, q_a^2 the largest eigenvalue of g_a.(dP/dF).g_a.
 * Where L is no less than the sum of both over the node's mass, at all nodes, each element has with a part
 * l_e/L of its mass, and the films have with the rest, no frequency whose square is above L: so none has the model.
 * The problem owns its films; these borrow the model. */
#ifndef SINEW_FILMS_H
#define SINEW_FILMS_H

#include "base/pool.h"
#include "mesh/bone_films.h"
#include "tled/problem/state.h"

typedef struct films {
    bone_films rows;    /* owned, as is all but `whole` */
    film_rest rest;     /* what films leave of elements */
    const float *whole; /* elements: their share with films, or NULL: 1 */
    uint8_t *fibred;    /* films: whether its element has fibres, of either volume */
    int64_t nodes;
    int32_t *node;                  /* nodes: of the model, ascending, that films pull */
    int32_t *place;                 /* films x 8: a corner's among these */
    int32_t *pull_start, *pull;     /* nodes + 1; films x 8: 8 film + corner, ascending at each node */
    double *borne;                  /* nodes, 1/s2: of elements, over the mass */
    double taken;                   /* of all films' volume, that elements do not count as theirs */
    double elements_square, square; /* 1/s2: the largest of elements; of the model with films, at rest */
} films;

/* Takes shares and moments away from elements, where the model has films; of laminates, which have to be known by now,
 * shares alone. Then, where masses and laws are known, makes the films. -1 with e filled. */
int films_share(tled_problem *p, const model *m, err *e);
int films_make(tled_problem *p, err *e);
void films_free(films *f);

static inline int64_t films_count(const tled_problem *p)
{
    return p->films ? p->films->rows.count : 0;
}

/* What an element has of mass, in parts of its box, before any least. */
double films_whole(const tled_problem *p, int64_t element);

/* What forces are computed in. The creator owns it. */
typedef struct films_work {
    const tled_problem *p;
    const double *value; /* borrowed: the curves' values */
    double *moved;       /* nodes x 3, m: displacements, the caller's to fill */
    double *stress;      /* count x 9, Pa: P, a row after the other */
    double *stiffness;   /* count x 8, N/m: of each corner */
} films_work;

/* w for the films of a problem that may have none. -1 with e filled and w to be freed all the same. */
int films_room(films_work *w, const tled_problem *p, err *e);
void films_room_free(films_work *w);
int64_t films_bytes(const films *f);

/* Computes what films pull with where w->moved has their nodes; then the sum at one of these nodes, which its internal
 * force has more. */
void films_strain(films_work *w, pool *threads, const double *value);
void films_sum(const films_work *w, int64_t i, double force[3]);

/* 1/s2: no less than the square of the highest frequency with films, where the elements' is `square`, at displacements
 * of all nodes (x 3). Without films, square. */
double films_square(films_work *w, pool *threads, const double *displacement, const double *value, double square);

#endif
