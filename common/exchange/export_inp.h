/* An input file for Abaqus and CalculiX: nodes, elements, sets, boundary conditions, materials and one static step. SI
 * units; nodes and elements are numbered from 1 in the model's order. The out is the caller's.
 */
#ifndef SINEW_EXPORT_INP_H
#define SINEW_EXPORT_INP_H

#include "base/out.h"
#include "exchange/export_shape.h"
#include "physics/law.h"

typedef struct export_inp_options {
    const char *element; /* of hexahedra: "C3D8R" or "C3D8" */
    double gravity[3];   /* m/s2; all 0: none */
} export_inp_options;

/* Writes the rest model. -1 with e filled and nothing written where it lacks volumes or materials, or a value makes no
 * material, or a law is not in such files (export_inp_has_law). What is left out (an empty volume) is noted. */
int export_inp(const model *m, const export_inp_options *options, out *to, notes *warnings, err *e);

/* -1 with e filled where the files have no such law. name: of the material. */
int export_inp_has_law(const law_row *law, const char *name, err *e);

/* The shortest text of at most 20 characters (the field of an input file) that is nearest to the value. text holds
 * 32 bytes. */
void export_inp_number(double value, char *text);

/* Set names of letters, digits and _, in capitals, that begin with a letter; two that would be the same become _2, _3.
 * name: count of them; to: count x size. */
void export_inp_names(char *const *name, int64_t count, const char *prefix, char *to, size_t size);

#endif
