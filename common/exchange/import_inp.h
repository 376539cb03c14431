/* Abaqus's input file, as far as it is a mesh: *NODE, *ELEMENT (C3D8, C3D4 and their variants), *NSET, *ELSET, *SOLID
 * SECTION, *MATERIAL with *ELASTIC, *HYPERELASTIC of a law of inp_law.h, *DENSITY, *BOUNDARY. After the Abaqus
 * Analysis User's Guide, "Input Syntax Rules", and CalculiX's manual. Sets are kept as ranges, so that a line that
 * generates many numbers takes no more room than its text.
 */
#ifndef SINEW_IMPORT_INP_H
#define SINEW_IMPORT_INP_H

#include "base/in.h"
#include "exchange/import_mesh.h"

/* Fills the mesh: volumes from sections (where there are none, from the ELSET of *ELEMENT), rigid nodes from *BOUNDARY
 * and from the sets that the wishes name. -1 with e at file:line. */
int import_inp(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e);

#endif
