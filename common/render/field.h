/* A quantity to colour by: one number for every node or element, what it is called, and its unit as it is shown. The
 * caller owns a field; names are borrowed from the model.
 */
#ifndef SINEW_FIELD_H
#define SINEW_FIELD_H

#include "model/model.h"

typedef struct field {
    bool of_elements; /* else of nodes */
    double *value;    /* elements or nodes; SI, or the index of a name; nan: there is none */
    int64_t count;
    double *vector;    /* of node arrays of three: nodes x 3, from which value comes; else NULL */
    int component;     /* of vector, or -1: its norm */
    bool displaces;    /* vector is the nodes' displacement: bone carries it as it carries vertices */
    char label[120];   /* "displacement" */
    char si[16];       /* "m", "Pa", …; "": a pure number */
    bool below_zero;   /* may be below 0: a scale need not begin at 0 */
    bool folds;        /* J: a scale begins at 0, and what is not above it is folded and stands out */
    char *const *name; /* of a quantity that is a name, such as material: what the indices mean; else NULL */
    int64_t names;
} field;

/* displacement, displacement.x|y|z, strain (von Mises' equivalent of Green-Lagrange's), strain.max (its largest
 * principal value), stress (element.stress.mises), quality.j.centre, quality.j.corner (mesh/quality.h), volume,
 * material; element.stress.xx and the other numbers of what results.h has, whether the frame has them or not; or an
 * array over nodes or elements by its name: its numbers, .x|y|z of its three, or their norm. f NULL: at rest, where
 * only what the body holds is there. -1 with e filled: no such field (with the names there are), or the model lacks
 * what it takes. */
int field_of(field *to, const model *m, const frame *f, const char *name, err *e);
void field_free(field *f);

/* The value of a vector: its component, or its norm. */
double field_of_vector(const field *f, const double vector[3]);

/* Values at the nodes: as they are, or the mean of the elements round a node, of J the smallest. nan where there is
 * none. The caller frees them. */
double *field_at_nodes(const field *f, const model *m, err *e);

/* How numbers up to `most` are shown: multiplied by *scale, in the unit that is returned. Lengths are in the model's
 * source.unit, stresses in Pa, kPa or MPa. */
const char *field_unit(const field *f, const model *m, double most, double *scale);

#endif
