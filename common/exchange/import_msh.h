/* Gmsh's MSH files, as its manual's "Gmsh file formats" describes them: versions 2.2 and 4.1, ASCII and binary
 * (little-endian). Hexahedra and tetrahedra of first order are the mesh, a physical group of them a volume by its name;
 * points, lines and surfaces in a physical group tell nodes. What else a file holds is passed over.
 */
#ifndef SINEW_IMPORT_MSH_H
#define SINEW_IMPORT_MSH_H

#include "base/in.h"
#include "exchange/import_mesh.h"

/* Rigid nodes are those of groups that the wishes name and of a group named `rigid` (as sinew export writes it). -1
 * with e at file:line, or in binary at the section. */
int import_msh(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e);

#endif
