/* The strain of films on bone (films.h) and what comes of it, in double, for reports and forces: apart from films.h, as
 * executors of other precisions read that. Owns nothing.
 */
#ifndef SINEW_FILM_STRAIN_H
#define SINEW_FILM_STRAIN_H

#include "physics/element.h"
#include "tled/problem/films.h"

/* How the bone of a film has moved. value: the curves'. */
film_bone films_bone(const tled_problem *p, int64_t film, const double *value);

/* H of a film. moved: displacements of all nodes (x 3) or of the films' nodes; at: 8, where its corners are in it. */
element_tensor films_gradient(const tled_problem *p, int64_t film, const double *moved, const int32_t *at,
                              const double *value);

/* The first Piola stress of a film, Pa, and its energy, J, without what muscles do. */
element_tensor films_stress(const tled_problem *p, int64_t film, element_tensor h, const double *value);
double films_energy(const tled_problem *p, int64_t film, element_tensor h);

/* What a film pulls a corner of its element with, A d P g, N. */
void films_pull(const films *f, int64_t film, int corner, const element_tensor *stress, double pull[3]);

/* The sum of all films' energies at displacements of all nodes, J, in their order. */
double films_energies(const tled_problem *p, const double *displacement, const double *value);

#endif
