/* What the elements of a model hold in a frame: stress, strain, stretches and energies, from the displacements of the
 * nodes, the materials, and what muscles were activated to. In double whatever executor ran, once an element, at its
 * centre, or its mean over what is enclosed of it and no film's; energies by material have the films' too. So the
 * arrays of a frame are the same, whether tled-run adds them or `sinew results` does later. The creator owns a results;
 * it borrows from the model and the threads.
 */
#ifndef SINEW_RESULTS_H
#define SINEW_RESULTS_H

#include "base/pool.h"
#include "cli/opt.h"
#include "model/model.h"

/* X(NAME, name on command lines, array, numbers an element or 0): the arrays are described in model/known.h. */
#define RESULTS_ROWS(X)                                                                                                \
    X(STRESS, "stress", "element.stress", 6)                                                                           \
    X(MISES, "stress.mises", "element.stress.mises", 1)                                                                \
    X(STRAIN, "strain", "element.strain", 6)                                                                           \
    X(STRETCH, "stretch", "element.stretch", 3)                                                                        \
    X(FIBRE_STRETCH, "stretch.fibre", "element.stretch.fibre", 1)                                                      \
    X(ENERGY, "energy", "element.energy", 1)                                                                           \
    X(MATERIAL_ENERGY, "material.energy", "material.energy", 0)                                                        \
    X(ACTIVATION, "activation", "volume.activation", 0)

#define RESULTS_NUMBER(NAME, name, array, columns) RESULTS_##NAME,
enum { RESULTS_ROWS(RESULTS_NUMBER) RESULTS };
#undef RESULTS_NUMBER

/* For the help and completion: the names between '|'. */
#define RESULTS_CHOICES "stress|stress.mises|strain|stretch|stretch.fibre|energy|material.energy|activation|all"

typedef struct results results;

/* Adds the bits 1 << RESULTS_STRESS and so on of names between commas; `all`: every one. option: for the message, NULL
 * of operands. -1 with e filled (status 2). */
int results_read(const char *list, const char *option, unsigned *which, err *e);

/* The row of such a name, or of the name of an array, in either spelling; RESULTS: there is none. */
int results_find(const char *name);
const char *results_array(int row);

/* Numbers an element; 0: the row is not of elements. */
int results_columns(int row);

/* -1 with e filled, and *r NULL, where the model lacks what these take. */
int results_create(results **r, const model *m, unsigned which, pool *threads, err *e);
void results_destroy(results *r);

/* Adds the arrays to a frame of the model that has node.displacement. activation: of the muscle that each volume is, 0
 * to 1; NULL: the frame's volume.activation, and where it has none nothing contracts. */
int results_add(results *r, frame *f, const double *activation, err *e);

/* One of them alone: elements x its columns, to be filled. */
void results_of_elements(results *r, int row, const frame *f, float *to);

struct film_bone;

/* Strain energy by material, J; u: nodes x 3, m; bone: how that of each film has moved; NULL where there is none. */
void results_energies(results *r, const double *u, const struct film_bone *bone, double *to);

#endif
